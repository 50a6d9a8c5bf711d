//! What traffic looks up of a lane, made once: curve speeds, what follows, where it conflicts and meets others.

use glam::Vec3;

use crate::map_data::{Conflict, Lane, LaneId, LaneKind, LanePoint, MapData, Place, Turn};
use crate::ops;
use crate::places::Places;

use super::bends::{Bend, bends};
use super::links::{LEAST_HALF_M, Onward, ends_beside, onward};
use super::meets::{Meet, meets};
use super::zones::zones;

/// Sideways acceleration that drivers accept in curves, m/s² (comfort limit of road design).
const CURVE_ACCEL_MPS2: f32 = 2.0;
/// Braking before curves, m/s².
const CURVE_BRAKE_MPS2: f32 = 1.8;
/// Nobody drives slower than this because of a curve, m/s.
const CURVE_FLOOR_MPS: f32 = 2.5;
/// Lanes whose middles are nearer than this leave a long vehicle that turns no room beside who waits there, metres.
const NARROW_M: f32 = 3.1;
/// On a shorter way the tails of those who wait farther back would stand in the junction before it, metres.
const STRETCH_M: f32 = 40.0;
/// Long vehicles sweep into lanes whose middles come within this, metres.
const SWEPT_M: f32 = 5.0;

/// How two lanes of a junction conflict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ConflictKind {
    /// They leave the same lane.
    Diverge,
    /// They enter the same lane.
    Merge,
    /// They cross.
    Cross,
}

/// A conflict seen from one lane, with the other lane's side of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneConflict {
    pub lane: LaneId,
    pub kind: ConflictKind,
    /// Stretch of this lane, metres.
    pub here: [f32; 2],
    /// Stretch of the other lane, metres.
    pub there: [f32; 2],
    /// 1 when traffic here goes first, -1 when the other does, 0 when neither has a right.
    pub precedence: i8,
}

/// A crosswalk on a lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct CrosswalkSpan {
    pub crosswalk: u32,
    /// Its near edge, metres from the lane's start.
    pub near_m: f32,
    /// Its far edge.
    pub far_m: f32,
}

#[derive(Clone, Debug, Default)]
pub(super) struct LaneWay {
    /// Highest speed at each point: curves, and braking for those ahead on the lane. m/s.
    pub speed_mps: Vec<f32>,
    /// Direction of travel from each point to the next.
    pub forward: Vec<Vec3>,
    /// Where vehicles go on.
    pub onward: Vec<Onward>,
    /// Where long vehicles do: no turns to the kerb, where there is another way, but out of roundabouts.
    pub onward_wide: Vec<Onward>,
    /// Where it is wide enough no more, if it ends beside another lane, metres from its start.
    pub ends_m: Option<f32>,
    /// Lanes of the same junction that overlap it.
    pub conflicts: Vec<LaneConflict>,
    /// Lanes of the same junction beside it, into which a long vehicle sweeps.
    pub swept: Vec<LaneId>,
    /// Whether who waits at its end stands in the way of long vehicles that turn into the street.
    pub narrow: bool,
    /// Lanes that it meets outside junctions.
    pub meets: Vec<Meet>,
    /// Bends that begin on it.
    pub bends: Vec<Bend>,
    /// Its zone: junctions without room to wait between them are one.
    pub zone: Option<u32>,
    /// Its roundabout, an index of [`Ways::roundabouts`](super::ways::Ways).
    pub circle: Option<u32>,
    /// Crosswalks on it, in the direction of travel.
    pub crosswalks: Vec<CrosswalkSpan>,
}

impl LaneWay {
    /// Like [`Lane::straight_on`], the direction turning smoothly between the points.
    pub fn pose(&self, lane: &Lane, s_m: f32) -> Place {
        lane.straight_on_facing(s_m, |i, share| {
            let here = self.forward[i];
            if share < 0.5 && i > 0 {
                self.forward[i - 1].lerp(here, (share + 0.5).max(0.0)).normalize_or(here)
            } else if share > 0.5 && i + 1 < self.forward.len() {
                here.lerp(self.forward[i + 1], (share - 0.5).min(0.5)).normalize_or(here)
            } else {
                here
            }
        })
    }

    /// The highest speed at `s_m`, interpolated between the points. m/s.
    pub fn curve_speed(&self, lane: &Lane, s_m: f32) -> f32 {
        let (i, t) = lane.segment(s_m);
        let (a, b) = (self.speed_mps[i], self.speed_mps[i + 1]);
        a + (b - a) * t.clamp(0.0, 1.0)
    }
}

/// `circle` tells for each lane the roundabout that it is part of.
pub(super) fn lane_ways(places: &Places, kerb: i8, circle: Vec<Option<u32>>) -> Vec<LaneWay> {
    let map = &*places.map;
    let onward = onward(places, kerb, &circle);
    let (meets, zones) = (meets(places, &onward), zones(map, &circle));
    let ways = onward.into_iter().zip(meets).zip(zones).zip(circle).enumerate();
    let way = |(id, (((onward, meets), zone), circle))| LaneWay {
        meets,
        zone,
        circle,
        ..lane_way(places, id as LaneId, onward)
    };
    let mut ways = ways.map(way).collect::<Vec<_>>();
    let place = |lane: LaneId, s_m: f32| ways[lane as usize].pose(&map.lanes[lane as usize], s_m).position;
    let bends = bends(places, place);
    ways.iter_mut().zip(bends).for_each(|(way, bends)| way.bends = bends);
    ways
}

fn lane_way(places: &Places, id: LaneId, [onward, onward_wide]: [Vec<Onward>; 2]) -> LaneWay {
    let map = &*places.map;
    let lane = &map.lanes[id as usize];
    let mut speed_mps = curve_speeds(lane);
    for i in (0..speed_mps.len().saturating_sub(1)).rev() {
        let ds = lane.points[i + 1].s_m - lane.points[i].s_m;
        let reachable = ops::sqrt(speed_mps[i + 1] * speed_mps[i + 1] + 2.0 * CURVE_BRAKE_MPS2 * ds.max(0.0));
        speed_mps[i] = speed_mps[i].min(reachable);
    }
    let (swept, narrow) = (swept(places, id), is_narrow(map, lane));
    let conflicts = lane.conflicts.iter().filter_map(|c| lane_conflict(map, id, c)).collect();
    let forward = directions(lane.points.iter().map(|p| p.position));
    let ends_m = ends_beside(lane, &onward).then(|| wide_up_to_m(lane));
    LaneWay { speed_mps, forward, onward, onward_wide, ends_m, conflicts, swept, narrow, ..LaneWay::default() }
}

/// Where a lane becomes too narrow to drive on to its end, metres from its start.
fn wide_up_to_m(lane: &Lane) -> f32 {
    let narrow = lane.points.iter().rev().take_while(|p| p.half_width_m < LEAST_HALF_M).last();
    narrow.map_or(lane.length_m, |p| p.s_m)
}

/// Speed at which the curve through each point asks for [`CURVE_ACCEL_MPS2`]; curvature is taken
/// over 3 m each way, so that single bends of the baked line do not count.
fn curve_speeds(lane: &Lane) -> Vec<f32> {
    let heading = |s: f32| {
        let forward = lane.straight_on(s.clamp(0.0, lane.length_m)).forward;
        ops::atan2(forward.y, forward.x)
    };
    let at = |s: f32| {
        let (from, to) = ((s - 3.0).max(0.0), (s + 3.0).min(lane.length_m));
        let turned = ops::wrap_angle(heading(to) - heading(from)).abs();
        let curvature = turned / (to - from).max(3.0);
        ops::sqrt(CURVE_ACCEL_MPS2 / curvature.max(1e-4)).max(CURVE_FLOOR_MPS)
    };
    lane.points.iter().map(|p| at(p.s_m)).collect()
}

fn lane_conflict(map: &MapData, id: LaneId, conflict: &Conflict) -> Option<LaneConflict> {
    let lane = &map.lanes[id as usize];
    let other = &map.lanes[conflict.lane as usize];
    let mirrored = other.conflicts.iter().find(|c| c.lane == id);
    let shares = |a: &[LaneId], b: &[LaneId]| a.iter().any(|x| b.contains(x));
    let kind = if shares(&lane.successors, &other.successors) {
        ConflictKind::Merge
    } else if shares(&lane.predecessors, &other.predecessors) {
        ConflictKind::Diverge
    } else {
        ConflictKind::Cross
    };
    let there = mirrored.map_or([0.0, other.length_m], |c| [c.from_m, c.to_m]);
    let gives_way = mirrored.is_some_and(|c| c.other_first);
    let precedence = i8::from(gives_way) - i8::from(conflict.other_first);
    (other.kind == LaneKind::Driving).then_some(LaneConflict {
        lane: conflict.lane,
        kind,
        here: [conflict.from_m, conflict.to_m],
        there,
        precedence,
    })
}

/// Lanes of its junction that come near a lane without a conflict, where the way of one of them bends.
fn swept(places: &Places, id: LaneId) -> Vec<LaneId> {
    let lanes = &places.map.lanes;
    let lane = &lanes[id as usize];
    if lane.junction.is_none() || lane.kind != LaneKind::Driving {
        return Vec::new();
    }
    let shares = |a: &[LaneId], b: &[LaneId]| a.iter().any(|x| b.contains(x));
    let beside = |o: LaneId| {
        let other = &lanes[o as usize];
        let bends = lane.turn != Turn::Straight || other.turn != Turn::Straight;
        let together = shares(&lane.predecessors, &other.predecessors) || lane.conflicts.iter().any(|c| c.lane == o);
        let chained = lane.successors.contains(&o) || other.successors.contains(&id);
        o != id && other.junction == lane.junction && bends && !together && !chained
    };
    let near = |p: &LanePoint| places.roads().around(p.position, LaneKind::Driving, SWEPT_M);
    let near = lane.points.iter().flat_map(near).filter(|p| p.distance_m < SWEPT_M && beside(p.lane));
    let mut found: Vec<LaneId> = near.map(|p| p.lane).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// Whether one turns out of the junction ahead right beside the end of a lane, in the other direction.
fn is_narrow(map: &MapData, lane: &Lane) -> bool {
    let Some(end) = lane.points.last().filter(|_| lane.junction.is_none() && has_room_to_wait(map, lane)) else {
        return false;
    };
    let junction = lane.successors.iter().find_map(|next| map.lanes[*next as usize].junction);
    let inside = junction.map_or(&[][..], |junction| &map.junctions[junction as usize].lanes);
    let turns = inside.iter().map(|id| &map.lanes[*id as usize]).filter(|inside| inside.turn != Turn::Straight);
    let beside = |out: LaneId| {
        let out = &map.lanes[out as usize].points[0];
        let opposite = ops::cos(out.heading_rad - end.heading_rad) < -0.5;
        opposite && out.position.distance(end.position) < NARROW_M
    };
    turns.flat_map(|turn| &turn.successors).any(|out| beside(*out))
}

/// Whether the way from the junction before a lane to its end is long enough for those who wait farther back.
fn has_room_to_wait(map: &MapData, lane: &Lane) -> bool {
    let (mut lane, mut length_m) = (lane, lane.length_m);
    while let [before] = lane.predecessors[..] {
        lane = &map.lanes[before as usize];
        if length_m > STRETCH_M || lane.junction.is_some() {
            break;
        }
        length_m += lane.length_m;
    }
    length_m > STRETCH_M
}

/// Directions from each point to the next.
pub(super) fn directions(points: impl Iterator<Item = Vec3> + Clone) -> Vec<Vec3> {
    points.clone().zip(points.skip(1)).map(|(a, b)| (b - a).normalize_or(Vec3::X)).collect()
}
