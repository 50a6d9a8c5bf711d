//! The way a vehicle will take, as far as it has to look ahead.

use crate::map_data::{Lane, MapData};
use crate::ops;

use super::journey::Journey;
use super::lists::{Entry, Lists};
use super::step::{LINE_MARGIN_M, Step};
use super::traits::Driver;
use super::vehicle::Vehicle;
use super::ways::Ways;
use super::zebra;

/// Braking that the look-ahead distance allows for, m/s².
const LOOK_BRAKE_MPS2: f32 = 2.0;
/// Room beyond a junction that the plan covers, metres.
const BEYOND_JUNCTION_M: f32 = 20.0;
/// Long vehicles wait so far before the line of a roundabout, metres, so that others of them can leave it beside them; where
/// the street is narrow, everybody does.
const BACK_M: f32 = 7.5;
/// Most lanes of a plan.
const MAX_STEPS: usize = 256;

/// The line before the next junction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// The zone of the junction.
    pub zone: u32,
    /// From the vehicle's front to the line, metres; negative when it reaches over it.
    pub ahead_m: f32,
    /// It waits so far before the line, metres, because another needs the room to come out of the junction.
    pub back_m: f32,
    /// From the front to where it waits: there, or before a crosswalk where there is no room between that and the line.
    pub hold_m: f32,
    /// Whether the front is over the marked line already; the vehicle may still stop where the
    /// junction begins.
    pub passed: bool,
    /// The step whose lane ends at the junction.
    pub approach: usize,
    /// The steps inside the junction: from, and one past the last, or as many as the plan has.
    pub inside: (usize, usize),
}

impl Line {
    /// The roundabout that who is outside of one comes into beyond the line.
    pub fn enters(&self, ways: &Ways, steps: &[Step]) -> Option<u32> {
        let circle = |step: &Step| ways.lanes[step.lane as usize].circle;
        let (first, last) = self.inside;
        let beyond = || steps[first..].iter().take(last - first + 1).find_map(circle);
        if circle(&steps[self.approach]).is_none() { beyond() } else { None }
    }
}

/// The vehicle ahead on the planned way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leader {
    /// Index of the vehicle.
    pub vehicle: u32,
    /// From bumper to bumper, metres.
    pub gap_m: f32,
    pub speed_mps: f32,
}

/// What a vehicle plans. `steps` is its stretch of the common list of steps.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plan {
    pub steps: (u32, u32),
    pub line: Option<Line>,
    pub leader: Option<Leader>,
    /// From the vehicle's middle to where it can go no further, metres.
    pub dead_end_m: Option<f32>,
}

/// Where a lane ends from which no way goes on, metres from its start: at its stop line if it has one.
pub(super) fn way_end_m(lane: &Lane) -> f32 {
    lane.stop.map_or(lane.length_m, |stop| stop.s_m)
}

/// How far a vehicle looks ahead, metres.
pub(super) fn horizon_m(speed_mps: f32, driver: &Driver) -> f32 {
    12.0 + driver.size_m.x + 2.5 * speed_mps + speed_mps * speed_mps / (2.0 * LOOK_BRAKE_MPS2)
}

/// Appends a vehicle's steps and says what lies on them, apart from its leader.
pub(super) fn plan(
    map: &MapData,
    ways: &Ways,
    seed: u64,
    vehicle: &Vehicle,
    driver: &Driver,
    out: &mut Vec<Step>,
) -> Plan {
    let first = out.len();
    let horizon = horizon_m(vehicle.speed_mps, driver);
    let mut plan = Plan::default();
    let mut step = Step { lane: vehicle.lane, start_m: -vehicle.s_m, from_m: 0.0 };
    let mut beyond_m = f32::NEG_INFINITY;
    let mut journey = Journey::of(ways, seed, vehicle);
    for k in 0..MAX_STEPS {
        out.push(step);
        let lane = &map.lanes[step.lane as usize];
        let end_m = step.start_m + lane.length_m;
        let Some(next) = journey.next_lane(step.lane) else {
            plan.dead_end_m = Some(step.start_m + way_end_m(lane));
            break;
        };
        let zone = ways.lanes[next.lane as usize].zone;
        match &mut plan.line {
            None if zone != ways.lanes[step.lane as usize].zone && zone.is_some() => {
                plan.line = Some(line(lane, zone.unwrap_or(0), end_m, driver, k));
            }
            Some(line) if line.inside.1 == k + 1 && zone == Some(line.zone) => line.inside.1 += 1,
            Some(line) if line.inside.1 == k + 1 => beyond_m = end_m + BEYOND_JUNCTION_M,
            _ => {}
        }
        let undecided = plan.line.is_some_and(|line| line.inside.1 > k && line.ahead_m < horizon);
        if end_m > horizon.max(beyond_m) && !undecided {
            break;
        }
        journey.enter(next.lane);
        step = Step { lane: next.lane, start_m: end_m - next.at_m, from_m: next.at_m };
    }
    plan.steps = (first as u32, out.len() as u32);
    let count = out.len() - first;
    plan.line = plan.line.filter(|line| line.inside.0 < count);
    if let Some(line) = &mut plan.line {
        line.inside.1 = line.inside.1.min(count);
        let steps = &out[first..];
        let makes_room = driver.is_long() && line.enters(ways, steps).is_some();
        let narrow = ways.lanes[steps[line.approach].lane as usize].narrow;
        line.back_m = if makes_room || narrow { BACK_M } else { 0.0 };
        let before_m = line.ahead_m - line.back_m;
        let hold_m = zebra::kept_clear(ways, steps, driver, before_m - LINE_MARGIN_M);
        line.hold_m = before_m.min(hold_m + LINE_MARGIN_M);
    }
    plan
}

fn line(lane: &Lane, zone: u32, end_m: f32, driver: &Driver, k: usize) -> Line {
    let front_m = driver.size_m.x * 0.5;
    let marked = lane.stop.map(|stop| end_m - lane.length_m + stop.s_m - front_m);
    let passed = marked.is_some_and(|m| m < -1.0);
    let ahead_m = marked.filter(|_| !passed).unwrap_or(end_m - front_m);
    Line { zone, ahead_m, back_m: 0.0, hold_m: ahead_m, passed, approach: k, inside: (k + 1, k + 2) }
}

/// The nearest vehicle ahead on the planned way, but for those that are `apart` from it.
pub(super) fn leader(
    lists: &Lists,
    steps: &[Step],
    index: usize,
    driver: &Driver,
    horizon_m: f32,
    apart: impl Fn(&Entry) -> bool,
) -> Option<Leader> {
    for step in steps.iter().take_while(|step| step.start_m < horizon_m) {
        // Whoever is beside the place where this vehicle joins the lane is for `zipper` to settle.
        let is_ahead = |e: &&Entry| step.start_m + e.s_m > 0.0 && (e.s_m >= step.from_m || step.from_m == 0.0);
        let ahead = lists.on(step.lane).iter().find(|e| e.vehicle as usize != index && is_ahead(e) && !apart(e));
        if let Some(entry) = ahead {
            let gap_m = step.start_m + entry.s_m - entry.half_m - driver.size_m.x * 0.5;
            return Some(Leader { vehicle: entry.vehicle, gap_m, speed_mps: entry.speed_mps });
        }
    }
    None
}

/// The braking that stops within `distance_m`, m/s², positive; infinite where there is no room.
pub(super) fn braking_needed(speed_mps: f32, distance_m: f32) -> f32 {
    if distance_m <= 0.0 {
        if speed_mps > 0.0 { f32::INFINITY } else { 0.0 }
    } else {
        speed_mps * speed_mps / (2.0 * distance_m)
    }
}

/// The speed from which braking at `brake_mps2` stops within `distance_m`, m/s.
pub(super) fn stopping_speed(distance_m: f32, brake_mps2: f32) -> f32 {
    ops::sqrt(2.0 * brake_mps2 * distance_m.max(0.0))
}
