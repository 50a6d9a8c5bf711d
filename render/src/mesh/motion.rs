//! What moves the joints of a model: a function of one snapshot, so that its picture needs no other.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;
use kernel::scene::{ActorScene, EgoScene};

/// Vehicles' phases advance by a turn in this distance, be there pedals or not, metres.
pub const LAP_M: f32 = 5.0;

/// Directions that the ego car's heading is rounded to.
const SECTORS: f32 = 12.0;

/// How somebody moves at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Phase of gait or pedalling, radians.
    pub phase_rad: f32,
    /// Speed forward, m/s.
    pub speed_mps: f32,
    /// Mean angle of the front wheels, radians, positive to the left.
    pub steer_rad: f32,
    /// How far it has rolled since a multiple of [`LAP_M`], metres in [0, [`LAP_M`]).
    pub rolled_m: f32,
}

impl Motion {
    /// That of a road user. Where its front wheels point is not known, so they point ahead.
    pub fn of_actor(actor: &ActorScene) -> Self {
        let ActorScene { phase_rad, speed_mps, .. } = *actor;
        Self { phase_rad, speed_mps, steer_rad: 0.0, rolled_m: phase_rad / TAU * LAP_M }
    }

    /// That of the ego car.
    pub fn of_ego(ego: &EgoScene) -> Self {
        Self { phase_rad: 0.0, speed_mps: ego.speed_mps, steer_rad: -ego.wheel_angle_rad, rolled_m: rolled_m(ego) }
    }
}

/// How far the ego car is along the direction nearest to its heading. Along the heading itself it would roll by turning,
/// the more the farther from the origin; so in bends it rolls up to 4 % too little, and starts anew every 30 degrees.
fn rolled_m(ego: &EgoScene) -> f32 {
    let ahead = ego.rotation * Vec3::X;
    let sector = ops::round(ops::atan2(ahead.y, ahead.x) * (SECTORS / TAU));
    let direction_rad = sector * (TAU / SECTORS);
    let along_m = ego.position.x * ops::cos(direction_rad) + ego.position.y * ops::sin(direction_rad);
    along_m.rem_euclid(LAP_M)
}
