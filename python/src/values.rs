//! Values as Python hands them over; the same are refused as by the command.

use std::ops::RangeInclusive;
use std::path::Path;

use drivers::checkpoint::CheckpointChoice;
use kernel::scenario::{HazardLevel, MOST_OF_A_KIND};
use kernel::weather::WeatherPreset;
use pyo3::prelude::*;

use crate::errors::input;

/// A checkpoint.
pub fn choice(path: &Path) -> PyResult<CheckpointChoice> {
    path.to_string_lossy().parse().map_err(input)
}

/// How much is done at the same time.
pub fn jobs_at_once(jobs: u16) -> PyResult<u16> {
    if (1..=256).contains(&jobs) { Ok(jobs) } else { Err(input(format!("jobs={jobs}; expected 1 to 256"))) }
}

/// How many people are on foot.
pub fn people(count: u16) -> PyResult<u16> {
    let refused = || input(format!("pedestrians={count}; expected 0 to {MOST_OF_A_KIND}"));
    if count <= MOST_OF_A_KIND { Ok(count) } else { Err(refused()) }
}

/// A level of hazards by its name.
pub fn level(name: &str) -> PyResult<HazardLevel> {
    let names = || HazardLevel::ALL.map(HazardLevel::name).join(", ");
    HazardLevel::named(name).ok_or_else(|| input(format!("hazards=\"{name}\"; expected one of {}", names())))
}

/// A weather by CARLA's name.
pub fn preset(name: &str) -> PyResult<WeatherPreset> {
    let names = || WeatherPreset::names().collect::<Vec<_>>().join(", ");
    let found = WeatherPreset::find(name).copied();
    found.ok_or_else(|| input(format!("weather=\"{name}\"; expected one of {}", names())))
}

/// A time in whole seconds.
pub fn whole_seconds(seconds: f64, name: &str, within: RangeInclusive<u32>) -> PyResult<u32> {
    let whole = (seconds.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&seconds)).then_some(seconds as u32);
    whole.filter(|seconds| within.contains(seconds)).ok_or_else(|| {
        let (least, most) = (within.start(), within.end());
        input(format!("{name}={seconds}; expected whole seconds from {least} to {most}"))
    })
}
