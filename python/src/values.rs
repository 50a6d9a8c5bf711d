//! Values as Python hands them over; the same are refused as by the command.

use std::fs;
use std::io::ErrorKind;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use anyhow::Error;
use base::asked;
use drivers::film::Viewpoint;
use drivers::vision::DEFAULT_SIZE;
use kernel::scenario::{HazardLevel, MOST_OF_A_KIND};
use kernel::weather::WeatherPreset;
use lab::share::Share;
use numpy::PyUntypedArray;
use pyo3::prelude::*;
use render::{Imaging, Quality, Sensor};

use crate::errors::{file, input, raise};
use crate::given::{Given, Pair, Whole, named, within};

/// Width and height of pictures that nobody asked otherwise for.
pub const DEFAULT_PAIR: Given<Pair> = Given::of(Pair(DEFAULT_SIZE.0 as i128, DEFAULT_SIZE.1 as i128));

// Signatures that Python shows say it in numbers.
const _: () = assert!(DEFAULT_SIZE.0 == 256 && DEFAULT_SIZE.1 == 128);

/// Width and height of pictures.
pub fn picture_size(size: Given<Pair>, name: &str) -> PyResult<(u32, u32)> {
    let Pair(width, height) = size.named(name)?;
    let sides = u32::try_from(width).ok().zip(u32::try_from(height).ok());
    let refused = || input(format!("{name} {width}x{height}; expected {}", asked::sizes()));
    sides.filter(|size| asked::is_size(*size)).ok_or_else(refused)
}

/// A camera by its name.
pub fn viewpoint(name: Given<String>) -> PyResult<Viewpoint> {
    name.named("camera")?.parse().map_err(|error| raise(&Error::from(error)))
}

/// What somebody handed over in the place of an array: kind and shape, or the type of what is none.
pub fn described(value: &Bound<'_, PyAny>) -> String {
    let of = |name: &str| value.getattr(name).and_then(|value| value.str()?.extract::<String>());
    match (of("dtype"), of("shape")) {
        (Ok(kind), Ok(shape)) if value.is_instance_of::<PyUntypedArray>() => format!("{kind} of shape {shape}"),
        _ => value.get_type().to_string(),
    }
}

/// How much is done at the same time.
pub fn jobs_at_once(jobs: Option<Given<Whole>>) -> PyResult<Option<u16>> {
    within(jobs, "jobs", 1..=256)
}

/// How many people are on foot.
pub fn people(count: Option<Given<Whole>>) -> PyResult<Option<u16>> {
    within(count, "pedestrians", 0..=MOST_OF_A_KIND)
}

/// A level of hazards by its name.
pub fn level(name: Option<Given<String>>) -> PyResult<Option<HazardLevel>> {
    named(name, "hazards")?.map(|name| level_named(&name)).transpose()
}

/// The level of hazards of a name.
pub fn level_named(name: &str) -> PyResult<HazardLevel> {
    let names = || HazardLevel::ALL.map(HazardLevel::name).join(", ");
    HazardLevel::named(name).ok_or_else(|| input(format!("hazards=\"{name}\"; expected one of {}", names())))
}

/// A weather by its name.
pub fn preset(name: Option<Given<String>>) -> PyResult<Option<WeatherPreset>> {
    let Some(name) = named(name, "weather")? else { return Ok(None) };
    let names = || WeatherPreset::names().collect::<Vec<_>>().join(", ");
    let found = WeatherPreset::find(&name).copied().map(Some);
    found.ok_or_else(|| input(format!("weather=\"{name}\"; expected one of {}", names())))
}

/// How pictures are made: their quality by its name, and what lens and chip do, in the words of the command.
pub fn imaging(quality: Option<Given<String>>, sensor: Option<Given<String>>) -> PyResult<Imaging> {
    let refused = |name: &str, text: &str, expected: String| input(format!("{name}=\"{text}\"; {expected}"));
    let quality =
        named(quality, "quality")?.map(|name| name.parse::<Quality>().map_err(|why| refused("quality", &name, why)));
    let sensor =
        named(sensor, "sensor")?.map(|text| text.parse::<Sensor>().map_err(|why| refused("sensor", &text, why)));
    Ok(Imaging {
        quality: quality.transpose()?.unwrap_or_default(),
        sensor: sensor.transpose()?.unwrap_or_default(),
        models: None,
    })
}

/// A time in whole seconds.
pub fn whole_seconds(seconds: Given<f64>, name: &str, within: RangeInclusive<u32>) -> PyResult<u32> {
    let seconds = seconds.named(name)?;
    let whole = (seconds.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&seconds)).then_some(seconds as u32);
    whole.filter(|seconds| within.contains(seconds)).ok_or_else(|| {
        let (least, most) = (within.start(), within.end());
        input(format!("{name}={seconds}; expected whole seconds from {least} to {most}"))
    })
}

/// A share of a campaign: which one, from 1 on, and of how many.
pub fn share(share: Option<Given<Pair>>) -> PyResult<Option<Share>> {
    let Some(Pair(shard, of)) = named(share, "shard")? else { return Ok(None) };
    let refused = |_| input(format!("shard=({shard}, {of}); expected (i, n) with i from 1 to n"));
    format!("{shard}/{of}").parse().map(Some).map_err(refused)
}

/// Refuses what is not there. Lists (`@FILE`) are left to those who read them.
pub fn check_there(paths: &[PathBuf]) -> PyResult<()> {
    for path in paths.iter().filter(|path| !path.to_string_lossy().starts_with('@')) {
        match fs::metadata(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Err(file(format!("{}: no such file or folder", path.display())));
            }
            Err(error) => return Err(raise(&Error::from(error).context(path.display().to_string()))),
            Ok(_) => {}
        }
    }
    Ok(())
}
