//! How rain falls, and whether there is weather to draw at all.

use glam::Vec3;
use kernel::scene::Weather;
use kernel::time::{TICK_S, Tick};
use kernel::weather::Water;

use crate::wind;

/// Speed of large drops, m/s (Gunn and Kinzer 1949: 8 m/s at 3.5 mm).
const FALL_MPS: f32 = 8.0;
/// What a storm adds to it along the wind.
const STORM_MPS: f32 = 6.0;
/// Exposure of a picture for its streaks, s.
const EXPOSURE_S: f32 = 0.03;
/// Drops in the box around the eye in a cloudburst.
const DROPS: f32 = 5000.0;
/// Sides of that box, metres, as `rain.wgsl` has them.
pub(crate) const BOX_M: Vec3 = Vec3::new(24.0, 24.0, 12.0);

/// Whether rain, fog or water changes the picture.
pub(crate) fn is_drawn(weather: &Weather) -> bool {
    weather.fog_density_pct > 0.0 || Water::of(weather).wet > 0.0
}

/// Number of drops.
pub(crate) fn drops(weather: &Weather) -> u32 {
    (DROPS * 0.01 * weather.precipitation_pct) as u32
}

fn velocity_mps(weather: &Weather) -> Vec3 {
    (wind::DIRECTION * (STORM_MPS * 0.01 * weather.wind_pct)).extend(-FALL_MPS)
}

/// How far drops have fallen since the start, metres upwards, up to whole boxes. How far the wind takes them aside follows from their
/// height in the box: a snapshot knows the wind of its tick alone, and drops that had always gone with that would leap where it
/// changes.
pub(crate) fn fall_m(tick: Tick) -> f32 {
    let time_s = f64::from(TICK_S) * tick as f64;
    (f64::from(-FALL_MPS) * time_s).rem_euclid(f64::from(BOX_M.z)) as f32
}

/// The way of a drop during the exposure, metres.
pub(crate) fn streak_m(weather: &Weather) -> Vec3 {
    velocity_mps(weather) * EXPOSURE_S
}
