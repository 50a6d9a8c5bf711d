//! Measures and masses of the ego car: a mid-size front-wheel drive passenger car.
//!
//! The origin of its axes lies below the middle of the rear axle, on the ground when the car stands.

use glam::Vec3;

/// Mass with driver, kg.
pub const MASS_KG: f32 = 1400.0;
/// Distance between the axles, metres.
pub const WHEELBASE_M: f32 = 2.7;
/// Distance between the wheels of an axle, metres.
pub const TRACK_M: f32 = 1.55;
/// Distance from the rear axle to the rear bumper, metres.
pub const REAR_OVERHANG_M: f32 = 0.9;
/// Distance from the rear axle to the front bumper, metres.
pub const FRONT_M: f32 = 3.6;
/// Room between the ground and the body, metres.
const CLEARANCE_M: f32 = 0.25;
const HEIGHT_M: f32 = 1.5;
/// Extent of the body, metres.
pub const SIZE_M: Vec3 = Vec3::new(FRONT_M + REAR_OVERHANG_M, 1.8, HEIGHT_M - CLEARANCE_M);
/// Middle of the body, metres.
pub const CENTRE_M: Vec3 = Vec3::new((FRONT_M - REAR_OVERHANG_M) / 2.0, 0.0, (HEIGHT_M + CLEARANCE_M) / 2.0);
/// Centre of mass, metres: 56 % of the weight on the front wheels.
pub const CENTRE_OF_MASS_M: Vec3 = Vec3::new(1.5, 0.0, 0.52);
/// Moments of inertia about roll, pitch and yaw axis, kg m^2.
pub const INERTIA: Vec3 = Vec3::new(550.0, 2300.0, 2500.0);
/// Standard acceleration of free fall, m/s^2.
pub const GRAVITY_MPS2: f32 = 9.81;

/// Radius of a wheel, metres.
pub const WHEEL_RADIUS_M: f32 = 0.32;
/// Moment of inertia of a wheel with what turns with it, kg m^2.
pub const WHEEL_INERTIA: f32 = 1.2;
/// Greatest mean angle of the front wheels, radians.
pub const MAX_WHEEL_ANGLE_RAD: f32 = 35.0 * core::f32::consts::PI / 180.0;

/// The wheels: front left, front right, rear left, rear right.
pub const WHEELS: usize = 4;

/// Whether a wheel is one of the front axle.
pub const fn is_front(wheel: usize) -> bool {
    wheel < 2
}

/// Where a wheel is, metres along the car's x and y axis.
pub const fn place_m(wheel: usize) -> [f32; 2] {
    let side = if wheel.is_multiple_of(2) { 0.5 } else { -0.5 };
    [if is_front(wheel) { WHEELBASE_M } else { 0.0 }, side * TRACK_M]
}

/// Load of a wheel when the car stands on flat ground, N.
pub const fn standing_load_n(wheel: usize) -> f32 {
    let front = CENTRE_OF_MASS_M.x / WHEELBASE_M;
    0.5 * MASS_KG * GRAVITY_MPS2 * if is_front(wheel) { front } else { 1.0 - front }
}
