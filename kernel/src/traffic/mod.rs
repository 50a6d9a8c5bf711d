//! Other road users: vehicles on lanes, people on foot.
//!
//! Everyone decides from the state of the previous tick and writes only its own next state, so the
//! order of actors cannot matter, but for two who enter the map at one place in one tick. State is what
//! cannot be derived: places, speeds and waiting times.
//! Poses follow from the map's geometry, individual differences from stateless random numbers.

mod actors;
mod body;
mod change;
mod company;
mod counts;
mod crosswalk;
mod crowd;
mod drive;
mod hazard;
mod jaywalk;
mod journey;
mod junction;
mod lane_way;
mod links;
mod lists;
mod look;
mod manoeuvre;
mod meets;
mod pass;
mod passage;
mod plan;
mod poses;
mod routes;
mod sideways;
mod spawn;
mod state;
mod step;
mod traits;
mod vehicle;
mod walk;
mod walker;
mod watchdog;
mod ways;
mod zebra;
mod zipper;
mod zones;

use std::sync::Arc;

use glam::Vec3;

use crate::actor::ActorKind;
use crate::events::EventKind;
use actors::Actors;
use look::Sight;
use passage::Told;

pub use body::{Body, Obstacle, Surroundings};
pub use counts::{Missing, TrafficCounts};
pub use manoeuvre::Manoeuvre;
pub use state::TrafficState;
pub use vehicle::Vehicle;
pub use walker::{Walker, WalkerMode};
pub use ways::Ways;

/// All traffic of a world: its state, and what is derived from it and the map.
#[derive(Clone, Debug)]
pub struct Traffic {
    actors: Actors,
    /// Memory for the next step; holds nothing between steps.
    sight: Sight,
    /// What the watchdog found in the last step.
    told: Vec<Told>,
}

impl Traffic {
    /// Fills a map with the actors that are asked for, none inside another or within 20 m of
    /// `ego_start`; fewer where the map has no room ([`Traffic::missing`] says so).
    pub fn spawn(counts: &TrafficCounts, seed: u64, ways: &Arc<Ways>, ego_start: Vec3) -> Self {
        Self::with(counts, seed, ways, spawn::spawn(counts, seed, ways, ego_start))
    }

    /// Traffic as it was, from its state. Fails with one sentence when the state does not fit the
    /// map (lane or edge out of range, ids not ascending).
    pub(crate) fn resume(
        counts: &TrafficCounts,
        seed: u64,
        ways: &Arc<Ways>,
        state: TrafficState,
    ) -> Result<Self, String> {
        state.check(&ways.places.map)?;
        Ok(Self::with(counts, seed, ways, state))
    }

    fn with(counts: &TrafficCounts, seed: u64, ways: &Arc<Ways>, state: TrafficState) -> Self {
        let actors = Actors::new(counts, seed, ways, state);
        Self { actors, sight: Sight::default(), told: Vec::new() }
    }

    /// The steering state, for hashing and keyframes.
    pub fn state(&self) -> &TrafficState {
        &self.actors.state
    }

    /// Every actor by ascending id, at its place on the map; physics overrides the pose of those
    /// it has made loose.
    pub fn bodies(&self) -> &[Body] {
        &self.actors.bodies
    }

    /// Who was asked for and found no room.
    pub fn missing(&self) -> Missing {
        let TrafficState { vehicles, walkers } = self.state();
        let walkers = walkers.iter().map(|_| ActorKind::Pedestrian);
        self.actors.counts.missing(vehicles.iter().map(|v| v.kind).chain(walkers))
    }

    /// What the watchdog found in the last step, each with the id of a vehicle: [`EventKind::Stuck`] and
    /// [`EventKind::Dissolved`].
    pub fn told(&self) -> &[(EventKind, u32)] {
        &self.told
    }

    /// Advances everyone by one tick.
    pub fn step(&mut self, surroundings: &Surroundings<'_>) {
        let Self { actors, sight, told } = self;
        told.clear();
        actors.heed(&surroundings.conditions);
        sight.look(actors, surroundings);
        let (mut next, mut places) = (std::mem::take(&mut sight.next), std::mem::take(&mut sight.places));
        places.clear();
        next.vehicles.clear();
        next.walkers.clear();
        let (view, streets) = (sight.view(actors), sight.streets(actors));
        let driven = |i: usize, v: &Vehicle| if surroundings.holds(v.id) { *v } else { view.drive(i) };
        next.vehicles.extend(actors.state.vehicles.iter().enumerate().map(|(i, v)| driven(i, v)));
        for (i, walker) in actors.state.walkers.iter().enumerate() {
            let held = surroundings.holds(walker.id);
            let (walker, place) = if held { (*walker, actors.places[i]) } else { streets.walk(i) };
            next.walkers.push(walker);
            places.push(place);
        }
        sight.next = std::mem::replace(&mut actors.state, next);
        sight.places = std::mem::replace(&mut actors.places, places);
        actors.return_to_map(surroundings, told);
        actors.place_bodies();
    }
}

#[cfg(test)]
mod tests;
