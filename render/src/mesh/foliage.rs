//! Leaves seen near: pictures of clusters on squares that stand all ways on the surface of a crown.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};
use kernel::ops;

use super::shape::Lump;
use super::variety::Variety;
use super::{Finish, Mesh, Paint};

/// Whose leaves a picture shows; its layer among the textures of leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leaf {
    /// A cluster of those of oaks, limes and maples.
    Broad = 0,
    /// A cluster of those of birches, poplars and bushes.
    Small = 1,
    /// A twig of a spruce, along u.
    Needle = 2,
    /// The face of a clipped hedge; it repeats.
    Clipped = 3,
}

impl Leaf {
    /// All, in the order of their layers.
    pub const ALL: [Self; 4] = [Self::Broad, Self::Small, Self::Needle, Self::Clipped];

    /// Paint of a colour that lets `through` 255ths of the light behind it through.
    pub const fn paint(self, paint: Paint, through: u8) -> Paint {
        Paint { finish: Finish::Leafy, code: self as u8, param: through, ..paint }
    }
}

/// Corners of a square around its middle.
const CORNERS: [Vec2; 4] = [Vec2::new(-0.5, -0.5), Vec2::new(0.5, -0.5), Vec2::new(0.5, 0.5), Vec2::new(-0.5, 0.5)];

impl Mesh {
    /// A quadrilateral that is seen from both sides and lit as its `normals` say, with given coordinates on its picture.
    pub fn leaf_quad(&mut self, paint: Paint, corners: [Vec3; 4], normals: [Vec3; 4], uv: [Vec2; 4]) {
        let ids: [u32; 4] = core::array::from_fn(|i| self.vertex(paint, corners[i], normals[i], uv[i]));
        let [a, b, c, d] = ids;
        for corners in [[a, b, c], [a, c, d], [a, c, b], [a, d, c]] {
            self.triangle(paint.finish, corners);
        }
    }

    /// A square of a cluster around `centre` spanned by two unit vectors, lit as part of a round crown around `heart`.
    pub fn leaf_card(&mut self, paint: Paint, centre: Vec3, [u, v]: [Vec3; 2], side_m: f32, heart: Vec3) {
        let corners = CORNERS.map(|c| centre + side_m * (c.x * u + c.y * v));
        let normals = corners.map(|corner| (corner - heart).normalize_or(Vec3::Z));
        self.leaf_quad(paint, corners, normals, CORNERS.map(|c| c + 0.5));
    }

    /// Clusters `side_m` wide all over a lump but where it is inside of others, which shade one another towards `heart`.
    pub fn leafy_lump(&mut self, paint: Paint, lump: &Lump, others: &[Lump], side_m: f32, variety: &mut Variety) {
        let r = lump.radii;
        let area = 4.2 * (r.x * r.y + r.y * r.z + r.z * r.x);
        let count = (1.7 * area / (side_m * side_m)).round().clamp(6.0, 70.0) as u32;
        for k in 0..count {
            let out = on_sphere(k, count, variety);
            let centre = lump.centre + 0.9 * out * r;
            let (u, v) = standing(out, variety);
            let light = variety.between(0.86, 1.12) * (0.86 + 0.2 * out.z);
            if !others.iter().any(|other| other.holds(centre, 0.72)) {
                self.leaf_card(paint.shaded(light), centre, [u, v], side_m * variety.between(0.85, 1.2), lump.centre);
            }
        }
    }
}

impl Lump {
    /// Whether a point is inside of it, when it is so many times as large.
    fn holds(&self, point: Vec3, factor: f32) -> bool {
        ((point - self.centre) / (factor * self.radii)).length_squared() < 1.0
    }
}

/// One of many directions spread over a sphere (a Fibonacci lattice), shaken.
fn on_sphere(k: u32, count: u32, variety: &mut Variety) -> Vec3 {
    const GOLDEN_RAD: f32 = 2.399_963_2;
    let z = 1.0 - (2.0 * k as f32 + 1.0) / count as f32;
    let (flat, turn) = (ops::sqrt(1.0 - z * z), GOLDEN_RAD * k as f32 + variety.between(-0.4, 0.4));
    Vec3::new(flat * ops::cos(turn), flat * ops::sin(turn), z)
}

/// Two unit vectors that span a square which looks more or less outwards.
fn standing(out: Vec3, variety: &mut Variety) -> (Vec3, Vec3) {
    let any = Vec3::new(variety.between(-1.0, 1.0), variety.between(-1.0, 1.0), variety.between(-1.0, 1.0));
    let facing = (out + 0.9 * any).normalize_or(Vec3::X);
    let u = facing.cross(if facing.z.abs() > 0.9 { Vec3::X } else { Vec3::Z }).normalize_or(Vec3::Y);
    let (turn, v) = (variety.between(0.0, TAU), facing.cross(u));
    let (sin, cos) = (ops::sin(turn), ops::cos(turn));
    (cos * u + sin * v, cos * v - sin * u)
}
