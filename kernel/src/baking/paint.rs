//! Paint on the road: lines along it, the bars of crosswalks, and stop lines.

use glam::{Vec2, Vec3};

use super::gaps::Gaps;
use super::mesh::{PAINT_M, thinned};
use super::rounding::{snap, snap3};
use super::shapes::point;
use super::source::Source;
use super::stops::STOP_LINE_M;
use crate::map_data::{Crosswalk, Lane, LaneKind, LanePoint, StopKind, Surface};
use crate::ops;

/// How far paint lies above the road.
const UP: Vec3 = Vec3::new(0.0, 0.0, PAINT_M);

/// All paint of a map.
pub(super) fn bake(source: &Source, lanes: &[Lane], crosswalks: &[Crosswalk], surface: &mut Surface) {
    lines(source, &Gaps::new(lanes, crosswalks), surface);
    for stripe in crosswalks.iter().flat_map(stripes) {
        surface.fan(&stripe.map(|p| p + UP));
    }
    for lane in lanes.iter().filter(|l| l.kind == LaneKind::Driving) {
        if let Some(stop) = lane.stop {
            let (from, to) = (lane.at(stop.s_m), lane.at(stop.s_m + STOP_LINE_M));
            stop_line(surface, &from, &to, stop.kind);
        }
    }
}

/// The lines along the road, but for gaps.
fn lines(source: &Source, gaps: &Gaps, surface: &mut Surface) {
    for line in source.net.road_marks().iter().flat_map(|m| &m.lines) {
        for dash in dashes(&line.pieces).into_iter().flat_map(|dash| gaps.cut(dash)) {
            surface.strip(&thinned(&dash));
        }
    }
}

/// The ribs of each painted dash; xodr cuts a dash at every station of its lane.
fn dashes(pieces: &[[xodr::Point; 4]]) -> Vec<Vec<[Vec3; 2]>> {
    let mut dashes: Vec<Vec<[Vec3; 2]>> = Vec::new();
    for piece in pieces {
        let [right, end_right, end_left, left] = piece.map(|p| snap3(point(p) + UP));
        match dashes.last_mut() {
            Some(dash) if dash.last() == Some(&[left, right]) => dash.push([end_left, end_right]),
            _ => dashes.push(vec![[left, right], [end_left, end_right]]),
        }
    }
    dashes
}

/// A bar, or a row of blocks where one only has to give way.
fn stop_line(surface: &mut Surface, from: &LanePoint, to: &LanePoint, kind: StopKind) {
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
        let side = |p: &LanePoint, offset: f32| p.position + UP + (left * offset).extend(0.0);
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

/// The lines along the road of a text that bakes, as if there were neither crosswalks nor stop lines.
#[cfg(test)]
pub(crate) fn lines_without_gaps(xodr: &str) -> Surface {
    let mut notes = super::notes::Notes::unwanted();
    let source = Source::read(xodr, &mut notes).expect("a road network");
    let mut surface =
        Surface { kind: crate::map_data::SurfaceKind::RoadLine, positions: Vec::new(), triangles: Vec::new() };
    lines(&source, &Gaps::new(&[], &[]), &mut surface);
    surface
}
