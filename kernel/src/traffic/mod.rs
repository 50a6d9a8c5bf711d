//! Other road users: vehicles on lanes, people on foot.
//!
//! Everyone decides from the state of the previous tick and writes only its own next state, so the
//! order of actors cannot matter. State is what cannot be derived: places, speeds and waiting times.
//! Poses follow from the map's geometry, individual differences from stateless random numbers.

mod vehicle;
mod walker;

use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::map::RoadNetwork;
use crate::scenario::Scenario;
use crate::scene::ActorKind;
use crate::state;
use crate::time::Tick;

pub use vehicle::Vehicle;
pub use walker::{Walker, WalkerMode};

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
    scenario: Scenario,
    state: TrafficState,
    bodies: Vec<Body>,
}

impl Traffic {
    /// Fills a map with the actors a scenario asks for, none inside another or within 20 m of
    /// `ego_start`; fewer where the map has no room (compare [`Traffic::bodies`] with the scenario).
    pub fn spawn(_scenario: &Scenario, _network: &Arc<RoadNetwork>, _ego_start: Vec3) -> Self {
        todo!()
    }

    /// Traffic as it was, from its state. Fails with one sentence when the state does not fit the
    /// map (lane or edge out of range, ids not ascending).
    pub fn resume(_scenario: &Scenario, _network: &Arc<RoadNetwork>, _state: TrafficState) -> Result<Self, String> {
        todo!()
    }

    /// The steering state, for hashing and keyframes.
    pub fn state(&self) -> &TrafficState {
        &self.state
    }

    /// Advances everyone by one tick.
    pub fn step(&mut self, _surroundings: &Surroundings<'_>) {
        todo!()
    }

    /// Every actor by ascending id, at its place on the map; physics overrides the pose of those
    /// it has made loose.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }
}
