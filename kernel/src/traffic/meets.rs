//! Where lanes come so near each other that vehicles on them would touch, and no junction orders them:
//! where they split, and outside junctions also where they merge, cross, or where one ends beside another.

use std::collections::BTreeMap;

use crate::map_data::{Lane, LaneId, LaneKind, LanePoint};
use crate::ops;
use crate::places::Places;

use super::links::{Onward, ends_beside};
use super::sideways::EDGE_M;

/// Lanes whose middles are nearer than this never have room for two wide vehicles, metres.
const NARROW_M: f32 = 2.5;
/// Lanes whose middles are farther apart than this always have, metres.
const WIDE_M: f32 = 2.9;
/// Between these the lanes' own widths decide, less this, metres.
const CLEARANCE_M: f32 = 0.6;
/// Width of the widest vehicle, which leans over the border where its lane ends beside another, metres.
const WIDEST_M: f32 = 2.5;
/// Length of the longest, metres.
const LONGEST_M: f32 = 11.0;
/// Where it is looked for along a lane, metres.
const PROBE_M: f32 = 1.0;
/// A place off the end of a lane by more than this is not beside it, metres.
const BEYOND_M: f32 = 0.3;
/// Lanes farther apart in height pass over each other, metres.
const LEVEL_M: f32 = 3.0;

/// Another lane that meets one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Meet {
    pub lane: LaneId,
    /// Stretch of this lane, metres.
    pub here: [f32; 2],
    /// Stretch of the other lane, metres.
    pub there: [f32; 2],
    /// What a place on the other lane is on this one: `s + shift_m`. None where they cross.
    pub shift_m: Option<f32>,
}

/// A stretch of one lane beside another: from, to, and the places on the other at both.
type Stretch = ([f32; 2], [f32; 2]);

/// For each lane those that it meets. Both sides of a pair are told alike.
pub(super) fn meets(places: &Places, onward: &[[Vec<Onward>; 2]]) -> Vec<Vec<Meet>> {
    let lanes = &places.map.lanes;
    let mut found = vec![Vec::new(); lanes.len()];
    for id in 0..lanes.len() as LaneId {
        if lanes[id as usize].kind != LaneKind::Driving {
            continue;
        }
        for (other, (mut here, mut there)) in beside(places, onward, id).into_iter().filter(|(other, _)| *other > id) {
            let shift_m = shift_m(lanes, onward, id, other, (here, there));
            here.sort_by(f32::total_cmp);
            there.sort_by(f32::total_cmp);
            found[id as usize].push(Meet { lane: other, here, there, shift_m });
            let back = Meet { lane: id, here: there, there: here, shift_m: shift_m.map(|m| -m) };
            found[other as usize].push(back);
        }
    }
    found
}

/// Lanes beside a lane, and where.
fn beside(places: &Places, onward: &[[Vec<Onward>; 2]], id: LaneId) -> BTreeMap<LaneId, Stretch> {
    let lanes = &places.map.lanes;
    let lean_m = |lane: LaneId, s_m: f32| {
        let (lane, onward) = (&lanes[lane as usize], &onward[lane as usize][0]);
        let half_width_m = [-LONGEST_M, LONGEST_M].map(|m| lane.at(s_m + m).half_width_m);
        let over_m = WIDEST_M * 0.5 + EDGE_M - half_width_m[0].min(half_width_m[1]);
        if ends_beside(lane, onward) { over_m.max(0.0) } else { 0.0 }
    };
    let lane = &lanes[id as usize];
    let mut stretches: BTreeMap<LaneId, Stretch> = BTreeMap::new();
    let steps = (lane.length_m / PROBE_M) as u32 + 1;
    for k in 0..=steps {
        let s_m = (k as f32 * PROBE_M).min(lane.length_m);
        let here = lane.at(s_m);
        for near in places.roads().around(here.position, LaneKind::Driving, NARROW_M) {
            let other = &lanes[near.lane as usize];
            let there = other.at(near.s_m);
            let is_beside = near.distance_m - near.lateral_m.abs() < BEYOND_M;
            let apart_m = near.distance_m - lean_m(id, s_m) - lean_m(near.lane, near.s_m);
            if is_beside && may_meet(id, lane, near.lane, other) && touches(&here, &there, apart_m) {
                let stretch = stretches.entry(near.lane).or_insert(([s_m; 2], [near.s_m; 2]));
                (stretch.0[1], stretch.1[1]) = (s_m, near.s_m);
            }
        }
    }
    stretches
}

/// Whether it is for these two to watch each other here: not one after the other, and not in one
/// junction, which has its own order, but where they fan out of one lane and that order leaves them out.
fn may_meet(id: LaneId, lane: &Lane, other_id: LaneId, other: &Lane) -> bool {
    let shares = |a: &[LaneId], b: &[LaneId]| a.iter().any(|x| b.contains(x));
    let fans_out = shares(&lane.predecessors, &other.predecessors);
    let related = fans_out || shares(&lane.successors, &other.successors);
    let outside = lane.junction.is_none() && other.junction.is_none();
    let chained = lane.successors.contains(&other_id) || other.successors.contains(&id);
    let together = lane.junction == other.junction;
    let ordered = lane.conflicts.iter().any(|conflict| conflict.lane == other_id);
    id != other_id && !chained && (outside || if together { fans_out && !ordered } else { related })
}

fn touches(here: &LanePoint, there: &LanePoint, distance_m: f32) -> bool {
    let near_m = (here.half_width_m + there.half_width_m - CLEARANCE_M).clamp(NARROW_M, WIDE_M);
    let oncoming = ops::cos(here.heading_rad - there.heading_rad) < -0.5;
    distance_m < near_m && !oncoming && (here.position.z - there.position.z).abs() < LEVEL_M
}

fn shift_m(lanes: &[Lane], onward: &[[Vec<Onward>; 2]], a: LaneId, b: LaneId, (here, there): Stretch) -> Option<f32> {
    let (one, other) = (&lanes[a as usize], &lanes[b as usize]);
    let arrives = |from: LaneId, to: LaneId| onward[from as usize][0].iter().find(|n| n.lane == to).map(|n| n.at_m);
    if let Some(at_m) = arrives(a, b) {
        return Some(one.length_m - at_m);
    }
    if let Some(at_m) = arrives(b, a) {
        return Some(at_m - other.length_m);
    }
    if one.successors.iter().any(|next| other.successors.contains(next)) {
        return Some(one.length_m - other.length_m);
    }
    if one.predecessors.iter().any(|before| other.predecessors.contains(before)) {
        return Some(0.0);
    }
    let turn = one.at(here[1]).heading_rad - other.at(there[1]).heading_rad;
    (ops::cos(turn) > 0.5).then(|| here[1] - there[1])
}
