//! Fences, walls and guard rails; each runs along its x axis, centred.

use glam::Vec3;

use crate::SemanticTag;
use crate::mesh::look::row_of;
use crate::mesh::model::Detail;
use crate::mesh::variety::Variety;
use crate::mesh::{CODE_SETTS, Finish, Mesh, Paint};

/// Ends of pieces of about `step_m` that fill a length.
fn pieces(length_m: f32, step_m: f32) -> impl Iterator<Item = [f32; 2]> {
    let count = (length_m / step_m).round().max(1.0) as u32;
    let step = length_m / count as f32;
    (0..count).map(move |i| [-0.5 * length_m + step * i as f32, -0.5 * length_m + step * (i + 1) as f32])
}

/// Boards between posts, of class Fence.
pub fn fence(variant: u32, size: Vec3, detail: Detail) -> Mesh {
    let mut variety = Variety::of(variant);
    let colour = row_of(variant).colour(&[[134, 100, 68], [206, 202, 192], [96, 104, 88], [112, 84, 62]]);
    let wood = Paint::plain(SemanticTag::Fence, colour);
    let mut mesh = Mesh::default();
    let height = size.z.max(0.6);
    if detail == Detail::Rough {
        mesh.cuboid(wood.shaded(0.95), Vec3::new(-0.5 * size.x, -0.025, 0.0), Vec3::new(0.5 * size.x, 0.025, height));
        return mesh;
    }
    for [a, b] in pieces(size.x, 2.2) {
        mesh.cuboid(wood.shaded(0.8), Vec3::new(a - 0.05, -0.06, 0.0), Vec3::new(a + 0.05, 0.06, height + 0.08));
        if detail == Detail::Coarse {
            mesh.cuboid(wood.shaded(0.95), Vec3::new(a, -0.025, 0.08), Vec3::new(b, 0.025, height));
            continue;
        }
        for [p, q] in pieces(b - a, 0.36) {
            let middle = 0.5 * (a + b);
            let light = variety.between(0.88, 1.08);
            let (low, high) = (Vec3::new(middle + p, -0.025, 0.08), Vec3::new(middle + q - 0.012, 0.025, height));
            mesh.cuboid(wood.shaded(light), low, high);
        }
    }
    mesh
}

/// How far walls and rails reach into the next one of their row, metres.
const BEYOND_M: f32 = 0.1;

/// Masonry under a coping, of class Wall.
pub fn wall(variant: u32, size: Vec3) -> Mesh {
    let colour = row_of(variant).colour(&[[156, 148, 136], [150, 96, 76], [178, 170, 156], [134, 132, 130]]);
    let coping = Paint::plain(SemanticTag::Wall, colour).grainy(110).shaded(1.12);
    let stone = Paint { finish: Finish::Paving, param: 0, ..coping.shaded(0.9).coded(CODE_SETTS) };
    let half = Vec3::new(0.5 * size.x + BEYOND_M, 0.5 * size.y.max(0.2), 0.0);
    let top = size.z - 0.1;
    let mut mesh = Mesh::default();
    mesh.cuboid(stone, -half, half + Vec3::Z * top);
    // Its stones are larger than those of roads.
    mesh.vertices.iter_mut().for_each(|v| v.uv = v.uv.map(|m| 0.6 * m));
    let edge = half + Vec3::new(0.0, 0.05, 0.0);
    mesh.cuboid(coping, -edge + Vec3::Z * top, edge + Vec3::Z * size.z);
    mesh
}

/// A steel rail on posts, of class GuardRail.
pub fn guard_rail(size: Vec3, detail: Detail) -> Mesh {
    let steel = Paint::plain(SemanticTag::GuardRail, [168, 172, 174]).glossy(60);
    let (top, half) = (size.z.max(0.5), 0.5 * size.x + BEYOND_M);
    // The profile from below to above: two ridges with a groove between.
    let profile = [(0.03, 0.0), (0.1, 0.06), (0.1, 0.12), (0.05, 0.16), (0.1, 0.2), (0.1, 0.26), (0.03, 0.32)];
    let mut mesh = Mesh::default();
    for side in [-1.0f32, 1.0] {
        for pair in profile.windows(2) {
            let at = |x: f32, (y, z): (f32, f32)| Vec3::new(x, -side * y, top - 0.32 + z);
            let (a, b) = (-half * side, half * side);
            mesh.polygon(steel, &[at(a, pair[0]), at(b, pair[0]), at(b, pair[1]), at(a, pair[1])]);
        }
    }
    if detail == Detail::Fine {
        for [a, _] in pieces(size.x, 2.0) {
            let post = Vec3::new(a + 0.3, 0.0, 0.0);
            mesh.cuboid(steel.shaded(0.75), post - Vec3::new(0.05, 0.03, 0.0), post + Vec3::new(0.05, 0.03, top - 0.1));
        }
    }
    mesh
}
