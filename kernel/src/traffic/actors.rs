//! Everyone in traffic: their state, and what follows from it, the map and the seed.

use std::sync::Arc;

use super::body::Body;
use super::counts::TrafficCounts;
use super::doors::Doors;
use super::groups::Groups;
use super::rates::HazardRates;
use super::state::TrafficState;
use super::traits::{Driver, WalkerTraits, driver, walker_traits};
use super::walker::Walker;
use super::ways::Ways;
use crate::map_data::{MapData, Place};
use crate::weather::Conditions;

/// All actors of a world.
#[derive(Clone, Debug)]
pub(super) struct Actors {
    pub ways: Arc<Ways>,
    pub seed: u64,
    pub counts: TrafficCounts,
    /// How often drivers make mistakes.
    pub rates: HazardRates,
    pub state: TrafficState,
    pub drivers: Vec<Driver>,
    pub walker_traits: Vec<WalkerTraits>,
    /// Who walks with whom.
    pub groups: Groups,
    /// Where walkers stand on their ways, before what they are beside the middle.
    pub places: Vec<Place>,
    /// At the places of the state.
    pub bodies: Vec<Body>,
    /// The same without those who ride in buses; empty where nobody does.
    seen: Vec<Body>,
    /// Which open about this time.
    pub doors: Doors,
    /// The weather that drivers and walkers heed.
    conditions: Conditions,
}

impl Actors {
    /// Those of a state.
    pub fn new(counts: &TrafficCounts, seed: u64, ways: &Arc<Ways>, state: TrafficState) -> Self {
        let mut actors = Self {
            ways: ways.clone(),
            seed,
            counts: *counts,
            rates: HazardRates::NONE,
            drivers: Vec::new(),
            walker_traits: Vec::new(),
            groups: Groups::new(seed, &state.walkers),
            places: state.walkers.iter().map(|w| ways.walker_place(w)).collect(),
            state,
            bodies: Vec::new(),
            seen: Vec::new(),
            doors: Doors::default(),
            conditions: Conditions::default(),
        };
        actors.know_drivers();
        actors.know_walkers();
        actors.place_bodies();
        actors
    }

    /// How everybody on foot walks in this weather: in company as fast as the slowest.
    fn know_walkers(&mut self) {
        let Self { seed, conditions, groups, state, .. } = self;
        let own: Vec<_> = state.walkers.iter().map(|w| walker_traits(*seed, w.id).heeding(conditions)).collect();
        let slowest_mps = |i: usize| groups.members(i).map(|k| own[k].speed_mps).fold(f32::MAX, f32::min);
        let known = own.iter().enumerate().map(|(i, known)| WalkerTraits { speed_mps: slowest_mps(i), ..*known });
        self.walker_traits = known.collect();
    }

    /// How everybody at the wheel drives: by nature, with the habits that the rates ask for, in this weather.
    pub fn know_drivers(&mut self) {
        let Self { counts, seed, rates, conditions, drivers, state, .. } = self;
        drivers.clear();
        drivers.extend(state.vehicles.iter().map(|v| {
            let mut known = driver(&counts.drivers, *seed, v.id, v.kind);
            rates.form(*seed, v, &mut known);
            known.heeding(conditions)
        }));
    }

    /// Everybody drives and walks as the weather asks for.
    pub fn heed(&mut self, conditions: &Conditions) {
        if self.conditions == *conditions {
            return;
        }
        self.conditions = *conditions;
        self.know_drivers();
        self.know_walkers();
    }

    /// Leaves out who rides in a bus of what there is to see.
    pub(super) fn know_seen(&mut self) {
        self.seen.clear();
        let (vehicles, walkers) = (self.state.vehicles.len(), &self.state.walkers);
        if walkers.iter().any(Walker::rides) {
            let there = |i: &usize| *i < vehicles || !walkers[*i - vehicles].rides();
            self.seen.extend((0..self.bodies.len()).filter(there).map(|i| self.bodies[i]));
        }
    }

    /// The bodies of all who stand in the world.
    pub fn seen(&self) -> &[Body] {
        if self.seen.is_empty() { &self.bodies } else { &self.seen }
    }

    /// The map they are on.
    pub fn map(&self) -> &MapData {
        &self.ways.places.map
    }
}
