//! The car against the books, on a plane without lanes. What a test expects is computed in it, from figures of its own.

#![allow(clippy::disallowed_methods, reason = "tests may read the environment")]

mod braking;
mod cornering;
mod driving;
mod forces;
mod plots;
mod standing;
mod state;
#[path = "../common/svg.rs"]
mod svg;

use std::sync::Arc;

use glam::{Quat, Vec3};

use kernel::Controls;
use kernel::car::CarSetup;
use kernel::ego::Ego;
use kernel::map::{MapData, Surface, SurfaceKind};
use kernel::motion::Motion;
use kernel::physics::{Physics, Statics};
use kernel::time::{Tick, seconds};
use kernel::weather::{Water, Weather};

const HELPED: CarSetup = CarSetup { abs: true, esc: true };
const BARE: CarSetup = CarSetup { abs: false, esc: false };

/// One kind of ground of each grip, and the one that the slabs of a square are made of; tracks and water have that of others.
const GROUNDS: [SurfaceKind; 7] = {
    use SurfaceKind as K;
    [K::Road, K::RoadLine, K::Sidewalk, K::Terrain, K::Ground, K::Gravel, K::Setts]
};

/// A square of 4 km of one kind of ground, rising eastwards; paint lies on asphalt.
fn plain(kind: SurfaceKind, grade: f32) -> MapData {
    let corner = |x: f32, y: f32| Vec3::new(x, y, grade * x) * 2000.0;
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let square = |kind, lift: f32| Surface {
        kind,
        positions: corners.iter().map(|corner| corner + Vec3::Z * lift).collect(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let painted = kind == SurfaceKind::RoadLine;
    let ground = square(if painted { SurfaceKind::Road } else { kind }, 0.0);
    MapData {
        name: String::from("plain"),
        surfaces: if painted { vec![ground, square(kind, 0.016)] } else { vec![ground] },
        bounds: [corner(-1.0, -1.0), corner(1.0, 1.0)],
        ..MapData::default()
    }
}

struct Drive {
    ego: Ego,
    physics: Physics,
    setup: CarSetup,
    water: Water,
}

impl Drive {
    /// Eastwards at a speed on flat ground.
    fn over(kind: SurfaceKind, speed_mps: f32, setup: CarSetup) -> Self {
        Self::posed(plain(kind, 0.0), Quat::IDENTITY, speed_mps, setup)
    }

    /// Eastwards at a speed on flat asphalt, for a second already.
    fn at(speed_mps: f32) -> Self {
        let mut drive = Self::over(SurfaceKind::Road, speed_mps, HELPED);
        drive.hold(seconds(1), |car| if speed_mps > 0.0 { cruise(car, speed_mps, 0.0) } else { Controls::default() });
        drive
    }

    fn posed(map: MapData, rotation: Quat, speed_mps: f32, setup: CarSetup) -> Self {
        let velocity_mps = rotation * Vec3::X * speed_mps;
        let motion = Motion { position: Vec3::ZERO, rotation, velocity_mps, spin_radps: Vec3::ZERO };
        let physics = Physics::new(&Arc::new(Statics::new(&map)), &motion);
        Self { physics, ego: Ego::new(motion), setup, water: Water::default() }
    }

    fn step(&mut self, controls: &Controls) {
        self.physics.drive(&mut self.ego, controls, &self.setup, &self.water);
        self.physics.step(&mut self.ego);
    }

    fn hold(&mut self, ticks: Tick, driver: impl Fn(&Ego) -> Controls) {
        for _ in 0..ticks {
            let controls = driver(&self.ego);
            self.step(&controls);
        }
    }

    fn upright(&self) -> f32 {
        (self.ego.motion.rotation * Vec3::Z).z
    }

    fn yaw_radps(&self) -> f32 {
        self.ego.motion.spin_radps.z
    }
}

/// How many cases of a property are tried: `PROPTEST_CASES` of them, if it is set.
fn cases(usual: u32) -> u32 {
    std::env::var("PROPTEST_CASES").map_or(usual, |cases| cases.parse().expect("PROPTEST_CASES is a number"))
}

/// Keeps a speed.
fn cruise(car: &Ego, speed_mps: f32, steer: f32) -> Controls {
    Controls::from_fractions(steer, (speed_mps - car.speed_mps()) * 0.5 + 0.1, 0.0)
}

fn pedals(throttle: f32, brake: f32) -> Controls {
    Controls::from_fractions(0.0, throttle, brake)
}

/// The figures of the car, once more and in f64: mass, kg; wheelbase, track, height of the centre of mass, metres;
/// gravity; share of the weight on the front wheels.
const MASS: f64 = 1400.0;
const BASE: f64 = 2.7;
const TRACK: f64 = 1.55;
const HEIGHT: f64 = 0.52;
const G: f64 = 9.81;
const FRONT: f64 = 1.5 / 2.7;

/// Greatest force of a tyre under a load, N, by the friction of the ground.
fn most_n(friction: f64, load_n: f64) -> f64 {
    friction * load_n / (1.0 + 0.1 * (load_n / (MASS * G / 4.0) - 1.0))
}

/// Peak and sliding friction.
fn friction(kind: SurfaceKind) -> [f64; 2] {
    match kind {
        SurfaceKind::Road => [1.0, 0.8],
        SurfaceKind::RoadLine => [0.9, 0.7],
        SurfaceKind::Sidewalk => [0.9, 0.75],
        SurfaceKind::Ground | SurfaceKind::Setts | SurfaceKind::Track | SurfaceKind::Rail => [0.7, 0.58],
        SurfaceKind::Terrain | SurfaceKind::Water => [0.45, 0.38],
        SurfaceKind::Gravel => [0.6, 0.55],
    }
}

/// The same wet through, at a walking pace.
fn wet_friction(kind: SurfaceKind) -> [f64; 2] {
    match kind {
        SurfaceKind::Road => [0.75, 0.55],
        SurfaceKind::RoadLine => [0.5, 0.4],
        SurfaceKind::Sidewalk => [0.7, 0.58],
        SurfaceKind::Ground | SurfaceKind::Setts | SurfaceKind::Track | SurfaceKind::Rail => [0.45, 0.37],
        SurfaceKind::Terrain | SurfaceKind::Water => [0.28, 0.22],
        SurfaceKind::Gravel => [0.55, 0.5],
    }
}
