//! Worn ground beside roads and pavements: bare soil at their edge that grass thins out to.

use std::collections::BTreeSet;

use glam::Vec3;
use kernel::map::{RoadNetwork, Surface, SurfaceKind};

use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// Width of worn ground beside roadways and pavements, metres.
const ROAD_M: f32 = 0.7;
const PAVEMENT_M: f32 = 0.28;
/// It is laid in pieces of at most this length, metres, on the ground below their ends.
const PIECE_M: f32 = 5.0;
/// How far it lies above the ground, metres, as paint does.
const UP_M: f32 = 16.0 / 1024.0;
/// How far beside an edge to look what is there, metres.
const BESIDE_M: f32 = 0.08;

/// The worn ground around a surface, in pieces. `paint` is that of grass; how bare it is is [`crate::mesh::Vertex::param`].
pub(super) fn pieces<'a>(
    network: &'a RoadNetwork,
    surface: &'a Surface,
    paint: Paint,
) -> impl Iterator<Item = [(Vec3, Paint); 4]> + 'a {
    let width_m = match surface.kind {
        SurfaceKind::Road | SurfaceKind::Gravel | SurfaceKind::Setts => ROAD_M,
        SurfaceKind::Sidewalk => PAVEMENT_M,
        _ => 0.0,
    };
    let edges = if width_m > 0.0 { edges(surface) } else { Vec::new() };
    edges.into_iter().flat_map(move |[from, to]| {
        let count = ((to - from).length() / PIECE_M).ceil().max(1.0);
        let out = (to - from).truncate().perp().normalize_or_zero() * -1.0;
        let rib = move |i: f32| {
            let at = from.lerp(to, i / count);
            let far_m = width_m * Variety::of(at.x.to_bits() ^ at.y.to_bits().rotate_left(9)).between(0.6, 1.3);
            let beside = |m: f32| at + (out * m).extend(0.0);
            let ground = |m: f32| network.ground(beside(m)).filter(|g| g.kind == SurfaceKind::Terrain);
            let height = |m: f32| Some(ground(m)?.height_m + UP_M);
            Some([at.with_z(height(BESIDE_M)?), beside(far_m).with_z(height(far_m)?)])
        };
        let bare = Paint { param: 255, ..paint };
        (0..count as u32).filter_map(move |i| {
            let ([a, b], [c, d]) = (rib(i as f32)?, rib(i as f32 + 1.0)?);
            Some([(a, bare), (b, paint), (d, paint), (c, bare)])
        })
    })
}

/// A piece as a mesh.
pub(super) fn mesh(corners: &[(Vec3, Paint); 4], mesh: &mut Mesh) {
    let [a, b, c, d] = corners.map(|(at, paint)| mesh.vertex(paint, at, Vec3::Z, at.truncate()));
    let finish = corners[0].1.finish;
    mesh.triangle(finish, [a, b, c]);
    mesh.triangle(finish, [a, c, d]);
}

/// Edges that belong to one triangle alone, with the surface to their left; the faces of kerbs have none.
fn edges(surface: &Surface) -> Vec<[Vec3; 2]> {
    let at = |i: u32| surface.positions[i as usize];
    let place = |i: u32| at(i).to_array().map(f32::to_bits);
    let is_level = |&&[a, b, c]: &&[u32; 3]| {
        let normal = (at(b) - at(a)).cross(at(c) - at(a));
        normal.z > 0.7 * normal.length()
    };
    let around = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
    let all: Vec<[u32; 2]> = surface.triangles.iter().filter(is_level).flat_map(around).collect();
    let known: BTreeSet<_> = all.iter().map(|&[a, b]| [place(a), place(b)]).collect();
    let is_open = |[a, b]: &[u32; 2]| !known.contains(&[place(*b), place(*a)]);
    all.into_iter().filter(is_open).map(|edge| edge.map(at)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;

    #[test]
    fn worn_ground_lies_on_grass_beside_what_is_paved() {
        let network = kernel::map::bundled("rural").expect("a bundled map");
        let paint = Paint::plain(SemanticTag::Terrain, [90; 3]);
        let mut count = 0;
        for surface in &network.surfaces {
            for piece in pieces(&network, surface, paint) {
                let middle = 0.25 * piece.iter().map(|(at, _)| *at).sum::<Vec3>();
                let ground = network.ground(middle).expect("ground");
                assert!(ground.kind == SurfaceKind::Terrain && (ground.height_m - middle.z).abs() < 0.2, "{piece:?}");
                assert!([0, 3].iter().all(|&i| piece[i].1.param == 255 && piece[3 - i].1.param == 255));
                count += 1;
            }
        }
        assert!(count > 1000, "{count}");
    }
}
