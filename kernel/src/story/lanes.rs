//! Along lanes: which comes next, and which way leads to a place.

use std::collections::BTreeMap;

use crate::map::RoadNetwork;
use crate::map_data::{LaneId, Turn};
use crate::ops;

use super::spot::OnLane;

/// Most lanes that a place ahead is looked for on.
const AHEAD_LANES: usize = 500;
/// Most lanes that a way is looked for over, or steps of a way.
const LOOKED_AT: usize = 20_000;
/// Such a step, metres.
const STEP_M: f32 = 10.0;

/// The lane after one, and where on it one comes, metres from its start: the next of a route if that goes on there, or else
/// the one that leads most nearly straight on.
fn next(network: &RoadNetwork, lane: LaneId, route: &[LaneId]) -> Option<(LaneId, f32)> {
    let here = &network.lanes[lane as usize];
    let listed = network.ways().onward(lane).iter().map(|next| (next.lane, next.at_m));
    let mut onward: Vec<_> = listed.collect();
    if onward.is_empty() {
        onward.extend(here.successors.iter().map(|next| (*next, 0.0)));
    }
    if let Some(asked) = route.first().and_then(|asked| onward.iter().find(|(next, _)| next == asked)) {
        return Some(*asked);
    }
    let bend = |next: LaneId| {
        let next = &network.lanes[next as usize];
        let turns = if next.turn == Turn::Straight { 0.0 } else { 1.0 };
        turns + ops::wrap_angle(next.end().heading_rad - here.end().heading_rad).abs()
    };
    onward.into_iter().min_by(|a, b| bend(a.0).total_cmp(&bend(b.0)).then(a.0.cmp(&b.0)))
}

/// The lane beside one to which a route goes over there.
fn beside(network: &RoadNetwork, lane: LaneId, route: &[LaneId]) -> Option<LaneId> {
    let here = &network.lanes[lane as usize];
    route.first().copied().filter(|next| [here.left, here.right].contains(&Some(*next)))
}

/// Goes over to the lane beside one, if its route does so there, at the same place on the map: that it was in the middle of its
/// lane there stays so.
pub fn change(network: &RoadNetwork, on: &mut OnLane, route: &mut Vec<LaneId>) -> bool {
    let Some(lane) = beside(network, on.lane, route) else { return false };
    route.remove(0);
    let there = network.project(lane, network.lane_point(on.lane, on.s_m).position);
    *on = OnLane { lane, s_m: there.s_m, ..*on };
    true
}

/// The lane before one, as straight as may be.
fn previous(network: &RoadNetwork, lane: LaneId) -> Option<LaneId> {
    let here = &network.lanes[lane as usize];
    let bend = |before: LaneId| {
        let before = &network.lanes[before as usize];
        let turns = if before.turn == Turn::Straight { 0.0 } else { 1.0 };
        turns + ops::wrap_angle(before.start().heading_rad - here.start().heading_rad).abs()
    };
    here.predecessors.iter().copied().min_by(|a, b| bend(*a).total_cmp(&bend(*b)).then(a.cmp(b)))
}

/// Moves a place on along its lanes by so many metres, as who is there faces; of a route those lanes are taken that are
/// reached. `false` when the road ends before.
pub fn advance(network: &RoadNetwork, on: &mut OnLane, by_m: f32, route: &mut Vec<LaneId>) -> bool {
    let ahead_m = if on.against { -by_m } else { by_m };
    on.s_m += ahead_m;
    // A tick is not longer than some lanes.
    for _ in 0..16 {
        let length_m = network.lanes[on.lane as usize].length_m;
        if on.s_m > length_m || (on.s_m == length_m && !on.against) {
            let Some((lane, at_m)) = next(network, on.lane, route) else {
                on.s_m = length_m;
                return false;
            };
            if route.first() == Some(&lane) {
                route.remove(0);
            }
            (on.s_m, on.lane) = (on.s_m - length_m + at_m, lane);
        } else if on.s_m < 0.0 || (on.s_m == 0.0 && on.against) {
            let Some(lane) = previous(network, on.lane) else {
                on.s_m = 0.0;
                return false;
            };
            (on.s_m, on.lane) = (on.s_m + network.lanes[lane as usize].length_m, lane);
        } else {
            break;
        }
    }
    true
}

/// So many metres on, over as many lanes as it takes.
pub fn ahead(network: &RoadNetwork, from: OnLane, by_m: f32) -> OnLane {
    along(network, from, by_m, Vec::new())
}

/// The same over the lanes of a route.
pub fn along(network: &RoadNetwork, from: OnLane, by_m: f32, mut route: Vec<LaneId>) -> OnLane {
    let (mut on, mut left_m) = (from, by_m);
    for _ in 0..LOOKED_AT {
        while change(network, &mut on, &mut route) {}
        let step_m = left_m.clamp(-STEP_M, STEP_M);
        if step_m == 0.0 || !advance(network, &mut on, step_m, &mut route) {
            break;
        }
        left_m -= step_m;
    }
    on
}

/// The way to a place ahead, over the lanes of a route and then straight on, metres; negative for one behind on the same lane,
/// nothing for one that is not met within so many metres.
pub fn ahead_m(network: &RoadNetwork, from: OnLane, to: OnLane, route: &[LaneId], within_m: f32) -> Option<f32> {
    if from.lane == to.lane {
        let ahead_m = to.s_m - from.s_m;
        return Some(if from.against { -ahead_m } else { ahead_m });
    }
    if from.against {
        return None;
    }
    // The way is to where the lane starts.
    let (mut lane, mut s_m, mut route, mut way_m) = (from.lane, from.s_m, route, -from.s_m);
    // So many lanes at most: some have next to no length.
    for _ in 0..AHEAD_LANES {
        if let Some(beside) = beside(network, lane, route) {
            let there_m = network.project(beside, network.lane_point(lane, s_m).position).s_m;
            way_m += s_m - there_m;
            (lane, s_m, route) = (beside, there_m, &route[1..]);
            if lane == to.lane {
                return Some(way_m + to.s_m);
            }
            continue;
        }
        way_m += network.lanes[lane as usize].length_m;
        let (after, at_m) = next(network, lane, route)?;
        if route.first() == Some(&after) {
            route = &route[1..];
        }
        if after == to.lane {
            return Some(way_m + to.s_m - at_m);
        }
        (lane, s_m, way_m) = (after, at_m, way_m - at_m);
        if way_m > within_m {
            break;
        }
    }
    None
}

/// The lanes after the first on the shortest way from one to another; neighbours count as following each other.
pub fn way(network: &RoadNetwork, from: OnLane, to: OnLane) -> Option<Vec<LaneId>> {
    if from.lane == to.lane && from.s_m <= to.s_m {
        return Some(Vec::new());
    }
    search(network, from, |lane| lane == to.lane, true)
}

/// Whether a place is on the shortest way from one to another, after the first.
pub fn is_on_way(network: &RoadNetwork, at: OnLane, from: OnLane, to: OnLane) -> bool {
    let Some(way) = way(network, from, to) else { return false };
    let after_from = at.lane != from.lane || at.s_m > from.s_m;
    let before_to = at.lane != to.lane || at.s_m <= to.s_m;
    (at.lane == from.lane || way.contains(&at.lane)) && after_from && before_to
}

/// The way to the road that a route leads to, from where who drove it is now: without a change of lanes, if there is one.
pub fn onward_way(network: &RoadNetwork, from: OnLane, route: &[LaneId]) -> Vec<LaneId> {
    let Some(last) = route.last() else { return Vec::new() };
    let road = |lane: LaneId| network.lanes[lane as usize].name.rsplit_once('/').map(|(road, _)| road);
    if road(from.lane) == road(*last) {
        return Vec::new();
    }
    let is_there = |lane: LaneId| road(lane) == road(*last);
    let found = search(network, from, is_there, false).or_else(|| search(network, from, |lane| lane == *last, true));
    found.unwrap_or_default()
}

fn search(network: &RoadNetwork, from: OnLane, is_goal: impl Fn(LaneId) -> bool, changes: bool) -> Option<Vec<LaneId>> {
    let tenths = |m: f32| (m * 10.0) as u64;
    let mut open = BTreeMap::from([((0_u64, from.lane), None)]);
    let mut came: BTreeMap<LaneId, Option<LaneId>> = BTreeMap::new();
    while let Some(((cost, lane), before)) = open.pop_first() {
        if came.len() > LOOKED_AT {
            return None;
        }
        // Who starts behind the place on its own lane comes back to it.
        let first = before.is_none() && lane == from.lane;
        if came.contains_key(&lane) {
            continue;
        }
        if !first {
            came.insert(lane, before);
        }
        if is_goal(lane) && !first {
            return Some(back(&came, from.lane, lane));
        }
        let here = &network.lanes[lane as usize];
        let length_m = if first { (here.length_m - from.s_m).max(0.0) } else { here.length_m };
        for next in network.ways().onward(lane) {
            open.insert((cost + tenths(length_m) + 1, next.lane), Some(lane));
        }
        for beside in [here.left, here.right].into_iter().flatten().filter(|_| changes) {
            open.insert((cost + tenths(50.0), beside), Some(lane));
        }
    }
    None
}

fn back(came: &BTreeMap<LaneId, Option<LaneId>>, from: LaneId, to: LaneId) -> Vec<LaneId> {
    let mut lanes = vec![to];
    let mut at = to;
    while let Some(Some(before)) = came.get(&at) {
        if *before == from || lanes.len() > LOOKED_AT {
            break;
        }
        lanes.push(*before);
        at = *before;
    }
    lanes.reverse();
    lanes
}
