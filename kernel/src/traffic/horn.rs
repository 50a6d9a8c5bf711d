//! The ego car's horn: for whom it is meant.

use glam::Vec2;

use crate::controls::Controls;
use crate::geometry::direction;

use super::body::Surroundings;

/// The horn is meant for who is so far ahead, metres, and so far to the side.
const HEARD_M: f32 = 30.0;
pub(super) const VEHICLES_ASIDE_M: f32 = 2.5;
/// The same of people beside the road, metres.
pub(super) const PEOPLE_ASIDE_M: f32 = 8.0;

/// Where the ego car sounds its horn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Horn {
    position: Vec2,
    forward: Vec2,
    half_m: f32,
}

impl Horn {
    /// The horn of the ego car, if it sounds.
    pub fn of(around: &Surroundings<'_>) -> Option<Self> {
        let Surroundings { ego, ego_flags, .. } = around;
        let sounds = ego_flags & Controls::HORN != 0;
        let half_m = ego.size_m.x * 0.5;
        sounds.then(|| Self { position: ego.position.truncate(), forward: direction(ego.heading_rad), half_m })
    }

    /// Whether it is meant for somebody at a place, up to so far to the side.
    pub fn is_for(&self, place: Vec2, aside_m: f32) -> bool {
        let to = place - self.position;
        let ahead_m = to.dot(self.forward) - self.half_m;
        (0.0..HEARD_M).contains(&ahead_m) && self.forward.perp_dot(to).abs() < aside_m
    }
}
