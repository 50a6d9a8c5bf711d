//! From places on lanes and ways to poses in the world.

use glam::{Mat3, Quat, Vec3};

use crate::actor::ActorKind;
use crate::map_data::Place;
use crate::ops;
use crate::scene::lamps;

use super::actors::Actors;
use super::body::Body;
use super::traits::{Driver, WalkerTraits};
use super::vehicle::Vehicle;
use super::walker::{Walker, WalkerMode};

/// Radians in 2^-16 turns.
const TURN_RAD: f32 = core::f32::consts::TAU / 65536.0;

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
        let walkers = self.state.walkers.iter().zip(&self.walker_traits).zip(&self.places);
        bodies.extend(walkers.map(|((walker, traits), place)| walker_body(walker, traits, place)));
        self.bodies = bodies;
    }

    pub(super) fn vehicle_body(&self, vehicle: &Vehicle, driver: &Driver) -> Body {
        let lane = vehicle.lane as usize;
        let place = self.ways.lanes[lane].pose(&self.map().lanes[lane], vehicle.s_m);
        let forward = match vehicle.drift {
            0 => place.forward,
            drift => {
                let aslant = place.left().extend(0.0) * (0.01 * f32::from(drift));
                (place.forward + aslant).normalize_or(place.forward)
            }
        };
        Body {
            id: u32::from(vehicle.id),
            kind: vehicle.kind,
            variant: driver.variant,
            position: place.beside(vehicle.offset_m),
            rotation: level_rotation(forward),
            velocity_mps: forward * vehicle.speed_mps,
            phase_rad: f32::from(vehicle.phase) * TURN_RAD,
            lamps: lamps(vehicle),
        }
    }
}

fn lamps(vehicle: &Vehicle) -> u8 {
    let on = |lamp: u8, is_on: bool| if is_on { lamp } else { 0 };
    let side = vehicle.manoeuvre.side();
    on(lamps::BRAKE, vehicle.flags & Vehicle::BRAKING != 0)
        | on(lamps::LEFT, side > 0 || side == 0 && vehicle.flags & Vehicle::TURNS_LEFT != 0)
        | on(lamps::RIGHT, side < 0 || side == 0 && vehicle.flags & Vehicle::TURNS_RIGHT != 0)
}

/// Somebody on foot whose way leads over a place.
pub(super) fn walker_body(walker: &Walker, traits: &WalkerTraits, place: &Place) -> Body {
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
        lamps: 0,
    }
}
