//! How wind moves branches, as a plain function, so that others can compute it on their own.

use glam::Vec2;
use kernel::ops;
use kernel::scene::Weather;
use kernel::time::{TICK_S, Tick};

/// Displacement of a vertex of full [`crate::mesh::Vertex::sway`] in a storm (wind of 100 %), metres.
pub const REACH_M: f32 = 0.5;

/// How fast gusts swing a branch, radians a second.
pub const SWING_RADPS: f32 = 2.2;

/// Gusts travel across the land: radians per metre along x and y.
pub const WAVE: Vec2 = Vec2::new(0.11, 0.07);

/// Mean bend and amplitude of the swing, as shares of [`REACH_M`].
pub const BEND: Vec2 = Vec2::new(0.35, 0.65);

/// Wind blows towards this direction, a unit vector.
pub const DIRECTION: Vec2 = Vec2::new(0.8, 0.6);

/// Horizontal displacement of a vertex of full sway whose place at rest is `at` (x and y), metres:
/// `DIRECTION * REACH_M * wind * (BEND.x + BEND.y * sin(SWING_RADPS * t + WAVE . at))`.
pub fn offset(weather: &Weather, tick: Tick, at: Vec2) -> Vec2 {
    Gusts::new(weather, tick).offset(at)
}

/// The wind at a tick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Gusts {
    phase_rad: f32,
    strength_m: f32,
}

impl Gusts {
    pub(crate) fn new(weather: &Weather, tick: Tick) -> Self {
        Self { phase_rad: phase_rad(tick), strength_m: strength_m(weather) }
    }

    /// As [`offset`].
    pub(crate) fn offset(&self, at: Vec2) -> Vec2 {
        let swing = ops::sin(self.phase_rad + WAVE.dot(at));
        DIRECTION * (self.strength_m * (BEND.x + BEND.y * swing))
    }
}

/// Phase of the gusts at a tick, radians, wrapped so that it stays exact over hours.
pub fn phase_rad(tick: Tick) -> f32 {
    let full = f64::from(SWING_RADPS) * f64::from(TICK_S) * tick as f64;
    (full % core::f64::consts::TAU) as f32
}

/// [`REACH_M`] times the wind's share of a storm, metres.
pub fn strength_m(weather: &Weather) -> f32 {
    REACH_M * 0.01 * weather.wind_pct
}
