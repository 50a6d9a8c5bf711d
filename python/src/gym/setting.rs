//! What drives start from.

use std::path::{Path, PathBuf};

use base::setting::{self, Changes};
use kernel::Scenario;
use pyo3::prelude::*;

use crate::errors::{input, raise};
use crate::given::{Given, Whole};
use crate::values::{level, people, preset, whole_seconds};

/// The map of drives for which nothing is named.
const DEFAULT_MAP: &str = "city";

/// What drives start from: a bundled map or an OpenDRIVE file (`map`), or a `scenario` file, and what is to be otherwise
/// than it says.
///
/// Raises FileError where a file is not there, InputError for a value that cannot be.
#[pyclass(frozen, module = "aeye._aeye")]
pub struct Setting {
    setting: setting::Setting,
    changes: Changes,
}

impl Setting {
    /// What the drive of a seed starts from, and where.
    pub fn of_seed(&self, seed: u64) -> (Scenario, base::maps::Map) {
        (self.setting.scenario(Some(seed), &self.changes), self.setting.map.clone())
    }
}

#[pymethods]
impl Setting {
    #[new]
    #[pyo3(signature = (
        *, map = None, scenario = None, hazards = None, weather = None, pedestrians = None, max_time = None,
        brake_threshold = None, steer_threshold = None
    ))]
    #[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
    fn new(
        py: Python<'_>,
        map: Option<PathBuf>,
        scenario: Option<PathBuf>,
        hazards: Option<Given<String>>,
        weather: Option<Given<String>>,
        pedestrians: Option<Given<Whole>>,
        max_time: Option<Given<f64>>,
        brake_threshold: Option<Given<f64>>,
        steer_threshold: Option<Given<f64>>,
    ) -> PyResult<Self> {
        let changes = Changes {
            hazards: level(hazards)?,
            weather: preset(weather)?,
            pedestrians: people(pedestrians)?,
            max_seconds: max_time.map(|time| whole_seconds(time, "max_time", 4..=86_400)).transpose()?,
            brake_threshold: brake_threshold.map(|value| threshold(value, "brake_threshold")).transpose()?,
            steer_threshold: steer_threshold.map(|value| threshold(value, "steer_threshold")).transpose()?,
        };
        if map.is_some() && scenario.is_some() {
            return Err(input("a map and a scenario, which names its own map; expected one of them".to_owned()));
        }
        let setting = py.detach(|| open(map.as_deref(), scenario.as_deref())).map_err(|error| raise(&error))?;
        Ok(Self { setting, changes })
    }
}

fn open(map: Option<&Path>, scenario: Option<&Path>) -> anyhow::Result<setting::Setting> {
    match (map, scenario) {
        (_, Some(path)) => setting::Setting::of_scenario(path),
        (map, None) => setting::Setting::of_map(&map.unwrap_or(Path::new(DEFAULT_MAP)).to_string_lossy()),
    }
}

/// As the command takes it: a hundredth and more below the whole.
fn threshold(value: Given<f64>, name: &str) -> PyResult<f32> {
    let value = value.named(name)? as f32;
    if (0.01..=0.99).contains(&value) {
        Ok(value)
    } else {
        Err(input(format!("{name}={value}; expected 0.01 to 0.99")))
    }
}
