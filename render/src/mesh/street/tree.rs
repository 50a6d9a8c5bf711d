//! Trees, hedges and bushes; trunks count as vegetation, as in CARLA.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;

use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::shape::Lump;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const LEAVES: [[u8; 3]; 6] =
    [[92, 122, 52], [80, 112, 50], [108, 132, 56], [72, 102, 56], [122, 134, 58], [96, 116, 64]];
const NEEDLES: [[u8; 3]; 2] = [[52, 84, 56], [60, 90, 50]];
const BARKS: [[u8; 3]; 3] = [[92, 76, 60], [110, 98, 84], [78, 66, 54]];

const TAG: SemanticTag = SemanticTag::Vegetation;

/// A tree `height_m` high with a crown `crown_m` wide.
pub fn tree(variant: u32, crown_m: f32, height_m: f32, detail: Detail) -> Mesh {
    let mut variety = Variety::of(variant);
    let bark = Paint::plain(TAG, variety.colour(&BARKS));
    let mut mesh = Mesh::default();
    if variety.one_in(5) {
        let needles = Paint::plain(TAG, variety.colour(&NEEDLES)).grainy(200);
        conifer(&mut mesh, needles, bark, crown_m, height_m, detail);
    } else {
        let leaves = Paint::plain(TAG, variety.colour(&LEAVES)).grainy(220);
        let trunk = 0.05 + 0.022 * height_m;
        let sides = if detail == Detail::Fine { 7 } else { 4 };
        mesh.tube(bark, Vec3::ZERO, Vec3::Z * 0.65 * height_m, trunk, 0.5 * trunk, sides);
        for (i, (lump, light)) in (0..).zip(crown(crown_m, height_m, detail, &mut variety)) {
            // Dents have choices of their own, so that lumps lie alike at every level of detail.
            mesh.lump(leaves.shaded(light), &lump, &mut Variety::of(variant ^ (i + 1) << 24));
        }
    }
    mesh.sway_between(0.25 * height_m, height_m);
    mesh
}

/// One large and five smaller lumps of leaves, each with its brightness.
fn crown(crown_m: f32, height_m: f32, detail: Detail, variety: &mut Variety) -> Vec<(Lump, f32)> {
    let (radius, foot) = (0.5 * crown_m, 0.3 * height_m);
    let middle = Vec3::new(0.0, 0.0, 0.5 * (foot + height_m));
    let ([rings, sides], [small_rings, small_sides]) = match detail {
        Detail::Fine => ([5, 8], [4, 6]),
        Detail::Coarse => ([5, 7], [4, 6]),
        Detail::Rough => ([4, 6], [3, 5]),
    };
    let core = Vec3::new(0.78 * radius, 0.78 * radius, 0.46 * (height_m - foot));
    let lump = Lump { centre: middle + Vec3::Z * 0.08 * core.z, radii: core, rings, sides, rough: 0.1 };
    let mut lumps = vec![(lump, 1.0)];
    let turn = variety.between(0.0, TAU);
    for i in 0..5 {
        let angle = turn + TAU * i as f32 / 5.0;
        let rise = variety.between(-0.55, 0.35) * core.z;
        let reach = variety.between(0.5, 0.6) * radius;
        let centre = middle + Vec3::new(reach * ops::cos(angle), reach * ops::sin(angle), rise);
        let size = variety.between(0.38, 0.48) * radius;
        let radii = Vec3::new(size, size, size * 0.9);
        let lump = Lump { centre, radii, rings: small_rings, sides: small_sides, rough: 0.14 };
        lumps.push((lump, variety.between(0.86, 1.08)));
    }
    lumps
}

/// A trunk under a stack of cones.
fn conifer(mesh: &mut Mesh, needles: Paint, bark: Paint, crown_m: f32, height_m: f32, detail: Detail) {
    mesh.tube(bark, Vec3::ZERO, Vec3::Z * 0.3 * height_m, 0.16, 0.12, 6);
    let (layers, sides) = (5, if detail == Detail::Fine { 9 } else { 7 });
    for i in 0..layers {
        let up = i as f32 / layers as f32;
        let (z0, z1) = (height_m * (0.16 + 0.78 * up), height_m * (0.16 + 0.78 * up + 0.3).min(1.0));
        let radius = 0.5 * crown_m * (1.0 - 0.86 * up);
        let paint = needles.shaded(0.86 + 0.06 * i as f32);
        mesh.tube(paint, Vec3::Z * z0, Vec3::Z * z1, radius, 0.02, sides);
        mesh.disc(paint.shaded(0.5), Vec3::Z * z0, Vec3::NEG_Z, radius, sides);
    }
}

/// A trimmed hedge or, when short, a bush, filling a box `size` metres.
pub fn hedge(variant: u32, size: Vec3) -> Mesh {
    let mut variety = Variety::of(variant);
    let leaves = Paint::plain(TAG, variety.colour(&LEAVES)).shaded(0.8).grainy(230);
    let mut mesh = Mesh::default();
    if size.x < 2.0 * size.y.max(size.z) {
        let radii = Vec3::new(0.5 * size.x, 0.5 * size.y, 0.62 * size.z);
        let lump = Lump { centre: Vec3::Z * 0.38 * size.z, radii, rings: 5, sides: 8, rough: 0.12 };
        mesh.lump(leaves, &lump, &mut variety);
        return mesh;
    }
    let pieces = (size.x / 1.5).ceil().max(1.0) as u32;
    let step = size.x / pieces as f32;
    let mut cut = |x: f32| {
        let (w, h) = (0.5 * size.y * variety.between(0.88, 1.0), size.z * variety.between(0.9, 1.0));
        [Vec3::new(x, -w, 0.0), Vec3::new(x, -0.85 * w, h), Vec3::new(x, 0.85 * w, h), Vec3::new(x, w, 0.0)]
    };
    let mut last = cut(-0.5 * size.x);
    mesh.polygon(leaves, &[last[3], last[0], last[1], last[2]]);
    for i in 1..=pieces {
        let next = cut(-0.5 * size.x + step * i as f32);
        for (k, light) in [(0, 0.85), (1, 1.15), (2, 0.85)] {
            mesh.polygon(leaves.shaded(light), &[last[k], next[k], next[k + 1], last[k + 1]]);
        }
        last = next;
    }
    mesh.polygon(leaves, &[last[0], last[3], last[2], last[1]]);
    mesh
}
