//! From the steering wheel to the directions of the front wheels.

use glam::Vec3;

use super::dimensions::{MAX_WHEEL_ANGLE_RAD, WHEELBASE_M, is_front, place_m};
use crate::ops;
use crate::time::TICK_S;

/// How fast the front wheels turn when the car stands, rad/s.
const RATE_RADPS: f32 = 1.0;
/// Speed at which they turn half as fast, m/s.
const RATE_HALF_MPS: f32 = 15.0;

/// The mean angle of the front wheels a tick later, radians, positive to the right, on its way to what the steering
/// fraction asks for.
pub fn turned_rad(angle_rad: f32, fraction: f32, speed_mps: f32) -> f32 {
    let most = TICK_S * RATE_RADPS / (1.0 + speed_mps.abs() / RATE_HALF_MPS);
    angle_rad + (fraction * MAX_WHEEL_ANGLE_RAD - angle_rad).clamp(-most, most)
}

/// The direction of a wheel along the car's axes. The front wheels point across the same centre of the turn
/// (Ackermann).
pub fn direction(wheel: usize, angle_rad: f32) -> Vec3 {
    if !is_front(wheel) {
        return Vec3::X;
    }
    let left = -ops::tan(angle_rad);
    Vec3::new(WHEELBASE_M - place_m(wheel)[1] * left, WHEELBASE_M * left, 0.0).normalize()
}
