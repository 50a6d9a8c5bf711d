//! Who may enter a junction.
//!
//! A vehicle enters only with a grant. It is given when no vehicle that has one, or is inside, still
//! has to clear a place where the two ways meet, when the vehicle goes before everyone else who asks,
//! and when there is room to leave the junction again. Whoever asks and is not granted stops at the
//! line, so a grant is safe whatever the others do, and the order below decides every pair one way.

use glam::Vec3;

use crate::light::LightPhase;
use crate::map_data::{MapData, StopKind};
use crate::time::{TICK_S, Tick};

use super::lane_way::{ConflictKind, LaneConflict};
use super::lists::{Entry, Lists};
use super::plan::{Line, Plan, braking_needed};
use super::roundabout::{goes_round_first, is_followed};
use super::step::{LINE_MARGIN_M, Step};
use super::traits::{Driver, LONG_HALF_M};
use super::vehicle::Vehicle;
use super::ways::Ways;
use super::zebra;

/// After this long at a line a vehicle goes before those that have the right of way.
pub(super) const PATIENCE_TICKS: u16 = 240;
/// Braking that a yellow light asks for at most, m/s².
pub(super) const YELLOW_BRAKE_MPS2: f32 = 4.0;
/// Braking within which a vehicle asks for its grant, m/s².
const ASK_BRAKE_MPS2: f32 = 1.5;
/// Distance from the line within which it asks at any speed, metres.
const ASK_M: f32 = 8.0;
/// Braking with which whoever is ahead is expected to come to a stand, m/s².
const AHEAD_BRAKE_MPS2: f32 = 2.0;

/// Somebody in a zone of junctions, or before it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Member {
    pub zone: u32,
    /// Index of the vehicle; [`EGO`] for the ego car.
    pub vehicle: u32,
    pub id: u16,
    /// Inside, or granted; otherwise asking.
    pub holds: bool,
    /// Waits for room behind the junction, and would enter but for that.
    pub wants_room: bool,
    /// The roundabout in which it drives round, and the one that it comes into.
    pub rounds: Option<u32>,
    pub enters: Option<u32>,
    /// Half of its length, metres.
    pub half_m: f32,
    /// [`swept_half_m`] of it.
    pub swept_half_m: f32,
    pub wait_ticks: u16,
    /// Its lanes in this zone, a stretch of the list of [`Members`].
    pub lanes: (u32, u32),
}

/// Half of the length that a vehicle needs in a junction, metres: the tail of a long one swings out
/// of its lane.
pub(super) fn swept_half_m(size_m: Vec3) -> f32 {
    let half_m = size_m.x * 0.5;
    half_m + 0.9 * (half_m - LONG_HALF_M).max(0.0)
}

/// [`Member::vehicle`] of the ego car.
pub(super) const EGO: u32 = u32::MAX;

/// Everybody in or before a junction, by zone and id.
#[derive(Clone, Debug, Default)]
pub(super) struct Members {
    list: Vec<Member>,
    lanes: Vec<Step>,
}

impl Members {
    pub fn clear(&mut self) {
        self.list.clear();
        self.lanes.clear();
    }

    pub fn push(&mut self, member: Member, lanes: impl IntoIterator<Item = Step>) {
        let first = self.lanes.len() as u32;
        self.lanes.extend(lanes);
        self.list.push(Member { lanes: (first, self.lanes.len() as u32), ..member });
    }

    pub fn sort(&mut self) {
        self.list.sort_unstable_by_key(|m| (m.zone, m.id, m.holds));
    }

    fn of(&self, zone: u32) -> &[Member] {
        let first = self.list.partition_point(|m| m.zone < zone);
        let count = self.list[first..].partition_point(|m| m.zone == zone);
        &self.list[first..first + count]
    }

    fn lanes_of(&self, member: &Member) -> &[Step] {
        &self.lanes[member.lanes.0 as usize..member.lanes.1 as usize]
    }

    /// Whether the one who asks may enter.
    pub fn grants(&self, ways: &Ways, asking: &Member, steps: &[Step]) -> bool {
        let others = self.of(asking.zone).iter().filter(|m| m.vehicle != asking.vehicle);
        let keeps_out = |other: &Member| {
            steps.iter().any(|step| {
                let conflicts = &ways.lanes[step.lane as usize].conflicts;
                let theirs = self.lanes_of(other);
                let swept = &ways.lanes[step.lane as usize].swept;
                let long = other.half_m > LONG_HALF_M || asking.half_m > LONG_HALF_M;
                let sweeps = long && !other.wants_room && theirs.iter().any(|t| swept.contains(&t.lane));
                sweeps && (other.holds || !goes_before(asking, other, 0))
                    || conflicts
                        .iter()
                        .any(|c| theirs.iter().any(|t| t.lane == c.lane && prevents(asking, other, c, t)))
            })
        };
        !others.into_iter().any(keeps_out)
    }

    /// The member that asks for vehicle `index`, if it asks.
    pub fn asking(&self, zone: u32, index: usize) -> Option<&Member> {
        self.of(zone).iter().find(|m| m.vehicle as usize == index && !m.holds && !m.wants_room)
    }
}

/// Whether `other` on lane `there` keeps the one who asks out, where their lanes conflict.
fn prevents(asking: &Member, other: &Member, conflict: &LaneConflict, there: &Step) -> bool {
    // Who has waited long for room is not taken it by others; for them the way across stays open.
    let merges = conflict.kind == ConflictKind::Merge;
    if conflict.kind == ConflictKind::Diverge || (other.wants_room && (!merges || asking.rounds.is_some())) {
        return false;
    }
    if other.holds {
        if merges && (asking.rounds.is_some() || other.rounds.is_some()) {
            return !is_followed(asking.rounds.is_some(), conflict, there, other.half_m);
        }
        // A long vehicle sweeps more than its lane: nobody passes close behind it, nor does it.
        let long = other.half_m > LONG_HALF_M || asking.half_m > LONG_HALF_M;
        let rear_m = -there.start_m - other.swept_half_m;
        return long || rear_m < conflict.there[1];
    }
    !goes_before(asking, other, conflict.precedence)
}

/// The order of two who ask, the same seen from both: who is in a roundabout first, or it would fill up, until those who
/// want in have waited long; then the impatient; then the right of way, then the longer wait, then the smaller id. Nobody
/// takes the ego car's right of way because of impatience: it would not hear of it.
fn goes_before(a: &Member, b: &Member, precedence: i8) -> bool {
    // Unless the map tells that those who drive round wait.
    let rounds =
        |m: &Member, other: &Member, precedence: i8| m.rounds.is_some() && m.rounds == other.enters && precedence >= 0;
    let first =
        |round: &Member, other: &Member| round.vehicle == EGO || goes_round_first(round.wait_ticks, other.wait_ticks);
    if rounds(a, b, precedence) {
        return first(a, b);
    }
    if rounds(b, a, -precedence) {
        return !first(b, a);
    }
    let impatient = |m: &Member, other: &Member| other.vehicle != EGO && m.wait_ticks > PATIENCE_TICKS;
    match (impatient(a, b), impatient(b, a)) {
        (true, false) => true,
        (false, true) => false,
        (false, false) if precedence != 0 => precedence > 0,
        _ => (b.wait_ticks, a.id) < (a.wait_ticks, b.id),
    }
}

/// What the signs and lights at a line say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Signal {
    /// Go, as far as the others let.
    Open,
    /// Stop if it can be done safely; closed after so many ticks.
    Closing(Tick),
    /// Stop.
    Closed,
}

/// What the light or sign at a line says to a vehicle with these steps.
pub(super) fn signal(
    map: &MapData,
    lights: &[(LightPhase, Tick)],
    vehicle: &Vehicle,
    steps: &[Step],
    line: &Line,
) -> Signal {
    let approach = steps[line.approach].lane;
    if let Some(group) = map.light_between(approach, steps[line.inside.0].lane) {
        return match lights[group as usize] {
            (LightPhase::Green, _) => Signal::Open,
            (LightPhase::Yellow, left) => Signal::Closing(left),
            (LightPhase::Red, _) => Signal::Closed,
        };
    }
    let sign = map.lanes[approach as usize].stop.is_some_and(|stop| stop.kind == StopKind::Stop);
    if sign && vehicle.flags & Vehicle::HALTED == 0 { Signal::Closed } else { Signal::Open }
}

/// Whether a vehicle is close enough to the line to ask; `spare_m` widens the distance.
pub(super) fn near_enough(vehicle: &Vehicle, line: &Line, spare_m: f32) -> bool {
    let near_m = ASK_M + spare_m;
    line.hold_m < near_m || braking_needed(vehicle.speed_mps, line.hold_m - near_m) > ASK_BRAKE_MPS2
}

/// Whether a granted vehicle gives its grant back because the light has changed; `pace_mps` is how fast it gets to the
/// line at most.
pub(super) fn must_stop(signal: Signal, vehicle: &Vehicle, line: &Line, pace_mps: f32) -> bool {
    let needed = braking_needed(vehicle.speed_mps, line.ahead_m);
    match signal {
        _ if line.passed => false,
        Signal::Open => false,
        // At high speed yellow may be too short to get there.
        Signal::Closing(left) if line.ahead_m < pace_mps * left as f32 * TICK_S => needed < YELLOW_BRAKE_MPS2,
        Signal::Closing(_) | Signal::Closed => needed < 1.5 * YELLOW_BRAKE_MPS2,
    }
}

/// How far a vehicle gets until it stands, metres.
pub(super) fn stopping_m(speed_mps: f32) -> f32 {
    speed_mps * speed_mps / (2.0 * AHEAD_BRAKE_MPS2)
}

/// Whether the way out of the junction has room for the vehicle behind everyone who is before it,
/// wherever they come to a stand, at the line of the next junction but for those that may enter that; `stands_m` is where
/// something stands in its way, from its middle.
pub(super) fn has_room(
    view: (&MapData, &Ways, &Lists, &[Vehicle]),
    plan: &Plan,
    line: &Line,
    steps: &[Step],
    index: usize,
    driver: &Driver,
    stands_m: f32,
) -> bool {
    let (map, ways, lists, vehicles) = view;
    let enters = |other: u32| vehicles[other as usize].flags & (Vehicle::GRANTED | Vehicle::CROSSING) != 0;
    let last = steps[line.inside.1 - 1];
    let end_m = last.start_m + map.lanes[last.lane as usize].length_m;
    let end_m = zebra::beyond(ways, &steps[line.inside.1..], driver, end_m);
    // A tail that sweeps over the junction still holds it.
    let mut needed_m = 0.5 * driver.size_m.x + swept_half_m(driver.size_m) + driver.gap_m;
    for step in &steps[line.approach..] {
        for entry in lists.on(step.lane) {
            let at_m = step.start_m + entry.s_m;
            if entry.vehicle as usize == index || at_m <= 0.0 || (entry.s_m < step.from_m && step.from_m > 0.0) {
                continue;
            }
            if at_m - entry.half_m > end_m {
                let at_line_m = next_line_m(map, ways, step).filter(|_| !enters(entry.vehicle));
                let at_bend_m = next_bend_m(ways, step, entry);
                let stops_m = at_m + stopping_m(entry.speed_mps);
                let stops_m =
                    at_line_m.map_or(stops_m, |line_m| stops_m.min(line_m - entry.half_m)).min(at_bend_m).max(at_m);
                return (stops_m - entry.half_m).min(stands_m) - end_m > needed_m;
            }
            if entry.speed_mps < 0.5 {
                return false;
            }
            needed_m += 2.0 * entry.half_m + driver.gap_m;
        }
    }
    plan.dead_end_m.unwrap_or(f32::MAX).min(stands_m) - end_m > needed_m
}

/// From a vehicle's middle to where others stop on a lane of its way because that leads into a junction, metres.
fn next_line_m(map: &MapData, ways: &Ways, step: &Step) -> Option<f32> {
    let lane = &map.lanes[step.lane as usize];
    let leads_in =
        ways.lanes[step.lane as usize].onward.iter().any(|next| ways.lanes[next.lane as usize].zone.is_some());
    let line_m = || step.start_m + lane.stop.map_or(lane.length_m, |stop| stop.s_m) - LINE_MARGIN_M;
    (lane.junction.is_none() && leads_in).then(line_m)
}

/// The same to where the middle of a long one is that waits before the next bend of its lane; infinite where it does not.
fn next_bend_m(ways: &Ways, step: &Step, entry: &Entry) -> f32 {
    let bends = ways.lanes[step.lane as usize].bends.iter().filter(|bend| bend.here[0] > entry.s_m);
    let nearest_m = bends.map(|bend| step.start_m + bend.here[0] - LINE_MARGIN_M).fold(f32::INFINITY, f32::min);
    if entry.half_m > LONG_HALF_M { nearest_m } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two who ask one goes first, seen from either.
    #[test]
    fn the_order_of_those_who_ask_is_one() {
        let mut members = vec![Member { vehicle: EGO, rounds: Some(1), ..Member::default() }];
        let places = [(None, None), (Some(1), None), (None, Some(1)), (Some(2), None), (None, Some(2))];
        for (rounds, enters) in places {
            let waits = [0, 100, 400, 1300].into_iter().enumerate();
            members.extend(waits.map(|(k, wait_ticks)| {
                let id = 1 + k as u16 + 4 * places.iter().position(|p| *p == (rounds, enters)).map_or(0, |p| p as u16);
                Member { vehicle: u32::from(id), id, rounds, enters, wait_ticks, ..Member::default() }
            }));
        }
        for (i, a) in members.iter().enumerate() {
            for b in &members[i + 1..] {
                for precedence in -1..=1 {
                    assert_ne!(
                        goes_before(a, b, precedence),
                        goes_before(b, a, -precedence),
                        "{a:?} {b:?} {precedence}"
                    );
                }
            }
        }
    }

    #[test]
    fn who_drives_round_goes_first_until_somebody_has_waited() {
        let [mut round, mut enters] = [1, 2].map(|id| Member { vehicle: id, id: id as u16, ..Member::default() });
        (round.rounds, enters.enters) = (Some(0), Some(0));
        assert!(goes_before(&round, &enters, 0));
        assert!(!goes_before(&round, &enters, -1), "the map tells otherwise");
        enters.wait_ticks = 1300;
        assert!(goes_before(&enters, &round, -1));
        assert!(goes_before(&Member { vehicle: EGO, ..round }, &enters, 0), "the ego car does not hear of it");
        round.wait_ticks = 400;
        assert!(goes_before(&round, &enters, 0));
        round.rounds = Some(1);
        assert!(goes_before(&enters, &round, 0), "another roundabout");
    }
}
