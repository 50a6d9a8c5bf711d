//! Other road users: vehicles on lanes, people on foot.
//!
//! Everyone decides from the state of the previous tick and writes only its own next state, so the
//! order of actors cannot matter, but for two who enter the map at one place in one tick. State is what
//! cannot be derived: places, speeds and waiting times.
//! Poses follow from the map's geometry, individual differences from stateless random numbers.

mod actors;
mod approach;
mod asking;
mod axles;
mod barge;
mod bends;
mod boarding;
mod body;
mod boxes;
mod brink;
mod bus;
mod calls;
mod change;
mod company;
mod counts;
mod courtesy;
mod cover;
mod crash;
mod crosswalk;
mod doors;
mod drive;
mod forbear;
mod groups;
mod hazard;
mod hazards;
mod horn;
mod jaywalk;
mod journey;
mod junction;
mod lane_way;
mod lapse;
mod links;
mod lists;
mod look;
mod manoeuvre;
mod meets;
mod mistakes;
mod nearby;
mod off_vehicles;
mod openings;
mod outline;
mod pass;
mod passage;
mod perception;
mod plan;
mod population;
mod poses;
mod rates;
mod reasons;
mod riders;
mod roundabout;
mod routes;
mod sideways;
mod slack;
mod spawn;
mod state;
mod step;
mod stop_ways;
mod surprise;
mod through_bends;
mod together;
mod traits;
mod turns;
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
use crate::time::Tick;
use actors::Actors;
use look::Sight;
use passage::Told;

pub use body::{Body, Obstacle, Surroundings};
pub use counts::{Missing, TrafficCounts};
pub(crate) use doors::{Door, Hinge, OPEN_RAD};
pub use lapse::Lapse;
pub use manoeuvre::Manoeuvre;
pub use population::Population;
pub use rates::{HazardLevel, HazardRates};
pub use state::TrafficState;
pub use vehicle::Vehicle;
pub use walker::{Walker, WalkerMode};
pub use ways::Ways;

/// Mistakes of others within this distance are events of the ego car's run, metres.
pub(crate) const SIGHT_M: f32 = 100.0;

/// All traffic of a world: its state, and what is derived from it and the map.
#[derive(Clone, Debug)]
pub struct Traffic {
    actors: Actors,
    /// Memory for the next step; holds nothing between steps.
    sight: Sight,
    /// What the watchdog found in the last step, and which mistakes began.
    told: Vec<Told>,
}

impl Traffic {
    /// Fills a map with the actors that are asked for, none inside another or within 20 m of
    /// `ego_start`; fewer where the map has no room ([`Traffic::missing`] says so).
    pub fn spawn(counts: &TrafficCounts, seed: u64, ways: &Arc<Ways>, ego_start: Vec3) -> Self {
        Self::spawn_clear_of(counts, seed, ways, &[ego_start])
    }

    /// The same within 20 m of none of some places.
    pub(crate) fn spawn_clear_of(counts: &TrafficCounts, seed: u64, ways: &Arc<Ways>, taken: &[Vec3]) -> Self {
        Self::with(counts, seed, ways, spawn::spawn(counts, seed, ways, taken))
    }

    /// The same with people at the wheel who make mistakes at these rates; by itself nobody does.
    pub fn with_hazards(mut self, rates: &HazardRates) -> Self {
        self.actors.rates = *rates;
        self.actors.know_drivers();
        self
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

    /// Every actor but those who ride in buses, by ascending id, at its place on the map; physics overrides the pose of those
    /// it has made loose.
    pub fn bodies(&self) -> &[Body] {
        self.actors.seen()
    }

    /// Who was asked for and found no room.
    pub fn missing(&self) -> Missing {
        let TrafficState { vehicles, walkers } = self.state();
        let walkers = walkers.iter().map(|_| ActorKind::Pedestrian);
        self.actors.counts.missing(vehicles.iter().map(|v| v.kind).chain(walkers))
    }

    /// What the watchdog found in the last step and which mistakes began, each with the id of a vehicle: all kinds
    /// from [`EventKind::Stuck`] on.
    pub fn told(&self) -> &[(EventKind, u32)] {
        &self.told
    }

    /// The same, of mistakes only those in sight of a place.
    pub(crate) fn told_near(&self, place: Vec3) -> impl Iterator<Item = (EventKind, u32)> {
        let bodies = self.bodies();
        let position = |id: u32| bodies.binary_search_by_key(&id, |body| body.id).map(|at| bodies[at].position);
        let near = move |id: u32| position(id).is_ok_and(|p| p.distance_squared(place) < SIGHT_M * SIGHT_M);
        self.told.iter().copied().filter(move |(kind, id)| !mistakes::is_mistake(*kind) || near(*id))
    }

    /// Looks up which doors open about a tick; a step does it by itself.
    pub(crate) fn know_doors(&mut self, tick: Tick) {
        self.actors.know_doors(tick);
    }

    /// The doors of parked cars that stand open at the end of a tick.
    pub(crate) fn open_doors(&self, tick: Tick, ego: Obstacle) -> impl Iterator<Item = Door> {
        self.actors.open_doors(tick, ego)
    }

    /// Advances everyone by one tick.
    pub fn step(&mut self, surroundings: &Surroundings<'_>) {
        let Self { actors, sight, told } = self;
        told.clear();
        actors.heed(&surroundings.conditions);
        actors.know_doors(surroundings.tick);
        sight.look(actors, surroundings);
        let (mut next, mut places) = (std::mem::take(&mut sight.next), std::mem::take(&mut sight.places));
        places.clear();
        next.vehicles.clear();
        next.walkers.clear();
        let (view, streets, mut near) = (sight.view(actors), sight.streets(actors), Vec::new());
        let driven = |i: usize, v: &Vehicle| if surroundings.holds(v.id) { *v } else { view.drive(i) };
        next.vehicles.extend(actors.state.vehicles.iter().enumerate().map(|(i, v)| driven(i, v)));
        for (i, walker) in actors.state.walkers.iter().enumerate() {
            let held = surroundings.holds(walker.id);
            let (walker, place) = if held { (*walker, actors.places[i]) } else { streets.walk(i, &mut near) };
            next.walkers.push(walker);
            places.push(place);
        }
        sight.next = std::mem::replace(&mut actors.state, next);
        sight.places = std::mem::replace(&mut actors.places, places);
        mistakes::tell(&sight.next.vehicles, &actors.state.vehicles, told);
        actors.return_to_map(&sight.next.vehicles, surroundings, told);
        actors.exchange(&sight.calls, surroundings);
        actors.place_bodies();
        actors.crash(&sight.hazards, surroundings, told);
    }
}

#[cfg(test)]
mod tests;
