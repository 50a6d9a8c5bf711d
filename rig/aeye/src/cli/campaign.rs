//! Arguments of simulated drives.

use std::path::PathBuf;

use clap::Args;
use drivers::checkpoint::CheckpointChoice;
use kernel::scenario::HazardLevel;
use kernel::weather::WeatherPreset;
use lab::experiment::Preset;
use lab::share::Share;
use render::ModelsId;

use super::values::{CHECKPOINTS, ImagingArgs, MAPS, file, hazards, jobs, models, people, preset, seconds, weather};

/// What says when a campaign is over, or that there is none.
const ENDS: [&str; 7] = ["runs", "vary", "km", "cases", "pedestrian_cases", "print_scenario", "collect"];

/// What decides which runs are driven.
const DRIVES: [&str; 16] = [
    "checkpoint",
    "maps",
    "embed_map",
    "scenario",
    "runs",
    "vary",
    "km",
    "cases",
    "pedestrian_cases",
    "pedestrians",
    "hazards",
    "weather",
    "run_seconds",
    "seed",
    "shard",
    "print_scenario",
];

/// Arguments of `campaign`.
#[derive(Args, Clone, Debug)]
#[command(group = clap::ArgGroup::new("goal").args(["km", "cases", "pedestrian_cases"]))]
#[command(group = clap::ArgGroup::new("end").required(true).multiple(true).args(ENDS))]
#[command(group = clap::ArgGroup::new("counted").args(["runs", "vary"]))]
pub struct CampaignArgs {
    /// What the semantic driver sees: bundled checkpoints, ground truth, or ONNX files; each drives
    /// the same runs.
    #[arg(
        long,
        required_unless_present_any = ["print_scenario", "collect"],
        value_delimiter = ',',
        value_name = CHECKPOINTS
    )]
    pub checkpoint: Vec<CheckpointChoice>,
    /// Bundled maps or OpenDRIVE files, in turn; `all` are the bundled ones (default: the scenario's
    /// map, or all).
    #[arg(long, value_delimiter = ',', value_name = MAPS)]
    pub maps: Vec<String>,
    /// Put the files of maps that are not bundled into the recordings, instead of once beside them.
    #[arg(long)]
    pub embed_map: bool,
    /// A scenario file, a story in OpenSCENARIO XML, or a bundled story by name, as cut_out; its seed and length are replaced for
    /// each run.
    #[arg(long, value_name = "FILE.toml|FILE.xosc|STORY")]
    pub scenario: Option<PathBuf>,
    /// Number of runs of each checkpoint; beside another goal, how many runs must come to that.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub runs: Option<u32>,
    /// As many runs, for each of which values are drawn for those parameters of the story that have ranges.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), requires = "scenario")]
    pub vary: Option<u32>,
    /// Kilometres of each checkpoint.
    #[arg(long)]
    pub km: Option<f64>,
    /// Corner cases of each checkpoint.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub cases: Option<u32>,
    /// Corner cases of each checkpoint with the label `walker`: takeovers because of people on foot.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub pedestrian_cases: Option<u32>,
    /// People on foot, instead of as many as the scenario or the map's default has.
    #[arg(long, value_parser = people, value_name = "N")]
    pub pedestrians: Option<u16>,
    /// How often people at the wheel endanger others, instead of what the scenario says.
    #[arg(long, value_parser = hazards(), value_name = "LEVEL")]
    pub hazards: Option<HazardLevel>,
    /// Weather by its name, as `weather.preset` of scenarios, instead of the scenario's or of
    /// one that is drawn for each run.
    #[arg(long, value_parser = weather(), value_name = "NAME")]
    pub weather: Option<WeatherPreset>,
    /// How the pictures are made.
    #[command(flatten)]
    pub imaging: ImagingArgs,
    /// Longest simulated time of a run, 10s to 24h.
    #[arg(long = "max-time", default_value = "4m", value_parser = seconds(10..=86_400), value_name = "DURATION")]
    pub run_seconds: u32,
    /// Seed of the campaign; run `i` follows from it and `i` alone.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Worlds simulated at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Drive one share of the runs: of N, the I-th one. Each has a folder of its own.
    #[arg(long, value_name = "I/N", requires = "counted", conflicts_with = "print_scenario")]
    pub shard: Option<Share>,
    /// Drive nothing, and put together what shards drove.
    #[arg(long, requires = "folders", conflicts_with_all = DRIVES)]
    pub collect: bool,
    /// The folders of shards for `--collect`, or folders that hold those.
    #[arg(value_name = "DIR", value_parser = file())]
    pub folders: Vec<PathBuf>,
    /// Print the scenario of the first run, as a file for `--scenario`, and do nothing.
    #[arg(long)]
    pub print_scenario: bool,
    /// Folder of the results; a campaign that was interrupted goes on there.
    #[arg(long, value_name = "DIR", required_unless_present = "print_scenario")]
    pub out: Option<PathBuf>,
}

/// Arguments of `demo`.
#[derive(Args, Clone, Debug)]
pub struct DemoArgs {
    /// Seed of the campaign.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Drives, files and frames worked on at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Folder of the results; a demo that was interrupted goes on there.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Arguments of `experiment`.
#[derive(Args, Clone, Debug)]
pub struct ExperimentArgs {
    /// The experiment's numbers: twenty minutes, an hour, a night (on two cores), or as in the paper.
    #[arg(long, value_parser = preset(), required_unless_present = "recipe", conflicts_with = "recipe")]
    pub preset: Option<Preset>,
    /// A file with other numbers; `--print-recipe` shows what it has to hold.
    #[arg(long, value_name = "FILE.toml")]
    pub recipe: Option<PathBuf>,
    /// Folder with models of your own for vehicles, people, trees and furniture; the recipe's `models` is its digest.
    #[arg(long, value_parser = models, value_name = "DIR")]
    pub models: Option<ModelsId>,
    /// Print the recipe as TOML and do nothing.
    #[arg(long)]
    pub print_recipe: bool,
    /// Drives at the same time (default: one a core); the results do not depend on it.
    #[arg(long, value_parser = jobs, value_name = "N")]
    pub jobs: Option<u16>,
    /// Print the pieces that are not done yet in the folder and can be done now, and do nothing.
    #[arg(long, conflicts_with_all = ["print_recipe", "piece"])]
    pub pieces: bool,
    /// Do one of these pieces alone; other processes may do others in the same folder.
    #[arg(long, value_name = "NAME", conflicts_with = "print_recipe")]
    pub piece: Option<String>,
    /// Folder of the results; an experiment that was interrupted goes on there.
    #[arg(long, value_name = "DIR", required_unless_present = "print_recipe")]
    pub out: Option<PathBuf>,
}
