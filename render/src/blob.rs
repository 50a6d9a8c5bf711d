//! Soft shadows of moving things as flat polygons on the ground, for adapters that cannot afford a
//! shadow map a frame.

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Vec2, Vec3};

/// A vertex of a blob.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct BlobVertex {
    pub(crate) position: [f32; 3],
    /// Share of light that is taken away, 0 to 1.
    pub(crate) darkness: f32,
}

/// Width of the soft edge, metres.
const FRINGE_M: f32 = 0.22;
/// Height above the ground, metres; above road markings.
const LIFT_M: f32 = 0.03;
/// Share of light taken away (of bytes, that is after the square root).
const DARKNESS: f32 = 0.42;

/// Appends the triangles of the shadow that a box in a frame throws on the plane it stands on.
pub(crate) fn append(out: &mut Vec<BlobVertex>, frame: &Affine3A, size: Vec3, sun: Vec3) {
    let outline = outline(frame, size, sun);
    let middle: Vec2 = outline.iter().sum::<Vec2>() / outline.len() as f32;
    let at =
        |p: Vec2, darkness: f32| BlobVertex { position: frame.transform_point3(p.extend(LIFT_M)).to_array(), darkness };
    for i in 0..outline.len() {
        let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
        let grow = |p: Vec2| p + (p - middle).normalize_or_zero() * FRINGE_M;
        let (inner, outer) = ([a, b], [grow(a), grow(b)]);
        out.extend([at(middle, DARKNESS), at(inner[0], DARKNESS), at(inner[1], DARKNESS)]);
        out.extend([at(inner[0], DARKNESS), at(outer[0], 0.0), at(outer[1], 0.0)]);
        out.extend([at(inner[0], DARKNESS), at(outer[1], 0.0), at(inner[1], DARKNESS)]);
    }
}

/// The hull of the footprint and of the top's shadow, in the frame's ground plane.
fn outline(frame: &Affine3A, size: Vec3, sun: Vec3) -> Vec<Vec2> {
    let towards = frame.matrix3.transpose() * sun;
    let slope = if towards.z > 0.05 { -towards.truncate() / towards.z.max(0.3) } else { Vec2::ZERO };
    let fall = slope.clamp_length_max(2.5) * (0.85 * size.z);
    let (foot, top) = (0.46 * size.truncate(), 0.36 * size.truncate());
    let mut points = Vec::with_capacity(8);
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let corner = Vec2::new(x, y);
        points.push(foot * corner);
        points.push(top * corner + fall);
    }
    hull(points)
}

/// Convex hull, counter-clockwise (monotone chain of Andrew).
fn hull(mut points: Vec<Vec2>) -> Vec<Vec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut chain = half_hull(points.iter());
    chain.extend(half_hull(points.iter().rev()));
    chain
}

fn half_hull<'a>(points: impl Iterator<Item = &'a Vec2>) -> Vec<Vec2> {
    let mut chain: Vec<Vec2> = Vec::new();
    for &p in points {
        while chain.len() > 1
            && (chain[chain.len() - 1] - chain[chain.len() - 2]).perp_dot(p - chain[chain.len() - 1]) <= 0.0
        {
            chain.pop();
        }
        chain.push(p);
    }
    chain.pop();
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shadow_falls_away_from_the_sun() {
        let outline = outline(&Affine3A::IDENTITY, Vec3::new(4.0, 2.0, 1.5), Vec3::new(0.6, 0.0, 0.8));
        let reach = |f: fn(f32, f32) -> f32| outline.iter().map(|p| p.x).fold(0.0, f);
        assert!(reach(f32::min) < -2.0 && reach(f32::max) < 2.0, "{outline:?}");
    }

    #[test]
    fn the_hull_of_a_square_with_points_inside_is_the_square() {
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0), (0.5, 1.0)];
        assert_eq!(hull(points.map(|(x, y)| Vec2::new(x, y)).to_vec()).len(), 4);
    }
}
