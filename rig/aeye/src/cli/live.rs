//! Arguments of the rig itself: drives, their viewer, the machine and its devices.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use drivers::checkpoint::CheckpointChoice;
use drivers::pictures::{Pictures, Screens};
use drivers::seat::SeatChoice;
use kernel::scenario::HazardLevel;
use kernel::weather::WeatherPreset;
use perception::Compute;
use study::{Pseudonym, Study};
use viewers::server::{self, Endpoint};

use super::values::{
    CHECKPOINT, CHECKPOINTS, ImagingArgs, ModelsArgs, file, force, hazards, new_recording, one_checkpoint, screens,
    seconds, size, threshold, weather,
};

/// Arguments of `drive`.
#[derive(Args, Clone, Debug)]
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
    #[arg(long, value_delimiter = ',', value_name = "FILE.toml,...", conflicts_with = "headless")]
    pub calibration: Vec<PathBuf>,
    /// Greatest force of wheels and gamepads, 0 (off) to 1 (all that they can).
    #[arg(long, default_value_t = 0.6, value_parser = force, value_name = "FRACTION", conflicts_with = "headless")]
    pub force: f32,
    /// Where the safety driver, and the operators, hear the car and are warned: `default` is the system's own choice, `off` none;
    /// else part of a device's name.
    #[arg(long, value_name = "default|off|DEVICE", conflicts_with = "headless")]
    pub sound: Option<String>,
    /// Where the semantic driver hears that the car was taken over, as the other one does (default: nowhere).
    #[arg(long, value_name = "default|off|DEVICE", conflicts_with = "headless")]
    pub semantic_sound: Option<String>,
    /// The semantic driver hears the car as well, with all that is around it: that tells what the mask does not.
    #[arg(long, requires = "semantic_sound")]
    pub semantic_hears_car: bool,
    /// Shows the drive to Foxglove at this port of this machine, or at this address.
    #[arg(long, value_parser = server::address, value_name = "PORT|ADDRESS:PORT")]
    foxglove: Option<SocketAddr>,
    /// Pages in browsers that may look on too, as `http://rig.lab:8080`; those of this machine and
    /// Foxglove's own always may.
    #[arg(long, value_delimiter = ',', value_parser = server::origin, value_name = "ORIGIN,...", requires = "foxglove")]
    foxglove_origin: Vec<String>,
    /// A bundled map or an OpenDRIVE file.
    #[arg(long, value_name = "NAME|FILE.xodr", conflicts_with = "scenario")]
    pub map: Option<String>,
    /// Put the file of a map that is not bundled into the recording, instead of beside it.
    #[arg(long)]
    pub embed_map: bool,
    /// A scenario file, a story in OpenSCENARIO XML, or a bundled story by name, as cut_out.
    #[arg(long, value_name = "FILE.toml|FILE.xosc|STORY")]
    pub scenario: Option<PathBuf>,
    /// What the semantic driver sees: a bundled checkpoint, ground truth, or an ONNX file.
    #[arg(long, default_value = "truth", value_parser = one_checkpoint, value_name = CHECKPOINT)]
    pub checkpoint: CheckpointChoice,
    /// Seed of everything random; replaces the scenario's.
    #[arg(long)]
    pub seed: Option<u64>,
    /// How often people at the wheel endanger others; replaces what the scenario says.
    #[arg(long, value_parser = hazards(), value_name = "LEVEL")]
    pub hazards: Option<HazardLevel>,
    /// Weather by its name, as `weather.preset` of scenarios; replaces the scenario's.
    #[arg(long, value_parser = weather(), value_name = "NAME")]
    pub weather: Option<WeatherPreset>,
    /// Longest simulated time of a run, 4s to 24h, as `rules.max_seconds` of scenarios.
    #[arg(long = "max-time", value_parser = seconds(4..=86_400), value_name = "DURATION")]
    pub seconds: Option<u32>,
    /// The pictures in windows.
    #[command(flatten)]
    pub pictures: PictureArgs,
    /// Brake of the safety driver beyond which it intervenes, 0.01 to 0.99 of the pedal, as
    /// `rules.brake_threshold` of scenarios (default there: 0.1).
    #[arg(long, value_parser = threshold, value_name = "FRACTION")]
    pub brake_threshold: Option<f32>,
    /// Steering of the safety driver beyond which it intervenes, 0.01 to 0.99 of full steering, as
    /// `rules.steer_threshold` of scenarios (default there: 0.1).
    #[arg(long, value_parser = threshold, value_name = "FRACTION")]
    pub steer_threshold: Option<f32>,
    /// Print the scenario that would be driven, as a file for `--scenario`, and do nothing.
    #[arg(long)]
    pub print_scenario: bool,
    /// Where the recording goes; further live runs go to FILE-2.mcap, FILE-3.mcap and so on.
    #[arg(
        long,
        value_name = "FILE.mcap",
        value_parser = new_recording(),
        required_unless_present = "print_scenario"
    )]
    record: Option<PathBuf>,
    /// What makes it part of a study with people.
    #[command(flatten, next_help_heading = "Study")]
    pub study: StudyArgs,
    /// Drive what a plan has for two people, from where it was left under the name of `--record`: maps, checkpoints and
    /// seats in order, breaks, questions.
    #[arg(
        long,
        value_name = "FILE.toml",
        help_heading = "Study",
        conflicts_with_all = [
            "headless", "map", "scenario", "embed_map", "checkpoint", "seed", "hazards", "weather", "seconds",
            "brake_threshold", "steer_threshold", "print_scenario", "semantic_name", "safety_name", "questionnaire",
            "familiarisation", "blind",
        ]
    )]
    pub plan: Option<PathBuf>,
    /// Print what the plan has, what of it is driven, and what each person did in each seat, and do nothing.
    #[arg(long, requires = "plan", help_heading = "Study")]
    pub print_plan: bool,
}

impl DriveArgs {
    /// Where the recording goes; nowhere where the scenario is only printed.
    pub fn record(&self) -> &Path {
        self.record.as_deref().unwrap_or(Path::new(""))
    }

    /// Where the drive is shown to Foxglove, and to whom.
    pub fn foxglove(&self) -> Option<Endpoint> {
        self.foxglove.map(|at| Endpoint { at, origins: self.foxglove_origin.clone() })
    }
}

/// How the live rig makes its pictures.
#[derive(Args, Clone, Debug)]
pub struct PictureArgs {
    /// Size of the safety driver's picture.
    #[arg(long, default_value = IMAGE_SIZE, value_parser = size, value_name = "WxH")]
    pub image_size: (u32, u32),
    /// Size of the semantic driver's mask (default: the checkpoint's own, 256x128).
    #[arg(long, value_parser = size, value_name = "WxH")]
    pub mask_size: Option<(u32, u32)>,
    /// How the pictures are made.
    #[command(flatten)]
    pub imaging: ImagingArgs,
    /// What computes the networks: one core of the CPU; an NVIDIA GPU with the libraries of CUDA 13 and
    /// cuDNN; or the library of onnxruntime (`ORT_DYLIB_PATH`). The latter two must see in a picture what the CPU sees.
    #[arg(long, default_value = "cpu", value_name = "cpu|cuda|ort")]
    pub inference: Compute,
    /// Monitors that the safety driver's view is spread over: 3 show 60 degrees each, every one of
    /// `--image-size`.
    #[arg(long, default_value = "1", value_parser = screens())]
    pub screens: Screens,
}

const IMAGE_SIZE: &str = "640x360";

impl From<&PictureArgs> for Pictures {
    fn from(args: &PictureArgs) -> Self {
        let PictureArgs { image_size, mask_size, imaging, inference, screens } = *args;
        Self { image_size, mask_size, imaging: imaging.into(), inference, screens }
    }
}

/// Arguments of a drive that is part of a study.
#[derive(Args, Clone, Debug)]
pub struct StudyArgs {
    /// Pseudonym of the semantic driver, for the recording.
    #[arg(long, value_name = "PSEUDONYM")]
    pub semantic_name: Option<Pseudonym>,
    /// Pseudonym of the safety driver, for the recording.
    #[arg(long, value_name = "PSEUDONYM")]
    pub safety_name: Option<Pseudonym>,
    /// The drivers' answers, for the recording.
    #[arg(long, value_name = "FILE.toml")]
    pub questionnaire: Option<PathBuf>,
    /// A drive to get used to the rig: it is marked and does not count, and no case is cut from it.
    #[arg(long)]
    pub familiarisation: bool,
    /// Two or more checkpoints, of which each run draws one by its seed without telling which.
    #[arg(long, value_delimiter = ',', value_name = CHECKPOINTS, conflicts_with = "checkpoint")]
    pub blind: Vec<CheckpointChoice>,
}

impl From<&StudyArgs> for Study {
    fn from(args: &StudyArgs) -> Self {
        let StudyArgs { semantic_name, safety_name, questionnaire, familiarisation, blind } = args.clone();
        Self { semantic_name, safety_name, questionnaire, familiarisation, blind }
    }
}

impl PictureArgs {
    /// Whether anything is asked for that only windows have a use for.
    pub fn is_special(&self) -> bool {
        let Self { image_size, mask_size, inference, screens, .. } = self;
        Ok(*image_size) != size(IMAGE_SIZE)
            || mask_size.is_some()
            || *inference != Compute::default()
            || *screens != Screens::One
    }
}

/// Arguments of `doctor`.
#[derive(Args, Clone, Debug)]
pub struct DoctorArgs {
    /// How long bots drive in windows to measure real time, in simulated time; 0s: not at all.
    #[arg(long = "max-time", default_value = "20s", value_parser = seconds(0..=86_400), value_name = "DURATION")]
    pub seconds: u32,
    /// What the semantic driver sees there.
    #[arg(long, default_value = "full", value_parser = one_checkpoint, value_name = CHECKPOINT)]
    pub checkpoint: CheckpointChoice,
    /// The pictures there.
    #[command(flatten)]
    pub pictures: PictureArgs,
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
#[derive(Args, Clone, Debug)]
#[command(after_help = VIEW_KEYS)]
pub struct ViewArgs {
    /// A recording or case; one that was cut off is shown as far as it goes.
    #[arg(value_parser = file(), value_name = "FILE")]
    pub file: PathBuf,
    /// Checkpoints to look through (default: the bundled ones). The one that the run was driven through is
    /// among them when it is bundled.
    #[arg(long, value_delimiter = ',', value_name = CHECKPOINTS)]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Opens no window: makes every mask that was shown again and compares its digest with the logged
    /// one; exit code 3 if any differs. Equal digests are promised on the adapter that made them.
    #[arg(long)]
    pub digests: bool,
    /// Whose models stand for what it shows.
    #[command(flatten)]
    pub models: ModelsArgs,
    /// Show a blind drive all the same, with its checkpoint.
    #[arg(long)]
    pub reveal: bool,
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
#[derive(Args, Clone, Debug)]
pub struct WheelListArgs {
    /// Calibrations to choose from, by the name of their device.
    #[arg(long, value_delimiter = ',', value_name = "FILE.toml,...")]
    pub calibration: Vec<PathBuf>,
}

/// Arguments of `wheel calibrate`.
#[derive(Args, Clone, Debug)]
pub struct WheelCalibrateArgs {
    /// The device, such as /dev/input/event5 (default: the only one).
    #[arg(long, value_name = "PATH")]
    pub device: Option<String>,
    /// Where the calibration goes.
    #[arg(long, value_name = "FILE.toml")]
    pub out: PathBuf,
}

/// Arguments of `wheel import`.
#[derive(Args, Clone, Debug)]
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
    pub out: PathBuf,
}
