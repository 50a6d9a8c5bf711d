//! Junctions: their lanes, which way these turn, and where they overlap.

use std::collections::BTreeMap;

use glam::Vec3;

use super::rounding::snap3;
use super::source::Source;
use crate::map_data::{Conflict, Junction, Lane, LaneId, LaneKind, LanePoint, Turn};
use crate::ops;
use crate::places::{LaneGrid, Roads};

/// Turning by less than this is going straight on.
const STRAIGHT_RAD: f32 = 0.5;
/// Lanes overlap where their centre lines are nearer than the half widths together, less this.
const CLEARANCE_M: f32 = 0.6;
/// Where overlap is looked for along a lane.
const PROBE_M: f32 = 0.5;
/// Lanes farther apart in height pass over each other.
const LEVEL_M: f32 = 3.0;

/// Finds the junctions; of their lanes which way they turn, their limits, and where they overlap.
pub(super) fn bake(source: &Source, mut lanes: Vec<Lane>, grid: &LaneGrid) -> (Vec<Lane>, Vec<Junction>) {
    let mut junctions: Vec<Junction> = Vec::new();
    let mut by_name: BTreeMap<&str, u32> = BTreeMap::new();
    for (id, lane) in lanes.iter_mut().enumerate() {
        let road = source.net.road(xodr::RoadId(source.origins[id].road));
        let Some(name) = road.and_then(|r| r.junction()) else { continue };
        let junction = *by_name.entry(name).or_insert_with(|| {
            junctions.push(Junction { name: name.to_owned(), ..Junction::default() });
            junctions.len() as u32 - 1
        });
        lane.junction = Some(junction);
        if lane.kind == LaneKind::Driving {
            lane.turn = turn(lane);
            junctions[junction as usize].lanes.push(id as LaneId);
        }
    }
    for junction in &mut junctions {
        junction.center = center(&junction.lanes, &lanes);
    }
    inherit_limits(&mut lanes);
    for junction in &junctions {
        let found: Vec<_> = junction.lanes.iter().map(|&id| overlaps(&grid.over(&lanes), id)).collect();
        for (&id, conflicts) in junction.lanes.iter().zip(found) {
            lanes[id as usize].conflicts = conflicts;
        }
    }
    (lanes, junctions)
}

fn turn(lane: &Lane) -> Turn {
    // Summed over the lane, so that more than half a turn keeps its side.
    let bend: f32 = lane.points.windows(2).map(|p| ops::wrap_angle(p[1].heading_rad - p[0].heading_rad)).sum();
    match bend {
        b if b > STRAIGHT_RAD => Turn::Left,
        b if b < -STRAIGHT_RAD => Turn::Right,
        _ => Turn::Straight,
    }
}

fn center(ids: &[LaneId], lanes: &[Lane]) -> Vec3 {
    let middles: Vec<Vec3> =
        ids.iter().map(|&id| lanes[id as usize].at(lanes[id as usize].length_m / 2.0).position).collect();
    snap3(middles.iter().sum::<Vec3>() / middles.len().max(1) as f32)
}

/// Files seldom give limits inside junctions: there the limit of the lane before holds.
fn inherit_limits(lanes: &mut [Lane]) {
    for id in 0..lanes.len() {
        let before = lanes[id].predecessors.iter().map(|&p| lanes[p as usize].speed_limit_mps);
        let before = before.fold(f32::MAX, f32::min);
        if lanes[id].junction.is_some() && before < f32::MAX {
            lanes[id].speed_limit_mps = before;
        }
    }
}

/// The lanes of the same junction within whose width a lane lies, and where.
fn overlaps(roads: &Roads<'_>, id: LaneId) -> Vec<Conflict> {
    let lane = &roads.lanes[id as usize];
    let mut stretches: BTreeMap<LaneId, (f32, f32)> = BTreeMap::new();
    let steps = (lane.length_m / PROBE_M) as u32 + 1;
    for k in 0..=steps {
        let s = (k as f32 * PROBE_M).min(lane.length_m);
        let here = lane.at(s);
        for near in roads.around(here.position, LaneKind::Driving, here.half_width_m) {
            let other = &roads.lanes[near.lane as usize];
            let competes = near.lane != id && other.junction == lane.junction && !same_start(lane, other);
            if competes && overlap(&here, &other.at(near.s_m), near.distance_m) {
                stretches.entry(near.lane).or_insert((s, s)).1 = s;
            }
        }
    }
    let conflict = |(lane, (from_m, to_m))| Conflict { lane, from_m, to_m, other_first: false };
    stretches.into_iter().map(conflict).collect()
}

/// Whether two places on lanes lie within the width of both.
fn overlap(here: &LanePoint, there: &LanePoint, distance_m: f32) -> bool {
    let near = here.half_width_m + there.half_width_m - CLEARANCE_M;
    distance_m < near && (here.position.z - there.position.z).abs() < LEVEL_M
}

/// Lanes that fan out of one lane do not compete: who follows whom is settled before.
fn same_start(a: &Lane, b: &Lane) -> bool {
    a.predecessors.iter().any(|p| b.predecessors.contains(p))
}
