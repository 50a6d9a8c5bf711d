//! Where lines along the road are interrupted: at crosswalks, and from stop lines on.

use glam::{Vec2, Vec3};

use super::stops::{SETBACK_M, STOP_LINE_M};
use crate::geometry::direction;
use crate::map_data::{Crosswalk, Lane, LaneKind, LanePoint};
use crate::places::Grid;

/// Room between a crosswalk and the end of a line, metres.
const MARGIN_M: f32 = 0.2;
/// How far beyond the edges of its lane a stop line ends lines: the far one of a double line ends there too, metres.
const BORDER_M: f32 = 0.4;
/// What is left of a line beside a gap is painted if it is longer, metres.
const STUB_M: f32 = 0.5;
/// What lies so far above or below a gap is of another road, metres.
const STOREY_M: f32 = 2.5;
/// Cells in which areas are looked up, metres.
const CELL_M: f32 = 16.0;

/// All gaps of a map.
pub(super) struct Gaps {
    areas: Vec<Area>,
    grid: Grid,
}

/// An area without lines along the road: convex, counter-clockwise seen from above.
struct Area {
    corners: [Vec2; 4],
    middle: Vec3,
    radius_m: f32,
}

impl Gaps {
    /// No lines run over crosswalks, and none from a stop line to what it lies before.
    pub fn new(lanes: &[Lane], crosswalks: &[Crosswalk]) -> Self {
        let driving = lanes.iter().filter(|lane| lane.kind == LaneKind::Driving);
        let areas: Vec<Area> = crosswalks.iter().map(across).chain(driving.filter_map(beyond)).collect();
        let boxes: Vec<_> =
            areas.iter().map(|a| (a.middle.truncate() - a.radius_m, a.middle.truncate() + a.radius_m)).collect();
        Self { areas, grid: Grid::new(&boxes, CELL_M) }
    }

    /// The parts of a painted dash, in (left, right) ribs, that lie in no gap.
    pub fn cut(&self, dash: Vec<[Vec3; 2]>) -> Vec<Vec<[Vec3; 2]>> {
        let mut gaps: Vec<[f64; 2]> = Vec::new();
        for (k, pair) in dash.windows(2).enumerate() {
            let within = self.within([pair[0], pair[1]]);
            gaps.extend(within.map(|stretch| stretch.map(|share| k as f64 + f64::from(share))));
        }
        if gaps.is_empty() {
            return vec![dash];
        }
        gaps.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (mut parts, mut from) = (Vec::new(), 0.0);
        for [start, end] in gaps {
            if start > from {
                parts.push(part(&dash, from, start));
            }
            from = end.max(from);
        }
        let end = (dash.len() - 1) as f64;
        if from < end {
            parts.push(part(&dash, from, end));
        }
        parts.retain(|part| length_m(part) > STUB_M);
        parts
    }

    /// The stretches between two ribs that lie in gaps, as shares of the way from one to the other.
    fn within(&self, ribs: [[Vec3; 2]; 2]) -> impl Iterator<Item = [f32; 2]> + '_ {
        let [near, far] = ribs.map(|[left, right]| (left + right) / 2.0);
        let middle = (near + far) / 2.0;
        let reach_m = ribs.as_flattened().iter().map(|p| p.truncate().distance(middle.truncate())).fold(0.0, f32::max);
        let candidates = self.grid.around(middle.truncate(), reach_m).map(|k| &self.areas[k as usize]);
        candidates.filter_map(move |area| {
            let apart_m = area.middle.truncate().distance(middle.truncate());
            if apart_m > area.radius_m + reach_m {
                return None;
            }
            let [left, right] = [0, 1].map(|side| area.holds(ribs[0][side].truncate(), ribs[1][side].truncate()));
            let (one, other) = (left.or(right)?, right.or(left)?);
            let stretch = [one[0].min(other[0]), one[1].max(other[1])];
            let there = near.lerp(far, (stretch[0] + stretch[1]) / 2.0);
            ((there.z - area.middle.z).abs() < STOREY_M).then_some(stretch)
        })
    }
}

impl Area {
    fn new(corners: [Vec3; 4]) -> Self {
        let middle = corners.iter().sum::<Vec3>() / 4.0;
        let corners = corners.map(Vec3::truncate);
        let radius_m = corners.iter().map(|c| c.distance(middle.truncate())).fold(0.0, f32::max);
        Self { corners, middle, radius_m }
    }

    /// From where to where the way between two places is inside, as shares of it (Cyrus and Beck).
    fn holds(&self, from: Vec2, to: Vec2) -> Option<[f32; 2]> {
        let (mut start, mut end) = (0.0f32, 1.0f32);
        for (k, corner) in self.corners.iter().enumerate() {
            let edge = self.corners[(k + 1) % self.corners.len()] - *corner;
            let (a, b) = (edge.perp_dot(from - *corner), edge.perp_dot(to - *corner));
            match (a < 0.0, b < 0.0) {
                (true, true) => return None,
                (true, false) => start = start.max(a / (a - b)),
                (false, true) => end = end.min(a / (a - b)),
                (false, false) => {}
            }
        }
        (start < end).then_some([start, end])
    }
}

/// A crosswalk with some room on both sides.
fn across(crosswalk: &Crosswalk) -> Area {
    let [a, b] = crosswalk.ends;
    let along = (b - a).truncate().normalize_or_zero();
    let aside = (along.perp() * (crosswalk.half_width_m + MARGIN_M)).extend(0.0);
    Area::new([a - aside, b - aside, b + aside, a + aside])
}

/// From the stop line of a lane, if it is painted, to the crosswalk or junction that it lies before.
fn beyond(lane: &Lane) -> Option<Area> {
    let s_m = lane.stop?.s_m;
    if lane.length_m - s_m < STOP_LINE_M / 2.0 {
        return None;
    }
    let sides = |p: &LanePoint| {
        let left = (direction(p.heading_rad).perp() * (p.half_width_m + BORDER_M)).extend(0.0);
        [p.position - left, p.position + left]
    };
    let [right, left] = sides(&lane.at(s_m));
    let [end_right, end_left] = sides(&lane.at(s_m + SETBACK_M + MARGIN_M));
    Some(Area::new([right, end_right, end_left, left]))
}

/// The part of a dash between two places that are counted in ribs.
fn part(dash: &[[Vec3; 2]], from: f64, to: f64) -> Vec<[Vec3; 2]> {
    let at = |place: f64| {
        let k = (place as usize).min(dash.len() - 2);
        let share = (place - k as f64) as f32;
        [0, 1].map(|side: usize| dash[k][side].lerp(dash[k + 1][side], share))
    };
    let between = (0..dash.len()).filter(|&k| k as f64 > from && (k as f64) < to).map(|k| dash[k]);
    [at(from)].into_iter().chain(between).chain([at(to)]).collect()
}

fn length_m(ribs: &[[Vec3; 2]]) -> f32 {
    let middle = |[left, right]: [Vec3; 2]| (left + right) / 2.0;
    ribs.windows(2).map(|pair| middle(pair[0]).distance(middle(pair[1]))).sum()
}
