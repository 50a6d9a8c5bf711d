//! What a step of an episode came to, in figures.

use glam::Vec2;
use kernel::events::EventKind;
use kernel::time::{CLIP_STRIDE_TICKS, TICK_S, Tick};
use kernel::{TickOutput, World, ops};

use crate::footprint;

/// Ticks between two looks at how the car moves: 10 a second, however long a step is.
const SAMPLE_TICKS: Tick = CLIP_STRIDE_TICKS;
const SAMPLE_S: f32 = SAMPLE_TICKS as f32 * TICK_S;

/// What happened in a step. Everything adds up: facts of two steps are the sums of theirs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facts {
    /// Way along the route, metres; negative against it.
    pub progress_m: f32,
    /// Changes of the acceleration along the car, without sign: integral of the jerk, m/s^2.
    pub jerk_mps2: f32,
    /// Integral of the acceleration to the side, without sign, m/s.
    pub sideways_mps: f32,
    /// Red lights that were run.
    pub red_lights: u32,
    /// Actors and objects that the car began to touch.
    pub collisions: u32,
    /// Time with a wheel beside the road, seconds.
    pub off_road_s: f32,
    /// Time against the direction of the lane, seconds.
    pub wrong_way_s: f32,
    /// Time more than 3 km/h above the limit, seconds.
    pub speeding_s: f32,
    /// 1 if the safety driver took over, else 0.
    pub takeovers: u32,
}

impl Facts {
    /// Names of what [`Facts::row`] gives, in its order.
    pub const NAMES: [&str; 9] = [
        "progress_m",
        "jerk_mps2",
        "sideways_mps",
        "red_lights",
        "collisions",
        "off_road_s",
        "wrong_way_s",
        "speeding_s",
        "takeovers",
    ];

    /// As numbers.
    pub fn row(&self) -> [f64; Self::NAMES.len()] {
        [
            self.progress_m.into(),
            self.jerk_mps2.into(),
            self.sideways_mps.into(),
            self.red_lights.into(),
            self.collisions.into(),
            self.off_road_s.into(),
            self.wrong_way_s.into(),
            self.speeding_s.into(),
            self.takeovers.into(),
        ]
    }
}

/// What has to be remembered of a drive to tell the facts of its ticks.
#[derive(Clone, Debug)]
pub struct Observer {
    route: [Vec2; 2],
    odometer_mm: u64,
    moved: Moved,
}

/// How the car moved at a sample.
#[derive(Clone, Copy, Debug)]
struct Moved {
    speed_mps: f32,
    heading_rad: f32,
    /// None until two speeds are known.
    acceleration_mps2: Option<f32>,
}

impl Observer {
    /// At the start of a drive.
    pub fn new(world: &World) -> Self {
        let [speed_mps, heading_rad] = motion(world);
        let moved = Moved { speed_mps, heading_rad, acceleration_mps2: None };
        Self { route: route(world), odometer_mm: world.odometer_mm(), moved }
    }

    /// Adds a tick, which led to the world as it is.
    pub fn add(&mut self, world: &World, output: &TickOutput, facts: &mut Facts) {
        facts.progress_m += self.progress_m(world);
        if output.tick.is_multiple_of(SAMPLE_TICKS) {
            self.sample(world, facts);
        }
        for event in &output.events {
            match event.kind {
                EventKind::RedLight => facts.red_lights += 1,
                EventKind::CollisionActor | EventKind::CollisionScenery => facts.collisions += 1,
                _ => {}
            }
        }
        let watch = world.watch_state();
        let time_s = |is: bool| if is { TICK_S } else { 0.0 };
        facts.off_road_s += time_s(watch.off_road);
        facts.wrong_way_s += time_s(watch.wrong_way);
        facts.speeding_s += time_s(watch.speeding);
        facts.takeovers += u32::from(output.intervention.is_some());
    }

    /// Where the route is planned anew its middle jumps; nobody comes farther than was driven.
    fn progress_m(&mut self, world: &World) -> f32 {
        let (from, route) = (self.route, route(world));
        let driven_m = (world.odometer_mm() - self.odometer_mm) as f32 / 1000.0;
        (self.route, self.odometer_mm) = (route, world.odometer_mm());
        let along = (from[1] - from[0]).normalize_or_zero();
        // The odometer counts whole millimetres.
        (route[0] - from[0]).dot(along).clamp(-driven_m - 0.001, driven_m + 0.001)
    }

    fn sample(&mut self, world: &World, facts: &mut Facts) {
        let before = self.moved;
        let [speed_mps, heading_rad] = motion(world);
        let acceleration_mps2 = (speed_mps - before.speed_mps) / SAMPLE_S;
        let turned_rad = ops::wrap_angle(heading_rad - before.heading_rad);
        facts.jerk_mps2 += before.acceleration_mps2.map_or(0.0, |earlier| (acceleration_mps2 - earlier).abs());
        facts.sideways_mps += (speed_mps * turned_rad).abs();
        self.moved = Moved { speed_mps, heading_rad, acceleration_mps2: Some(acceleration_mps2) };
    }
}

/// The route's place beside the car, and the one a metre on.
fn route(world: &World) -> [Vec2; 2] {
    let ahead = world.route_ahead(1.0);
    let at = |index: usize| ahead.get(index).or(ahead.last()).map_or(Vec2::ZERO, |point| point.truncate());
    [at(0), at(1)]
}

/// Speed and heading.
fn motion(world: &World) -> [f32; 2] {
    let ego = world.scene().ego;
    let forward = footprint::forward(&ego);
    [world.hud().speed_mps, ops::atan2(forward.y, forward.x)]
}
