//! The shapes that meshes are made of.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};
use kernel::ops;

use super::variety::Variety;
use super::{Mesh, Paint};

/// Metres on a flat surface, from the two axes it spreads along most.
fn flat_uv(p: Vec3, normal: Vec3) -> Vec2 {
    let n = normal.abs();
    if n.z >= n.x.max(n.y) {
        Vec2::new(p.x, p.y)
    } else if n.x > n.y {
        Vec2::new(p.y, p.z)
    } else {
        Vec2::new(p.x, p.z)
    }
}

/// Point on a circle in the plane of `u` and `v`.
fn around(u: Vec3, v: Vec3, angle: f32) -> Vec3 {
    u * ops::cos(angle) + v * ops::sin(angle)
}

/// Two unit vectors that span the plane across `axis`, so that u x v = axis.
fn across(axis: Vec3) -> (Vec3, Vec3) {
    let up = if axis.z.abs() > 0.9 { Vec3::X } else { Vec3::Z };
    let u = up.cross(axis).normalize();
    (u, axis.cross(u))
}

impl Mesh {
    /// A flat convex polygon, corners counter-clockwise seen from outside.
    pub fn polygon(&mut self, paint: Paint, corners: &[Vec3]) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let ids: Vec<u32> = corners.iter().map(|&p| self.vertex(paint, p, normal, flat_uv(p, normal))).collect();
        for i in 2..ids.len() {
            self.triangle(paint.finish, [ids[0], ids[i - 1], ids[i]]);
        }
    }

    /// A flat quadrilateral with given coordinates on its surface.
    pub fn quad_uv(&mut self, paint: Paint, corners: [Vec3; 4], uv: [Vec2; 4]) {
        let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalize_or_zero();
        let ids: [u32; 4] = core::array::from_fn(|i| self.vertex(paint, corners[i], normal, uv[i]));
        self.triangle(paint.finish, [ids[0], ids[1], ids[2]]);
        self.triangle(paint.finish, [ids[0], ids[2], ids[3]]);
    }

    /// The side walls of a prism: `floor` counter-clockwise from above, `roof` above it.
    pub fn walls(&mut self, paint: Paint, floor: &[Vec3], roof: &[Vec3]) {
        for i in 0..floor.len() {
            let j = (i + 1) % floor.len();
            self.polygon(paint, &[floor[i], floor[j], roof[j], roof[i]]);
        }
    }

    /// A solid between two polygons, without its bottom.
    pub fn frustum(&mut self, paint: Paint, floor: &[Vec3], roof: &[Vec3]) {
        self.walls(paint, floor, roof);
        self.polygon(paint, roof);
    }

    /// A box, bottom left out where it lies on the ground or below.
    pub fn cuboid(&mut self, paint: Paint, low: Vec3, high: Vec3) {
        let ring = |z: f32| {
            [
                Vec3::new(low.x, low.y, z),
                Vec3::new(high.x, low.y, z),
                Vec3::new(high.x, high.y, z),
                Vec3::new(low.x, high.y, z),
            ]
        };
        self.frustum(paint, &ring(low.z), &ring(high.z));
        if low.z > 0.01 {
            let [a, b, c, d] = ring(low.z);
            self.polygon(paint, &[d, c, b, a]);
        }
    }

    /// A round bar from `a` to `b` with its end caps left open.
    pub fn tube(&mut self, paint: Paint, a: Vec3, b: Vec3, radius_a: f32, radius_b: f32, sides: u32) {
        let (u, v) = across((b - a).normalize_or(Vec3::Z));
        let first = self.vertices.len() as u32;
        for i in 0..sides {
            let out = around(u, v, TAU * i as f32 / sides as f32);
            self.vertex(paint, a + out * radius_a, out, Vec2::new(i as f32, 0.0));
            self.vertex(paint, b + out * radius_b, out, Vec2::new(i as f32, (b - a).length()));
        }
        for i in 0..sides {
            let (p, q) = (first + 2 * i, first + 2 * ((i + 1) % sides));
            self.triangle(paint.finish, [p, q, q + 1]);
            self.triangle(paint.finish, [p, q + 1, p + 1]);
        }
    }

    /// A flat disc that faces along `normal`.
    pub fn disc(&mut self, paint: Paint, centre: Vec3, normal: Vec3, radius: f32, sides: u32) {
        let (u, v) = across(normal);
        let rim: Vec<Vec3> =
            (0..sides).map(|i| centre + around(u, v, TAU * i as f32 / sides as f32) * radius).collect();
        self.polygon(paint, &rim);
    }

    /// A closed round bar.
    pub fn rod(&mut self, paint: Paint, a: Vec3, b: Vec3, radius: f32, sides: u32) {
        let axis = (b - a).normalize_or(Vec3::Z);
        self.tube(paint, a, b, radius, radius, sides);
        self.disc(paint, b, axis, radius, sides);
        self.disc(paint, a, -axis, radius, sides);
    }

    /// An ellipsoid with smooth normals.
    pub fn ellipsoid(&mut self, paint: Paint, centre: Vec3, radii: Vec3, rings: u32, sides: u32) {
        self.lump(paint, &Lump { centre, radii, rings, sides, rough: 0.0 }, &mut Variety::of(0));
    }

    /// A dented ellipsoid with smooth normals.
    pub fn lump(&mut self, paint: Paint, lump: &Lump, variety: &mut Variety) {
        let first = self.vertices.len() as u32;
        for ring in 0..=lump.rings {
            for side in 0..lump.sides {
                let out = lump.direction(ring, side);
                let pole = ring == 0 || ring == lump.rings;
                let dent = if pole { 1.0 } else { 1.0 + variety.between(-1.0, 1.0) * lump.rough };
                let light = if lump.rough == 0.0 { 1.0 } else { dent * (0.84 + 0.22 * out.z) };
                let position = lump.centre + out * lump.radii * dent;
                let uv = Vec2::new(position.x + position.y, position.z + 0.37 * position.y);
                self.vertex(paint.shaded(light), position, (out / lump.radii).normalize(), uv);
            }
        }
        for [a, b, c] in lump.faces() {
            self.triangle(paint.finish, [first + a, first + b, first + c]);
        }
    }
}

/// An ellipsoid in rings from top to bottom, every other ring turned by half a side.
#[derive(Clone, Copy, Debug)]
pub struct Lump {
    /// Middle.
    pub centre: Vec3,
    /// Half axes, metres.
    pub radii: Vec3,
    /// Rings, 2 or more.
    pub rings: u32,
    /// Corners a ring, 3 or more.
    pub sides: u32,
    /// Share of the radius by which corners move in or out; above 0 the underside is darker, as
    /// foliage is.
    pub rough: f32,
}

impl Lump {
    fn direction(&self, ring: u32, side: u32) -> Vec3 {
        let polar = 0.5 * TAU * ring as f32 / self.rings as f32;
        let azimuth = TAU * (side as f32 + 0.5 * (ring % 2) as f32) / self.sides as f32;
        let (flat, z) = (ops::sin(polar), ops::cos(polar));
        Vec3::new(flat * ops::cos(azimuth), flat * ops::sin(azimuth), z)
    }

    fn faces(&self) -> Vec<[u32; 3]> {
        let mut faces = Vec::new();
        for ring in 0..self.rings {
            for side in 0..self.sides {
                let (a, b) = (ring * self.sides + side, ring * self.sides + (side + 1) % self.sides);
                let (c, d) = (a + self.sides, b + self.sides);
                let [wide_above, wide_below] =
                    if ring % 2 == 0 { [[a, c, b], [b, c, d]] } else { [[a, d, b], [a, c, d]] };
                // At the poles one of the two has no area.
                if ring > 0 {
                    faces.push(wide_above);
                }
                if ring + 1 < self.rings {
                    faces.push(wide_below);
                }
            }
        }
        faces
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;

    /// Volume by the divergence theorem: positive when all faces look outwards, and that of the
    /// shape when it is closed.
    fn volume(mesh: &Mesh) -> f32 {
        let at = |i: u32| Vec3::from_array(mesh.vertices[i as usize].position);
        mesh.all_triangles().map(|[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0).sum()
    }

    const PAINT: Paint = Paint::plain(SemanticTag::Static, [200; 3]);

    #[test]
    fn closed_shapes_have_their_volume() {
        let mut cuboid = Mesh::default();
        cuboid.cuboid(PAINT, Vec3::new(1.0, 1.0, 1.0), Vec3::new(3.0, 4.0, 2.0));
        assert!((volume(&cuboid) - 6.0).abs() < 1e-4);
        let mut rod = Mesh::default();
        rod.rod(PAINT, Vec3::new(1.0, 0.0, 0.0), Vec3::new(1.0, 2.0, 1.0), 0.5, 64);
        assert!((volume(&rod) - 0.785 * 2.236).abs() < 0.02, "{}", volume(&rod));
        let mut ball = Mesh::default();
        ball.ellipsoid(PAINT, Vec3::new(5.0, 1.0, 1.0), Vec3::new(1.0, 1.0, 2.0), 24, 32);
        assert!((volume(&ball) - 8.378).abs() < 0.2, "{}", volume(&ball));
    }
}
