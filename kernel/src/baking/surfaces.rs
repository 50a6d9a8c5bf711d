//! The road surface: asphalt, pavements with kerbs, verges, and paint.

use glam::{Vec2, Vec3};

use super::flat;
use super::materials::{material, stretches};
use super::mesh::{Meshes, PAINT_M};
use super::notes::Notes;
use super::rounding::{snap, snap3};
use super::shapes::point;
use super::source::Source;
use crate::geometry::direction;
use crate::map_data::{Crosswalk, Junction, Lane, LaneKind, LanePoint, StopKind, Surface, SurfaceKind};
use crate::ops;

/// How far a kerb reaches below the pavement, metres.
const KERB_FACE_M: f32 = 0.4;
/// How far the floor of a junction lies below its lanes, metres.
const FLOOR_M: f32 = 20.0 / 1024.0;
/// Mouths farther apart than this share no paved floor.
const FLOOR_REACH_M: f32 = 60.0;
/// A strip of surface is cut at least this often, metres.
const MAX_QUAD_M: f32 = 24.0;
/// A strip of this many ribs is cut, however short it is.
const MAX_RIBS: usize = 256;
/// How far the bed of rails lies below other ground, metres: where a road crosses, its asphalt is seen.
const BED_M: f32 = 32.0 / 1024.0;
/// Between the middles of two rails, and how wide each is, metres.
const GAUGE_M: f32 = 1.5;
const RAIL_M: f32 = 0.08;
/// An edge that strays less than this from a line is straight, metres.
const STRAIGHT_M: f32 = 0.003;
/// Depth of a stop line along the road, metres.
const STOP_LINE_M: f32 = 0.4;

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
    paint(source, lanes, crosswalks, meshes.of(SurfaceKind::RoadLine));
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

/// Leaves out ribs between which a strip is straight.
fn thinned(ribs: &[[Vec3; 2]]) -> Vec<[Vec3; 2]> {
    let mut kept: Vec<[Vec3; 2]> = Vec::new();
    let mut from = 0;
    for k in 0..ribs.len() {
        let is_end = k == 0 || k + 1 == ribs.len();
        if is_end || !is_straight(&ribs[from..=k + 1]) {
            kept.push(ribs[k]);
            from = k;
        }
    }
    kept
}

/// Whether a strip without its inner ribs keeps its shape, and is not too long for its light and fog.
fn is_straight(ribs: &[[Vec3; 2]]) -> bool {
    let (first, last) = (ribs[0], ribs[ribs.len() - 1]);
    let edge = |side: usize| {
        let along = last[side] - first[side];
        let squared = along.length_squared().max(1e-6);
        squared < MAX_QUAD_M * MAX_QUAD_M
            && ribs.iter().all(|rib| {
                let off = rib[side] - first[side];
                (off - along * (off.dot(along) / squared)).length_squared() < STRAIGHT_M * STRAIGHT_M
            })
    };
    ribs.len() < MAX_RIBS && edge(0) && edge(1)
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

fn paint(source: &Source, lanes: &[Lane], crosswalks: &[Crosswalk], surface: &mut Surface) {
    let up = Vec3::Z * PAINT_M;
    for line in source.net.road_marks().iter().flat_map(|m| &m.lines) {
        for dash in dashes(&line.pieces, up) {
            surface.strip(&thinned(&dash));
        }
    }
    for stripe in crosswalks.iter().flat_map(stripes) {
        surface.fan(&stripe.map(|p| p + up));
    }
    for lane in lanes.iter().filter(|l| l.kind == LaneKind::Driving) {
        if let Some(stop) = lane.stop {
            let (from, to) = (lane.at(stop.s_m), lane.at(stop.s_m + STOP_LINE_M));
            stop_line(surface, &from, &to, stop.kind, up);
        }
    }
}

/// The ribs of each painted dash; xodr cuts a dash at every station of its lane.
fn dashes(pieces: &[[xodr::Point; 4]], up: Vec3) -> Vec<Vec<[Vec3; 2]>> {
    let mut dashes: Vec<Vec<[Vec3; 2]>> = Vec::new();
    for piece in pieces {
        let [right, end_right, end_left, left] = piece.map(|p| snap3(point(p) + up));
        match dashes.last_mut() {
            Some(dash) if dash.last() == Some(&[left, right]) => dash.push([end_left, end_right]),
            _ => dashes.push(vec![[left, right], [end_left, end_right]]),
        }
    }
    dashes
}

/// A bar, or a row of blocks where one only has to give way.
fn stop_line(surface: &mut Surface, from: &LanePoint, to: &LanePoint, kind: StopKind, up: Vec3) {
    let blocks = if kind == StopKind::Yield { 5 } else { 1 };
    let ahead = (to.position - from.position).truncate();
    if ahead.length() < STOP_LINE_M / 2.0 {
        return;
    }
    let left: Vec2 = ahead.perp().normalize();
    let width = 2.0 * from.half_width_m - 0.2;
    let pitch = snap(width / blocks as f32);
    let block = if blocks > 1 { 0.6 * pitch } else { pitch };
    for k in 0..blocks {
        let right_edge = -width / 2.0 + pitch * k as f32;
        let side = |p: &LanePoint, offset: f32| p.position + up + (left * offset).extend(0.0);
        surface.fan(&[
            side(from, right_edge),
            side(to, right_edge),
            side(to, right_edge + block),
            side(from, right_edge + block),
        ]);
    }
}

/// The corners of each stripe of a crosswalk.
fn stripes(crosswalk: &Crosswalk) -> Vec<[Vec3; 4]> {
    let [a, b] = crosswalk.ends;
    let length = (b - a).truncate().length();
    let along = (b - a) / length.max(1e-3);
    let aside = along.truncate().perp().extend(0.0) * crosswalk.half_width_m;
    let count = (ops::floor(length) as u32).max(1);
    let pitch = length / count as f32;
    (0..count)
        .map(|k| {
            let (from, to) = (a + along * (pitch * (k as f32 + 0.25)), a + along * (pitch * (k as f32 + 0.75)));
            [from - aside, to - aside, to + aside, from + aside].map(snap3)
        })
        .collect()
}
