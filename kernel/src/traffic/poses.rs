//! From places on lanes and ways to poses in the world.

use glam::{Mat3, Quat, Vec3};

use crate::map_data::{LaneId, Place};
use crate::ops;
use crate::scene::lamps;

use super::actors::Actors;
use super::axles::{AXLE, on_axles};
use super::body::Body;
use super::journey::Journey;
use super::traits::{Driver, WalkerTraits};
use super::vehicle::Vehicle;
use super::walker::{Walker, WalkerMode, radians};
use super::ways::Ways;

/// Vehicles longer than this have their axles on the way, metres; shorter ones their middle.
const LONG_M: f32 = 5.0;

/// How much farther to the left the middle of a vehicle is than its rear axle, which does not slip sideways, metres.
pub(super) fn leads_m(vehicle: &Vehicle, driver: &Driver) -> f32 {
    0.01 * f32::from(vehicle.drift) * AXLE * driver.size_m.x
}

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
        bodies.extend(vehicles.map(|(vehicle, driver)| self.ways.vehicle_body(self.seed, vehicle, driver)));
        let walkers = self.state.walkers.iter().zip(&self.walker_traits).zip(&self.places);
        bodies.extend(walkers.map(|((walker, traits), place)| walker_body(walker, traits, place)));
        self.bodies = bodies;
        self.know_seen();
    }
}

impl Ways {
    /// The middle of a vehicle and the direction of its way there. A long one has both axles on the way, so that in
    /// bends its middle is inside of it and its tail swings out little.
    fn vehicle_place(&self, seed: u64, vehicle: &Vehicle, driver: &Driver) -> (Vec3, Vec3) {
        if driver.size_m.x < LONG_M {
            let place = self.lane_place(vehicle.lane, vehicle.s_m);
            return (place.beside(vehicle.offset_m), place.forward);
        }
        on_axles(driver.size_m.x, |ahead_m| {
            let place = if ahead_m < 0.0 {
                self.place_behind(vehicle, ahead_m)
            } else {
                self.place_ahead(seed, vehicle, ahead_m)
            };
            place.beside(vehicle.offset_m)
        })
    }

    /// The place on the way of a vehicle at a distance from its middle, metres, negative behind it.
    fn place_behind(&self, vehicle: &Vehicle, ahead_m: f32) -> Place {
        let s_m = vehicle.s_m + ahead_m;
        match self.places.map.lanes[vehicle.before as usize].length_m {
            length_m if s_m < 0.0 && vehicle.before != vehicle.lane => {
                self.lane_place(vehicle.before, (length_m + s_m).max(0.0))
            }
            _ => self.lane_place(vehicle.lane, s_m),
        }
    }

    /// The same ahead of it.
    fn place_ahead(&self, seed: u64, vehicle: &Vehicle, ahead_m: f32) -> Place {
        let s_m = vehicle.s_m + ahead_m;
        let over_m = s_m - self.places.map.lanes[vehicle.lane as usize].length_m;
        let next = || Journey::of(self, seed, vehicle).next_lane(vehicle.lane);
        match if over_m > 0.0 { next() } else { None } {
            Some(next) if self.lane_end(vehicle.lane).joins(&self.lane_place(next.lane, next.at_m)) => {
                self.lane_place(next.lane, next.at_m + over_m)
            }
            _ => self.lane_place(vehicle.lane, s_m),
        }
    }

    fn lane_end(&self, lane: LaneId) -> Place {
        self.lane_place(lane, self.places.map.lanes[lane as usize].length_m)
    }

    fn lane_place(&self, lane: LaneId, s_m: f32) -> Place {
        self.lanes[lane as usize].pose(&self.places.map.lanes[lane as usize], s_m)
    }

    /// A vehicle at its place on the map; the seed is that of its journey.
    pub(super) fn vehicle_body(&self, seed: u64, vehicle: &Vehicle, driver: &Driver) -> Body {
        let (middle, ahead) = self.vehicle_place(seed, vehicle, driver);
        let (position, forward) = match vehicle.drift {
            0 => (middle, ahead),
            drift => {
                let left = Vec3::new(-ahead.y, ahead.x, 0.0).normalize_or(Vec3::Y);
                let turned = (ahead + left * (0.01 * f32::from(drift))).normalize_or(ahead);
                (middle + left * leads_m(vehicle, driver), turned)
            }
        };
        Body {
            id: u32::from(vehicle.id),
            kind: vehicle.kind,
            variant: driver.variant,
            position,
            rotation: level_rotation(forward),
            velocity_mps: forward * vehicle.speed_mps,
            phase_rad: radians(vehicle.phase),
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
    let half_rad = radians(walker.heading) * 0.5;
    let (sin, cos) = (ops::sin(half_rad), ops::cos(half_rad));
    let rotation = Quat::from_xyzw(0.0, 0.0, sin, cos);
    let sign = if walker.forward { 1.0 } else { -1.0 };
    let ahead = match walker.mode {
        WalkerMode::Jaywalk => place.left().extend(0.0) * sign,
        WalkerMode::Boards | WalkerMode::Alights => rotation * Vec3::X,
        _ => place.forward * sign,
    };
    Body {
        id: u32::from(walker.id),
        kind: traits.kind,
        variant: traits.variant,
        position: place.beside(walker.offset_m),
        rotation,
        velocity_mps: ahead * walker.speed_mps,
        phase_rad: radians(walker.phase),
        lamps: 0,
    }
}
