//! Foot brake and hand brake as torques.

use super::dimensions::{MASS_KG, WHEEL_RADIUS_M, is_front};
use crate::controls::Controls;

/// Deceleration by the pedal in the range of daily driving, m/s^2, and what its last part adds: enough to lock the
/// wheels on any surface.
const DAILY_MPS2: f32 = 8.4;
const LAST_MPS2: f32 = 5.0;
/// Share of the front axle: below a deceleration of 1 g the front wheels lock first, as UN R13-H asks for.
const FRONT_SHARE: f32 = 0.74;
/// Force of the hand brake, which acts on the rear wheels, N.
const HAND_BRAKE_N: f32 = 7_000.0;

/// Torque of the foot brake on a wheel, N m.
pub fn foot_nm(controls: &Controls, wheel: usize) -> f32 {
    let pedal = controls.brake_fraction();
    let square = pedal * pedal;
    let force_n = MASS_KG * (DAILY_MPS2 * pedal + LAST_MPS2 * square * square);
    let share = if is_front(wheel) { FRONT_SHARE } else { 1.0 - FRONT_SHARE };
    0.5 * share * force_n * WHEEL_RADIUS_M
}

/// Torque of the hand brake on a wheel, N m.
pub fn hand_nm(wheel: usize) -> f32 {
    if is_front(wheel) { 0.0 } else { 0.5 * HAND_BRAKE_N * WHEEL_RADIUS_M }
}
