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
/// What reaches farther from its middle is of no lane that one stops on, and would fill the cells, metres.
const REACH_M: f32 = 100.0;
/// At each corner of an area its edges span more than this, m²: else it has no inside, and would hold everything.
const TURN_M2: f32 = 1e-4;

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
        let areas = crosswalks.iter().map(across).chain(driving.filter_map(beyond));
        let areas: Vec<Area> = areas.filter(Area::is_sound).collect();
        let grid = grid(&areas);
        Self { areas, grid }
    }

    /// The parts of a painted dash, in (left, right) ribs, that lie in no gap.
    pub fn cut(&self, dash: Vec<[Vec3; 2]>) -> Vec<Vec<[Vec3; 2]>> {
        let gaps = self.stretches(&dash);
        if gaps.is_empty() {
            return vec![dash];
        }
        let (mut parts, mut from) = (Vec::new(), 0.0);
        for [start, end] in gaps {
            if start > from {
                parts.push(part(&dash, from, start));
            }
            from = end;
        }
        let end = (dash.len() - 1) as f64;
        if from < end {
            parts.push(part(&dash, from, end));
        }
        parts.retain(|part| length_m(part) > STUB_M);
        parts
    }

    /// Where a dash lies in gaps, counted in ribs: in ascending order, and none touches the next.
    fn stretches(&self, dash: &[[Vec3; 2]]) -> Vec<[f64; 2]> {
        let mut gaps: Vec<[f64; 2]> = Vec::new();
        // Those of one pair of ribs, joined before the next: as many gaps as a file likes may lie on each other.
        let mut here: Vec<[f32; 2]> = Vec::new();
        for (k, pair) in dash.windows(2).enumerate() {
            here.clear();
            here.extend(self.within([pair[0], pair[1]]));
            here.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
            for [start, end] in here.iter().map(|stretch| stretch.map(|share| k as f64 + f64::from(share))) {
                match gaps.last_mut().filter(|last| start <= last[1]) {
                    Some(last) => last[1] = last[1].max(end),
                    None => gaps.push([start, end]),
                }
            }
        }
        gaps
    }

    /// The stretches between two ribs that lie in gaps, as shares of the way from one to the other.
    fn within(&self, ribs: [[Vec3; 2]; 2]) -> impl Iterator<Item = [f32; 2]> + '_ {
        let [near, far] = ribs.map(|[left, right]| (left + right) / 2.0);
        let middle = (near + far) / 2.0;
        // Lines as wide as a file likes look no farther than others: ribs are two metres apart.
        let reach_m = ribs
            .as_flattened()
            .iter()
            .map(|p| p.truncate().distance(middle.truncate()))
            .fold(0.0, f32::max)
            .min(CELL_M);
        let mut candidates: Vec<u32> = self.grid.around(middle.truncate(), reach_m).collect();
        candidates.sort_unstable();
        candidates.dedup();
        candidates.into_iter().filter_map(move |k| {
            let area = &self.areas[k as usize];
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

    /// Whether it is what [`Self::holds`] takes it for, and no larger than one is.
    fn is_sound(&self) -> bool {
        let edge = |k: usize| self.corners[(k + 1) % 4] - self.corners[k % 4];
        self.radius_m < REACH_M && (0..4).all(|k| edge(k).perp_dot(edge(k + 1)) > TURN_M2)
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

/// A crosswalk in the cell that the most of them touch, and how many do.
pub(super) fn most_crowded(crosswalks: &[Crosswalk]) -> Option<(usize, usize)> {
    let areas: Vec<Area> = crosswalks.iter().map(across).collect();
    grid(&areas).most_crowded().map(|(crosswalk, crowd)| (crosswalk as usize, crowd))
}

fn grid(areas: &[Area]) -> Grid {
    let boxes: Vec<_> =
        areas.iter().map(|a| (a.middle.truncate() - a.radius_m, a.middle.truncate() + a.radius_m)).collect();
    Grid::new(&boxes, CELL_M)
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
    // Only the ribs between: a long dash may have thousands of parts.
    let between = (from as usize + 1..dash.len()).take_while(|&k| (k as f64) < to).map(|k| dash[k]);
    [at(from)].into_iter().chain(between).chain([at(to)]).collect()
}

fn length_m(ribs: &[[Vec3; 2]]) -> f32 {
    let middle = |[left, right]: [Vec3; 2]| (left + right) / 2.0;
    ribs.windows(2).map(|pair| middle(pair[0]).distance(middle(pair[1]))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More crosswalks than any map has.
    const MANY: usize = 20_000;

    /// Across the x axis, from right to left.
    fn crosswalk(x: f32) -> Crosswalk {
        let ends = [Vec3::new(x, -5.0, 0.0), Vec3::new(x, 5.0, 0.0)];
        Crosswalk { ends, half_width_m: 0.0, lanes: vec![(0, x)], junction: None }
    }

    /// A line along the x axis with a rib every two metres.
    fn line(length_m: usize) -> Vec<[Vec3; 2]> {
        (0..=length_m / 2).map(|k| [0.1, -0.1].map(|y| Vec3::new(2.0 * k as f32, y, 0.0))).collect()
    }

    #[test]
    fn crosswalks_on_one_spot_are_one_gap() {
        let gaps = Gaps::new(&[], &vec![crosswalk(51.0); MANY]);
        let line = line(100);
        assert_eq!(gaps.stretches(&line).len(), 1);
        assert_eq!(gaps.cut(line).len(), 2);
        // On the border of cells, which yields each of them more than once.
        let twice: Vec<Crosswalk> = (0..MANY).map(|k| crosswalk(51.0 + (k % 2) as f32)).collect();
        assert!(Gaps::new(&[], &twice).stretches(&self::line(100)).len() <= 2);
    }

    #[test]
    fn crosswalks_all_along_a_line_leave_as_many_parts_of_few_ribs() {
        let crosswalks: Vec<Crosswalk> = (0..MANY).map(|k| crosswalk(k as f32 + 0.5)).collect();
        let line = line(MANY);
        let gaps = Gaps::new(&[], &crosswalks);
        assert_eq!(gaps.stretches(&line).len(), MANY);
        let ribs = line.len() + 2 * (MANY + 1);
        let parts = gaps.cut(line);
        // Before the first and after the last there are stubs.
        assert_eq!(parts.len(), MANY - 1);
        assert!(parts.iter().map(Vec::len).sum::<usize>() <= ribs);
    }

    #[test]
    fn areas_without_an_inside_hold_nothing() {
        let area = |corners: [[f32; 2]; 4]| Area::new(corners.map(|[x, y]| Vec3::new(x, y, 0.0)));
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        assert!(area(square).is_sound());
        let [a, b, c, d] = square;
        let far = [0.0, 500.0];
        for odd in
            [[a; 4], [a, a, c, d], [a, b, b, a], [a, c, b, d], [d, c, b, a], [a, b, c, [1.9, 0.1]], [a, b, c, far]]
        {
            assert!(!area(odd).is_sound(), "{odd:?}");
        }
        assert!(!area([a, b, c, [f32::NAN; 2]]).is_sound());
        let point = Crosswalk { ends: [Vec3::ZERO; 2], ..crosswalk(0.0) };
        assert_eq!(Gaps::new(&[], &[point]).cut(line(100)), [line(100)]);
    }
}
