//! Two scripted drivers: everything a run can hold, in one minute.

use kernel::arbiter::Phase;
use kernel::signals::LightPhase;
use kernel::{Controls, TickInput, World};

/// Follows the route at a speed, by nothing but what the HUD says.
pub fn follow(world: &World, target_mps: f32) -> Controls {
    let hud = world.hud();
    let steer = f32::from(hud.arrow.bearing_deg) * 0.013;
    let gap = target_mps - hud.speed_mps;
    Controls::from_fractions(steer, gap * 0.3, if gap < -0.3 { -gap * 0.2 } else { 0.0 })
}

/// Keeps the limit and stops at lights.
pub fn polite(world: &World) -> Controls {
    let hud = world.hud();
    let stop = hud.light.is_some_and(|light| light != LightPhase::Green) && hud.light_distance_m < 30;
    let near = f32::from(hud.light_distance_m) * 0.4 - 1.0;
    follow(world, if stop { near.max(0.0) } else { 0.85 * hud.limit_mps })
}

/// A drive with overrides before and after arming, lights kept and passed, collisions with whatever
/// comes, reversing and a swerve into the scenery.
pub fn input(world: &World) -> TickInput {
    let tick = world.tick();
    let mut driver = match tick % 3600 {
        0..1500 => polite(world),
        1500..2700 => follow(world, 17.0),
        2700..2760 => Controls { flags: Controls::REVERSE, ..Controls::from_fractions(0.2, 0.6, 0.0) },
        2760..3300 => follow(world, 14.0),
        3300..3420 => Controls::from_fractions(0.9, 0.8, 0.0),
        _ => Controls { flags: Controls::HAND_BRAKE, ..Controls::default() },
    };
    let takes_over = (90..110).contains(&tick) || (200..210).contains(&tick);
    let mut safety = Controls::from_fractions(0.0, 0.0, if takes_over { 0.8 } else { 0.0 });
    if tick.is_multiple_of(400) {
        safety.flags |= Controls::SEEN;
    }
    if world.arbiter().intervention.is_some() && !takes_over {
        safety = driver;
        driver = Controls::default();
        if world.arbiter().phase == Phase::Done {
            driver.throttle = 20_000;
        }
    }
    TickInput { semantic: driver, safety }
}
