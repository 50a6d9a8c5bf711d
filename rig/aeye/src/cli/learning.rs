//! Arguments of datasets and trainings.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use drivers::checkpoint::CheckpointChoice;
use kernel::weather::WeatherPreset;
use lab::redrive::Need;
use lab::share::Share;
use perception::training;
use replay::Label;

use super::library::verdict;
use super::values::{
    CHECKPOINT, ImagingArgs, MAPS, ModelsArgs, file, jobs, one_checkpoint, people, rate, size, training_preset, weather,
};

/// The datasets that can be made.
#[derive(Debug, Subcommand)]
pub enum DatasetCommand {
    /// Frames with ground truth from simulated drives.
    Natural(NaturalArgs),
    /// The last 3 s of corner cases at 10 frames a second, with ground truth.
    Cases(CasesArgs),
    /// The paper's three training sets of equal size: natural, pedestrian and corner-case enriched.
    Mix(MixArgs),
    /// Make a dataset again from its recipe.
    Rebuild(RebuildArgs),
}

/// Arguments of `dataset cases`.
#[derive(Args, Clone, Debug)]
pub struct CasesArgs {
    /// Corner cases, or folders of them.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// Take only cases with these labels: walker, vehicle, rules, boredom.
    #[arg(long, value_delimiter = ',', value_name = "LABEL,...")]
    pub label: Vec<Label>,
    /// Take only cases on whose takeover a campaign came to one of these verdicts, which stands beside its recording.
    #[arg(long, value_delimiter = ',', value_parser = verdict(), value_name = "VERDICT,...")]
    pub verdict: Vec<Need>,
    /// Which split they become.
    #[arg(long, default_value = "train", value_parser = ["train", "val", "test"])]
    pub split: String,
    /// Size of the pictures.
    #[arg(long, default_value = "256x128", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// How the pictures are made.
    #[command(flatten)]
    pub imaging: ImagingArgs,
    /// A file with cameras that take every frame, instead of the drivers' (as of `render`): their names stand in those
    /// of its files.
    #[arg(long, value_name = "FILE.toml")]
    pub cameras: Option<PathBuf>,
    /// Cases drawn at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Folder of the dataset; must not exist, be empty, or hold this dataset already.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `dataset mix`.
#[derive(Args, Clone, Debug)]
pub struct MixArgs {
    /// Dataset whose training frames are replaced; its other splits are in all three sets.
    #[arg(long, value_name = "DIR")]
    pub natural: PathBuf,
    /// Dataset of drives among more people (`dataset natural --pedestrians N` with another seed).
    #[arg(long, value_name = "DIR")]
    pub pool: PathBuf,
    /// Dataset of corner cases.
    #[arg(long = "corner-cases", value_name = "DIR")]
    pub cases: PathBuf,
    /// Training frames replaced (paper: 1500; default: as many as the corner cases have).
    #[arg(long, value_name = "N")]
    pub replace: Option<u32>,
    /// Seed of which frames are replaced, and by which.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Folder of the datasets `natural`, `pedestrian` and `corner-case`; must not exist, be empty, or
    /// hold them already.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `dataset rebuild`.
#[derive(Args, Clone, Debug)]
pub struct RebuildArgs {
    /// `dataset.json` of a dataset, or its folder.
    pub recipe: PathBuf,
    /// Corner cases that the recipe asks for, or folders with cases anywhere below; they are found by their digests.
    #[arg(value_parser = file(), value_name = "FILE|DIR")]
    pub cases: Vec<PathBuf>,
    /// OpenDRIVE files of maps that are not bundled.
    #[arg(long, value_delimiter = ',', value_name = "FILE.xodr,...")]
    pub maps: Vec<String>,
    /// Whose models stand for what it shows.
    #[command(flatten)]
    pub models: ModelsArgs,
    /// Scenes simulated at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Folder of the dataset; one that was interrupted is completed.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `dataset natural`.
#[derive(Args, Clone, Debug)]
pub struct NaturalArgs {
    /// Scenes (drives) of the training split (paper: 85).
    #[arg(long, default_value_t = 85)]
    pub scenes: u32,
    /// Scenes of the validation split, with seeds of their own (paper: 20).
    #[arg(long, default_value_t = 20)]
    pub val_scenes: u32,
    /// Scenes of the test split, with seeds of their own (paper: 21).
    #[arg(long, default_value_t = 21)]
    pub test_scenes: u32,
    /// Frames a scene of training and validation, one a second (paper: 60).
    #[arg(long, default_value_t = 60)]
    pub frames: u32,
    /// Frames a scene of the test split (paper: 30).
    #[arg(long, default_value_t = 30)]
    pub test_frames: u32,
    /// Size of the pictures.
    #[arg(long, default_value = "256x128", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// How the pictures are made.
    #[command(flatten)]
    pub imaging: ImagingArgs,
    /// A file with cameras that take every frame, instead of the drivers' (as of `render`): their names stand in those
    /// of its files.
    #[arg(long, value_name = "FILE.toml")]
    pub cameras: Option<PathBuf>,
    /// Bundled maps or OpenDRIVE files, in turn; `all` are the bundled ones.
    #[arg(long, value_delimiter = ',', default_value = "all", value_name = MAPS)]
    pub maps: Vec<String>,
    /// People on foot in each scene, instead of as many as the map's default scenario has.
    #[arg(long, value_parser = people, value_name = "N")]
    pub pedestrians: Option<u16>,
    /// The scenes' weathers, in turn after each round of maps (as `weather.preset` of scenarios), instead of those that their seeds
    /// draw.
    #[arg(long, value_delimiter = ',', value_parser = weather(), value_name = "NAME,...")]
    pub weather: Vec<WeatherPreset>,
    /// Seed of the dataset.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Scenes simulated at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Do one share of the scenes: of N, the I-th one. The folders of all shares, copied into one, are completed by the same
    /// command without `--shard`.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Share>,
    /// Folder of the dataset; one that was interrupted is completed.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `train`.
#[derive(Args, Clone, Debug)]
pub struct TrainArgs {
    /// Dataset folder.
    #[arg(long, value_name = "DIR")]
    pub dataset: PathBuf,
    /// Where the checkpoint goes.
    #[arg(long, value_name = "C.onnx")]
    pub out: PathBuf,
    /// Passes over the training split.
    #[arg(long, default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..))]
    pub epochs: u32,
    /// Seed of weights, order and augmentation.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Size at which the network is trained.
    #[arg(long, default_value = "256x128", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// Epochs after which the learning rate would be 0 (default: `--epochs`). A larger one makes a
    /// training that is stopped early, and that can go on later.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub horizon: Option<u32>,
    /// Stop after so many epochs without a better validation mIoU, and keep the best epoch's network
    /// instead of the last one's.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub patience: Option<u32>,
    /// Frames a step.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(2..))]
    pub batch: u32,
    /// Threads that share a batch; the result depends on their number, not on the machine's.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub replicas: u32,
    /// First learning rate.
    #[arg(long, default_value_t = 2e-3, value_parser = rate)]
    pub rate: f32,
    /// What pictures look like and how often what is rare is shown: `plain`, as the bundled networks were trained, or
    /// `people`, which shows people and other rare things more often, also from nearby, under more lights, colours and
    /// faults of cameras.
    #[arg(long, default_value = "plain", value_parser = training_preset())]
    pub preset: training::Preset,
    /// People less high than this in a picture count nowhere, pixels of `--size` (default: as the preset has it).
    #[arg(long, value_name = "PX")]
    pub min_height: Option<u32>,
}

/// Arguments of `eval`.
#[derive(Args, Clone, Debug)]
pub struct EvalArgs {
    /// Checkpoint.
    #[arg(long, value_parser = one_checkpoint, value_name = CHECKPOINT)]
    pub checkpoint: CheckpointChoice,
    /// Dataset folder.
    #[arg(long, value_name = "DIR")]
    pub dataset: PathBuf,
    /// Which split.
    #[arg(long, default_value = "val", value_name = "SPLIT")]
    pub split: String,
    /// Frames looked at at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Folder for the predictions, as `CITY/CITY_SEQ_FRAME_pred_labelIds.png` in tags; must not exist or
    /// be empty.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}
