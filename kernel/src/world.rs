//! The world: everything that happens in a tick.

use std::sync::Arc;

use glam::Vec3;

use crate::arbiter::{Applied, Arbiter, Intervention};
use crate::controls::TickInput;
use crate::events::{Event, Hud};
use crate::map::RoadNetwork;
use crate::scenario::Scenario;
use crate::scene::SceneSnapshot;
use crate::state::{DecodeError, StateHash};
use crate::time::Tick;

/// Why a world cannot start or resume.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// The scenario does not fit the map.
    #[error("scenario does not fit map {map}: {reason}")]
    Scenario {
        /// The map's name.
        map: String,
        /// What does not fit.
        reason: String,
    },
    /// The keyframe's bytes are no state.
    #[error("keyframe of tick {tick}: {source}")]
    Keyframe {
        /// Tick of the keyframe.
        tick: Tick,
        /// What is wrong with its bytes.
        source: DecodeError,
    },
}

/// Parts of the state with a hash of their own, in the order of [`World::part_hashes`].
pub const PARTS: [&str; 7] = ["input", "ego", "vehicles", "pedestrians", "bodies", "arbiter", "output"];

/// The compact state of the world at a keyframe tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keyframe {
    /// Its tick.
    pub tick: Tick,
    /// Canonical bytes of the whole state.
    pub bytes: Vec<u8>,
}

/// A value that differs between two keyframes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldDifference {
    /// One of [`PARTS`].
    pub part: String,
    /// Id of the actor, if the field belongs to one.
    pub actor: Option<u32>,
    /// Name of the field.
    pub field: String,
    /// Value in `self`.
    pub expected: String,
    /// Value in the other.
    pub got: String,
}

impl Keyframe {
    /// The first field in which this keyframe (as recorded) and another (as computed) differ.
    pub fn difference(&self, _computed: &Keyframe) -> Result<Option<FieldDifference>, WorldError> {
        todo!()
    }
}

/// What a tick gave.
#[derive(Clone, Debug, PartialEq)]
pub struct TickOutput {
    /// The tick that was reached.
    pub tick: Tick,
    /// Hash over the tick's inputs, the state after it, and its outputs.
    pub hash: StateHash,
    /// What the arbitration let through.
    pub applied: Applied,
    /// The intervention, in the tick in which it happens.
    pub intervention: Option<Intervention>,
    /// Events of this tick, in a fixed order.
    pub events: Vec<Event>,
    /// Distance driven so far, millimetres.
    pub odometer_mm: u64,
    /// The state, at keyframe ticks.
    pub keyframe: Option<Keyframe>,
}

/// The simulated world. `Clone` copies the engine's caches too; use it for rewinds and forks.
#[derive(Clone)]
pub struct World {}

impl World {
    /// A world at tick 0.
    pub fn new(_scenario: &Scenario, _network: &Arc<RoadNetwork>) -> Result<Self, WorldError> {
        todo!()
    }

    /// The world as it was at a keyframe, bit for bit.
    pub fn resume(_scenario: &Scenario, _network: &Arc<RoadNetwork>, _keyframe: &Keyframe) -> Result<Self, WorldError> {
        todo!()
    }

    /// Advances by one tick.
    pub fn step(&mut self, _input: &TickInput) -> TickOutput {
        todo!()
    }

    /// The current tick.
    pub fn tick(&self) -> Tick {
        todo!()
    }

    /// The keyframe of tick 0; only valid before the first step.
    pub fn initial_keyframe(&self) -> Keyframe {
        todo!()
    }

    /// Hash of the current state, of the last input and output: that of the last [`TickOutput`].
    pub fn hash(&self) -> StateHash {
        todo!()
    }

    /// A hash for each of [`PARTS`].
    pub fn part_hashes(&self) -> [u64; PARTS.len()] {
        todo!()
    }

    /// Every named value of the state, each with its part and actor, for comparing two worlds.
    pub fn difference(&self, _other: &World) -> Option<FieldDifference> {
        todo!()
    }

    /// What there is to see, on the grid of [`crate::scene::quantise`].
    pub fn scene(&self) -> SceneSnapshot {
        todo!()
    }

    /// What the HUD shows.
    pub fn hud(&self) -> Hud {
        todo!()
    }

    /// Where the run stands.
    pub fn arbiter(&self) -> &Arbiter {
        todo!()
    }

    /// The middle of the ego car's route ahead, from the car on, points about 1 m apart.
    pub fn route_ahead(&self, _distance_m: f32) -> Vec<Vec3> {
        todo!()
    }

    /// Distance driven so far, millimetres.
    pub fn odometer_mm(&self) -> u64 {
        todo!()
    }

    /// The map.
    pub fn network(&self) -> &Arc<RoadNetwork> {
        todo!()
    }

    /// The scenario.
    pub fn scenario(&self) -> &Scenario {
        todo!()
    }

    /// Events of the last tick.
    pub fn last_events(&self) -> &[Event] {
        todo!()
    }
}
