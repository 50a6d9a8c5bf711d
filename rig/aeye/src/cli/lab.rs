//! Arguments of what looks at corner cases again.

use std::path::PathBuf;

use clap::Args;
use drivers::checkpoint::CheckpointChoice;
use drivers::film::Viewpoint;
use kernel::map::BUNDLED;
use kernel::time::{CLIP_FPS, Tick};
use kernel::weather::WeatherPreset;
use lab::compare::Gate;
use lab::export::Format;
use lab::redrive::Need;
use lab::share::Share;
use lab::still::{LAYERS, Layer};
use render::{ModelsId, Quality, Sensor};

use super::library::verdict;
use super::values::{
    CHECKPOINT, CHECKPOINTS, ImagingArgs, ModelsArgs, SENSOR, duration, file, frame_rate, jobs, models, moment,
    one_checkpoint, people, quality, seconds, size, weather,
};

/// Arguments of `rerender`.
#[derive(Args, Clone, Debug)]
#[command(override_usage = "aeye rerender <FILE|DIR>... --checkpoint <C,...> --out <DIR> [OPTIONS]")]
pub struct RerenderArgs {
    /// Recordings or cases, or folders with cases anywhere below.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// Checkpoints to look through.
    #[arg(long, required = true, value_delimiter = ',', value_name = CHECKPOINTS)]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Length of the window that ends at the intervention (or at the end), as in `3s`.
    #[arg(long, default_value = "3s", value_parser = duration, value_name = "DURATION")]
    pub last: Tick,
    /// Frames a second; must divide 60.
    #[arg(long, default_value_t = CLIP_FPS, value_parser = frame_rate)]
    pub fps: u32,
    /// Size of the pictures (default: that which the first network takes, 256x128 where it takes any); other
    /// networks see them resampled.
    #[arg(long, value_parser = size, value_name = "WxH")]
    pub size: Option<(u32, u32)>,
    /// How the pictures are made.
    #[command(flatten)]
    pub imaging: ImagingArgs,
    /// A file with cameras that see the windows, too (as of `render`): colour and labels in `OUT/FILE/cameras/NAME`.
    #[arg(long, value_name = "FILE.toml")]
    pub cameras: Option<PathBuf>,
    /// Frames looked at at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Do one share of the files: of N, the I-th one. The folders of all shares, copied into one, are completed by the same
    /// command without `--shard`.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Share>,
    /// Folder of the results. One that this command began with the same options is completed: what is whole and
    /// follows from the same files and checkpoints is kept.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `render`.
#[derive(Args, Clone, Debug)]
#[command(override_usage = "aeye render [FILE] --out <FILE.png> [OPTIONS]")]
pub struct RenderArgs {
    /// A recording or case; without one, a run is simulated so far, with drivers who see the truth.
    #[arg(value_parser = file(), value_name = "FILE", conflicts_with_all = ["map", "scenario", "seed", "weather", "pedestrians"])]
    pub file: Option<PathBuf>,
    /// A bundled map or an OpenDRIVE file (default: city).
    #[arg(long, value_name = "NAME|FILE.xodr", conflicts_with = "scenario")]
    pub map: Option<String>,
    /// A scenario file, a story in OpenSCENARIO XML, or a bundled story by name, as cut_out.
    #[arg(long, value_name = "FILE.toml|FILE.xosc|STORY")]
    pub scenario: Option<PathBuf>,
    /// Seed of everything random; replaces the scenario's.
    #[arg(long)]
    pub seed: Option<u64>,
    /// Weather by its name, as `weather.preset` of scenarios; replaces the scenario's.
    #[arg(long, value_parser = weather(), value_name = "NAME")]
    pub weather: Option<WeatherPreset>,
    /// People on foot, instead of as many as the scenario or the map's default has.
    #[arg(long, value_parser = people, value_name = "N")]
    pub pedestrians: Option<u16>,
    /// Time of the run (default: that of the corner case or the end of a file, else 20s).
    #[arg(long, value_parser = moment, value_name = "TIME")]
    pub at: Option<Tick>,
    /// From where: as both drivers see, from behind the car, or from above, north up.
    #[arg(long, default_value = "driver", value_name = "driver|chase|top")]
    pub camera: Viewpoint,
    /// Instead of that, through each camera of a file: `[[cameras]]` with name, x_m, y_m, z_m, yaw_rad, pitch_rad, fov_x_rad,
    /// width, height, quality and sensor. Their pictures go to the folder `--out`.
    #[arg(long, value_name = "FILE.toml", conflicts_with = "camera")]
    pub cameras: Option<PathBuf>,
    /// What of the picture: colour, classes in the colours of their tags, instances, or depth in parts of 1/256 m.
    #[arg(long, default_value = "rgb", value_name = LAYERS)]
    pub layer: Layer,
    /// Size of the picture.
    #[arg(long, default_value = "1280x640", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// How the pictures are made.
    #[command(flatten)]
    pub imaging: ImagingArgs,
    /// Where it goes; a file that is there stays. With `--cameras` a new folder, with a file for each.
    #[arg(long, value_name = "FILE.png|DIR")]
    pub out: PathBuf,
}

/// Arguments of `gallery`.
#[derive(Args, Clone, Debug)]
pub struct GalleryArgs {
    /// Bundled maps or OpenDRIVE files.
    #[arg(long, value_delimiter = ',', default_values = BUNDLED, value_name = "NAME|FILE.xodr,...")]
    pub maps: Vec<String>,
    /// Seed of the runs.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Time of the runs.
    #[arg(long, value_parser = moment, default_value = "20s", value_name = "TIME")]
    pub at: Tick,
    /// From where: as both drivers see, from behind the car, or from above, north up.
    #[arg(long, default_value = "driver", value_name = "driver|chase|top")]
    pub camera: Viewpoint,
    /// Size of the pictures.
    #[arg(long, default_value = "640x320", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// How good the pictures are: fast, with smooth edges, or the best (for GPUs).
    #[arg(long, default_value = "fine", value_parser = quality(), value_name = "NAME")]
    pub quality: Quality,
    /// What lens and chip do to the pictures, as in `exposure_ev=-1,noise=4` (default: nothing).
    #[arg(long, value_name = SENSOR)]
    pub sensor: Option<Sensor>,
    /// Folder with models of your own for vehicles, people, trees and furniture (default: none).
    #[arg(long, value_parser = models, value_name = "DIR")]
    pub models: Option<ModelsId>,
    /// Folder they go to; a gallery of the same options there is gone on with.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `export`.
#[derive(Args, Clone, Debug)]
#[command(override_usage = "aeye export <FILE|DIR>... [--checkpoint <C,...>] --out <OUT|DIR> [OPTIONS]")]
pub struct ExportArgs {
    /// Recordings or cases, or folders with cases anywhere below.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// As what: messages for viewers of robot logs, moving pictures, which but for apng take `ffmpeg` on the PATH, a story, a
    /// trace of OSI, annotations of COCO, labels of OpenLABEL, a bag of ROS 2, or what was heard (default: by the
    /// ending of --out, else mcap).
    #[arg(long, value_name = "mcap|apng|gif|mp4|openscenario|osi|coco|openlabel|ros2|wav")]
    pub format: Option<Format>,
    /// From where moving pictures are taken: as both drivers see, from behind the car, or from above, north up.
    #[arg(long, default_value = "driver", value_name = "driver|chase|top")]
    pub camera: Viewpoint,
    /// Checkpoints whose masks come along: with the ground truth, or on the right of a moving picture.
    #[arg(long, value_delimiter = ',', value_name = CHECKPOINTS)]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Only a window of this length that ends at the intervention (or at the end), as in `3s`; without a
    /// window everything is exported.
    #[arg(long, value_parser = duration, value_name = "DURATION", conflicts_with_all = ["from", "to"])]
    pub last: Option<Tick>,
    /// Only from this time of the run on, as in `10s`.
    #[arg(long, value_parser = moment, value_name = "TIME")]
    pub from: Option<Tick>,
    /// Only up to this time of the run, as in `20s`.
    #[arg(long, value_parser = moment, value_name = "TIME")]
    pub to: Option<Tick>,
    /// Pictures a second; must divide 60. What is measured is exported at every tick.
    #[arg(long, default_value_t = CLIP_FPS, value_parser = frame_rate)]
    pub fps: u32,
    /// Size of the pictures (default: that which the first network takes, 256x128 where it takes any); other
    /// networks see them resampled.
    #[arg(long, value_parser = size, value_name = "WxH")]
    pub size: Option<(u32, u32)>,
    /// How the pictures are made.
    #[command(flatten)]
    pub imaging: ImagingArgs,
    /// A file with cameras whose pictures come along (as of `render`), in mcap, ros2, coco and openlabel.
    #[arg(long, value_name = "FILE.toml")]
    pub cameras: Option<PathBuf>,
    /// Files exported at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// File of the export, `*.mcap` with its layout for viewers beside it, `*.png` (apng), `*.gif`, `*.mp4`, `*.xosc` or `*.json`
    /// (openlabel); or a folder, for several files, coco and ros2. What is whole there and follows from the same files, checkpoints and options is kept.
    #[arg(long, value_name = "OUT|DIR")]
    pub out: PathBuf,
}

/// Arguments of `compare`.
#[derive(Args, Clone, Debug)]
#[command(override_usage = "aeye compare <FILE|DIR>... --checkpoint <A,B,...> --out <DIR> [OPTIONS]")]
pub struct CompareArgs {
    /// Corner cases, or folders with cases anywhere below.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// Take only cases on whose takeover a campaign came to one of these verdicts, which stands beside its recording.
    #[arg(long, value_delimiter = ',', value_parser = verdict(), value_name = "VERDICT,...")]
    pub verdict: Vec<Need>,
    /// Two or more checkpoints; the first is the baseline.
    #[arg(long, required = true, value_delimiter = ',', value_name = CHECKPOINTS)]
    pub checkpoint: Vec<CheckpointChoice>,
    /// A condition on every checkpoint but the baseline, as in `ped_iou>=0.5`. Metrics: ped_iou, miou,
    /// ped_recall_on_path, hazards_seen (share of the hazards seen 1 s or more before the intervention),
    /// first_sight_s (mean), and against the baseline the numbers of cases fixed and broken.
    #[arg(long, value_delimiter = ',', value_name = "CONDITION,...")]
    pub gate: Vec<Gate>,
    /// A checkpoint than which no other may be worse: of no metric may the paired 95 % interval of the
    /// difference lie below 0 as a whole.
    #[arg(long, value_name = "NAME")]
    pub no_worse_than: Option<String>,
    /// Size of the pictures (default: that which the first network takes, 256x128 where it takes any); other
    /// networks see them resampled.
    #[arg(long, value_parser = size, value_name = "WxH")]
    pub size: Option<(u32, u32)>,
    /// How the pictures are made.
    #[command(flatten)]
    pub imaging: ImagingArgs,
    /// Frames looked at at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Do one share of the files: of N, the I-th one. The folders of all shares, copied into one, are completed by the same
    /// command without `--shard`, which alone looks at gates.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Share>,
    /// Folder of the results. One that this command began is completed: what follows from the same cases,
    /// checkpoints and size is kept.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `redrive`.
#[derive(Args, Clone, Debug)]
#[command(group = clap::ArgGroup::new("counterfactual").required(true).args(["without_intervention", "checkpoint"]))]
pub struct RedriveArgs {
    /// Recordings or cases with an intervention (or a collision that nobody prevented, for
    /// `--checkpoint`), or folders with cases anywhere below.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// The safety driver does nothing from the tick of the intervention on; the semantic driver is a bot
    /// that looks through the recorded checkpoint. What would have happened?
    #[arg(long)]
    pub without_intervention: bool,
    /// Bots drive from the first tick at hand, at least 3 s before the intervention, the semantic one
    /// looking through this checkpoint. Is there an intervention again?
    #[arg(long, value_parser = one_checkpoint, value_name = CHECKPOINT)]
    pub checkpoint: Option<CheckpointChoice>,
    /// Where the recorded checkpoint may be found, if it does not come with the program.
    #[arg(long = "recorded-checkpoint", value_delimiter = ',', value_name = "FILE.onnx,...")]
    pub recorded: Vec<CheckpointChoice>,
    /// Tell the checkpoint of blind drives.
    #[arg(long)]
    pub reveal: bool,
    /// Further forks of each file with other weather of the paper's ranges and, without the
    /// intervention, with the safety driver gone 0.1 s earlier each; through another checkpoint, with
    /// safety drivers of other reaction times.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=30))]
    pub vary: u16,
    /// How long after the intervention a fork goes on, 1s to 60s.
    #[arg(long = "after", default_value = "10s", value_parser = seconds(1..=60), value_name = "DURATION")]
    pub seconds: u32,
    /// Files driven on at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Whose models stand for what it shows.
    #[command(flatten)]
    pub models: ModelsArgs,
    /// Do one share of the files: of N, the I-th one. The folders of all shares, copied into one, are completed by the same
    /// command without `--shard`.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Share>,
    /// Folder of the forks' recordings and of `redrive.jsonl`. One that this command began with the same options is
    /// completed: forks that are there and follow from the same file are kept.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `report`.
#[derive(Args, Clone, Debug)]
#[command(override_usage = "aeye report <FILE|DIR>... --checkpoint <C,...> --out <FILE.html> [OPTIONS]")]
pub struct ReportArgs {
    /// Corner cases, or folders with cases anywhere below. Kilometres are those of all recordings anywhere below the
    /// folders, in the folders of the cases that are named, and that are named themselves.
    #[arg(required = true, value_parser = file(), value_name = "FILE|DIR")]
    pub files: Vec<PathBuf>,
    /// Checkpoints to look through.
    #[arg(long, required = true, value_delimiter = ',', value_name = CHECKPOINTS)]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Size of the pictures (default: that which the first network takes, 256x128 where it takes any); other
    /// networks see them resampled.
    #[arg(long, value_parser = size, value_name = "WxH")]
    pub size: Option<(u32, u32)>,
    /// Cases drawn at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Where the page goes.
    #[arg(long, value_name = "FILE.html")]
    pub out: PathBuf,
}
