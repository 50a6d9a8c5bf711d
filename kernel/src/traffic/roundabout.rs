//! Roundabouts: who drives round goes first, and nobody enters one that would fill up.
//!
//! A junction grants a way when the room behind it is free. In a circle that ends in a ring of vehicles which all wait for
//! the one before; so room is counted once, when somebody enters, and whoever is inside drives on.

use crate::map_data::{Circle, Lane, LaneId, circles};
use crate::time::seconds;

use super::lane_way::LaneConflict;
use super::step::Step;

/// Nobody enters where more than this share of the way round would then be taken.
const SHARE: f32 = 0.6;
/// The same for those who have waited for [`LET_IN_TICKS`].
const LAST_SHARE: f32 = 0.7;
/// Who has waited for so long to enter is let in by those who drive round, if these have not waited for so long themselves:
/// the tail of one that waits keeps others out at the arm behind it. In a jam these stand for longer than that.
const LET_IN_TICKS: u16 = seconds(20) as u16;
const LETS_IN_TICKS: u16 = seconds(5) as u16;
const LET_IN_AT_LAST_TICKS: u16 = seconds(45) as u16;
const LETS_IN_AT_LAST_TICKS: u16 = seconds(30) as u16;
/// Who may enter is counted from so far before the junction on, metres: grants are given while one still rolls.
const APPROACH_M: f32 = 80.0;

/// A circle, the lanes of junctions that lead into it, and those before, up to [`APPROACH_M`].
#[derive(Clone, Debug)]
pub(super) struct Roundabout {
    circle: Circle,
    entries: Vec<LaneId>,
    approaches: Vec<LaneId>,
}

/// Those of a map, and for each lane the index of the one that it is part of.
pub(super) fn roundabouts(lanes: &[Lane]) -> (Vec<Roundabout>, Vec<Option<u32>>) {
    let mut part_of = vec![None; lanes.len()];
    let found: Vec<Circle> = circles(lanes);
    for (k, circle) in found.iter().enumerate() {
        circle.lanes.iter().for_each(|lane| part_of[*lane as usize] = Some(k as u32));
    }
    let outside = |lane: LaneId| part_of[lane as usize].is_none();
    let with_entries = |circle: Circle| {
        let enters = |lane: LaneId, _: f32| outside(lane) && lanes[lane as usize].junction.is_some();
        let entries = before(lanes, &circle.lanes, enters);
        let near =
            |lane: LaneId, away_m: f32| outside(lane) && lanes[lane as usize].junction.is_none() && away_m < APPROACH_M;
        let approaches = before(lanes, &entries, near);
        Roundabout { circle, entries, approaches }
    };
    let found = found.into_iter().map(with_entries).collect();
    (found, part_of)
}

/// All lanes before some from which such lanes alone lead there, which are told with their distance from these, metres.
fn before(lanes: &[Lane], from: &[LaneId], is_such: impl Fn(LaneId, f32) -> bool) -> Vec<LaneId> {
    let mut found: Vec<LaneId> = Vec::new();
    let mut ways: Vec<(LaneId, f32)> = from.iter().map(|lane| (*lane, 0.0)).collect();
    while let Some((lane, away_m)) = ways.pop() {
        for &next in &lanes[lane as usize].predecessors {
            if is_such(next, away_m) && !found.contains(&next) {
                found.push(next);
                ways.push((next, away_m + lanes[next as usize].length_m));
            }
        }
    }
    found
}

impl Roundabout {
    /// Lanes on which those are who drive round or come in, and those before.
    pub fn lanes(&self) -> (impl Iterator<Item = &LaneId>, impl Iterator<Item = &LaneId>) {
        (self.circle.lanes.iter().chain(&self.entries), self.approaches.iter())
    }

    /// Whether it has room for one that needs `needed_m` and has waited, when others take `taken_m`.
    pub fn has_room(&self, taken_m: f32, needed_m: f32, wait_ticks: u16) -> bool {
        let share = if wait_ticks < LET_IN_TICKS { SHARE } else { LAST_SHARE };
        // An empty one has room for anybody.
        taken_m == 0.0 || taken_m + needed_m <= share * self.circle.length_m
    }
}

/// Whether one that drives round goes before one that wants in, by how long both have waited.
pub(super) fn goes_round_first(waits_round_ticks: u16, waits_to_enter_ticks: u16) -> bool {
    let at_last = waits_to_enter_ticks >= LET_IN_AT_LAST_TICKS;
    let lets_in_ticks = if at_last { LETS_IN_AT_LAST_TICKS } else { LETS_IN_TICKS };
    waits_to_enter_ticks < LET_IN_TICKS || waits_round_ticks >= lets_in_ticks
}

/// Whether one that asks may follow one that comes in or drives round on the other lane of a merge, `half_m` long to both
/// sides of its middle: who drives round as soon as that is before it, who enters once it is out of the way.
pub(super) fn is_followed(circulates: bool, conflict: &LaneConflict, there: &Step, half_m: f32) -> bool {
    let (front_m, rear_m) = (-there.start_m + half_m, -there.start_m - half_m);
    if circulates { front_m > conflict.there[1] } else { rear_m > conflict.there[1] }
}
