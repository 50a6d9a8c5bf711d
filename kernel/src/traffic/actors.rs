//! Everyone in traffic: their state, and what follows from it, the map and the seed.

use std::sync::Arc;

use super::body::Body;
use super::counts::TrafficCounts;
use super::state::TrafficState;
use super::traits::{Driver, WalkerTraits, driver, walker_traits};
use super::ways::Ways;
use crate::map_data::MapData;

/// All actors of a world.
#[derive(Clone, Debug)]
pub(super) struct Actors {
    pub ways: Arc<Ways>,
    pub seed: u64,
    pub jaywalks_per_min: f32,
    pub state: TrafficState,
    pub drivers: Vec<Driver>,
    pub walker_traits: Vec<WalkerTraits>,
    /// At the places of the state.
    pub bodies: Vec<Body>,
}

impl Actors {
    /// Those of a state, not yet placed.
    pub fn new(counts: &TrafficCounts, seed: u64, ways: &Arc<Ways>, state: TrafficState) -> Self {
        Self {
            ways: ways.clone(),
            seed,
            jaywalks_per_min: counts.jaywalks_per_min,
            drivers: state.vehicles.iter().map(|v| driver(seed, v.id, v.kind)).collect(),
            walker_traits: state.walkers.iter().map(|w| walker_traits(seed, w.id)).collect(),
            state,
            bodies: Vec::new(),
        }
    }

    /// The map they are on.
    pub fn map(&self) -> &MapData {
        &self.ways.places.map
    }
}
