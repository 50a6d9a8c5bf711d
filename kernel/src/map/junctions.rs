//! Junctions: their lanes, which way these turn, where they overlap, and who goes first.

use std::collections::BTreeMap;

use glam::Vec3;

use super::bake::{Approach, Source, direction, snap3};
use super::{Conflict, Junction, Lane, LaneId, LaneKind, RoadNetwork, StopKind, StopLine, Turn};
use crate::ops;

/// Turning by less than this is going straight on.
const STRAIGHT_RAD: f32 = 0.5;
/// Lanes overlap where their centre lines are nearer than the half widths together, less this.
const CLEARANCE_M: f32 = 0.6;
/// Where overlap is looked for along a lane.
const PROBE_M: f32 = 0.5;
/// Lanes farther apart in height pass over each other.
const LEVEL_M: f32 = 3.0;

/// Finds junctions and their lanes, and the overlaps of these.
pub(super) fn bake(source: &Source, map: &mut RoadNetwork) {
    let mut by_name: BTreeMap<&str, u32> = BTreeMap::new();
    for id in 0..map.lanes.len() {
        let road = source.net.road(xodr::RoadId(source.origins[id].road));
        let Some(name) = road.and_then(|r| r.junction()) else { continue };
        let junction = *by_name.entry(name).or_insert_with(|| {
            map.junctions.push(Junction { name: name.to_owned(), ..Junction::default() });
            map.junctions.len() as u32 - 1
        });
        let lane = &mut map.lanes[id];
        lane.junction = Some(junction);
        if lane.kind == LaneKind::Driving {
            lane.turn = turn(lane);
            map.junctions[junction as usize].lanes.push(id as LaneId);
        }
    }
    for junction in &mut map.junctions {
        junction.center = center(&junction.lanes, &map.lanes);
    }
    inherit_limits(map);
    overlaps(map);
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
fn inherit_limits(map: &mut RoadNetwork) {
    for id in 0..map.lanes.len() {
        let before = map.lanes[id].predecessors.iter().map(|&p| map.lanes[p as usize].speed_limit_mps);
        let before = before.fold(f32::MAX, f32::min);
        if map.lanes[id].junction.is_some() && before < f32::MAX {
            map.lanes[id].speed_limit_mps = before;
        }
    }
}

fn overlaps(map: &mut RoadNetwork) {
    for j in 0..map.junctions.len() {
        let ids = map.junctions[j].lanes.clone();
        for &a in &ids {
            for &b in &ids {
                let (one, other) = (&map.lanes[a as usize], &map.lanes[b as usize]);
                if a == b || same_start(one, other) {
                    continue;
                }
                if let Some((from_m, to_m)) = overlap(one, other) {
                    map.lanes[a as usize].conflicts.push(Conflict { lane: b, from_m, to_m, other_first: false });
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

/// Decides who goes first at every overlap, and adds the stop lines of those who wait without a sign.
pub(super) fn rank(source: &Source, map: &mut RoadNetwork) {
    for a in 0..map.lanes.len() as LaneId {
        for k in 0..map.lanes[a as usize].conflicts.len() {
            let b = map.lanes[a as usize].conflicts[k].lane;
            map.lanes[a as usize].conflicts[k].other_first = gives_way(source, map, a, b);
        }
    }
    for before in 0..map.lanes.len() {
        let lane = &map.lanes[before];
        let waits = |next: &LaneId| map.lanes[*next as usize].conflicts.iter().any(|c| c.other_first);
        if lane.kind == LaneKind::Driving
            && lane.stop.is_none()
            && lane.junction.is_none()
            && lane.successors.iter().any(waits)
        {
            let s_m = super::lights::stop_place(map, before as LaneId);
            map.lanes[before].stop = Some(StopLine { s_m, kind: StopKind::Yield });
        }
    }
}

/// Whether traffic on junction lane `a` waits for traffic on `b`; never true both ways.
fn gives_way(source: &Source, map: &RoadNetwork, a: LaneId, b: LaneId) -> bool {
    let (one, other) = (&map.lanes[a as usize], &map.lanes[b as usize]);
    if let Some(told) = priority(source, map, a, b) {
        return told;
    }
    match (sign(map, one), sign(map, other)) {
        (x, y) if x != y => return x > y,
        _ => {}
    }
    let (from, towards) = (direction(one.start().heading_rad), direction(other.start().heading_rad));
    let opposite = from.dot(towards) < -0.5;
    let oncoming_left = (one.turn == Turn::Left, other.turn == Turn::Left);
    match (opposite, oncoming_left) {
        (true, (true, false)) => true,
        (true, (false, true)) => false,
        // Right before left: who comes from the right moves to our left.
        (false, _) if from.perp_dot(towards).abs() > 0.3 => from.perp_dot(towards) > 0.0,
        _ => a > b,
    }
}

/// 1 where a sign says to wait, 0 with a light or without a sign.
fn sign(map: &RoadNetwork, lane: &Lane) -> u32 {
    let stops = lane.predecessors.iter().filter_map(|&p| map.lanes[p as usize].stop);
    u32::from(stops.into_iter().any(|s| matches!(s.kind, StopKind::Stop | StopKind::Yield)))
}

/// What `<priority>` records say about two junction lanes, by their own or their incoming roads.
fn priority(source: &Source, map: &RoadNetwork, a: LaneId, b: LaneId) -> Option<bool> {
    let roads = |id: LaneId| {
        let before = map.lanes[id as usize].predecessors.iter().map(|&p| source.origins[p as usize].road);
        std::iter::once(source.origins[id as usize].road).chain(before).collect::<Vec<_>>()
    };
    let (ours, theirs) = (roads(a), roads(b));
    let yields = |low: &[usize], high: &[usize]| {
        low.iter().any(|&l| source.net.yields_to(xodr::RoadId(l)).any(|h| high.contains(&h.0)))
    };
    match (yields(&ours, &theirs), yields(&theirs, &ours)) {
        (true, false) => Some(true),
        (false, true) => Some(false),
        _ => None,
    }
}

/// The lanes of `junction`'s approaches that lead into it, by approach.
pub(super) fn approaches(source: &Source, map: &RoadNetwork, junction: u32) -> BTreeMap<Approach, Vec<LaneId>> {
    let mut found: BTreeMap<Approach, Vec<LaneId>> = BTreeMap::new();
    for &inside in &map.junctions[junction as usize].lanes {
        for &before in &map.lanes[inside as usize].predecessors {
            if map.lanes[before as usize].junction != Some(junction) {
                let lanes = found.entry(source.origins[before as usize].approach()).or_default();
                if !lanes.contains(&before) {
                    lanes.push(before);
                }
            }
        }
    }
    found
}
