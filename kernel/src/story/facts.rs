//! What is measured between those who play.

use glam::Vec2;

use crate::geometry::{direction, rectangles_overlap};

use super::actor::{self, StoryActor};
use super::script::{Along, Measure, Role};

/// Somebody as a box, seen from above.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    pub middle: Vec2,
    pub forward: Vec2,
    pub half: Vec2,
    pub velocity_mps: Vec2,
}

impl Outline {
    /// That of somebody who plays.
    pub fn of(actor: &StoryActor, role: &Role) -> Self {
        Self {
            middle: actor.spot.plan(),
            forward: direction(actor.spot.heading_rad),
            half: actor::size_m(role).truncate() * 0.5,
            velocity_mps: actor.velocity_mps.truncate(),
        }
    }

    /// A place.
    pub fn point(place: Vec2) -> Self {
        Self { middle: place, forward: Vec2::X, half: Vec2::ZERO, velocity_mps: Vec2::ZERO }
    }

    /// Whether two touch.
    pub fn touches(&self, other: &Self) -> bool {
        let seen = |v: Vec2| Vec2::new(self.forward.dot(v), self.forward.perp_dot(v));
        rectangles_overlap(self.half, seen(other.middle - self.middle), seen(other.forward), other.half)
    }

    /// Half of its extent along a unit vector, metres.
    fn half_along(&self, axis: Vec2) -> f32 {
        self.half.x * self.forward.dot(axis).abs() + self.half.y * self.forward.perp_dot(axis).abs()
    }

    fn corners(&self) -> [Vec2; 4] {
        let (along, across) = (self.forward * self.half.x, self.forward.perp() * self.half.y);
        [along + across, along - across, -along - across, -along + across].map(|corner| self.middle + corner)
    }

    /// From the outline to a place, metres; nothing inside.
    fn to_place_m(self, place: Vec2) -> f32 {
        let way = place - self.middle;
        let beyond = Vec2::new(self.forward.dot(way), self.forward.perp_dot(way)).abs() - self.half;
        beyond.max(Vec2::ZERO).length()
    }

    /// From outline to outline, metres: the nearest places of two boxes apart are at a corner of one.
    fn gap_m(&self, other: &Self) -> f32 {
        if self.touches(other) {
            return 0.0;
        }
        let to = |one: &Self, other: &Self| other.corners().map(|corner| one.to_place_m(corner));
        to(self, other).into_iter().chain(to(other, self)).fold(f32::MAX, f32::min)
    }

    /// The distance to another, metres.
    pub fn distance_m(&self, other: &Self, measure: Measure) -> f32 {
        let way = other.middle - self.middle;
        let axis = match measure.along {
            Along::Straight if measure.free => return self.gap_m(other),
            Along::Straight => return way.length(),
            Along::Forward => self.forward,
            Along::Sideways => self.forward.perp(),
        };
        let halves_m = if measure.free { self.half_along(axis) + other.half_along(axis) } else { 0.0 };
        (way.dot(axis).abs() - halves_m).max(0.0)
    }

    /// How fast that becomes less, m/s.
    fn closing_mps(&self, other: &Self, measure: Measure) -> f32 {
        let (way, relative) = (other.middle - self.middle, self.velocity_mps - other.velocity_mps);
        let axis = match measure.along {
            Along::Straight => way.normalize_or_zero(),
            Along::Forward => self.forward * way.dot(self.forward).signum(),
            Along::Sideways => self.forward.perp() * way.dot(self.forward.perp()).signum(),
        };
        relative.dot(axis)
    }

    /// Seconds until it is where another is now; nothing when it stands, or when the other is behind it.
    pub fn headway_s(&self, other: &Self, measure: Measure) -> Option<f32> {
        let speed_mps = self.velocity_mps.length();
        let is_ahead = self.velocity_mps.dot(other.middle - self.middle) >= 0.0;
        (speed_mps > 0.01 && is_ahead).then(|| self.distance_m(other, measure) / speed_mps)
    }

    /// Seconds until it meets another if both go on; nothing when they do not come nearer.
    pub fn time_to_collision_s(&self, other: &Self, measure: Measure) -> Option<f32> {
        let closing_mps = self.closing_mps(other, measure);
        (closing_mps > 0.01).then(|| self.distance_m(other, measure) / closing_mps)
    }
}
