//! Junctions: their lanes, which way these turn, and where they overlap.

use std::collections::BTreeMap;

use glam::Vec3;

use super::rounding::snap3;
use super::source::Source;
use crate::map_data::{Conflict, Junction, Lane, LaneId, LaneKind, Turn};
use crate::ops;

/// Turning by less than this is going straight on.
const STRAIGHT_RAD: f32 = 0.5;
/// Lanes overlap where their centre lines are nearer than the half widths together, less this.
const CLEARANCE_M: f32 = 0.6;
/// Where overlap is looked for along a lane.
const PROBE_M: f32 = 0.5;
/// Lanes farther apart in height pass over each other.
const LEVEL_M: f32 = 3.0;

/// Finds the junctions; of their lanes which way they turn, their limits, and where they overlap.
pub(super) fn bake(source: &Source, mut lanes: Vec<Lane>) -> (Vec<Lane>, Vec<Junction>) {
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
    overlaps(&mut lanes, &junctions);
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

fn overlaps(lanes: &mut [Lane], junctions: &[Junction]) {
    for junction in junctions {
        for &a in &junction.lanes {
            for &b in &junction.lanes {
                let (one, other) = (&lanes[a as usize], &lanes[b as usize]);
                if a == b || same_start(one, other) {
                    continue;
                }
                if let Some((from_m, to_m)) = overlap(one, other) {
                    lanes[a as usize].conflicts.push(Conflict { lane: b, from_m, to_m, other_first: false });
                }
            }
        }
    }
}

/// Lanes that fan out of one lane do not compete: who follows whom is settled before.
fn same_start(a: &Lane, b: &Lane) -> bool {
    a.predecessors.iter().any(|p| b.predecessors.contains(p))
}

/// The stretch of `lane` that lies within the width of `other`.
fn overlap(lane: &Lane, other: &Lane) -> Option<(f32, f32)> {
    let mut stretch: Option<(f32, f32)> = None;
    let steps = (lane.length_m / PROBE_M) as u32 + 1;
    for k in 0..=steps {
        let s = (k as f32 * PROBE_M).min(lane.length_m);
        let here = lane.at(s);
        let (at, _, distance) = other.project(here.position);
        let there = other.at(at);
        let near = here.half_width_m + there.half_width_m - CLEARANCE_M;
        if distance < near && (here.position.z - there.position.z).abs() < LEVEL_M {
            stretch = Some(stretch.map_or((s, s), |(from, _)| (from, s)));
        }
    }
    stretch
}
