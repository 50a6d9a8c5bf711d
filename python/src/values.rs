//! Values as Python hands them over; the same are refused as by the command.

use std::ops::RangeInclusive;

use kernel::scenario::{HazardLevel, MOST_OF_A_KIND};
use kernel::weather::WeatherPreset;
use lab::share::Share;
use numpy::PyUntypedArray;
use pyo3::prelude::*;

use crate::errors::input;

/// One of something, or several.
#[derive(FromPyObject)]
pub enum OneOrMore<T> {
    /// Tried first: a path is no list.
    One(T),
    More(Vec<T>),
}

impl<T> OneOrMore<T> {
    /// All of them.
    pub fn list(self) -> Vec<T> {
        match self {
            Self::One(one) => vec![one],
            Self::More(more) => more,
        }
    }
}

/// Width and height of pictures.
pub fn picture_size((width, height): (u32, u32)) -> PyResult<(u32, u32)> {
    let is_side = |side| (8..=8192).contains(&side);
    if is_side(width) && is_side(height) {
        return Ok((width, height));
    }
    Err(input(format!("size {width}x{height}; expected sides of 8 to 8192")))
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

/// A share of a campaign: which one, from 1 on, and of how many.
pub fn share((shard, of): (u32, u32)) -> PyResult<Share> {
    let refused = |_| input(format!("shard=({shard}, {of}); expected (i, n) with i from 1 to n"));
    format!("{shard}/{of}").parse().map_err(refused)
}
