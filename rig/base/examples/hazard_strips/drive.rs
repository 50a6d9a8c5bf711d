//! A drive, as scenes ten times a second and what happened between them.

use std::sync::Arc;

use glam::Vec3;
use kernel::events::Event;
use kernel::scene::{ActorScene, SceneSnapshot};
use kernel::signals::LightPhase;
use kernel::time::{TICK_S, Tick, seconds};
use kernel::{Controls, RoadNetwork, Scenario, TickInput, World};

/// Simulated time of a drive, as in the test of the same files.
const DRIVE_TICKS: Tick = seconds(180);
/// Ticks between two scenes.
const STRIDE_TICKS: Tick = 6;
/// How far the ego car looks ahead on its route, metres.
const SEEN_M: f32 = 40.0;
/// From the middle of the rear axle to the front bumper, metres.
const FRONT_M: usize = 4;
/// Who is closer to the middle of the route than this is in the way, metres.
const BESIDE_M: f32 = 1.1;
/// Scenes a second.
pub const SCENE_HZ: f32 = 10.0;

/// What was to be seen, and what happened: events with the number of the scene after them.
pub struct Film {
    pub scenes: Vec<SceneSnapshot>,
    pub events: Vec<(usize, Event)>,
}

impl Film {
    /// Simulated time of a scene, s.
    pub fn time_s(&self, at: usize) -> f32 {
        self.scenes[at].tick as f32 * TICK_S
    }

    /// The scene so many seconds after another.
    pub fn after(&self, at: usize, time_s: f32) -> Option<usize> {
        let index = at as f32 + (time_s * SCENE_HZ).round();
        (index >= 0.0 && (index as usize) < self.scenes.len()).then_some(index as usize)
    }

    /// A road user in a scene.
    pub fn actor(&self, at: usize, id: u32) -> Option<&ActorScene> {
        self.scenes[at].actors.iter().find(|actor| actor.id == id)
    }
}

/// Drives a scenario.
pub fn film(scenario: &Scenario, network: &Arc<RoadNetwork>) -> anyhow::Result<Film> {
    let mut world = World::new(scenario, network)?;
    let mut film = Film { scenes: vec![world.scene()], events: Vec::new() };
    while world.tick() < DRIVE_TICKS {
        let semantic = careful(&world);
        let output = world.step(&TickInput { semantic, ..TickInput::default() });
        film.events.extend(output.events.iter().map(|event| (film.scenes.len(), *event)));
        if world.tick().is_multiple_of(STRIDE_TICKS) {
            film.scenes.push(world.scene());
        }
    }
    Ok(film)
}

/// Follows the route (pure pursuit, Coulter 1992), halts at red, and drives into nobody ahead.
pub fn careful(world: &World) -> Controls {
    let (hud, ego) = (world.hud(), world.scene().ego);
    let route = world.route_ahead(SEEN_M);
    let target = route.iter().rfind(|place| place.distance(ego.position) < 7.0).copied().unwrap_or(ego.position);
    let local = ego.rotation.inverse() * (target - ego.position);
    let halts = hud.light.is_some_and(|light| light != LightPhase::Green) && hud.light_distance_m < 30;
    let line_m = if halts { f32::from(hud.light_distance_m) - 2.0 } else { SEEN_M };
    let room_m = line_m.min(free_m(&route, &world.scene())).max(0.0);
    // As fast as 2.5 m/s^2 can stop.
    let target_mps = (0.85 * hud.limit_mps).min((2.0 * 2.5 * room_m).sqrt());
    let gap_mps = target_mps - hud.speed_mps;
    // A car that is to stand is held, as it creeps without a pedal.
    let least = if target_mps > 0.5 { 0.0 } else { 0.3 };
    let steer = -1.5 * local.y.atan2(local.x.max(1.0));
    Controls::from_fractions(steer, gap_mps * 0.3, (-gap_mps * 0.3).max(least))
}

/// Metres of the route before the ego car on which nobody is.
fn free_m(route: &[Vec3], scene: &SceneSnapshot) -> f32 {
    let taken = |place: Vec3| {
        scene.actors.iter().any(|actor| {
            let local = actor.rotation.inverse() * (place - actor.position);
            let beyond = (local.abs() - 0.5 * actor.kind.size_m()).max(Vec3::ZERO);
            beyond.truncate().length() < BESIDE_M && beyond.z < 2.0
        })
    };
    let first = route.iter().enumerate().skip(FRONT_M).find(|(_, place)| taken(**place));
    first.map_or(SEEN_M, |(at_m, _)| (at_m - FRONT_M) as f32 - 2.0)
}
