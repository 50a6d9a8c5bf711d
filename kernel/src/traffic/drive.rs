//! What a vehicle does in a tick.

use crate::light::LightPhase;
use crate::map_data::{LaneId, MapData, StopKind};
use crate::time::{TICK_S, Tick, seconds};

use super::body::Body;
use super::crosswalk::{self, Claim};
use super::hazard::{Hazard, Seeker, in_way};
use super::junction::{self, Members, Signal, swept_half_m};
use super::lists::{Entry, Lists};
use super::plan::{self, Line, Plan, Step, next_lane, stopping_speed};
use super::traits::Driver;
use super::vehicle::Vehicle;
use super::ways::{ConflictKind, LaneConflict, Ways};

/// Hardest braking, m/s².
const EMERGENCY_MPS2: f32 = 8.0;
/// Time in which a driver takes up a speed that the road asks for, s.
const ADAPT_S: f32 = 0.4;
/// The same before a line; short, so that it is not overrun.
const STOP_S: f32 = 0.25;
/// Distance kept from a line, metres.
const LINE_MARGIN_M: f32 = 1.0;
/// Vehicles look this far ahead for others in a junction, metres.
const CONFLICT_M: f32 = 30.0;
/// How long a vehicle stands at a stop sign.
const HALT_TICKS: u16 = seconds(1) as u16;
/// Braking at most for people at a crosswalk who are not in the way yet, m/s².
const CROSSWALK_BRAKE_MPS2: f32 = 4.5;
/// Distance that one turn of the pedals drives a bicycle, metres.
const PEDAL_M: f32 = 5.0;

/// What every vehicle sees of the previous tick.
pub(super) struct View<'a> {
    pub map: &'a MapData,
    pub ways: &'a Ways,
    pub seed: u64,
    pub lights: &'a [(LightPhase, Tick)],
    pub vehicles: &'a [Vehicle],
    pub drivers: &'a [Driver],
    pub bodies: &'a [Body],
    pub steps: &'a [Step],
    pub plans: &'a [Plan],
    pub lists: &'a Lists,
    pub members: &'a Members,
    pub hazards: &'a [Hazard],
    pub claims: &'a [Claim],
}

impl View<'_> {
    /// The next state of vehicle `index`.
    pub fn drive(&self, index: usize) -> Vehicle {
        let plan = &self.plans[index];
        let mut next = self.vehicles[index];
        self.decide(index, plan, &mut next);
        let accel = self.acceleration(index, plan, &next);
        self.advance(index, accel, &mut next);
        next
    }

    fn steps_of(&self, plan: &Plan) -> &[Step] {
        &self.steps[plan.steps.0 as usize..plan.steps.1 as usize]
    }

    /// Asks for grants, gives them back, waits and halts.
    fn decide(&self, index: usize, plan: &Plan, next: &mut Vehicle) {
        let Some(line) = &plan.line else {
            next.flags &= !Vehicle::GRANTED;
            next.wait_ticks = 0;
            return;
        };
        let steps = self.steps_of(plan);
        let signal = junction::signal(self.map, self.lights, next, steps[line.approach].lane);
        if next.flags & Vehicle::GRANTED != 0 {
            if junction::must_stop(signal, next, line) || !junction::near_enough(next, line, 6.0) {
                next.flags &= !Vehicle::GRANTED;
            }
        } else if let Some(asking) = self.members.asking(line.junction, index)
            && self.members.grants(self.ways, asking, &steps[line.inside.0..line.inside.1])
        {
            next.flags |= Vehicle::GRANTED;
        }
        self.wait(line, signal, steps, next);
    }

    fn wait(&self, line: &Line, signal: Signal, steps: &[Step], next: &mut Vehicle) {
        let stop = self.map.lanes[steps[line.approach].lane as usize].stop;
        let sign = stop.is_some_and(|stop| stop.kind == StopKind::Stop);
        let at_line = line.ahead_m < LINE_MARGIN_M + 2.0 && next.speed_mps < 0.3;
        if at_line && (sign || signal == Signal::Open) {
            next.wait_ticks = next.wait_ticks.saturating_add(1);
        } else if !at_line {
            next.wait_ticks = 0;
        }
        if sign && next.wait_ticks >= HALT_TICKS {
            next.flags |= Vehicle::HALTED;
        }
    }

    fn acceleration(&self, index: usize, plan: &Plan, next: &Vehicle) -> f32 {
        let driver = &self.drivers[index];
        let steps = self.steps_of(plan);
        let v = next.speed_mps;
        let mut accel = self.free_acceleration(next, driver, steps);
        let mut follow = |gap_m: f32, speed_mps: f32| accel = accel.min(follow_idm(driver, v, gap_m, speed_mps));
        if let Some(leader) = plan.leader {
            follow(leader.gap_m, leader.speed_mps);
        }
        let seeker = self.seeker(index, driver);
        for hazard in self.hazards {
            if let Some((gap_m, speed_mps)) = in_way(self.map, steps, &seeker, hazard) {
                follow(gap_m, speed_mps);
            }
        }
        self.conflicts(index, plan, steps, next, &mut follow);
        let wall_m = self.wall(plan, steps, next, driver);
        let stop = (stopping_speed(wall_m, driver.brake_mps2) - v) / STOP_S;
        accel.min(stop).max(-EMERGENCY_MPS2)
    }

    fn seeker(&self, index: usize, driver: &Driver) -> Seeker {
        let vehicle = &self.vehicles[index];
        Seeker {
            position: self.bodies[index].position,
            offset_m: vehicle.offset_m,
            speed_mps: vehicle.speed_mps,
            half: driver.size_m.truncate() * 0.5,
            horizon_m: plan::horizon_m(vehicle.speed_mps, driver),
        }
    }

    /// Acceleration on an empty road: the model's, and what curves and limits ahead ask for.
    fn free_acceleration(&self, next: &Vehicle, driver: &Driver, steps: &[Step]) -> f32 {
        let lane = &self.map.lanes[next.lane as usize];
        let desired = |limit_mps: f32| (limit_mps * driver.limit_share).min(driver.top_mps);
        let curve = self.ways.lanes[next.lane as usize].curve_speed(lane, next.s_m);
        let mut aim = desired(lane.speed_limit_mps).min(curve);
        for step in &steps[1..] {
            let limit = desired(self.map.lanes[step.lane as usize].speed_limit_mps);
            let entry = self.ways.lanes[step.lane as usize].speed_mps[0].min(limit);
            let reachable = entry * entry + 2.0 * driver.brake_mps2 * step.start_m;
            aim = aim.min(crate::ops::sqrt(reachable));
        }
        let ratio = next.speed_mps / aim.max(0.1);
        if ratio <= 1.0 {
            driver.accel_mps2 * (1.0 - ratio * ratio * ratio * ratio)
        } else {
            ((aim - next.speed_mps) / ADAPT_S).max(-1.5 * driver.brake_mps2)
        }
    }

    /// Distance from the front to the first place at which the vehicle must not go on, metres.
    fn wall(&self, plan: &Plan, steps: &[Step], next: &Vehicle, driver: &Driver) -> f32 {
        let front_m = driver.size_m.x * 0.5;
        let mut wall_m = plan.dead_end_m.map_or(f32::MAX, |m| m - front_m - 1.0);
        if let Some(line) = plan.line.filter(|_| next.flags & Vehicle::GRANTED == 0) {
            wall_m = wall_m.min(line.ahead_m - LINE_MARGIN_M);
        }
        for step in steps {
            for span in &self.ways.lanes[step.lane as usize].crosswalks {
                let ahead_m = step.start_m + span.near_m - front_m - LINE_MARGIN_M;
                if ahead_m > wall_m || ahead_m < -1.0 {
                    continue;
                }
                let place = || self.map.lanes[step.lane as usize].straight_on(span.near_m);
                let stoppable = plan::braking_needed(next.speed_mps, ahead_m + 0.3) < CROSSWALK_BRAKE_MPS2;
                if stoppable && crosswalk::is_claimed(self.claims, span.crosswalk, place) {
                    wall_m = ahead_m;
                }
            }
        }
        wall_m
    }

    /// Follows or lets pass those inside the junction whose lanes conflict with this vehicle's.
    fn conflicts(&self, index: usize, plan: &Plan, steps: &[Step], next: &Vehicle, follow: &mut impl FnMut(f32, f32)) {
        let granted = next.flags & Vehicle::GRANTED != 0;
        let end = plan.line.filter(|_| !granted).map_or(steps.len(), |line| line.inside.0);
        let half_m = self.drivers[index].size_m.x * 0.5;
        for (k, step) in steps[..end].iter().enumerate() {
            for conflict in &self.ways.lanes[step.lane as usize].conflicts {
                let (from_m, to_m) = (step.start_m + conflict.here[0], step.start_m + conflict.here[1]);
                if to_m < -half_m || (k > 0 && from_m - half_m > CONFLICT_M) {
                    continue;
                }
                let others = self.lists.on(conflict.lane).iter().filter(|e| e.vehicle as usize != index);
                for entry in others {
                    if let Some((gap_m, speed_mps)) = self.conflict_gap(step, conflict, entry, half_m) {
                        follow(gap_m, speed_mps);
                    }
                }
            }
        }
    }

    /// Gap to a vehicle on a lane that conflicts with that of `step`, and its speed, if it is in the way.
    fn conflict_gap(&self, step: &Step, conflict: &LaneConflict, entry: &Entry, half_m: f32) -> Option<(f32, f32)> {
        let swept_m = swept_half_m(self.drivers[entry.vehicle as usize].size_m);
        let [from_m, to_m] = conflict.there;
        if entry.s_m + entry.half_m < from_m || entry.s_m - swept_m > to_m {
            return None;
        }
        let length = |lane: LaneId| self.map.lanes[lane as usize].length_m;
        let between_m = match conflict.kind {
            ConflictKind::Diverge => step.start_m + entry.s_m,
            ConflictKind::Merge => step.start_m + length(step.lane) - (length(conflict.lane) - entry.s_m),
            ConflictKind::Cross => {
                let ahead_m = step.start_m + conflict.here[0] - half_m;
                return (ahead_m > 0.0).then_some((ahead_m, 0.0));
            }
        };
        (between_m > 0.0).then_some((between_m - entry.half_m - half_m, entry.speed_mps))
    }

    fn advance(&self, index: usize, accel: f32, next: &mut Vehicle) {
        let driver = &self.drivers[index];
        let was_braking = next.flags & Vehicle::BRAKING != 0;
        let before = next.speed_mps;
        next.speed_mps = (before + accel * TICK_S).max(0.0);
        if accel < 0.05 && next.speed_mps < 0.02 {
            next.speed_mps = 0.0;
        }
        let moved_m = 0.5 * (before + next.speed_mps) * TICK_S;
        next.s_m += moved_m;
        let turns = moved_m / PEDAL_M;
        next.phase = next.phase.wrapping_add((turns * 65536.0) as u16);
        let braking = next.speed_mps < 0.1 || accel < if was_braking { -0.3 } else { -0.8 };
        next.flags = if braking { next.flags | Vehicle::BRAKING } else { next.flags & !Vehicle::BRAKING };
        self.change_lane(driver, next);
        self.keep_side(driver, moved_m, next);
    }

    /// Takes the lanes that follow, and clears what belonged to the junction left behind.
    fn change_lane(&self, driver: &Driver, next: &mut Vehicle) {
        loop {
            let length_m = self.map.lanes[next.lane as usize].length_m;
            if next.s_m < length_m {
                break;
            }
            let Some(lane) = next_lane(self.ways, self.seed, next, next.hops, next.lane) else {
                next.s_m = length_m;
                next.speed_mps = 0.0;
                break;
            };
            next.s_m -= length_m;
            next.lane = lane;
            next.hops = next.hops.wrapping_add(1);
            if self.map.lanes[lane as usize].junction.is_some() {
                next.flags &= !(Vehicle::GRANTED | Vehicle::HALTED);
                next.flags |= Vehicle::CROSSING;
                next.wait_ticks = 0;
            }
        }
        let outside = self.map.lanes[next.lane as usize].junction.is_none();
        if outside && next.s_m > swept_half_m(driver.size_m) {
            next.flags &= !Vehicle::CROSSING;
        }
    }

    fn keep_side(&self, driver: &Driver, moved_m: f32, next: &mut Vehicle) {
        let lane = &self.map.lanes[next.lane as usize];
        let half_width_m = || lane.points[lane.segment(next.s_m).0].half_width_m;
        let aim = driver.from_right_m.map_or(0.0, |m| (m - half_width_m()).min(0.0));
        let step = 0.08 * moved_m;
        next.offset_m += (aim - next.offset_m).clamp(-step, step);
    }
}

/// Acceleration behind somebody: the interaction part of the intelligent driver model; the caller
/// takes the lesser of this and the free part, as IDM+ does (Schakel, van Arem and Netten 2010). m/s².
fn follow_idm(driver: &Driver, speed_mps: f32, gap_m: f32, leader_mps: f32) -> f32 {
    if gap_m < 0.3 {
        return -EMERGENCY_MPS2;
    }
    let closing = speed_mps - leader_mps;
    let root = 2.0 * crate::ops::sqrt(driver.accel_mps2 * driver.brake_mps2);
    let wanted = driver.gap_m + (speed_mps * driver.headway_s + speed_mps * closing / root).max(0.0);
    let ratio = wanted / gap_m;
    driver.accel_mps2 * (1.0 - ratio * ratio)
}
