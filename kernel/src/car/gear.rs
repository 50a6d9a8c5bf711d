//! A tick of the car: what drivers' hands and feet do to its wheels, and its wheels to the body.

use glam::{Vec2, Vec3};

use super::assist::{self, CarSetup};
use super::body::Body;
use super::dimensions::{CENTRE_OF_MASS_M, WHEEL_RADIUS_M, WHEELS, is_front, place_m};
use super::surface::{Footing, Grip};
use super::suspension::{self, REST_M};
use super::tyre::Tyre;
use super::wheel::{Torque, Wheel};
use super::{brakes, powertrain, steering};
use crate::controls::Controls;
use crate::motion::Motion;
use crate::state;
use crate::time::TICK_S;

/// Steps within a tick.
const STEPS: usize = 4;
const STEP_S: f32 = TICK_S / STEPS as f32;
/// The ground is looked for so much farther than the wheels reach, as the body may fall within a tick, metres.
const BEYOND_M: f32 = 0.1;
/// Distance of the steering axis from the middle of the patch, metres.
const MECHANICAL_TRAIL_M: f32 = 0.015;

state! {
    /// All of the car but its body.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct RunningGear {
        /// Mean angle of the front wheels, radians, positive to the right.
        pub wheel_angle_rad: f32,
        /// Front left, front right, rear left, rear right.
        pub wheels: [Wheel; WHEELS],
        /// The parking brake holds until the accelerator is pressed for the first time.
        pub parked: bool,
        /// The yaw rate that stability control takes for what the driver means, rad/s counter-clockwise.
        pub meant_yaw_radps: f32,
        /// Torque of the road on the front wheels about their steering axes, N m, positive to the right: what a
        /// driver feels.
        pub aligning_torque_nm: f32,
    }
}

/// What a wheel and the ground do to each other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// Load, N.
    pub load_n: f32,
    /// Force on the car along and across the wheel, N, positive forwards and to the left.
    pub force_n: Vec2,
    /// Greatest force that this load allows here, N.
    pub limit_n: f32,
}

/// Where the springs are fixed to the body, metres.
pub fn mounts() -> [Vec3; WHEELS] {
    std::array::from_fn(|wheel| {
        let [x, y] = place_m(wheel);
        Vec3::new(x, y, suspension::mount_height_m(wheel))
    })
}

/// How far below its mount the ground matters to a wheel, metres.
pub const fn reach_m() -> f32 {
    REST_M + WHEEL_RADIUS_M + BEYOND_M
}

/// A wheel's place on the ground for a tick, along the car's axes.
struct Stand {
    /// Mount, metres from the centre of mass.
    mount_m: Vec3,
    distance_m: f32,
    normal: Vec3,
    forward: Vec3,
    left: Vec3,
    grip: Grip,
}

impl Stand {
    fn new(wheel: usize, mount_m: Vec3, angle_rad: f32, footing: &Footing, speed_mps: f32) -> Self {
        let (normal, ahead) = (footing.normal, steering::direction(wheel, angle_rad));
        let forward = (ahead - normal * normal.dot(ahead)).normalize_or(ahead);
        Self {
            mount_m: mount_m - CENTRE_OF_MASS_M,
            distance_m: footing.distance_m,
            normal,
            forward,
            left: normal.cross(forward),
            grip: footing.grip(speed_mps),
        }
    }

    /// The touched ground, metres from the centre of mass.
    fn arm_m(&self) -> Vec3 {
        self.mount_m - Vec3::Z * self.distance_m
    }
}

/// What pedals and helpers ask of the wheels in a tick.
struct Asked {
    drive_nm: f32,
    brake_nm: [f32; WHEELS],
    /// Wheels that anti-lock brakes watch.
    abs: [bool; WHEELS],
    traction: bool,
}

impl RunningGear {
    /// That of a car at a speed, m/s, with its parking brake on where it stands.
    pub fn rolling(speed_mps: f32) -> Self {
        Self {
            wheel_angle_rad: 0.0,
            wheels: [Wheel::rolling(speed_mps); WHEELS],
            parked: speed_mps == 0.0,
            meant_yaw_radps: 0.0,
            aligning_torque_nm: 0.0,
        }
    }

    /// Advances by a tick on the ground below each wheel. Gives the velocities that the body has at its end, linear and
    /// angular, and the footprints then.
    pub fn advance(
        &mut self,
        motion: &Motion,
        controls: &Controls,
        setup: &CarSetup,
        ground: &[Option<Footing>; WHEELS],
    ) -> (Vec3, Vec3, [Footprint; WHEELS]) {
        let mut body = Body::new(motion);
        let speed_mps = body.velocity_mps.x;
        self.wheel_angle_rad = steering::turned_rad(self.wheel_angle_rad, controls.steer_fraction(), speed_mps);
        self.parked &= controls.throttle == 0;
        let asked = self.ask(controls, setup, &body, ground);
        let over_ground_mps = body.velocity_mps.length();

        let (mounts, angle_rad) = (mounts(), self.wheel_angle_rad);
        let mut stands: [Option<Stand>; WHEELS] = std::array::from_fn(|wheel| {
            ground[wheel].as_ref().map(|footing| Stand::new(wheel, mounts[wheel], angle_rad, footing, over_ground_mps))
        });
        let mut footprints = [Footprint::default(); WHEELS];
        for _ in 0..STEPS {
            self.step(&mut body, &mut stands, &asked, &mut footprints);
        }
        let (velocity, spin) = body.velocities(TICK_S);
        (velocity, spin, footprints)
    }

    fn ask(&mut self, controls: &Controls, setup: &CarSetup, body: &Body, ground: &[Option<Footing>; WHEELS]) -> Asked {
        let (speed_mps, yaw_radps) = (body.velocity_mps.x, body.spin_radps.z);
        let hand = controls.has(Controls::HAND_BRAKE);
        let spin_radps = 0.5 * (self.wheels[0].spin_radps + self.wheels[1].spin_radps);
        let braking = controls.brake > 0 || hand;
        let mut asked = Asked {
            drive_nm: powertrain::torque_nm(controls, braking, spin_radps),
            brake_nm: std::array::from_fn(|wheel| {
                let held = if hand || self.parked { brakes::hand_nm(wheel) } else { 0.0 };
                brakes::foot_nm(controls, wheel) + held
            }),
            abs: std::array::from_fn(|wheel| setup.abs && (is_front(wheel) || !(hand || self.parked))),
            traction: setup.esc,
        };
        let friction = ground.iter().flatten().map(|footing| footing.grip(speed_mps).peak).fold(1.0, f32::min);
        self.meant_yaw_radps =
            assist::meant_yaw_radps(self.meant_yaw_radps, -self.wheel_angle_rad, speed_mps, friction);
        let correction = assist::correction(yaw_radps, self.meant_yaw_radps, speed_mps);
        if let Some((wheel, torque_nm)) = correction.filter(|_| setup.esc && !hand) {
            asked.brake_nm[wheel] += torque_nm;
            asked.abs[wheel] = true;
            asked.drive_nm = asked.drive_nm.min(0.0);
        }
        asked
    }

    fn step(
        &mut self,
        body: &mut Body,
        stands: &mut [Option<Stand>; WHEELS],
        asked: &Asked,
        footprints: &mut [Footprint; WHEELS],
    ) {
        let (mut force_n, mut moment_nm, mut aligning_nm) = (Vec3::ZERO, Vec3::ZERO, 0.0);
        let travels = self.wheels.map(|wheel| wheel.travel_m);
        for (wheel, stand) in stands.iter_mut().enumerate() {
            let turning = &mut self.wheels[wheel];
            let sinking = stand.as_mut().map(|stand| {
                stand.distance_m += STEP_S * stand.normal.dot(body.velocity_at(stand.mount_m)) / stand.normal.z;
                stand.distance_m
            });
            let (travel_m, load_n) = suspension::settle(wheel, travels[wheel], travels[wheel ^ 1], sinking, STEP_S);
            turning.travel_m = travel_m;
            let mut torque = Torque {
                drive_nm: if is_front(wheel) { asked.drive_nm } else { 0.0 },
                brake_nm: asked.brake_nm[wheel],
                least_radps: 0.0,
                most_radps: f32::MAX,
            };
            let Some(stand) = stand.as_ref().filter(|_| load_n > 0.0) else {
                turning.turn_freely(&torque, STEP_S);
                footprints[wheel] = Footprint::default();
                continue;
            };
            let (tyre, arm_m) = (Tyre::new(load_n, &stand.grip), stand.arm_m());
            let velocity = body.velocity_at(arm_m);
            let hub_mps = Vec2::new(stand.forward.dot(velocity), stand.left.dot(velocity));
            torque.brake_nm += stand.grip.rolling * load_n * WHEEL_RADIUS_M;
            if asked.abs[wheel] {
                torque.least_radps = assist::least_radps(&tyre, hub_mps.x);
            }
            if asked.traction {
                torque.most_radps = assist::most_radps(&tyre, hub_mps.x);
            }
            let (held_n, slips) = turning.turn(&tyre, hub_mps, &torque, STEP_S);
            let push_n = stand.forward * held_n.x + stand.left * held_n.y + stand.normal * load_n;
            force_n += push_n;
            moment_nm += arm_m.cross(push_n);
            if is_front(wheel) {
                aligning_nm += held_n.y * (tyre.trail_m(slips) + MECHANICAL_TRAIL_M);
            }
            footprints[wheel] = Footprint { load_n, force_n: held_n, limit_n: tyre.limit_n };
        }
        self.aligning_torque_nm = aligning_nm;
        body.push(force_n, moment_nm, STEP_S);
    }
}
