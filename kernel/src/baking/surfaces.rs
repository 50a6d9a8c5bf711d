//! The road surface: asphalt, pavements with kerbs, and verges; its paint is in `paint`.

use glam::Vec3;

use super::materials::{material, stretches};
use super::mesh::{Meshes, PAINT_M, thinned};
use super::notes::Notes;
use super::rounding::snap3;
use super::shapes::point;
use super::source::Source;
use super::{flat, paint};
use crate::geometry::direction;
use crate::map_data::{Crosswalk, Junction, Lane, LanePoint, Surface, SurfaceKind};

/// How far a kerb reaches below the pavement, metres.
const KERB_FACE_M: f32 = 0.4;
/// How far the floor of a junction lies below its lanes, metres.
const FLOOR_M: f32 = 20.0 / 1024.0;
/// Mouths farther apart than this share no paved floor.
const FLOOR_REACH_M: f32 = 60.0;
/// How far the bed of rails lies below other ground, metres: where a road crosses, its asphalt is seen.
const BED_M: f32 = 32.0 / 1024.0;
/// Between the middles of two rails, and how wide each is, metres.
const GAUGE_M: f32 = 1.5;
const RAIL_M: f32 = 0.08;

/// All surfaces but the land.
pub(super) fn bake(
    source: &Source,
    lanes: &[Lane],
    junctions: &[Junction],
    crosswalks: &[Crosswalk],
    notes: &mut Notes,
) -> Vec<Surface> {
    let mut meshes = Meshes::new();
    pave(source, lanes, &mut meshes, notes);
    flat::lay(source, &mut meshes);
    for junction in junctions {
        let corners = floor(lanes, junction);
        meshes.of(SurfaceKind::Road).fan(&corners);
    }
    paint::bake(source, lanes, crosswalks, meshes.of(SurfaceKind::RoadLine));
    meshes.finish().collect()
}

fn pave(source: &Source, lanes: &[Lane], meshes: &mut Meshes, notes: &mut Notes) {
    let mesh = source.net.surface_mesh();
    for span in &mesh.lanes {
        let (Some(lane), Some(&id)) = (source.net.lane(span.lane), source.ids.get(&span.lane.0)) else { continue };
        let kind = material(lane.kind);
        // Unnamed strips of connecting roads lie across each other's lanes.
        if kind == SurfaceKind::Terrain && lanes[id as usize].junction.is_some() {
            continue;
        }
        let lift = match kind {
            SurfaceKind::Sidewalk => Vec3::Z * source.rise(id),
            SurfaceKind::Track => Vec3::Z * -BED_M,
            _ => Vec3::ZERO,
        };
        let ribs: Vec<[Vec3; 2]> = mesh.vertices[span.vertices.start as usize..span.vertices.end as usize]
            .chunks_exact(2)
            .map(|rib| [snap3(point(rib[0]) + lift), snap3(point(rib[1]) + lift)])
            .collect();
        if kind == SurfaceKind::Track {
            rails(&ribs, lift).iter().for_each(|rail| meshes.of(SurfaceKind::Rail).strip(&thinned(rail)));
        }
        for (kind, ribs) in stretches(source, lane, ribs, notes) {
            let ribs = thinned(&ribs);
            let surface = meshes.of(kind);
            surface.strip(&ribs);
            if kind == SurfaceKind::Sidewalk {
                kerbs(surface, &ribs);
            }
        }
    }
}

/// Both rails along the middle of a bed that was lifted so much, above the ground around it.
fn rails(ribs: &[[Vec3; 2]], lift: Vec3) -> [Vec<[Vec3; 2]>; 2] {
    [1.0f32, -1.0].map(|side| {
        let rib = |[left, right]: &[Vec3; 2]| {
            let out = (*left - *right).normalize_or_zero();
            let at = |m: f32| snap3((*left + *right) / 2.0 + out * m - lift + Vec3::Z * PAINT_M);
            [at((side * GAUGE_M + RAIL_M) / 2.0), at((side * GAUGE_M - RAIL_M) / 2.0)]
        };
        ribs.iter().map(rib).collect()
    })
}

/// Faces down from both edges and both ends of a strip of (left, right) ribs.
fn kerbs(surface: &mut Surface, ribs: &[[Vec3; 2]]) {
    let down = Vec3::Z * KERB_FACE_M;
    let mut face = |a: Vec3, b: Vec3| surface.fan(&[a, b, b - down, a - down]);
    for pair in ribs.windows(2) {
        face(pair[0][0], pair[1][0]);
        face(pair[1][1], pair[0][1]);
    }
    if let [[left, right], .., [end_left, end_right]] = ribs {
        face(*right, *left);
        face(*end_left, *end_right);
    }
}

/// The paved floor of a junction: the hull of the mouths of its roads, just below its lanes.
fn floor(lanes: &[Lane], junction: &Junction) -> Vec<Vec3> {
    let ends = junction.lanes.iter().flat_map(|&l| [*lanes[l as usize].start(), *lanes[l as usize].end()]);
    let mut corners: Vec<Vec3> = ends.flat_map(|p| edges(&p)).map(|p| p - Vec3::Z * FLOOR_M).collect();
    let far = |a: &Vec3| corners.iter().any(|b| a.distance(*b) > FLOOR_REACH_M);
    if junction.lanes.len() < 3 || corners.iter().any(far) {
        return Vec::new();
    }
    hull(&mut corners)
}

/// The right and left edge of a lane at a point of its centre line.
fn edges(p: &LanePoint) -> [Vec3; 2] {
    let left = (direction(p.heading_rad).perp() * p.half_width_m).extend(0.0);
    [p.position - left, p.position + left]
}

/// The convex hull seen from above, counter-clockwise (Andrew's monotone chain).
fn hull(points: &mut [Vec3]) -> Vec<Vec3> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |points: &mut dyn Iterator<Item = Vec3>| {
        let mut chain: Vec<Vec3> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                let turn: f32 = (b - a).truncate().perp_dot((p - b).truncate());
                if turn > 0.01 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = chain(&mut points.iter().copied());
    lower.extend(chain(&mut points.iter().rev().copied()));
    lower
}
