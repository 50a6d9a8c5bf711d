//! Two scripted drivers: everything a run can hold, in one minute.

use kernel::signals::LightPhase;
use kernel::time::{Tick, seconds};
use kernel::{Controls, TickInput, World};

/// When the safety driver takes over.
const TAKEOVER: Tick = seconds(20);

/// Follows the route at a speed, by nothing but what the HUD says.
pub fn follow(world: &World, target_mps: f32) -> Controls {
    beside(world, target_mps, 0.0)
}

/// Keeps the place of the route 12 m ahead at a bearing in degrees, positive to the right. So the
/// car drives on the route at 0, and 3 m to the left of it at 15.
fn beside(world: &World, target_mps: f32, bearing_deg: f32) -> Controls {
    let hud = world.hud();
    let steer = (f32::from(hud.arrow.bearing_deg) - bearing_deg) * 0.013;
    let gap = target_mps - hud.speed_mps;
    let brake = if gap < -0.3 { -gap * 0.2 } else { 0.0 };
    // A car that is to stand is held, as it creeps without a pedal.
    Controls::from_fractions(steer, gap * 0.3, if target_mps > 0.0 { brake } else { brake.max(0.3) })
}

/// Keeps the limit and stops at lights.
pub fn polite(world: &World) -> Controls {
    let hud = world.hud();
    let stop = hud.light.is_some_and(|light| light != LightPhase::Green) && hud.light_distance_m < 30;
    let near = f32::from(hud.light_distance_m) * 0.4 - 1.0;
    follow(world, if stop { near.max(0.0) } else { 0.85 * hud.limit_mps })
}

/// Stops for nothing; backs off now and then from what holds the car.
fn reckless(world: &World, target_mps: f32, bearing_deg: f32) -> Controls {
    let speed_mps = world.hud().speed_mps;
    if speed_mps < 0.5 && world.tick() % seconds(5) < seconds(2) {
        return Controls { flags: Controls::REVERSE, ..Controls::from_fractions(0.2, 0.6, 0.0) };
    }
    if speed_mps < -0.5 {
        return Controls::from_fractions(0.0, 0.0, 0.5);
    }
    beside(world, target_mps, bearing_deg)
}

/// The semantic driver keeps the rules, and the safety driver overrides it once before arming. Then
/// the safety driver takes over and breaks them: drives through lights, too fast, on the wrong side,
/// and beside the road, into whatever comes.
pub fn input(world: &World) -> TickInput {
    let at = world.tick() % seconds(60);
    let driver = match at / seconds(1) {
        0..20 => polite(world),
        20..35 => reckless(world, 17.0, 0.0),
        35..45 => reckless(world, 12.0, 15.0),
        45..57 => reckless(world, 12.0, -25.0),
        _ => Controls { flags: Controls::HAND_BRAKE, ..Controls::default() },
    };
    let brake = Controls::from_fractions(0.0, 0.0, 0.8);
    let mut input = match world.tick() {
        90..110 => TickInput { semantic: driver, safety: brake },
        0..TAKEOVER => TickInput { semantic: driver, safety: Controls::default() },
        TAKEOVER => TickInput { semantic: driver, safety: brake },
        _ => TickInput { semantic: Controls::default(), safety: driver },
    };
    if at.is_multiple_of(400) {
        input.safety.flags |= Controls::SEEN;
    }
    input
}
