//! The command line of `aeye`.

mod values;

use std::convert::Infallible;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Parser, Subcommand, ValueEnum};
use kernel::time::{CLIP_FPS, Tick};
use perception::BUNDLED;

use crate::live::foxglove;
use crate::study::StudyArgs;
use crate::units::SeatChoice;
use values::{duration, force, frame_rate, rate, size, threshold};

/// Drive by the eyes of a network, record every tick, and learn from every takeover.
///
/// Data goes to stdout, progress and errors to stderr. Exit codes: 0 ok, 1 error (unreadable,
/// damaged), 2 usage, 3 a check failed.
#[derive(Debug, Parser)]
#[command(name = "aeye", version)]
pub struct Cli {
    /// Print JSON on stdout instead of text.
    #[arg(long, global = true)]
    pub json: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// Every command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Drive in windows, or one run without, and record it.
    Drive(Box<DriveArgs>),
    /// Simulated drives, headless, until so many runs, kilometres or corner cases.
    Campaign(CampaignArgs),
    /// Simulate recordings again and compare every tick.
    Verify(VerifyArgs),
    /// Say what is in recordings or cases.
    Inspect(InspectArgs),
    /// Look at a recording or case in a window, tick by tick.
    View(ViewArgs),
    /// Attach answers that were given after a drive.
    Questionnaire(QuestionnaireArgs),
    /// Render the window of recordings or cases through checkpoints.
    Rerender(RerenderArgs),
    /// Drive corner cases on from before the intervention: was it necessary?
    Redrive(RedriveArgs),
    /// Make datasets.
    #[command(subcommand)]
    Dataset(DatasetCommand),
    /// Train Fast-SCNN from a dataset folder.
    Train(TrainArgs),
    /// Measure a checkpoint on a dataset folder.
    Eval(EvalArgs),
    /// One self-contained page about corner cases.
    Report(ReportArgs),
    /// Drive until three corner cases, verify, render them again, and write a report.
    Demo(DemoArgs),
    /// List and calibrate wheels and gamepads.
    #[command(subcommand)]
    Wheel(WheelCommand),
    /// Say what this machine has and how fast it is.
    Doctor(DoctorArgs),
}

/// What the semantic driver looks at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CheckpointChoice {
    /// `truth`: the renderer's class ids instead of a prediction.
    Truth,
    /// One that comes with the program, by name.
    Bundled(&'static str),
    /// An ONNX file.
    File(PathBuf),
}

impl FromStr for CheckpointChoice {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        let bundled = BUNDLED.into_iter().find(|name| *name == text);
        Ok(match bundled {
            _ if text == "truth" => Self::Truth,
            Some(name) => Self::Bundled(name),
            None => Self::File(PathBuf::from(text)),
        })
    }
}

/// Arguments of `drive`.
#[derive(Args, Debug)]
pub struct DriveArgs {
    /// Without windows: bots in both seats, as fast as the machine allows.
    #[arg(long)]
    pub headless: bool,
    /// What the semantic driver drives with: `auto` takes a device if there is one, else the keyboard;
    /// `press` the device on which a button is pressed next.
    #[arg(long, value_name = "auto|keyboard|press|DEVICE|bot", conflicts_with = "headless")]
    pub semantic: Option<SeatChoice>,
    /// What the safety driver drives with.
    #[arg(long, value_name = "auto|keyboard|press|DEVICE|bot", conflicts_with = "headless")]
    pub safety: Option<SeatChoice>,
    /// Calibrations of wheels and gamepads, chosen by the names of their devices; others are read by
    /// presets.
    #[arg(long, value_name = "FILE.toml", conflicts_with = "headless")]
    pub calibration: Vec<PathBuf>,
    /// Greatest force of wheels and gamepads, 0 (off) to 1 (all that they can).
    #[arg(long, default_value_t = 0.6, value_parser = force, value_name = "FRACTION")]
    pub force: f32,
    /// Shows the drive to Foxglove at this port of this machine, or at this address.
    #[arg(long, value_parser = foxglove::address, value_name = "PORT|ADDRESS:PORT")]
    pub foxglove: Option<SocketAddr>,
    /// A bundled map or an OpenDRIVE file.
    #[arg(long, value_name = "NAME|FILE.xodr", conflicts_with = "scenario")]
    pub map: Option<String>,
    /// A scenario file.
    #[arg(long, value_name = "FILE.toml")]
    pub scenario: Option<PathBuf>,
    /// What the semantic driver sees: a bundled checkpoint, ground truth, or an ONNX file.
    #[arg(long, default_value = "truth", value_name = "early|full|truth|FILE.onnx")]
    pub checkpoint: CheckpointChoice,
    /// Seed of everything random; replaces the scenario's.
    #[arg(long)]
    pub seed: Option<u64>,
    /// Longest simulated time, seconds; 4 to 86400, as `rules.max_seconds` of scenarios.
    #[arg(long, value_parser = clap::value_parser!(u32).range(4..=86_400))]
    pub seconds: Option<u32>,
    /// Sizes of the pictures in windows.
    #[command(flatten)]
    pub sizes: SizeArgs,
    /// Brake of the safety driver beyond which it intervenes, 0.01 to 0.99 of the pedal, as
    /// `rules.brake_threshold` of scenarios (default there: 0.1).
    #[arg(long, value_parser = threshold, value_name = "FRACTION")]
    pub brake_threshold: Option<f32>,
    /// Steering of the safety driver beyond which it intervenes, 0.01 to 0.99 of full steering, as
    /// `rules.steer_threshold` of scenarios (default there: 0.1).
    #[arg(long, value_parser = threshold, value_name = "FRACTION")]
    pub steer_threshold: Option<f32>,
    /// Where the recording goes; further live runs go to FILE-2.mcap, FILE-3.mcap and so on.
    #[arg(long, value_name = "FILE.mcap")]
    pub record: PathBuf,
    /// What makes it part of a study with people.
    #[command(flatten, next_help_heading = "Study")]
    pub study: StudyArgs,
}

/// Sizes of the live rig's pictures.
#[derive(Args, Clone, Debug)]
pub struct SizeArgs {
    /// Size of the safety driver's picture.
    #[arg(long, default_value = "640x360", value_parser = size, value_name = "WxH")]
    pub image_size: (u32, u32),
    /// Size of the semantic driver's mask (default: the checkpoint's own, 256x128).
    #[arg(long, value_parser = size, value_name = "WxH")]
    pub mask_size: Option<(u32, u32)>,
    /// Monitors that the safety driver's view is spread over: 3 show 60 degrees each, every one of
    /// `--image-size`.
    #[arg(long, default_value = "1")]
    pub screens: Screens,
}

/// Monitors that a view is spread over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Screens {
    /// One.
    #[value(name = "1")]
    One,
    /// Three side by side.
    #[value(name = "3")]
    Three,
}

/// Arguments of `doctor`.
#[derive(Args, Debug)]
pub struct DoctorArgs {
    /// How long bots drive in windows to measure real time, seconds of simulated time; 0: not at all.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(0..=86_400))]
    pub seconds: u32,
    /// What the semantic driver sees there.
    #[arg(long, default_value = "full", value_name = "early|full|truth|FILE.onnx")]
    pub checkpoint: CheckpointChoice,
    /// Sizes of the pictures there.
    #[command(flatten)]
    pub sizes: SizeArgs,
}

/// Arguments of `campaign`.
#[derive(Args, Debug)]
#[command(group = clap::ArgGroup::new("until").required(true).args(["runs", "km", "cases"]))]
pub struct CampaignArgs {
    /// What the semantic driver sees: bundled checkpoints, ground truth, or ONNX files; each drives
    /// the same runs.
    #[arg(long, required = true, num_args = 1.., value_name = "early|full|truth|FILE.onnx")]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Bundled maps or OpenDRIVE files, in turn; `all` are the bundled ones (default: the scenario's
    /// map, or all).
    #[arg(long, value_delimiter = ',', value_name = "NAMES|all")]
    pub maps: Vec<String>,
    /// A scenario file; its seed and length are replaced for each run.
    #[arg(long, value_name = "FILE.toml")]
    pub scenario: Option<PathBuf>,
    /// Number of runs of each checkpoint.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub runs: Option<u32>,
    /// Kilometres of each checkpoint.
    #[arg(long)]
    pub km: Option<f64>,
    /// Corner cases of each checkpoint.
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub cases: Option<u32>,
    /// Longest simulated time of a run, seconds.
    #[arg(long, default_value_t = 240, value_parser = clap::value_parser!(u32).range(10..=86_400))]
    pub run_seconds: u32,
    /// Seed of the campaign; run `i` follows from it and `i` alone.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Worlds simulated at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub jobs: Option<u16>,
    /// Folder of the results; a campaign that was interrupted goes on there.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `verify`.
#[derive(Args, Debug)]
pub struct VerifyArgs {
    /// Recordings or cases.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Also go back this many ticks again and again and compare (rollback self-check).
    #[arg(long, value_name = "TICKS", value_parser = clap::value_parser!(u16).range(1..=600))]
    pub rewind: Option<u16>,
    /// Compare with this recording tick by tick, and name the field that differs first.
    #[arg(long, value_name = "FILE")]
    pub against: Option<PathBuf>,
}

/// Arguments of `inspect`.
#[derive(Args, Debug)]
pub struct InspectArgs {
    /// Recordings or cases.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Tell which checkpoint drove blind drives.
    #[arg(long)]
    pub reveal: bool,
}

/// Arguments of `questionnaire`.
#[derive(Args, Debug)]
pub struct QuestionnaireArgs {
    /// Recordings.
    #[arg(required = true, value_name = "RECORDING")]
    pub files: Vec<PathBuf>,
    /// The drivers' answers.
    #[arg(long, value_name = "FILE.toml")]
    pub answers: PathBuf,
}

/// What `view --help` says about the window.
const VIEW_KEYS: &str = "\
One window shows two views side by side, so that layers can be compared, over the facts of the tick,
the events, and a timeline to click and drag on. Keys:
  Space                 play, stop
  Left, Right           one tick back or on; with Shift one frame (6 ticks)
  Up, Down              faster, slower (0.1 to 8 times real time)
  Page Up, Page Down    event before, next event; Home, End: first and last tick
  1 to 6                left view: seen mask, RGB, truth, prediction, difference, confidence;
                        with Shift the right view
  V, K                  next camera (driver, chase, from above), next checkpoint
  I, O, C               mark the first and the last tick of a range, cut it as a case
  S                     screenshot of both views
  H, F11, Q or Escape   HUD on and off, full screen, quit
Cases and screenshots go beside FILE, under names with their ticks that are free.";

/// Arguments of `view`.
#[derive(Args, Debug)]
#[command(after_help = VIEW_KEYS)]
pub struct ViewArgs {
    /// A recording or case; one that was cut off is shown as far as it goes.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// A checkpoint to look through; may be given several times (default: the bundled ones). The one
    /// that the run was driven through is among them when it is bundled.
    #[arg(long, value_name = "early|full|truth|FILE.onnx")]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Opens no window: makes every mask that was shown again and compares its digest with the logged
    /// one; exit code 3 if any differs. Equal digests are promised on the adapter that made them.
    #[arg(long)]
    pub digests: bool,
    /// Show a blind drive all the same, with its checkpoint.
    #[arg(long)]
    pub reveal: bool,
}

/// Arguments of `rerender`.
#[derive(Args, Debug)]
pub struct RerenderArgs {
    /// Recordings or cases.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Checkpoints to look through.
    #[arg(long, required = true, num_args = 1.., value_name = "early|full|truth|FILE.onnx")]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Length of the window that ends at the intervention (or at the end), as in `3s`.
    #[arg(long, default_value = "3s", value_parser = duration)]
    pub last: Tick,
    /// Frames a second; must divide 60.
    #[arg(long, default_value_t = CLIP_FPS, value_parser = frame_rate)]
    pub fps: u32,
    /// Size of the pictures.
    #[arg(long, default_value = "512x256", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// Folder of the results; must not exist or be empty.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `redrive`.
#[derive(Args, Debug)]
#[command(group = clap::ArgGroup::new("counterfactual").required(true).args(["without_intervention", "checkpoint"]))]
pub struct RedriveArgs {
    /// Recordings or cases with an intervention.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// The safety driver does nothing from the tick of the intervention on; the semantic driver is a bot
    /// that looks through the recorded checkpoint. What would have happened?
    #[arg(long)]
    pub without_intervention: bool,
    /// Bots drive from the first tick at hand, at least 3 s before the intervention, the semantic one
    /// looking through this checkpoint. Is there an intervention again?
    #[arg(long, value_name = "early|full|truth|FILE.onnx")]
    pub checkpoint: Option<CheckpointChoice>,
    /// Where the recorded checkpoint may be found, if it does not come with the program.
    #[arg(long, value_name = "FILE.onnx")]
    pub recorded: Vec<CheckpointChoice>,
    /// Tell the checkpoint of blind drives.
    #[arg(long)]
    pub reveal: bool,
    /// Further forks of each file with other weather of the paper's ranges and, without the
    /// intervention, with the safety driver gone 0.1 s earlier each.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=30))]
    pub vary: u16,
    /// How long after the intervention a fork goes on, seconds.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=60))]
    pub seconds: u16,
    /// Folder of the forks' recordings and of `redrive.jsonl`; must not exist or be empty.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// The datasets that can be made.
#[derive(Debug, Subcommand)]
pub enum DatasetCommand {
    /// Frames with ground truth from simulated drives.
    Natural(NaturalArgs),
    /// The last 3 s of corner cases at 10 frames a second, with ground truth.
    Cases(CasesArgs),
}

/// Arguments of `dataset cases`.
#[derive(Args, Debug)]
pub struct CasesArgs {
    /// Corner cases.
    #[arg(required = true, value_name = "CASE")]
    pub files: Vec<PathBuf>,
    /// Which split they become.
    #[arg(long, default_value = "train", value_parser = ["train", "val", "test"])]
    pub split: String,
    /// Size of the pictures.
    #[arg(long, default_value = "256x128", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// Folder of the dataset; must not exist or be empty.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `dataset natural`.
#[derive(Args, Debug)]
pub struct NaturalArgs {
    /// Scenes (drives) of the training split (paper: 85).
    #[arg(long, default_value_t = 85)]
    pub scenes: u32,
    /// Scenes of the validation split, with seeds of their own (paper: 20).
    #[arg(long, default_value_t = 20)]
    pub val_scenes: u32,
    /// Frames a scene, one a second (paper: 60).
    #[arg(long, default_value_t = 60)]
    pub frames: u32,
    /// Size of the pictures.
    #[arg(long, default_value = "256x128", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// Bundled maps or OpenDRIVE files, in turn; `all` are the bundled ones.
    #[arg(long, value_delimiter = ',', default_value = "all", value_name = "NAMES|all")]
    pub maps: Vec<String>,
    /// People on foot in each scene, instead of as many as the map's default scenario has.
    #[arg(long, value_name = "N")]
    pub pedestrians: Option<u16>,
    /// Seed of the dataset.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Scenes simulated at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub jobs: Option<u16>,
    /// Folder of the dataset; one that was interrupted is completed.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `train`.
#[derive(Args, Debug)]
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
    /// Frames a step.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(2..))]
    pub batch: u32,
    /// Threads that share a batch; the result depends on their number, not on the machine's.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub replicas: u32,
    /// First learning rate.
    #[arg(long, default_value_t = 2e-3, value_parser = rate)]
    pub rate: f32,
}

/// Arguments of `eval`.
#[derive(Args, Debug)]
pub struct EvalArgs {
    /// Checkpoint.
    #[arg(long, value_name = "early|full|truth|FILE.onnx")]
    pub checkpoint: CheckpointChoice,
    /// Dataset folder.
    #[arg(long, value_name = "DIR")]
    pub dataset: PathBuf,
    /// Which split.
    #[arg(long, default_value = "val")]
    pub split: String,
}

/// Arguments of `report`.
#[derive(Args, Debug)]
pub struct ReportArgs {
    /// Corner cases; the recordings beside them give route and kilometres.
    #[arg(required = true, value_name = "CASE")]
    pub files: Vec<PathBuf>,
    /// Checkpoints to look through.
    #[arg(long, required = true, num_args = 1.., value_name = "early|full|truth|FILE.onnx")]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Size of the pictures.
    #[arg(long, default_value = "256x128", value_parser = size, value_name = "WxH")]
    pub size: (u32, u32),
    /// Where the page goes.
    #[arg(long, value_name = "FILE.html")]
    pub out: PathBuf,
}

/// What to do with wheels and gamepads.
#[derive(Debug, Subcommand)]
pub enum WheelCommand {
    /// Say which are there, and by which calibration they would be read.
    List(WheelListArgs),
    /// Ask for each movement of a device and write its calibration.
    Calibrate(WheelCalibrateArgs),
    /// Write a calibration from the `wheel_config.ini` of CARLA's example.
    Import(WheelImportArgs),
}

/// Arguments of `wheel list`.
#[derive(Args, Debug)]
pub struct WheelListArgs {
    /// Calibrations to choose from, by the name of their device.
    #[arg(long, value_name = "FILE.toml")]
    pub calibration: Vec<PathBuf>,
}

/// Arguments of `wheel calibrate`.
#[derive(Args, Debug)]
pub struct WheelCalibrateArgs {
    /// The device, such as /dev/input/event5 (default: the only one).
    #[arg(long, value_name = "PATH")]
    pub device: Option<String>,
    /// Where the calibration goes.
    #[arg(long, value_name = "FILE.toml")]
    pub calibration: PathBuf,
}

/// Arguments of `wheel import`.
#[derive(Args, Debug)]
pub struct WheelImportArgs {
    /// The file of CARLA's example.
    #[arg(value_name = "wheel_config.ini")]
    pub file: PathBuf,
    /// The device that the file numbers axes and buttons of, such as /dev/input/event5 (default: a
    /// G29, which need not be there).
    #[arg(long, value_name = "PATH")]
    pub device: Option<String>,
    /// Where the calibration goes.
    #[arg(long, value_name = "FILE.toml")]
    pub calibration: PathBuf,
}

/// Arguments of `demo`.
#[derive(Args, Debug)]
pub struct DemoArgs {
    /// Seed of the campaign.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Folder of the results; a demo that was interrupted goes on there.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_campaign_needs_exactly_one_end() {
        let parse = |tail: &[&str]| {
            let head = ["aeye", "campaign", "--checkpoint", "truth", "--out", "d"];
            Cli::try_parse_from(head.iter().chain(tail)).is_ok()
        };
        assert!(parse(&["--runs", "4"]) && parse(&["--km", "1.5"]));
        assert!(!parse(&[]) && !parse(&["--runs", "4", "--cases", "1"]));
    }
}
