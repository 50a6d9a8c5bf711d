//! From places on lanes and ways to poses in the world.

use glam::{Mat3, Quat, Vec3};

use crate::actor::ActorKind;
use crate::ops;
use crate::rng::{Stream, below};

use super::actors::Actors;
use super::body::{Body, Surroundings};
use super::spawn::EGO_CLEARANCE_M;
use super::traits::{Driver, WalkerTraits};
use super::vehicle::Vehicle;
use super::walker::{Walker, WalkerMode};

/// Radians in 2^-16 turns.
const TURN_RAD: f32 = core::f32::consts::TAU / 65536.0;
/// Vehicles leave and enter the map no nearer to the ego car than this, metres.
const UNSEEN_M: f32 = 2.0 * EGO_CLEARANCE_M;
/// Free stretch of a lane on which a vehicle enters the map, metres.
const ENTRY_SPACE_M: f32 = 18.0;

/// Rotation whose x axis is `forward` and whose y axis is level.
fn level_rotation(forward: Vec3) -> Quat {
    let left = Vec3::new(-forward.y, forward.x, 0.0).normalize_or(Vec3::Y);
    Quat::from_mat3(&Mat3::from_cols(forward, left, forward.cross(left)))
}

impl Actors {
    /// Brings the bodies to the places of the state.
    pub(super) fn place_bodies(&mut self) {
        let mut bodies = std::mem::take(&mut self.bodies);
        bodies.clear();
        let vehicles = self.state.vehicles.iter().zip(&self.drivers);
        bodies.extend(vehicles.map(|(vehicle, driver)| self.vehicle_body(vehicle, driver)));
        let walkers = self.state.walkers.iter().zip(&self.walker_traits);
        bodies.extend(walkers.map(|(walker, traits)| self.walker_body(walker, traits)));
        self.bodies = bodies;
    }

    fn vehicle_body(&self, vehicle: &Vehicle, driver: &Driver) -> Body {
        let lane = vehicle.lane as usize;
        let place = self.ways.lanes[lane].pose(&self.map().lanes[lane], vehicle.s_m);
        Body {
            id: u32::from(vehicle.id),
            kind: vehicle.kind,
            variant: driver.variant,
            position: place.beside(vehicle.offset_m),
            rotation: level_rotation(place.forward),
            velocity_mps: place.forward * vehicle.speed_mps,
            phase_rad: f32::from(vehicle.phase) * TURN_RAD,
            braking: vehicle.flags & Vehicle::BRAKING != 0,
        }
    }

    fn walker_body(&self, walker: &Walker, traits: &WalkerTraits) -> Body {
        let place = self.ways.walker_place(walker);
        let half_rad = f32::from(walker.heading) * (TURN_RAD * 0.5);
        let (sin, cos) = (ops::sin(half_rad), ops::cos(half_rad));
        let across = walker.mode == WalkerMode::Jaywalk;
        let ahead = if across { place.left().extend(0.0) } else { place.forward };
        let sign = if walker.forward { 1.0 } else { -1.0 };
        Body {
            id: u32::from(walker.id),
            kind: ActorKind::Pedestrian,
            variant: traits.variant,
            position: place.beside(walker.offset_m),
            rotation: Quat::from_xyzw(0.0, 0.0, sin, cos),
            velocity_mps: ahead * (sign * walker.speed_mps),
            phase_rad: f32::from(walker.phase) * TURN_RAD,
            braking: false,
        }
    }

    /// Moves vehicles that stand where the map ends to a lane on which it begins, out of sight of the
    /// ego car.
    pub(super) fn return_to_map(&mut self, surroundings: &Surroundings<'_>) {
        if self.ways.entries.is_empty() {
            return;
        }
        for i in 0..self.state.vehicles.len() {
            let vehicle = self.state.vehicles[i];
            let lane = &self.map().lanes[vehicle.lane as usize];
            let ends = self.ways.lanes[vehicle.lane as usize].onward.is_empty();
            let near_end = vehicle.s_m > lane.length_m - self.drivers[i].size_m.x * 0.5 - 4.0;
            if ends && near_end && vehicle.speed_mps < 0.5 && !surroundings.holds(vehicle.id) {
                self.enter_map(i, surroundings);
            }
        }
    }

    fn enter_map(&mut self, index: usize, surroundings: &Surroundings<'_>) {
        let vehicle = self.state.vehicles[index];
        let count = self.ways.entries.len() as u32;
        let pick = below(self.seed, Stream::Spawn, u64::from(vehicle.id), surroundings.tick, count);
        let lane = self.ways.entries[pick as usize];
        let s_m = self.drivers[index].size_m.x * 0.5 + 0.5;
        let place = |v: &Vehicle| self.map().lanes[v.lane as usize].straight_on(v.s_m).position;
        let entry = self.map().lanes[lane as usize].straight_on(s_m).position;
        let unseen = |p: Vec3| p.distance(surroundings.ego.position) > UNSEEN_M;
        let free = self.state.vehicles.iter().all(|other| other.lane != lane || other.s_m > ENTRY_SPACE_M);
        if unseen(entry) && unseen(place(&vehicle)) && free {
            let kept = vehicle.flags & Vehicle::BRAKING;
            let hops = vehicle.hops.wrapping_add(1);
            self.state.vehicles[index] =
                Vehicle { lane, s_m, flags: kept, hops, wait_ticks: 0, speed_mps: 3.0, ..vehicle };
        }
    }
}
