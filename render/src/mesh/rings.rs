//! Round bodies of changing width: limbs, trunks, shoes, hats.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};
use kernel::ops;

use super::{Mesh, Paint};

/// A level ellipse that a body's surface runs through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Middle.
    pub centre: Vec3,
    /// Half axes along x and y, metres; zero is a point.
    pub radii: Vec2,
}

impl Ring {
    /// At a height above the axis.
    pub const fn new(z: f32, x: f32, [radius_x, radius_y]: [f32; 2]) -> Self {
        Self { centre: Vec3::new(x, 0.0, z), radii: Vec2::new(radius_x, radius_y) }
    }

    fn is_point(&self) -> bool {
        self.radii == Vec2::ZERO
    }
}

impl Mesh {
    /// A smooth surface through rings from bottom to top, open at both ends unless they are points.
    pub fn loft(&mut self, paint: Paint, rings: &[Ring], sides: u32) {
        let first = self.vertices.len() as u32;
        let directions: Vec<Vec2> = (0..sides)
            .map(|side| TAU * side as f32 / sides as f32)
            .map(|angle| Vec2::new(ops::cos(angle), ops::sin(angle)))
            .collect();
        let at = |ring: &Ring, out: Vec2| ring.centre + (ring.radii * out).extend(0.0);
        for (i, ring) in rings.iter().enumerate() {
            let (below, above) = (&rings[i.saturating_sub(1)], &rings[(i + 1).min(rings.len() - 1)]);
            for &out in &directions {
                // Of a point, that of the ring next to it.
                let radii = if ring.is_point() { below.radii.max(above.radii) } else { ring.radii };
                let around = Vec3::new(-radii.x * out.y, radii.y * out.x, 0.0);
                let normal = around.cross(at(above, out) - at(below, out)).normalize_or(Vec3::Z);
                self.vertex(paint, at(ring, out), normal, Vec2::ZERO);
            }
        }
        for (i, pair) in (0u32..).zip(rings.windows(2)) {
            for side in 0..sides {
                let next = (side + 1) % sides;
                let (a, b) = (first + i * sides + side, first + i * sides + next);
                let (c, d) = (a + sides, b + sides);
                if !pair[0].is_point() {
                    self.triangle(paint.finish, [a, b, d]);
                }
                if !pair[1].is_point() {
                    self.triangle(paint.finish, [a, d, c]);
                }
            }
        }
    }

    /// The flat underside of a ring.
    pub fn sole(&mut self, paint: Paint, ring: &Ring, sides: u32) {
        let rim: Vec<Vec3> = (0..sides)
            .map(|side| -TAU * side as f32 / sides as f32)
            .map(|angle| ring.centre + Vec3::new(ring.radii.x * ops::cos(angle), ring.radii.y * ops::sin(angle), 0.0))
            .collect();
        self.polygon(paint, &rim);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;

    #[test]
    fn surfaces_look_outwards_and_enclose_their_volume() {
        let rings = [Ring::new(0.0, 0.0, [0.0; 2]), Ring::new(0.0, 0.0, [1.0, 2.0]), Ring::new(3.0, 0.0, [0.0; 2])];
        let mut cone = Mesh::default();
        cone.loft(Paint::plain(SemanticTag::Static, [90; 3]), &rings, 48);
        let at = |i: u32| Vec3::from(cone.vertices[i as usize].position);
        let volume: f32 = cone.all_triangles().map(|[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0).sum();
        assert!((volume - core::f32::consts::TAU).abs() < 0.05, "{volume}");
        for t in cone.all_triangles() {
            let flat = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
            let smooth: Vec3 = t.map(|i| Vec3::from(cone.vertices[i as usize].normal.map(f32::from))).iter().sum();
            assert!(flat.dot(smooth) > 0.0);
        }
    }
}
