//! What a scenario holds.

use std::sync::Arc;

use crate::car::CarSetup;
use crate::state;
use crate::state::State;
use crate::story::{Story, StoryError};
use crate::time::Tick;
use crate::traffic::{HazardRates, TrafficCounts};
use crate::weather::{Weather, WeatherChange, WeatherPreset};

/// Most actors of one kind.
pub const MOST_OF_A_KIND: u16 = 500;
/// Highest speed asked of the semantic driver as a rule, km/h (paper, section 3).
pub(super) const MAX_SPEED_KMH: f32 = 50.0;
/// Highest speed that can be asked of the semantic driver, km/h.
pub const MOST_KMH: f32 = 130.0;

state! {
    /// Rules of a run.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Rules {
        /// Highest speed asked of the semantic driver, km/h.
        pub max_speed_kmh: f32,
        /// Length after which a run ends as censored, seconds.
        pub max_seconds: u32,
        /// Brake fraction of the safety driver above which it takes over, (0, 1).
        pub brake_threshold: f32,
        /// Steering fraction of the safety driver above which it takes over, (0, 1).
        pub steer_threshold: f32,
        /// Speed below which the safety driver acts on the car but does not intervene, km/h.
        pub least_intervention_kmh: f32,
        /// Longest time that a run goes on after a takeover, seconds.
        pub takeover_s: u32,
    }
}

state! {
    /// Where the ego car starts.
    #[derive(Clone, Debug, PartialEq)]
    pub struct EgoStart {
        /// Lane index; chosen from the seed when absent.
        pub lane: Option<u32>,
        /// Distance along the lane, metres.
        pub s_m: f32,
    }
}

/// A validated scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Name of a bundled map, or of the foreign map that goes with it.
    pub map: String,
    /// Seed of every random number of the run.
    pub seed: u64,
    /// Other road users.
    pub traffic: TrafficCounts,
    /// How often people at the wheel endanger others.
    pub hazards: HazardRates,
    /// Weather at the start; [`Scenario::weather_at`] any tick.
    pub weather: Weather,
    /// What it becomes, if it changes.
    pub later: Option<WeatherChange>,
    /// Start of the ego car.
    pub ego: EgoStart,
    /// Which helpers of the ego car are on.
    pub car: CarSetup,
    /// Rules.
    pub rules: Rules,
    /// What others do to whom when, if the scenario says so.
    pub story: Option<Arc<Story>>,
}

impl Scenario {
    /// The canonical bytes. Those of a scenario without a story say nothing of stories.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let Self { map, seed, traffic, hazards, weather, later, ego, car, rules, story } = self;
        let mut bytes = Vec::new();
        map.write(&mut bytes);
        seed.write(&mut bytes);
        traffic.write(&mut bytes);
        hazards.write(&mut bytes);
        weather.write(&mut bytes);
        later.write(&mut bytes);
        ego.write(&mut bytes);
        car.write(&mut bytes);
        rules.write(&mut bytes);
        if let Some(story) = story {
            story.write(&mut bytes);
        }
        bytes
    }

    /// The weather at a tick.
    pub fn weather_at(&self, tick: Tick) -> Weather {
        self.later.map_or(self.weather, |later| later.at(&self.weather, tick))
    }

    /// Takes a story, the weather as far as that says, and the speed that its ego car begins with as the highest one asked for, if that
    /// is higher.
    pub fn play(&mut self, story: Story) {
        story.script().environment.change(&mut self.weather);
        self.rules.max_speed_kmh = self.rules.max_speed_kmh.max(asked_kmh(&story));
        self.story = Some(Arc::new(story));
    }

    /// Plays its story with values drawn by a seed for those of its parameters that have ranges. What the scenario says otherwise than
    /// its story stays.
    ///
    /// # Errors
    /// When the story cannot be played with what was drawn; it stays as it is then.
    pub fn vary(&mut self, seed: u64) -> Result<(), StoryError> {
        let Some(told) = self.story.clone() else { return Ok(()) };
        let drawn = told.varied(seed)?;
        let environment = told.script().environment.replaced(&drawn.script().environment, &self.weather);
        environment.change(&mut self.weather);
        if self.rules.max_speed_kmh == asked_kmh(&told) {
            self.rules.max_speed_kmh = asked_kmh(&drawn);
        }
        self.story = Some(Arc::new(drawn));
        Ok(())
    }

    /// Takes the weather of a preset, which stays, with the sun in the direction that it had.
    pub fn take_weather(&mut self, preset: &WeatherPreset) {
        self.weather = preset.weather(self.weather.sun_azimuth_deg);
        self.later = None;
    }
}

/// The highest speed that is asked for in a story, km/h: the usual one, or that with which its ego car begins.
fn asked_kmh(story: &Story) -> f32 {
    (story.ego_mps() * 3.6).clamp(MAX_SPEED_KMH, MOST_KMH)
}

/// Why a text is not a valid scenario; says line and key.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ScenarioError(pub String);
