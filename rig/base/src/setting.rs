//! What a run starts from, as people ask for it.

use std::path::Path;

use kernel::Scenario;
use kernel::scenario::HazardLevel;
use kernel::weather::WeatherPreset;

use crate::maps::Map;
use crate::scenario_file::ScenarioFile;

/// Map of a run when none is named.
const DEFAULT_MAP: &str = "city";

/// Where runs take place: a map, whose default scenarios they drive, or a scenario of a file.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The map.
    pub map: Map,
    scenario: Option<Scenario>,
}

impl Setting {
    /// The scenario that is asked for, else the map, else the usual one.
    pub fn of(scenario: Option<&Path>, map: Option<&str>) -> anyhow::Result<Self> {
        match scenario {
            Some(path) => Self::of_scenario(path),
            None => Self::of_map(map.unwrap_or(DEFAULT_MAP)),
        }
    }

    /// A bundled map by name, or an OpenDRIVE file by its path.
    pub fn of_map(name: &str) -> anyhow::Result<Self> {
        Ok(Self { map: Map::find(name)?, scenario: None })
    }

    /// A scenario file; its map is looked for beside it.
    pub fn of_scenario(path: &Path) -> anyhow::Result<Self> {
        let file = ScenarioFile::read(path)?;
        file.check_start(&file.map)?;
        Ok(Self { map: file.map, scenario: Some(file.scenario) })
    }

    /// The same, with the file of a foreign map in recordings instead of beside them.
    pub fn embedded(self) -> Self {
        Self { map: self.map.embedded(), ..self }
    }

    /// What a run starts from; without a seed that of the file, else 1.
    pub fn scenario(&self, seed: Option<u64>, changes: &Changes) -> Scenario {
        let of_file = || self.scenario.clone();
        let mut scenario = of_file().unwrap_or_else(|| self.map.scenario(seed.unwrap_or(1)));
        scenario.seed = seed.unwrap_or(scenario.seed);
        changes.apply(&mut scenario);
        scenario
    }
}

/// What is to be otherwise than a scenario says.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// How often people at the wheel endanger others.
    pub hazards: Option<HazardLevel>,
    /// Weather, which stays.
    pub weather: Option<WeatherPreset>,
    /// How many people are on foot.
    pub pedestrians: Option<u16>,
    /// Longest simulated time of a run, seconds.
    pub max_seconds: Option<u32>,
    /// Brake of the safety driver beyond which it takes over, (0, 1).
    pub brake_threshold: Option<f32>,
    /// Steering of the safety driver beyond which it takes over, (0, 1).
    pub steer_threshold: Option<f32>,
}

impl Changes {
    fn apply(&self, scenario: &mut Scenario) {
        scenario.hazards = self.hazards.map_or(scenario.hazards, HazardLevel::rates);
        self.weather.iter().for_each(|preset| scenario.take_weather(preset));
        scenario.traffic.pedestrians = self.pedestrians.unwrap_or(scenario.traffic.pedestrians);
        let rules = &mut scenario.rules;
        rules.max_seconds = self.max_seconds.unwrap_or(rules.max_seconds);
        rules.brake_threshold = self.brake_threshold.unwrap_or(rules.brake_threshold);
        rules.steer_threshold = self.steer_threshold.unwrap_or(rules.steer_threshold);
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn what_is_not_changed_is_that_of_the_map_or_file() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("run.toml");
        fs::write(&path, "seed = 7\nmap = \"rural\"\n[traffic]\npedestrians = 3\n").expect("writable");
        let (map, file) = (Setting::of_map("city").expect("bundled"), Setting::of_scenario(&path).expect("valid"));
        let none = Changes::default();
        assert_eq!(map.scenario(None, &none), Scenario::default_for("city", 1));
        assert_eq!(map.scenario(Some(5), &none), Scenario::default_for("city", 5));
        let of_file = file.scenario(None, &none);
        assert_eq!((of_file.seed, of_file.map.as_str(), of_file.traffic.pedestrians), (7, "rural", 3));
        assert_eq!(file.scenario(Some(9), &none), Scenario { seed: 9, ..of_file.clone() });
        let changes = Changes { pedestrians: Some(40), max_seconds: Some(20), ..none };
        let changed = file.scenario(None, &changes);
        assert_eq!((changed.traffic.pedestrians, changed.rules.max_seconds), (40, 20));
        assert_eq!(changed.weather, of_file.weather);
    }
}
