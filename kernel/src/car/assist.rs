//! Helpers that keep the wheels gripping: anti-lock brakes, traction control, electronic stability control.

use super::dimensions::{GRAVITY_MPS2, MASS_KG, WHEEL_RADIUS_M, WHEELBASE_M};
use super::tyre::Tyre;
use crate::state;
use crate::time::TICK_S;

state! {
    /// Which helpers the car has on.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct CarSetup {
        /// Anti-lock brakes.
        pub abs: bool,
        /// Stability and traction control.
        pub esc: bool,
    }
}

impl Default for CarSetup {
    fn default() -> Self {
        Self { abs: true, esc: true }
    }
}

/// Slip at which brakes and engine are held, in slips of greatest force: what the search of a real control comes to.
const HELD_SLIPS: f32 = 0.75;
/// Slower than this anti-lock brakes let the wheels lock, m/s.
const ABS_LEAST_MPS: f32 = 1.5;
/// Sliding that traction control allows at any speed, m/s.
const TRACTION_MPS: f32 = 0.2;

/// The spin below which anti-lock brakes do not brake a wheel whose hub moves at a speed along it, m/s; rad/s.
pub fn least_radps(tyre: &Tyre, hub_mps: f32) -> f32 {
    if hub_mps.abs() < ABS_LEAST_MPS {
        return 0.0;
    }
    hub_mps.abs() / (WHEEL_RADIUS_M * (1.0 + HELD_SLIPS * tyre.peak_slip))
}

/// The spin above which traction control does not drive it, rad/s.
pub fn most_radps(tyre: &Tyre, hub_mps: f32) -> f32 {
    let held = (HELD_SLIPS * tyre.peak_slip).min(0.5);
    (hub_mps.abs() / (1.0 - held)).max(hub_mps.abs() + TRACTION_MPS) / WHEEL_RADIUS_M
}

/// Slower than this stability control does nothing, m/s.
const ESC_LEAST_MPS: f32 = 6.0;
/// The car follows the wheels after about this time, s.
const ESC_LAG_S: f32 = 0.1;
/// Understeer of the car that the driver is thought to mean, rad s^2/m.
const ESC_UNDERSTEER: f32 = 0.001;
/// Share of the friction that the meant turn may ask for.
const ESC_FRICTION_SHARE: f32 = 0.85;
/// Difference of yaw rates that is left alone, rad/s.
const ESC_DEADBAND_RADPS: f32 = 0.08;
/// Torque by difference of yaw rates, N m s/rad, and its limit, N m.
const ESC_NMS_PER_RAD: f32 = 9_000.0;
const ESC_MAX_NM: f32 = 1_500.0;

/// The yaw rate that a driver means, rad/s counter-clockwise: a single-track model with lag, at most what friction
/// allows.
pub fn meant_yaw_radps(before_radps: f32, wheels_left_rad: f32, speed_mps: f32, friction: f32) -> f32 {
    let most = ESC_FRICTION_SHARE * friction * GRAVITY_MPS2 / speed_mps.abs().max(1.0);
    let steady = speed_mps * wheels_left_rad / (WHEELBASE_M + ESC_UNDERSTEER * speed_mps * speed_mps);
    before_radps + (steady.clamp(-most, most) - before_radps) * (TICK_S / (ESC_LAG_S + TICK_S))
}

/// The wheel that stability control brakes and its torque, N m: the outer front wheel of a car that turns too much,
/// the inner rear wheel of one that turns too little.
pub fn correction(yaw_radps: f32, meant_radps: f32, speed_mps: f32) -> Option<(usize, f32)> {
    let error = yaw_radps - meant_radps;
    let beyond = error.abs() - ESC_DEADBAND_RADPS;
    if speed_mps < ESC_LEAST_MPS || beyond <= 0.0 {
        return None;
    }
    // Braking on the right turns to the right.
    let right = usize::from(error > 0.0);
    let too_much = error * yaw_radps > 0.0;
    Some((if too_much { right } else { 2 + right }, (ESC_NMS_PER_RAD * beyond).min(ESC_MAX_NM)))
}

const _: () = assert!(ESC_MAX_NM / WHEEL_RADIUS_M < MASS_KG * GRAVITY_MPS2);
