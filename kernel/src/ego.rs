//! The ego car: a mid-size front-wheel drive passenger car.
//!
//! The origin of its axes lies below the middle of the rear axle, on the ground when the car stands.

use glam::Vec3;

use crate::controls::Controls;
use crate::motion::Motion;
use crate::ops;
use crate::state;
use crate::time::TICK_S;

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
/// Centre of mass, metres.
pub const CENTRE_OF_MASS_M: Vec3 = Vec3::new(WHEELBASE_M / 2.0, 0.0, 0.52);
/// Moments of inertia about roll, pitch and yaw axis, kg m^2.
pub const INERTIA: Vec3 = Vec3::new(550.0, 2300.0, 2500.0);

/// Radius of a wheel, metres.
pub const WHEEL_RADIUS_M: f32 = 0.32;
/// Length of the unloaded spring, metres.
pub const SPRING_REST_M: f32 = 0.3;
/// Stiffness of one spring by the car's mass, 1/s^2: the body bounces at 2 Hz.
pub const SPRING_PER_S2: f32 = 40.0;
/// Damping in compression by the car's mass, 1/s.
pub const BUMP_PER_S: f32 = 2.5;
/// Damping in release by the car's mass, 1/s.
pub const REBOUND_PER_S: f32 = 3.2;
/// Travel of the suspension to either side of its rest length, metres.
pub const TRAVEL_M: f32 = 0.15;
/// Greatest force of one spring, N.
pub const MAX_SUSPENSION_N: f32 = 30_000.0;
/// Friction of tyres on dry asphalt.
pub const GRIP: f32 = 1.0;

/// Greatest angle of the front wheels, radians.
pub const MAX_WHEEL_ANGLE_RAD: f32 = 35.0 * core::f32::consts::PI / 180.0;
/// How fast the front wheels turn when the car stands, rad/s.
const STEER_RATE_RADPS: f32 = 1.0;
/// Speed at which they turn half as fast, m/s.
const STEER_RATE_HALF_MPS: f32 = 15.0;

const MAX_POWER_W: f32 = 90_000.0;
const MAX_DRIVE_N: f32 = 5_600.0;
const MAX_REVERSE_N: f32 = 3_000.0;
/// Speed at which the engine gives no more in reverse, m/s.
const MAX_REVERSE_MPS: f32 = 6.0;
/// Above this speed the engine does not push against the motion, m/s.
const GEAR_CHANGE_MPS: f32 = 1.0;
/// Deceleration of the fully pressed brake, m/s^2.
const MAX_BRAKE_MPS2: f32 = 8.4;
const FRONT_BRAKE_SHARE: f32 = 0.62;
/// Deceleration of the hand brake, m/s^2; acts on the rear wheels.
const HAND_BRAKE_MPS2: f32 = 4.0;
/// Rolling resistance and engine drag, N.
const ROLLING_N: f32 = 200.0;
/// Air drag, N s^2/m^2.
const DRAG_N_PER_MPS2: f32 = 0.4;

/// Where the springs are fixed to the body: front left, front right, rear left, rear right.
pub fn wheel_mounts() -> [Vec3; 4] {
    let loaded = SPRING_REST_M - 9.81 / (4.0 * SPRING_PER_S2);
    let at = |x, side: f32| Vec3::new(x, side * TRACK_M / 2.0, WHEEL_RADIUS_M + loaded);
    [at(WHEELBASE_M, 1.0), at(WHEELBASE_M, -1.0), at(0.0, 1.0), at(0.0, -1.0)]
}

state! {
    /// Steering state of the ego car.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Ego {
        /// Pose and velocities.
        pub motion: Motion,
        /// Angle of the front wheels, radians, positive to the right.
        pub wheel_angle_rad: f32,
        /// Distance driven so far, micrometres.
        pub odometer_um: u64,
    }
}

/// What acts on the wheels in one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelForces {
    /// Angle of the front wheels, radians, positive to the right.
    pub wheel_angle_rad: f32,
    /// Force of the engine on both front wheels together, N; negative backwards.
    pub drive_n: f32,
    /// Greatest braking force of both front wheels together, N.
    pub front_brake_n: f32,
    /// Greatest braking force of both rear wheels together, N.
    pub rear_brake_n: f32,
}

impl Ego {
    /// Direction of the car's x axis.
    pub fn forward(&self) -> Vec3 {
        self.motion.rotation * Vec3::X
    }

    /// Direction of the car's x axis seen from above, radians counter-clockwise from east.
    pub fn heading_rad(&self) -> f32 {
        let forward = self.forward();
        ops::atan2(forward.y, forward.x)
    }

    /// Speed along the car's x axis, m/s; negative in reverse.
    pub fn speed_mps(&self) -> f32 {
        self.motion.velocity_mps.dot(self.forward())
    }

    /// Middle of the car's footprint, metres.
    pub fn middle(&self) -> Vec3 {
        self.motion.position + self.motion.rotation * Vec3::new(CENTRE_M.x, 0.0, 0.0)
    }

    /// Turns the front wheels towards what the controls ask for, and gives the forces of this tick.
    pub fn actuate(&mut self, controls: &Controls) -> WheelForces {
        let speed = self.speed_mps();
        let rate = STEER_RATE_RADPS / (1.0 + speed.abs() / STEER_RATE_HALF_MPS);
        let wanted = controls.steer_fraction() * MAX_WHEEL_ANGLE_RAD;
        let most = rate * TICK_S;
        self.wheel_angle_rad += (wanted - self.wheel_angle_rad).clamp(-most, most);

        let resistance = ROLLING_N + DRAG_N_PER_MPS2 * speed * speed;
        let mut brake = controls.brake_fraction() * MAX_BRAKE_MPS2 * MASS_KG;
        let hand_brake = if controls.has(Controls::HAND_BRAKE) { HAND_BRAKE_MPS2 * MASS_KG } else { 0.0 };
        let mut drive = if brake + hand_brake > 0.0 { 0.0 } else { engine_n(controls, speed) };
        if drive == 0.0 {
            brake += resistance;
        } else {
            drive -= resistance.min(drive.abs()) * drive.signum();
        }
        WheelForces {
            wheel_angle_rad: self.wheel_angle_rad,
            drive_n: drive,
            front_brake_n: brake * FRONT_BRAKE_SHARE,
            rear_brake_n: brake * (1.0 - FRONT_BRAKE_SHARE) + hand_brake,
        }
    }

    /// Takes over what physics made of the car.
    pub fn moved(&mut self, motion: Motion) {
        let way_m = (motion.position - self.motion.position).length();
        self.odometer_um += ops::round(way_m * 1e6) as u64;
        self.motion = motion;
    }
}

fn engine_n(controls: &Controls, speed_mps: f32) -> f32 {
    let throttle = controls.throttle_fraction();
    if controls.has(Controls::REVERSE) {
        let most = if !(-MAX_REVERSE_MPS..=GEAR_CHANGE_MPS).contains(&speed_mps) { 0.0 } else { MAX_REVERSE_N };
        -throttle * most
    } else {
        let most = if speed_mps < -GEAR_CHANGE_MPS { 0.0 } else { MAX_DRIVE_N.min(MAX_POWER_W / speed_mps.max(1.0)) };
        throttle * most
    }
}
