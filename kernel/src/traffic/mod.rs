//! Other road users: vehicles on lanes, people on foot.
//!
//! Everyone decides from the state of the previous tick and writes only its own next state, so the
//! order of actors cannot matter, but for two who enter the map at one place in one tick. State is what
//! cannot be derived: places, speeds and waiting times.
//! Poses follow from the map's geometry, individual differences from stateless random numbers.

mod actors;
mod body;
mod counts;
mod crosswalk;
mod drive;
mod edge_lists;
mod hazard;
mod jaywalk;
mod junction;
mod lists;
mod look;
mod plan;
mod poses;
mod spawn;
mod state;
mod traits;
mod vehicle;
mod walk;
mod walker;
mod ways;

use std::sync::Arc;

use glam::Vec3;

use actors::Actors;
use look::Sight;

pub use body::{Body, Obstacle, Surroundings};
pub use counts::TrafficCounts;
pub use state::TrafficState;
pub use vehicle::Vehicle;
pub use walker::{Walker, WalkerMode};
pub(crate) use ways::Ways;

/// All traffic of a world: its state, and what is derived from it and the map.
#[derive(Clone, Debug)]
pub struct Traffic {
    actors: Actors,
    /// Memory for the next step; holds nothing between steps.
    sight: Sight,
}

impl Traffic {
    /// Fills a map with the actors that are asked for, none inside another or within 20 m of
    /// `ego_start`; fewer where the map has no room (compare [`Traffic::bodies`] with `counts`).
    pub(crate) fn spawn(counts: &TrafficCounts, seed: u64, ways: &Arc<Ways>, ego_start: Vec3) -> Self {
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
        let mut actors = Actors::new(counts, seed, ways, state);
        actors.place_bodies();
        Self { actors, sight: Sight::default() }
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

    /// Advances everyone by one tick.
    pub fn step(&mut self, surroundings: &Surroundings<'_>) {
        let Self { actors, sight } = self;
        sight.look(actors, surroundings);
        let mut next = std::mem::take(&mut sight.next);
        next.vehicles.clear();
        next.walkers.clear();
        let (view, streets) = (sight.view(actors), sight.streets(actors));
        let driven = |i: usize, v: &Vehicle| if surroundings.holds(v.id) { *v } else { view.drive(i) };
        next.vehicles.extend(actors.state.vehicles.iter().enumerate().map(|(i, v)| driven(i, v)));
        let walked = |i: usize, w: &Walker| if surroundings.holds(w.id) { *w } else { streets.walk(i) };
        next.walkers.extend(actors.state.walkers.iter().enumerate().map(|(i, w)| walked(i, w)));
        sight.next = std::mem::replace(&mut actors.state, next);
        actors.return_to_map(surroundings);
        actors.place_bodies();
    }
}

#[cfg(test)]
mod tests;
