//! Other road users: vehicles on lanes, people on foot.
//!
//! Everyone decides from the state of the previous tick and writes only its own next state, so the
//! order of actors cannot matter, but for two who enter the map at one place in one tick. State is what
//! cannot be derived: places, speeds and waiting times.
//! Poses follow from the map's geometry, individual differences from stateless random numbers.

mod crossing;
mod drive;
mod hazard;
mod jaywalk;
mod junction;
mod lists;
mod look;
mod plan;
mod poses;
mod spawn;
mod traits;
mod vehicle;
mod walk;
mod walker;
mod ways;

use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::map::RoadNetwork;
use crate::scenario::Scenario;
use crate::scene::ActorKind;
use crate::state;
use crate::time::Tick;

use look::Sight;
use traits::{Driver, Person, driver, person};
use ways::Ways;

pub use vehicle::Vehicle;
pub use walker::{Walker, WalkerMode};
pub use ways::Lookups;

state! {
    /// Steering state of all traffic. Ids are unique over both lists, ascending in each, and start
    /// at 1; vehicles come before people.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct TrafficState {
        /// Cars, lorries, buses, motorcycles and bicycles.
        pub vehicles: Vec<Vehicle>,
        /// People on foot.
        pub walkers: Vec<Walker>,
    }
}

/// A box that moves freely: the ego car, or an actor that physics has taken over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// Id of the actor; 0 for the ego car.
    pub id: u32,
    /// Centre of its footprint on the ground, metres.
    pub position: Vec3,
    /// Direction of its x axis, radians counter-clockwise from east.
    pub heading_rad: f32,
    /// Velocity, m/s.
    pub velocity_mps: Vec3,
    /// Length, width and height, metres.
    pub size_m: Vec3,
}

/// What traffic sees of the rest of the world, as it was at the end of the previous tick.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// The tick that is being computed.
    pub tick: Tick,
    /// The ego car.
    pub ego: Obstacle,
    /// Actors that physics has made loose, by ascending id: they decide nothing, their state stays
    /// as it was, and others see them at these poses.
    pub loose: &'a [Obstacle],
}

/// An actor as physics and pictures need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Id of the actor, 1 or more.
    pub id: u32,
    /// What it is; gives its box by [`ActorKind::size_m`].
    pub kind: ActorKind,
    /// Selects colour and shape.
    pub variant: u32,
    /// Centre of its footprint on the ground, metres.
    pub position: Vec3,
    /// Rotation from its axes (x forward, y left, z up) to the world's.
    pub rotation: Quat,
    /// Velocity, m/s.
    pub velocity_mps: Vec3,
    /// Phase of gait or pedalling, radians in [0, 2 pi).
    pub phase_rad: f32,
    /// Brake lights on.
    pub braking: bool,
}

/// All traffic of a world: its state, and what is derived from it and the map.
#[derive(Clone, Debug)]
pub struct Traffic {
    network: Arc<RoadNetwork>,
    ways: Arc<Ways>,
    seed: u64,
    jaywalks_per_min: f32,
    state: TrafficState,
    drivers: Vec<Driver>,
    persons: Vec<Person>,
    /// At the places of the state.
    bodies: Vec<Body>,
    /// Memory for the next step; holds nothing between steps.
    sight: Sight,
}

impl Traffic {
    /// Fills a map with the actors a scenario asks for, none inside another or within 20 m of
    /// `ego_start`; fewer where the map has no room (compare [`Traffic::bodies`] with the scenario).
    pub fn spawn(scenario: &Scenario, network: &Arc<RoadNetwork>, ego_start: Vec3) -> Self {
        let ways = Ways::of(network);
        let state = spawn::spawn(scenario, network, &ways, ego_start);
        Self::with(scenario, network, ways, state)
    }

    /// Traffic as it was, from its state. Fails with one sentence when the state does not fit the
    /// map (lane or edge out of range, ids not ascending).
    pub fn resume(scenario: &Scenario, network: &Arc<RoadNetwork>, state: TrafficState) -> Result<Self, String> {
        state.check(network)?;
        Ok(Self::with(scenario, network, Ways::of(network), state))
    }

    fn with(scenario: &Scenario, network: &Arc<RoadNetwork>, ways: Arc<Ways>, state: TrafficState) -> Self {
        let seed = scenario.seed;
        let mut traffic = Self {
            network: network.clone(),
            ways,
            seed,
            jaywalks_per_min: scenario.traffic.jaywalks_per_min,
            drivers: state.vehicles.iter().map(|v| driver(seed, v.id, v.kind)).collect(),
            persons: state.walkers.iter().map(|w| person(seed, w.id)).collect(),
            state,
            bodies: Vec::new(),
            sight: Sight::default(),
        };
        traffic.place_bodies();
        traffic
    }

    /// The steering state, for hashing and keyframes.
    pub fn state(&self) -> &TrafficState {
        &self.state
    }

    /// Every actor by ascending id, at its place on the map; physics overrides the pose of those
    /// it has made loose.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Advances everyone by one tick.
    pub fn step(&mut self, surroundings: &Surroundings<'_>) {
        let mut sight = std::mem::take(&mut self.sight);
        sight.look(self, surroundings);
        let mut next = std::mem::take(&mut sight.next);
        next.vehicles.clear();
        next.walkers.clear();
        let (view, streets) = (sight.view(self), sight.streets(self));
        let driven = |i: usize, v: &Vehicle| if surroundings.holds(v.id) { *v } else { view.drive(i) };
        next.vehicles.extend(self.state.vehicles.iter().enumerate().map(|(i, v)| driven(i, v)));
        let walked = |i: usize, w: &Walker| if surroundings.holds(w.id) { *w } else { streets.walk(i) };
        next.walkers.extend(self.state.walkers.iter().enumerate().map(|(i, w)| walked(i, w)));
        sight.next = std::mem::replace(&mut self.state, next);
        self.return_to_map(surroundings);
        self.place_bodies();
        self.sight = sight;
    }
}

impl Surroundings<'_> {
    /// Whether physics holds the actor.
    fn holds(&self, id: u16) -> bool {
        self.loose.binary_search_by_key(&u32::from(id), |o| o.id).is_ok()
    }
}

impl TrafficState {
    fn check(&self, network: &RoadNetwork) -> Result<(), String> {
        let ids = || self.vehicles.iter().map(|v| v.id).chain(self.walkers.iter().map(|w| w.id));
        if !ids().zip(ids().skip(1)).all(|(a, b)| a < b) || ids().next() == Some(0) {
            return Err("actors: expected ascending ids from 1".into());
        }
        for v in &self.vehicles {
            let lane = network.lanes.get(v.lane as usize).filter(|lane| (0.0..=lane.length_m).contains(&v.s_m));
            let kind = v.kind != ActorKind::Pedestrian;
            if lane.is_none() || !kind || v.speed_mps < 0.0 || v.flags & !Vehicle::ALL_FLAGS != 0 {
                return Err(format!("vehicle {}: expected a vehicle on a lane of map {}", v.id, network.name));
            }
        }
        let on_map = |w: &&Walker| (w.edge as usize) < network.walk_edges.len() && w.speed_mps >= 0.0;
        match self.walkers.iter().find(|w| !on_map(w)) {
            Some(w) => Err(format!("walker {}: expected a way of map {}", w.id, network.name)),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
