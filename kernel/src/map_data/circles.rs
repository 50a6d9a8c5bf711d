//! Roundabouts: small circles of lanes on which traffic drives round and round.
//!
//! A file does not name them. A circle is found where lanes that follow each other come back to where they began after one turn
//! to one side, all of them about as far from their middle.

use std::f32::consts::TAU;

use glam::Vec2;

use super::{Lane, LaneId, LaneKind};
use crate::ops;

/// Longest way round, metres: larger ones are drawn as roads with junctions.
const LONGEST_M: f32 = 320.0;
/// Its points are no farther from the middle than the nearest one times this: a square has 1.41.
const ROUND: f32 = 1.25;
/// A way that turns less than a circle of [`LONGEST_M`] would is followed on this far, metres.
const STRAIGHT_M: f32 = 30.0;
/// Two circles about places so near to each other that are driven round in both directions are a street round a plaza, metres.
const PLAZA_M: f32 = 5.0;
/// Most lanes of a circle.
const MOST: usize = 64;
/// Most lanes that are looked at from one: ways through a web of short lanes are beyond counting.
const LOOKED_AT: u32 = 1000;

/// Lanes that lead round, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Circle {
    pub lanes: Vec<LaneId>,
    /// Once round, metres.
    pub length_m: f32,
    middle: Vec2,
    to_left: bool,
}

/// The circles among lanes; a lane is on one at most.
pub(crate) fn circles(lanes: &[Lane]) -> Vec<Circle> {
    let mut known = vec![false; lanes.len()];
    let mut found = Vec::new();
    for id in 0..lanes.len() as LaneId {
        // Each has a lane outside junctions, and most lanes are straight.
        let lane = &lanes[id as usize];
        if lane.kind != LaneKind::Driving || lane.junction.is_some() || known[id as usize] {
            continue;
        }
        let search = Search { lanes, known: &known, first: id, way: Vec::new(), looked_at: 0 };
        if let Some(circle) = search.run() {
            circle.lanes.iter().for_each(|lane| known[*lane as usize] = true);
            found.push(circle);
        }
    }
    let against = |a: &Circle, b: &Circle| a.to_left != b.to_left && a.middle.distance(b.middle) < PLAZA_M;
    let two_way: Vec<bool> = found.iter().map(|a| found.iter().any(|b| against(a, b))).collect();
    found.into_iter().zip(two_way).filter(|(_, two_way)| !two_way).map(|(circle, _)| circle).collect()
}

/// Follows the ways from a lane until one comes back to it.
struct Search<'a> {
    lanes: &'a [Lane],
    known: &'a [bool],
    first: LaneId,
    way: Vec<LaneId>,
    looked_at: u32,
}

/// How far a way has come.
#[derive(Clone, Copy, Default)]
struct Gone {
    length_m: f32,
    /// Turned to the left, radians.
    bend_rad: f32,
}

impl Gone {
    fn over(self, lane: &Lane) -> Self {
        Self { length_m: self.length_m + lane.length_m, bend_rad: self.bend_rad + bend_rad(lane) }
    }

    /// Where lanes are straight, circles bend between them.
    fn on_to(self, from: &Lane, to: &Lane) -> Self {
        let kink_rad = ops::wrap_angle(to.start().heading_rad - from.end().heading_rad);
        Self { bend_rad: self.bend_rad + kink_rad, ..self }
    }

    /// Whether a circle may go on so.
    fn turns(self) -> bool {
        let least_rad = (self.length_m - STRAIGHT_M) / LONGEST_M * TAU;
        self.length_m <= LONGEST_M && (least_rad..=TAU + 0.3).contains(&self.bend_rad.abs())
    }
}

impl Search<'_> {
    fn run(mut self) -> Option<Circle> {
        self.follow(self.first, Gone::default())
    }

    /// Goes on over a lane.
    fn follow(&mut self, id: LaneId, gone: Gone) -> Option<Circle> {
        let lane = &self.lanes[id as usize];
        self.looked_at += 1;
        let goes_on = lane.kind == LaneKind::Driving && !self.known[id as usize] && self.way.len() < MOST;
        let gone = gone.over(lane);
        if !goes_on || !gone.turns() || self.looked_at > LOOKED_AT {
            return None;
        }
        self.way.push(id);
        let found = lane.successors.iter().find_map(|&next| {
            let gone = gone.on_to(lane, &self.lanes[next as usize]);
            match next == self.first {
                true => self.closed(gone),
                false if self.way.contains(&next) => None,
                false => self.follow(next, gone),
            }
        });
        self.way.pop();
        found
    }

    fn closed(&self, Gone { length_m, bend_rad }: Gone) -> Option<Circle> {
        let (lanes, to_left) = (self.way.clone(), bend_rad > 0.0);
        let middle = round_about(self.lanes, &lanes).filter(|_| (bend_rad.abs() - TAU).abs() < 0.5)?;
        Some(Circle { lanes, length_m, middle, to_left })
    }
}

/// How far a lane turns to the left, radians.
fn bend_rad(lane: &Lane) -> f32 {
    lane.points.windows(2).map(|p| ops::wrap_angle(p[1].heading_rad - p[0].heading_rad)).sum()
}

/// The middle of lanes all of which are about as far from it.
fn round_about(lanes: &[Lane], circle: &[LaneId]) -> Option<Vec2> {
    let points = || circle.iter().flat_map(|id| &lanes[*id as usize].points).map(|p| p.position.truncate());
    let (low, high) = (points().fold(Vec2::MAX, Vec2::min), points().fold(Vec2::MIN, Vec2::max));
    let middle = (low + high) * 0.5;
    let radii = || points().map(|p| p.distance(middle));
    let is_round = radii().fold(0.0, f32::max) < ROUND * radii().fold(f32::MAX, f32::min);
    is_round.then_some(middle)
}

#[cfg(test)]
#[path = "../../tests/common/roundabout.rs"]
mod roundabout;

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::roundabout::Roundabout;
    use super::*;
    use crate::geometry::direction;
    use crate::map::bake;
    use crate::map_data::LanePoint;

    /// Draws lanes one behind the other.
    struct Pen {
        position: Vec2,
        heading_rad: f32,
        lanes: Vec<Lane>,
    }

    impl Pen {
        /// Ready at a place of a circle around the origin, driven to the left.
        fn on_circle(radius_m: f32, at_rad: f32) -> Self {
            let position = radius_m * direction(at_rad);
            Self { position, heading_rad: at_rad + TAU / 4.0, lanes: Vec::new() }
        }

        /// A lane that turns evenly, by so much to the left.
        fn lane(mut self, length_m: f32, by_rad: f32) -> Self {
            let steps = length_m as u32 + 1;
            let (step_m, step_rad) = (length_m / steps as f32, by_rad / steps as f32);
            let mut points = vec![self.point(0.0)];
            for step in 1..=steps {
                // Along the chord.
                self.position += step_m * direction(self.heading_rad + step_rad / 2.0);
                self.heading_rad = ops::wrap_angle(self.heading_rad + step_rad);
                points.push(self.point(step as f32 * step_m));
            }
            let id = self.lanes.len() as LaneId;
            let kind = LaneKind::Driving;
            self.lanes.push(Lane { kind, points, length_m, successors: vec![id + 1], ..Lane::default() });
            self
        }

        fn point(&self, s_m: f32) -> LanePoint {
            let position: Vec3 = self.position.extend(0.0);
            LanePoint { position, heading_rad: self.heading_rad, half_width_m: 1.75, s_m }
        }

        /// Turns where it is, so that there is a kink between lanes.
        fn turn(mut self, by_rad: f32) -> Self {
            self.heading_rad = ops::wrap_angle(self.heading_rad + by_rad);
            self
        }

        /// A circle of so many lanes.
        fn circle(self, radius_m: f32, parts: u32, side: f32) -> Self {
            let by_rad = TAU / parts as f32;
            (0..parts).fold(self, |pen, _| pen.lane(radius_m * by_rad, side * by_rad))
        }

        /// So many lanes in a line, with a kink behind each.
        fn polygon(self, corners: u32, side_m: f32) -> Self {
            (0..corners).fold(self, |pen, _| pen.lane(side_m, 0.0).turn(TAU / corners as f32))
        }

        /// The last lane leads to the first one.
        fn closed(mut self) -> Vec<Lane> {
            if let Some(last) = self.lanes.last_mut() {
                last.successors = vec![0];
            }
            self.lanes
        }

        /// The last lane leads nowhere.
        fn open(mut self) -> Vec<Lane> {
            if let Some(last) = self.lanes.last_mut() {
                last.successors.clear();
            }
            self.lanes
        }
    }

    fn pen() -> Pen {
        Pen::on_circle(20.0, 0.0)
    }

    fn lanes_of(found: &[Circle]) -> Vec<&[LaneId]> {
        found.iter().map(|circle| circle.lanes.as_slice()).collect()
    }

    #[test]
    fn finds_a_circle_and_how_long_it_is() {
        for (radius_m, parts, side) in
            [(8.0, 3, 1.0), (20.0, 8, 1.0), (20.0, 8, -1.0), (48.0, 40, -1.0), (20.0, 1, 1.0)]
        {
            let found = circles(&pen().circle(radius_m, parts, side).closed());
            let round: Vec<LaneId> = (0..parts).collect();
            assert_eq!(lanes_of(&found), [round], "{radius_m} m, {parts} lanes");
            let error_m = found[0].length_m - TAU * radius_m;
            assert!(error_m.abs() < 1e-3 * radius_m, "{radius_m} m: {error_m}");
        }
    }

    #[test]
    fn finds_a_circle_that_roads_lead_out_of_and_into() {
        let mut lanes = pen().circle(20.0, 8, 1.0).closed();
        for at in [1, 3, 5, 7] {
            // Every second lane is inside a junction, from whose start a road leads away.
            lanes[at].junction = Some(0);
            let (end, id) = (*lanes[at - 1].end(), lanes.len() as LaneId);
            let away = Pen { position: end.position.truncate(), heading_rad: end.heading_rad, lanes: Vec::new() };
            lanes.extend(away.lane(30.0, -1.0).open());
            lanes[at - 1].successors.insert(0, id);
            lanes[id as usize].predecessors = vec![at as LaneId - 1];
        }
        assert_eq!(lanes_of(&circles(&lanes)), [[0, 1, 2, 3, 4, 5, 6, 7]]);
    }

    #[test]
    fn finds_a_circle_of_straight_lanes() {
        let found = circles(&pen().polygon(12, 8.0).closed());
        assert_eq!((found.len(), found[0].lanes.len(), found[0].length_m), (1, 12, 96.0));
    }

    #[test]
    fn finds_the_circle_of_a_file() {
        for (radius_m, arms, left_hand) in [(10.0, 3, true), (15.0, 5, false), (25.0, 4, false), (35.0, 6, true)] {
            let roundabout = Roundabout { radius_m, arms, left_hand, ..Roundabout::default() };
            assert!(roundabout.is_drivable(), "{roundabout}");
            let map = bake("roundabout", &roundabout.open_drive()).expect("it bakes");
            let found = circles(&map.lanes);
            let lanes: Vec<usize> = found.iter().map(|circle| circle.lanes.len()).collect();
            assert_eq!(lanes, [2 * arms as usize], "{roundabout}");
            assert!((found[0].length_m - TAU * radius_m as f32).abs() < 0.1, "{roundabout}: {}", found[0].length_m);
        }
    }

    #[test]
    fn takes_no_block_of_streets_for_one() {
        for side_m in [16.0, 25.0, 40.0, 100.0] {
            assert_eq!(circles(&pen().polygon(4, side_m).closed()), [], "{side_m} m, sharp corners");
            let rounded = (0..4).fold(pen(), |pen, _| pen.lane(side_m, 0.0).lane(5.0, TAU / 4.0));
            assert_eq!(circles(&rounded.closed()), [], "{side_m} m, round corners");
        }
    }

    #[test]
    fn takes_no_ring_road_for_one() {
        for radius_m in [52.0, 80.0, 300.0] {
            assert_eq!(circles(&pen().circle(radius_m, 16, 1.0).closed()), [], "{radius_m} m");
        }
    }

    #[test]
    fn takes_nothing_for_one_that_does_not_come_back_or_not_after_one_turn() {
        let spiral = (0..24).fold(pen(), |pen, k| pen.lane(5.0 + 0.5 * k as f32, TAU / 8.0));
        assert_eq!(circles(&spiral.open()), [], "a spiral");
        let u_turn = pen().lane(25.0, 0.0).lane(16.0, TAU / 2.0).lane(25.0, 0.0);
        assert_eq!(circles(&u_turn.open()), [], "there and back");
        let two = (0..2).fold(pen(), |pen, _| pen.lane(25.0, 0.0).lane(16.0, TAU / 2.0));
        assert_eq!(circles(&two.closed()), [], "there and back, again and again");
        let twice = pen().circle(10.0, 8, 1.0).circle(10.0, 8, 1.0);
        assert_eq!(circles(&twice.closed()), [], "two turns");
        let eight = pen().circle(10.0, 8, 1.0).circle(10.0, 8, -1.0);
        assert_eq!(circles(&eight.closed()), [], "one turn to each side");
    }

    #[test]
    fn takes_neither_a_cycle_way_nor_a_junction_for_one() {
        for change in [|lane: &mut Lane| lane.kind = LaneKind::Biking, |lane: &mut Lane| lane.junction = Some(0)] {
            let mut lanes = pen().circle(20.0, 8, 1.0).closed();
            lanes.iter_mut().for_each(change);
            assert_eq!(circles(&lanes), []);
        }
    }

    #[test]
    fn takes_no_two_way_street_round_a_plaza_for_two() {
        let mut lanes = pen().circle(20.0, 8, 1.0).closed();
        let position = Vec2::new(23.5, 0.0);
        let outside = Pen { position, heading_rad: -TAU / 4.0, lanes: Vec::new() }.circle(23.5, 8, -1.0).closed();
        assert_eq!(circles(&outside).len(), 1);
        lanes.extend(outside.into_iter().map(|lane| {
            let successors = lane.successors.iter().map(|next| next + 8).collect();
            Lane { successors, ..lane }
        }));
        assert_eq!(circles(&lanes), []);
    }

    #[test]
    fn a_lane_is_on_one_circle_at_most() {
        // Two ways for the first eighth.
        let mut lanes = pen().circle(20.0, 8, 1.0).closed();
        let beside = Lane { successors: vec![1], ..lanes[0].clone() };
        lanes.push(beside);
        lanes[7].successors = vec![0, 8];
        assert_eq!(lanes_of(&circles(&lanes)), [[0, 1, 2, 3, 4, 5, 6, 7]]);
    }

    /// Each lane leads to both of the next row: 2^40 ways lead through as many rows.
    #[test]
    fn a_web_of_short_lanes_ends() {
        let mut lanes: Vec<Lane> = Vec::new();
        for row in 0..1000 {
            for _ in 0..2 {
                let straight = pen().lane(0.4, 0.0).lanes.remove(0);
                lanes.push(Lane { successors: vec![2 * row + 2, 2 * row + 3], ..straight });
            }
        }
        lanes.iter_mut().rev().take(2).for_each(|lane| lane.successors.clear());
        assert_eq!(circles(&lanes), []);
    }
}
