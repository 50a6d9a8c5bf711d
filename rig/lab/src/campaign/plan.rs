//! What a campaign drives.

use std::path::PathBuf;

use base::maps::Map;
use kernel::Scenario;
use kernel::rng::{self, Stream};
use kernel::scenario::HazardLevel;
use kernel::weather::WeatherPreset;

use super::until::Goal;

/// Everything that decides what a campaign's runs are.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Maps, in turn.
    pub maps: Vec<Map>,
    /// What every run has in common, if not the default of its map and seed.
    pub scenario: Option<Scenario>,
    /// Whether each run draws values for those parameters of the scenario's story that have ranges.
    pub vary: bool,
    /// People on foot, if not as many as the scenario says.
    pub pedestrians: Option<u16>,
    /// How often people at the wheel endanger others, if not as the scenario says.
    pub hazards: Option<HazardLevel>,
    /// Weather, if not as the scenario says.
    pub weather: Option<WeatherPreset>,
    /// Longest simulated time of a run, seconds.
    pub run_seconds: u32,
    /// Seed of the campaign.
    pub seed: u64,
    /// When it is over.
    pub goal: Goal,
    /// Where the files go.
    pub out: PathBuf,
}

impl Plan {
    /// Which of the maps a run is on.
    pub fn map_index(&self, run: u32) -> usize {
        run as usize % self.maps.len()
    }

    /// The scenario of a run.
    pub fn scenario_of(&self, run: u32) -> Scenario {
        let map = &self.maps[self.map_index(run)];
        let seed = seed_of(self.seed, run);
        let mut scenario = self.scenario.clone().unwrap_or_else(|| map.scenario(seed));
        scenario.map = map.network.name.clone();
        scenario.seed = seed;
        // All that is drawn can be played: `options::plan` looked.
        if self.vary {
            let _ = scenario.vary(seed);
        }
        scenario.rules.max_seconds = self.run_seconds;
        self.weather.iter().for_each(|preset| scenario.take_weather(preset));
        scenario.traffic.pedestrians = self.pedestrians.unwrap_or(scenario.traffic.pedestrians);
        scenario.hazards = self.hazards.map_or(scenario.hazards, HazardLevel::rates);
        scenario
    }
}

/// The seed of a run of a campaign with a seed.
pub fn seed_of(campaign: u64, run: u32) -> u64 {
    rng::bits(campaign, Stream::Scenario, u64::from(run), 0) >> 32
}
