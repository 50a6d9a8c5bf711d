//! Boxes on the road, seen from above: how near one is to a place or to another.

use glam::Vec2;

use crate::geometry::rectangles_overlap;

use super::hazard::Hazard;

/// Boxes at heights farther apart than this are on different roads, metres.
const LEVEL_M: f32 = 2.0;

impl Hazard {
    /// How a vector lies to the box: ahead and to the left.
    pub fn turned(&self, vector: Vec2) -> Vec2 {
        Vec2::new(vector.dot(self.forward), self.forward.perp_dot(vector))
    }

    /// From a place to the nearest of the box; nothing from inside of it.
    pub fn nearest_from(&self, place: Vec2) -> Vec2 {
        let local = self.turned(self.position.truncate() - place);
        let to = local - local.clamp(-self.half, self.half);
        self.forward * to.x + self.forward.perp() * to.y
    }

    /// The same from that of some places that is nearest to it.
    pub fn nearest_from_any(&self, places: impl Iterator<Item = Vec2>) -> Vec2 {
        let ways = places.map(|place| self.nearest_from(place));
        ways.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared())).unwrap_or_default()
    }

    /// Whether it is on the same road as something at that height, metres, not on a bridge over it.
    pub fn is_level_with(&self, z: f32) -> bool {
        (self.position.z - z).abs() < LEVEL_M
    }

    /// Whether another is nearer to it than `room_m`.
    pub fn is_within(&self, other: &Self, room_m: f32) -> bool {
        let way = self.turned((other.position - self.position).truncate());
        self.is_level_with(other.position.z)
            && rectangles_overlap(self.half + room_m, way, self.turned(other.forward), other.half)
    }
}
