//! Hedges and bushes.

use glam::{Vec2, Vec3};

use crate::SemanticTag;
use crate::mesh::foliage::Leaf;
use crate::mesh::look::row_of;
use crate::mesh::model::Detail;
use crate::mesh::shape::Lump;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// Colours of what is green in summer.
pub(super) const LEAVES: [[u8; 3]; 6] =
    [[92, 122, 52], [80, 112, 50], [108, 132, 56], [72, 102, 56], [122, 134, 58], [96, 116, 64]];

/// Side of the picture of a hedge's face, metres.
const FACE_M: f32 = 0.62;
/// Leaves stand so far out of the wood, metres.
const OUT_M: f32 = 0.07;
/// From one sprig on an edge to the next, metres.
const SPRIG_PITCH_M: f32 = 0.42;

/// A trimmed hedge or, when short, a bush, filling a box `size` metres.
pub fn hedge(variant: u32, size: Vec3, detail: Detail) -> Mesh {
    let mut variety = Variety::of(variant);
    let leaves = Paint::plain(SemanticTag::Vegetation, row_of(variant).colour(&LEAVES)).shaded(0.8).grainy(230);
    if size.x < 2.0 * size.y.max(size.z) {
        bush(leaves, size, detail, &mut variety)
    } else {
        clipped(leaves, size, detail, &mut variety)
    }
}

fn bush(leaves: Paint, size: Vec3, detail: Detail, variety: &mut Variety) -> Mesh {
    let mut mesh = Mesh::default();
    let radii = Vec3::new(0.5 * size.x, 0.5 * size.y, 0.62 * size.z);
    let lump = Lump { centre: Vec3::Z * 0.38 * size.z, radii, rings: 5, sides: 8, rough: 0.12 };
    if detail != Detail::Fine {
        mesh.lump(leaves, &lump, variety);
        return mesh;
    }
    mesh.lump(leaves.shaded(0.72), &Lump { radii: 0.8 * radii, ..lump }, variety);
    let side_m = (0.5 * size.min_element()).clamp(0.3, 0.8);
    mesh.leafy_lump(Leaf::Small.paint(leaves.shaded(1.04), 160), &lump, &[], side_m, variety);
    mesh
}

/// A clipped hedge is longer than its box by this share at each end: it grows into the next one of its row.
const BEYOND: f32 = 0.04;

/// Cross-sections along x, each from the foot on one side over the top to the other; those at both ends are alike in a row.
fn cuts(size: Vec3, variety: &mut Variety) -> Vec<[Vec3; 4]> {
    let pieces = (size.x / 1.5).ceil().max(1.0) as u32;
    let length = size.x * (1.0 + 2.0 * BEYOND);
    let cut = |i: u32| {
        let x = length * (i as f32 / pieces as f32 - 0.5);
        let [wide, high] = [0.88, 0.9].map(|least| variety.between(least, 1.0));
        let [wide, high] = if i == 0 || i == pieces { [0.94, 0.95] } else { [wide, high] };
        let (w, h) = (0.5 * size.y * wide, size.z * high);
        [Vec3::new(x, -w, 0.0), Vec3::new(x, -0.85 * w, h), Vec3::new(x, 0.85 * w, h), Vec3::new(x, w, 0.0)]
    };
    (0..=pieces).map(cut).collect()
}

fn clipped(leaves: Paint, size: Vec3, detail: Detail, variety: &mut Variety) -> Mesh {
    let mut mesh = Mesh::default();
    let cuts = cuts(size, variety);
    let is_near = detail == Detail::Fine;
    // The wood within is dark.
    let (paint, inner) = if is_near { (leaves.shaded(0.6), OUT_M) } else { (leaves, 0.0) };
    let within = |p: Vec3| {
        p - Vec3::new(
            inner * p.x.signum() * f32::from(p.x.abs() > 0.49 * size.x),
            inner * p.y.signum(),
            inner * f32::from(p.z > 0.0),
        )
    };
    faces(&cuts, |light, corners| mesh.polygon(paint.shaded(light), &corners.map(within)));
    if is_near {
        let face = Leaf::Clipped.paint(leaves, 120);
        faces(&cuts, |light, corners| leafy_face(&mut mesh, face.shaded(1.05 * light), corners));
        sprigs(&mut mesh, Leaf::Small.paint(leaves.shaded(1.1), 160), &cuts, variety);
    }
    mesh
}

/// All faces between cross-sections and at both ends, with how bright they are.
fn faces(cuts: &[[Vec3; 4]], mut each: impl FnMut(f32, [Vec3; 4])) {
    if let [first, .., last] = cuts {
        each(1.0, [first[3], first[0], first[1], first[2]]);
        each(1.0, [last[0], last[3], last[2], last[1]]);
    }
    for pair in cuts.windows(2) {
        for (k, light) in [(0, 0.85), (1, 1.15), (2, 0.85)] {
            each(light, [pair[0][k], pair[1][k], pair[1][k + 1], pair[0][k + 1]]);
        }
    }
}

/// A face of leaves seen from outside, pictured by metres along it.
fn leafy_face(mesh: &mut Mesh, paint: Paint, corners: [Vec3; 4]) {
    let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalize_or(Vec3::Z);
    let across = |p: Vec3| if normal.z > 0.7 { p.y } else { p.z };
    let along = |p: Vec3| if normal.x.abs() > 0.7 { p.y } else { p.x };
    mesh.quad_uv(paint, corners, corners.map(|p| Vec2::new(along(p), across(p)) / FACE_M));
}

/// Sprigs that stand out of the upper edges.
fn sprigs(mesh: &mut Mesh, paint: Paint, cuts: &[[Vec3; 4]], variety: &mut Variety) {
    for (pair, edge) in cuts.windows(2).flat_map(|pair| [1, 2].map(|edge| (pair, edge))) {
        let (from, to) = (pair[0][edge], pair[1][edge]);
        let count = (from.distance(to) / SPRIG_PITCH_M).ceil() as u32;
        for k in 0..count {
            let at = from.lerp(to, (k as f32 + variety.between(0.2, 0.8)) / count as f32);
            let side_m = variety.between(0.26, 0.4);
            let centre = at - Vec3::Z * (0.2 * side_m);
            let lean = Vec3::new(variety.between(-0.4, 0.4), variety.between(-0.4, 0.4), 1.0).normalize_or(Vec3::Z);
            let u = lean.cross(Vec3::Y).normalize_or(Vec3::X);
            mesh.leaf_card(paint.shaded(variety.between(0.85, 1.1)), centre, [u, lean], side_m, centre - Vec3::Z);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Finish;

    #[test]
    fn near_hedges_and_bushes_have_leaves_within_their_box() {
        for (variant, size) in [[3.0, 0.9, 1.2], [1.0, 0.9, 1.2], [5.6, 1.2, 1.5]].into_iter().enumerate() {
            let size = Vec3::from_array(size);
            let [fine, coarse, rough] = Detail::ALL.map(|detail| hedge(variant as u32, size, detail));
            let leafy = |mesh: &Mesh| mesh.triangles[Finish::Leafy as usize].len();
            assert!(leafy(&fine) > 20 && leafy(&coarse) + leafy(&rough) == 0);
            let bounds = size * Vec3::new(0.5, 0.5, 1.0) + 0.45;
            assert!(fine.vertices.iter().all(|v| Vec3::from(v.position).abs().cmple(bounds).all()), "{size}");
        }
    }

    /// Maps leave up to 0.4 m between pieces of 5.6 m.
    #[test]
    fn pieces_of_a_row_meet_in_the_same_cross_section() {
        let size = Vec3::new(5.6, 1.0, 1.3);
        for (one, next) in [(0, 1), (2, 9)] {
            let [one, next] = [one, next].map(|variant| cuts(size, &mut Variety::of(variant)));
            let ahead = Vec3::X * (size.x + 0.4);
            let gap = next[0].map(|corner| corner + ahead);
            let end = one[one.len() - 1];
            assert!(gap.iter().zip(end).all(|(a, b)| a.x <= b.x && (a.y, a.z) == (b.y, b.z)), "{gap:?} and {end:?}");
        }
    }
}
