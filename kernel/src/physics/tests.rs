//! How the car drives on a flat square of asphalt.

use std::sync::Arc;

use glam::{Quat, Vec3};

use super::{Physics, Statics};
use crate::controls::Controls;
use crate::ego::Ego;
use crate::map_data::{MapData, Surface, SurfaceKind};
use crate::motion::Motion;
use crate::time::{TICK_S, Tick, seconds};

/// A flat square of asphalt of 2 km, without lanes.
fn plain() -> MapData {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0) * 1000.0;
    let positions = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let road = Surface { kind: SurfaceKind::Road, positions, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    MapData {
        name: String::from("plain"),
        surfaces: vec![road],
        bounds: [corner(-1.0, -1.0), corner(1.0, 1.0)],
        ..MapData::default()
    }
}

struct Drive {
    ego: Ego,
    physics: Physics,
}

impl Drive {
    fn at(speed_mps: f32) -> Self {
        let velocity_mps = Vec3::X * speed_mps;
        let motion = Motion { position: Vec3::ZERO, rotation: Quat::IDENTITY, velocity_mps, spin_radps: Vec3::ZERO };
        let ego = Ego { motion, wheel_angle_rad: 0.0, odometer_um: 0 };
        let mut drive = Self { physics: Physics::new(&Arc::new(Statics::new(&plain())), &motion), ego };
        drive.hold(seconds(1), |car| cruise(car, speed_mps, 0.0));
        drive
    }

    fn hold(&mut self, ticks: Tick, driver: impl Fn(&Ego) -> Controls) {
        for _ in 0..ticks {
            let forces = self.ego.actuate(&driver(&self.ego));
            self.physics.step(&forces);
            self.ego.moved(self.physics.ego());
        }
    }

    fn upright(&self) -> f32 {
        (self.ego.motion.rotation * Vec3::Z).z
    }
}

fn cruise(car: &Ego, speed_mps: f32, steer: f32) -> Controls {
    Controls::from_fractions(steer, (speed_mps - car.speed_mps()) * 0.5, 0.0)
}

#[test]
fn it_stands_still_on_flat_ground() {
    let mut drive = Drive::at(0.0);
    drive.hold(seconds(10), |_| Controls::default());
    let at = drive.ego.motion.position;
    assert!(at.length() < 0.02, "{at}");
    assert!(drive.upright() > 0.9999);
    assert!(drive.ego.odometer_um < 50_000);
}

#[test]
fn it_drives_straight_ahead() {
    let mut drive = Drive::at(0.0);
    drive.hold(seconds(20), |_| Controls::from_fractions(0.0, 0.7, 0.0));
    let ego = &drive.ego;
    assert!(ego.motion.position.x > 200.0, "{}", ego.motion.position);
    assert!(ego.motion.position.y.abs() < 0.1, "{}", ego.motion.position);
    assert!(ego.motion.position.z.abs() < 0.05, "{}", ego.motion.position);
}

#[test]
fn it_reaches_50_kmh_like_a_car() {
    let mut drive = Drive::at(0.0);
    drive.hold(seconds(4), |_| Controls::from_fractions(0.0, 1.0, 0.0));
    let kmh = drive.ego.speed_mps() * 3.6;
    assert!((45.0..65.0).contains(&kmh), "{kmh} km/h after 4 s");
}

#[test]
fn it_brakes_from_50_kmh_within_10_to_13_m() {
    let mut drive = Drive::at(50.0 / 3.6);
    let start = drive.ego.motion.position.x;
    let speed = drive.ego.speed_mps();
    drive.hold(seconds(4), |_| Controls::from_fractions(0.0, 0.0, 1.0));
    let way = drive.ego.motion.position.x - start;
    assert!((speed - 50.0 / 3.6).abs() < 0.3, "{speed}");
    assert!((10.0..13.0).contains(&way), "{way} m");
    assert!(drive.ego.speed_mps().abs() < 0.01);
}

#[test]
fn steering_to_the_right_turns_right_at_half_a_g_without_rolling() {
    for (speed_mps, steer) in [(10.0, 0.22), (14.0, 0.12)] {
        let mut drive = Drive::at(speed_mps);
        drive.hold(seconds(1), |car| cruise(car, speed_mps, steer));
        let before = drive.ego.motion.velocity_mps;
        drive.hold(6, |car| cruise(car, speed_mps, steer));
        let g = (drive.ego.motion.velocity_mps - before).length() / (6.0 * TICK_S) / 9.81;
        assert!((0.4..0.7).contains(&g), "{g} g at {speed_mps} m/s");
        assert!(drive.ego.heading_rad() < -0.2);
        assert!(drive.upright() > 0.99, "{}", drive.upright());
    }
}

#[test]
fn full_steering_at_speed_slides_but_does_not_roll() {
    let mut drive = Drive::at(20.0);
    drive.hold(seconds(3), |_| Controls::from_fractions(-1.0, 0.3, 0.0));
    assert!(drive.upright() > 0.9, "{}", drive.upright());
}

#[test]
fn reverse_goes_back_and_the_hand_brake_holds() {
    let mut drive = Drive::at(0.0);
    let reverse = Controls { flags: Controls::REVERSE, ..Controls::from_fractions(0.0, 0.5, 0.0) };
    drive.hold(seconds(3), |_| reverse);
    assert!(drive.ego.speed_mps() < -1.0, "{}", drive.ego.speed_mps());
    drive.hold(seconds(3), |_| Controls { flags: Controls::HAND_BRAKE, ..Default::default() });
    assert!(drive.ego.speed_mps().abs() < 0.01, "{}", drive.ego.speed_mps());
}
