//! Values of arguments, read from text.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use base::failure::sentence;
use base::{asked, library};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use drivers::checkpoint::CheckpointChoice;
use drivers::pictures::Screens;
use kernel::scenario::{HazardLevel, MOST_OF_A_KIND};
use kernel::time::{TICK_HZ, Tick};
use kernel::weather::WeatherPreset;
use lab::experiment::Preset;
use perception::training;
use render::{Imaging, ModelsId, Quality, Sensor};

/// What stands for a checkpoint in help.
pub const CHECKPOINT: &str = "early|full|truth|FILE.onnx";
/// What stands for several: an option that takes a list takes it with commas, or is given again.
pub const CHECKPOINTS: &str = "early|full|truth|FILE.onnx,...";
/// What stands for several maps.
pub const MAPS: &str = "NAME|FILE.xodr|all,...";

/// A recording, a case or a folder. The name of a checkpoint is refused: it is what is left over when a list
/// is given with spaces.
pub fn file() -> impl TypedValueParser<Value = PathBuf> {
    clap::builder::PathBufValueParser::new().try_map(|path| if is_checkpoint(&path) { Err(LIST) } else { Ok(path) })
}

const LIST: &str = "is a checkpoint where a recording, case or folder is expected; \
                    several checkpoints are given as --checkpoint early,full";

fn is_checkpoint(path: &Path) -> bool {
    let choice = path.to_str().map(|text| text.parse::<CheckpointChoice>());
    let is_named = matches!(choice, Some(Ok(CheckpointChoice::Truth | CheckpointChoice::Bundled(_))));
    (is_named && !path.exists()) || path.extension().is_some_and(|ending| ending == "onnx")
}

/// One checkpoint. A list is refused as what it is, unless a file is called so.
pub fn one_checkpoint(text: &str) -> Result<CheckpointChoice, String> {
    if text.contains(',') && !Path::new(text).exists() {
        return Err("is a list; expected one checkpoint, as in early".into());
    }
    text.parse()
}

/// A recording that will be made, and found again by its name.
pub fn new_recording() -> impl TypedValueParser<Value = PathBuf> {
    let expected = "expected the name of a recording, as in drive.mcap, not of a case, of a fork, or of a hidden file";
    clap::builder::PathBufValueParser::new()
        .try_map(move |path| if library::is_drive_name(&path) { Ok(path) } else { Err(expected) })
}

/// Looks and sampling of a training with a name.
pub fn training_preset() -> impl TypedValueParser<Value = training::Preset> {
    let all = training::Preset::ALL;
    let named = move |name: String| all.into_iter().find(|preset| preset.name() == name);
    let names = all.map(training::Preset::name);
    PossibleValuesParser::new(names).try_map(move |name| named(name).ok_or("no such preset"))
}

/// An experiment with a name.
pub fn preset() -> impl TypedValueParser<Value = Preset> {
    let named = |name: String| Preset::ALL.into_iter().find(|preset| preset.name() == name);
    PossibleValuesParser::new(Preset::ALL.map(Preset::name)).try_map(move |name| named(name).ok_or("no such preset"))
}

/// How often people at the wheel endanger others.
pub fn hazards() -> impl TypedValueParser<Value = HazardLevel> {
    PossibleValuesParser::new(HazardLevel::ALL.map(HazardLevel::name))
        .try_map(|name| HazardLevel::named(&name).ok_or("no such level"))
}

/// The quality of pictures where none is asked for.
pub const QUALITY: &str = "standard";

/// A quality of pictures by its name.
pub fn quality() -> impl TypedValueParser<Value = Quality> {
    PossibleValuesParser::new(Quality::ALL.map(Quality::name)).try_map(|name| name.parse::<Quality>())
}

/// What stands for a sensor in help.
pub const SENSOR: &str = "SETTING=VALUE,...";

/// How pictures are made. In drives, it is the pictures that networks look at.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct ImagingArgs {
    /// How good the pictures are: fast, with smooth edges, or the best (for GPUs).
    #[arg(long, default_value = QUALITY, value_parser = quality(), value_name = "NAME")]
    pub quality: Quality,
    /// What lens and chip do to the pictures, as in `exposure_ev=-1,noise=4`; settings are exposure_ev, noise, k1, k2,
    /// motion_blur_s and vignetting (default: nothing).
    #[arg(long, value_name = SENSOR)]
    pub sensor: Option<Sensor>,
    /// Folder with models of your own for vehicles, people, trees and furniture: glTF files and a `models.toml` that says what
    /// stands for what (default: none).
    #[arg(long, value_parser = models, value_name = "DIR")]
    pub models: Option<ModelsId>,
}

/// Models that recordings or recipes were drawn with.
#[derive(Args, Clone, Debug, Default)]
pub struct ModelsArgs {
    /// Folders with the models that it was drawn with, which are told by their digest.
    #[arg(long, value_parser = models, value_delimiter = ',', value_name = "DIR,...")]
    pub models: Vec<ModelsId>,
}

/// A folder of models, which is read.
pub fn models(folder: &str) -> Result<ModelsId, String> {
    base::models::read(Path::new(folder)).map_err(|error| sentence(&error))
}

impl From<ImagingArgs> for Imaging {
    fn from(args: ImagingArgs) -> Self {
        Self { quality: args.quality, sensor: args.sensor.unwrap_or_default(), models: args.models }
    }
}

/// A weather with a name.
pub fn weather() -> impl TypedValueParser<Value = WeatherPreset> {
    let named = |name: String| WeatherPreset::find(&name).copied();
    PossibleValuesParser::new(WeatherPreset::names()).try_map(move |name| named(name).ok_or("no such weather"))
}

/// Monitors that a view is spread over.
pub fn screens() -> impl TypedValueParser<Value = Screens> {
    PossibleValuesParser::new(["1", "3"]).map(|number| if number == "3" { Screens::Three } else { Screens::One })
}

/// `WxH`, as in `512x256`.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let size = sides.filter(|size| asked::is_size(*size));
    size.ok_or_else(|| format!("expected WIDTHxHEIGHT with {}, as in 512x256", asked::sizes()))
}

/// A time such as `3s`, `0.5s`, `2m` or `1h`, as ticks. A number alone is seconds.
fn ticks(text: &str) -> Option<Tick> {
    let units = [("s", 1.0), ("m", 60.0), ("h", 3600.0)];
    let unit = units.iter().find_map(|(unit, seconds)| Some((text.strip_suffix(unit)?, *seconds)));
    let (number, seconds) = unit.unwrap_or((text, 1.0));
    asked::ticks(number.parse::<f64>().ok()? * seconds)
}

/// How long something takes, as ticks.
pub fn duration(text: &str) -> Result<Tick, String> {
    ticks(text).filter(|ticks| *ticks >= 1).ok_or_else(|| "expected a duration, as in 3s, 0.5s or 2m".into())
}

/// A time of a run, as a tick.
pub fn moment(text: &str) -> Result<Tick, String> {
    ticks(text).ok_or_else(|| "expected a time of the run, as in 0s, 12.5s or 2m".into())
}

/// A duration in whole seconds.
pub fn seconds(range: RangeInclusive<u32>) -> impl Fn(&str) -> Result<u32, String> + Clone + Send + Sync + 'static {
    move |text| {
        let whole = ticks(text).filter(|ticks| ticks.is_multiple_of(TICK_HZ.into()));
        let seconds = whole.map(|ticks| (ticks / Tick::from(TICK_HZ)) as u32).filter(|s| range.contains(s));
        let (low, high) = (range.start(), range.end());
        seconds.ok_or_else(|| format!("expected whole seconds from {low}s to {high}s, as in 20s or 2m"))
    }
}

/// A first learning rate.
pub fn rate(text: &str) -> Result<f32, String> {
    let rate = text.parse::<f32>().ok().filter(|r| (1e-7..=1.0).contains(r));
    rate.ok_or_else(|| "expected a number above 0 and up to 1, as in 0.002".into())
}

/// A fraction of the greatest force.
pub fn force(text: &str) -> Result<f32, String> {
    let fraction = text.parse::<f32>().ok().filter(|f| (0.0..=1.0).contains(f));
    fraction.ok_or_else(|| "expected a fraction of 0 to 1, as in 0.6".into())
}

/// A threshold of an intervention.
pub fn threshold(text: &str) -> Result<f32, String> {
    let fraction = text.parse::<f32>().ok().filter(|f| (0.01..=0.99).contains(f));
    fraction.ok_or_else(|| "expected a fraction of 0.01 to 0.99, as in 0.1".into())
}

/// How much is done at the same time.
pub fn jobs(text: &str) -> Result<u16, String> {
    let jobs = text.parse::<u16>().ok().filter(|n| (1..=256).contains(n));
    jobs.ok_or_else(|| "expected 1 to 256".into())
}

/// How many people are on foot.
pub fn people(text: &str) -> Result<u16, String> {
    let people = text.parse::<u16>().ok().filter(|n| *n <= MOST_OF_A_KIND);
    people.ok_or_else(|| format!("expected 0 to {MOST_OF_A_KIND}"))
}

/// Frames a second that fall on ticks.
pub fn frame_rate(text: &str) -> Result<u32, String> {
    let fps = text.parse::<u32>().ok().filter(|fps| asked::is_frame_rate(*fps));
    fps.ok_or_else(|| format!("expected {}", asked::frame_rates()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_as_good_as_the_renderer_draws_them_unless_asked_otherwise() {
        assert_eq!(QUALITY.parse(), Ok(Quality::default()));
    }

    #[test]
    fn a_checkpoint_is_no_file() {
        assert!(is_checkpoint(Path::new("truth")) && is_checkpoint(Path::new("runs/c.onnx")));
        assert!(!is_checkpoint(Path::new("early.case.mcap")) && !is_checkpoint(Path::new("./early")));
    }

    #[test]
    fn a_list_is_no_checkpoint() {
        assert_eq!(one_checkpoint("early"), Ok(CheckpointChoice::Bundled("early")));
        assert_eq!(one_checkpoint("early,full"), Err("is a list; expected one checkpoint, as in early".into()));
    }

    #[test]
    fn values_are_read_and_nonsense_is_refused() {
        assert_eq!(size("512x256"), Ok((512, 256)));
        assert_eq!((size("4096x4096"), size("8192x2048")), (Ok((4096, 4096)), Ok((8192, 2048))));
        assert!(size("8192x8192").unwrap_err().contains("at most 16777216 pixels"));
        assert!(size("512").is_err() && size("0x9").is_err() && size("12x99999999").is_err());
        assert_eq!(duration("3s"), Ok(180));
        assert_eq!(duration("0.5"), Ok(30));
        assert_eq!((duration("2m"), duration("1h")), (Ok(7200), Ok(216_000)));
        assert_eq!((seconds(4..=60)("4"), seconds(4..=60)("1m")), (Ok(4), Ok(60)));
        assert!(seconds(4..=60)("3s").is_err() && seconds(4..=60)("4.5s").is_err() && seconds(0..=9)("-1").is_err());
        assert!(duration("-1s").is_err() && duration("NaN").is_err());
        assert_eq!((moment("0s"), moment("1.5")), (Ok(0), Ok(90)));
        assert!(moment("-1").is_err() && moment("s").is_err());
        assert_eq!(threshold("0.2"), Ok(0.2));
        assert_eq!((force("0"), force("1")), (Ok(0.0), Ok(1.0)));
        assert!(force("1.1").is_err() && force("-0.1").is_err() && force("nan").is_err());
        assert!(threshold("0").is_err() && threshold("1").is_err() && threshold("nan").is_err());
        assert_eq!((people("0"), people("500")), (Ok(0), Ok(500)));
        assert!(people("501").is_err() && people("-1").is_err());
        assert_eq!((jobs("1"), jobs("256")), (Ok(1), Ok(256)));
        assert!(jobs("0").is_err() && jobs("257").is_err() && jobs("two").is_err());
        assert!(frame_rate("7").is_err() && frame_rate("0").is_err());
    }
}
