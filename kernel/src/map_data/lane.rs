//! Lanes, and places on them.

use std::ops::Range;

use glam::Vec3;

use super::digest::{Digested, digested, digested_codes};
use super::ids::{LaneId, LightGroupId};
use super::place::Place;
use crate::{ops, state_enum};

/// Limit where a file gives none, on roads of no or an urban type: 50 km/h.
pub(crate) const URBAN_MPS: f32 = 50.0 / 3.6;

state_enum! {
    /// What a lane is for.
    pub enum LaneKind {
        /// Motor traffic.
        Driving = 0,
        /// Bicycles only.
        Biking = 1,
        /// Pedestrians, raised by a kerb.
        Sidewalk = 2,
        /// Paved edge of a road, not driven on.
        Shoulder = 3,
        /// Parked cars.
        Parking = 4,
        /// Anything else: medians, borders, restricted areas.
        Other = 5,
    }
}

state_enum! {
    /// Which way a lane leads through a junction.
    pub enum Turn {
        /// Straight on, or no junction.
        Straight = 0,
        /// To the left.
        Left = 1,
        /// To the right.
        Right = 2,
    }
}

digested_codes!(LaneKind Turn);

digested! {
    /// One vertex of a lane's centre line.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct LanePoint {
        /// Position on the surface, metres.
        pub position: Vec3,
        /// Direction of travel, radians counter-clockwise from east.
        pub heading_rad: f32,
        /// Half of the lane's width, metres.
        pub half_width_m: f32,
        /// Distance along the centre line from its start, metres.
        pub s_m: f32,
    }
}

/// What makes a vehicle stop at the end of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopKind {
    /// A traffic light.
    Light(LightGroupId),
    /// A stop sign: halt, then give way.
    Stop,
    /// A yield sign, or a junction without signs: give way.
    Yield,
}

/// A stop line across a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopLine {
    /// Where on the lane's centre line, metres from its start.
    pub s_m: f32,
    /// Why to stop there.
    pub kind: StopKind,
}

impl Digested for Option<StopLine> {
    fn digest(&self, out: &mut Vec<u8>) {
        let (kind, group, s_m): (u32, u32, f32) = match *self {
            None => (0, 0, 0.0),
            Some(StopLine { s_m, kind: StopKind::Light(group) }) => (1, group, s_m),
            Some(StopLine { s_m, kind: StopKind::Stop }) => (2, 0, s_m),
            Some(StopLine { s_m, kind: StopKind::Yield }) => (3, 0, s_m),
        };
        ((kind, group), s_m).digest(out);
    }
}

digested! {
    /// Where another lane's area overlaps this one inside a junction.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Conflict {
        /// The other lane.
        pub lane: LaneId,
        /// Stretch of this lane that overlaps, metres from its start.
        pub from_m: f32,
        /// End of that stretch.
        pub to_m: f32,
        /// Whether traffic on the other lane goes first when no light says otherwise.
        pub other_first: bool,
    }
}

digested! {
    /// A lane in its direction of travel.
    #[derive(Clone, Debug)]
    pub struct Lane {
        /// What it is for.
        pub kind: LaneKind,
        /// OpenDRIVE ids of its road and lane, as in `"12/-1"`.
        pub name: String,
        /// Centre line in the direction of travel, at least two points, at most 2 m apart.
        pub points: Vec<LanePoint>,
        /// Length of the centre line in metres.
        pub length_m: f32,
        /// Lanes that follow.
        pub successors: Vec<LaneId>,
        /// Lanes that lead here.
        pub predecessors: Vec<LaneId>,
        /// Neighbour in the same direction to the left, where a change is possible.
        pub left: Option<LaneId>,
        /// Neighbour in the same direction to the right, where a change is possible.
        pub right: Option<LaneId>,
        /// Speed limit in m/s.
        pub speed_limit_mps: f32,
        /// Index in [`MapData::junctions`](super::MapData::junctions) when it crosses one.
        pub junction: Option<u32>,
        /// Which way it leads through that junction.
        pub turn: Turn,
        /// Stop line on it, if any (on the lane before the junction).
        pub stop: Option<StopLine>,
        /// Light that holds those who take this lane through a junction at the line before it, where that is another than
        /// the one of the line: an arrow.
        pub light: Option<LightGroupId>,
        /// Lanes of the same junction that overlap it.
        pub conflicts: Vec<Conflict>,
    }
}

/// A place told relative to a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The lane.
    pub lane: LaneId,
    /// Nearest place on its centre line, metres from its start, within the lane's length.
    pub s_m: f32,
    /// Offset from the centre line in metres, positive to the left of the direction of travel.
    pub lateral_m: f32,
    /// Horizontal distance to that nearest place in metres (more than `lateral_m` beyond the ends).
    pub distance_m: f32,
}

impl Projection {
    /// Where `position` is relative to a lane.
    pub fn onto(id: LaneId, lane: &Lane, position: Vec3) -> Self {
        let (s_m, lateral_m, distance_m) = lane.project(position);
        Self { lane: id, s_m, lateral_m, distance_m }
    }
}

impl LanePoint {
    /// The point at `share` of the way to another.
    pub(crate) fn towards(&self, next: &Self, share: f32) -> Self {
        let lerp = |x: f32, y: f32| x + (y - x) * share;
        let turn = ops::wrap_angle(next.heading_rad - self.heading_rad);
        Self {
            position: self.position + (next.position - self.position) * share,
            heading_rad: ops::wrap_angle(self.heading_rad + turn * share),
            half_width_m: lerp(self.half_width_m, next.half_width_m),
            s_m: lerp(self.s_m, next.s_m),
        }
    }
}

impl Default for Lane {
    /// A lane of nothing, to be filled in.
    fn default() -> Self {
        Self {
            kind: LaneKind::Other,
            name: String::new(),
            points: Vec::new(),
            length_m: 0.0,
            successors: Vec::new(),
            predecessors: Vec::new(),
            left: None,
            right: None,
            speed_limit_mps: URBAN_MPS,
            junction: None,
            turn: Turn::Straight,
            stop: None,
            light: None,
            conflicts: Vec::new(),
        }
    }
}

impl Lane {
    /// Its last vertex.
    pub fn end(&self) -> &LanePoint {
        &self.points[self.points.len() - 1]
    }

    /// Its first vertex.
    pub fn start(&self) -> &LanePoint {
        &self.points[0]
    }

    /// Index of the vertex before `s_m`, and the share of the way from it to the next one; beyond
    /// [0, 1] outside the lane. Every place on a lane is found with this.
    pub fn segment(&self, s_m: f32) -> (usize, f32) {
        let points = &self.points;
        let last = points.len() - 2;
        let guess = ((s_m / self.length_m * (last + 1) as f32) as usize).min(last);
        // Most vertices are evenly spaced, so that the guess is right or one off.
        let is_it = |i: &usize| (*i == 0 || points[*i].s_m <= s_m) && (*i == last || points[*i + 1].s_m > s_m);
        let near = [guess, guess + 1, guess.saturating_sub(1)].into_iter().filter(|i| *i <= last).find(is_it);
        let i = near.unwrap_or_else(|| points[..=last].partition_point(|p| p.s_m <= s_m).saturating_sub(1));
        // Vertices of a baked lane are 0.05 m apart or more.
        let span = (points[i + 1].s_m - points[i].s_m).max(1e-3);
        (i, (s_m - points[i].s_m) / span)
    }

    /// The point `s_m` from its start, interpolated; before the start the first one, beyond the end
    /// the last one.
    pub fn at(&self, s_m: f32) -> LanePoint {
        let (i, share) = self.segment(s_m);
        self.points[i].towards(&self.points[i + 1], share.clamp(0.0, 1.0))
    }

    /// The place `s_m` from its start, facing along its centre line; beyond its ends the lane goes
    /// straight on.
    pub fn straight_on(&self, s_m: f32) -> Place {
        let along = |i: usize, _| (self.points[i + 1].position - self.points[i].position).normalize_or(Vec3::X);
        self.straight_on_facing(s_m, along)
    }

    /// The same place, facing as `forward` says of a segment and the share of the way along it.
    pub fn straight_on_facing(&self, s_m: f32, forward: impl FnOnce(usize, f32) -> Vec3) -> Place {
        let (i, share) = self.segment(s_m);
        let (a, b) = (&self.points[i], &self.points[i + 1]);
        Place {
            position: a.position + (b.position - a.position) * share,
            forward: forward(i, share),
            half_width_m: a.half_width_m + (b.half_width_m - a.half_width_m) * share.clamp(0.0, 1.0),
        }
    }

    /// The nearest place of its centre line seen from above: (s, offset to the left, distance).
    pub fn project(&self, position: Vec3) -> (f32, f32, f32) {
        self.project_onto(std::iter::once(0..self.points.len() - 1), position)
    }

    /// The same, of the stretch within `reach_m` of a place on it alone.
    pub fn project_near(&self, position: Vec3, s_m: f32, reach_m: f32) -> (f32, f32, f32) {
        let [first, last] = [s_m - reach_m, s_m + reach_m].map(|s_m| self.segment(s_m).0);
        self.project_onto(std::iter::once(first..last + 1), position)
    }

    /// The same, of the segments in some ranges only.
    pub(crate) fn project_onto(&self, segments: impl Iterator<Item = Range<usize>>, position: Vec3) -> (f32, f32, f32) {
        let p = position.truncate();
        let mut best = (0.0, 0.0, f32::MAX);
        for pair in segments.flat_map(|range| self.points[range.start..=range.end].windows(2)) {
            let (a, along) = (pair[0].position.truncate(), (pair[1].position - pair[0].position).truncate());
            let share = ((p - a).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
            let off = p - (a + along * share);
            let squared = off.length_squared();
            if squared < best.2 {
                let s = pair[0].s_m + (pair[1].s_m - pair[0].s_m) * share;
                best = (s, along.perp_dot(off) / along.length().max(1e-6), squared);
            }
        }
        (best.0, best.1, ops::sqrt(best.2))
    }
}
