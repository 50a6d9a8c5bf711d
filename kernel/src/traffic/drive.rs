//! What a vehicle does in a tick.

use crate::light::LightPhase;
use crate::map_data::{LaneId, MapData, Turn};
use crate::ops;
use crate::time::{TICK_S, Tick, seconds};

use super::asking::Asking;
use super::body::Body;
use super::calls::Call;
use super::crosswalk::{self, Claim};
use super::hazard::{Hazard, REACH_M, Seeker, side, sight};
use super::hazards::Hazards;
use super::horn::Horn;
use super::journey::Journey;
use super::junction::{Members, stopping_m, swept_half_m};
use super::lane_way::{ConflictKind, LaneConflict};
use super::lapse::Lapse;
use super::lists::{Entry, Lists};
use super::nearby::Nearby;
use super::plan::{self, Plan, stopping_speed};
use super::poses::leads_m;
use super::rates::HazardRates;
use super::sideways::{EDGE_M, beside, drift, pass_drift};
use super::step::{LINE_MARGIN_M, Step};
use super::traits::Driver;
use super::vehicle::Vehicle;
use super::ways::Ways;
use super::zebra;

/// Time in which a driver takes up a speed that the road asks for, s.
const ADAPT_S: f32 = 0.4;
/// The same before a line; short, so that it is not overrun.
const STOP_S: f32 = 0.25;
/// Vehicles look this far ahead for others in a junction, metres.
const CONFLICT_M: f32 = 30.0;
/// A turn is indicated from here on, metres.
const INDICATE_M: f32 = 40.0;
/// Its indicator is looked after so often.
const INDICATE_TICKS: Tick = 15;
/// Braking at most for people at a crosswalk who are not in the way yet, m/s².
const CROSSWALK_BRAKE_MPS2: f32 = 4.5;
/// Sideways by so much for each metre driven.
const DRIFT: f32 = 0.08;
/// The same to pass something.
const PASS_DRIFT: f32 = 0.2;
/// Sideways motion fades out over this, metres and seconds.
const SWING_M: f32 = 1.5;
const SWING_S: f32 = 0.5;
/// Nobody turns without driving: by 1/100 at most in so much of its length (the turning circle of a car).
const STEERING: f32 = 0.011;
/// Distance that one turn of the pedals drives a bicycle, metres.
const PEDAL_M: f32 = 5.0;

/// What every vehicle sees of the previous tick.
pub(super) struct View<'a> {
    pub map: &'a MapData,
    pub ways: &'a Ways,
    pub seed: u64,
    /// How much the others count for who changes lanes.
    pub politeness: f32,
    pub rates: &'a HazardRates,
    pub lights: &'a [(LightPhase, Tick)],
    pub vehicles: &'a [Vehicle],
    pub drivers: &'a [Driver],
    pub bodies: &'a [Body],
    pub steps: &'a [Step],
    pub plans: &'a [Plan],
    pub lists: &'a Lists,
    pub members: &'a Members,
    pub hazards: &'a Hazards,
    /// People who stand in the world, by index.
    pub crowd: &'a Nearby,
    /// Vehicles that are between lanes.
    pub changing: &'a [Hazard],
    pub claims: &'a [Claim],
    /// Those who signal to another lane.
    pub asking: &'a [Asking],
    pub horn: Option<Horn>,
    /// The ego car is in a junction or on no lane, or cannot stop before a junction any more.
    pub ego_enters: bool,
    /// Buses whose doors are open.
    pub calls: &'a [Call],
    pub tick: Tick,
}

/// Where across its lane a vehicle is to drive, metres to the left of the middle, and how fast it gets
/// there: metres sideways for each metre ahead.
#[derive(Clone, Copy)]
struct Side {
    aim_m: f32,
    drift: f32,
}

impl Side {
    /// Sideways motion to get there, 1/100 for each metre ahead.
    fn drift_aim(&self, next: &Vehicle) -> i8 {
        let within_m = SWING_M.max(SWING_S * next.speed_mps);
        ops::round(((self.aim_m - next.offset_m) / within_m).clamp(-self.drift, self.drift) * 100.0) as i8
    }

    /// Where one that is `offset_m` to the left is after so many metres ahead.
    fn after(&self, offset_m: f32, ahead_m: f32) -> f32 {
        let most_m = self.drift * ahead_m;
        offset_m + (self.aim_m - offset_m).clamp(-most_m, most_m)
    }
}

/// The way on which a vehicle can turn by 1/100, metres.
pub(super) fn turns_in_m(driver: &Driver) -> f32 {
    STEERING * driver.size_m.x
}

/// By how much a vehicle on its way from `s_m` on may turn in a tick, 1/100.
fn steered(driver: &Driver, s_m: f32, moved_m: f32) -> i8 {
    let each_m = turns_in_m(driver);
    i8::from((s_m / each_m) as i32 != ((s_m + moved_m) / each_m) as i32)
}

impl View<'_> {
    /// The next state of vehicle `index`.
    pub fn drive(&self, index: usize) -> Vehicle {
        let mut next = self.vehicles[index];
        if next.is_aside() {
            self.stand_aside(index, &mut next);
            return next;
        }
        let decides = next.decides(self.tick);
        if decides {
            self.decide(index, &mut next);
        }
        self.roll(&self.drivers[index], &mut next);
        if decides {
            self.move_over(index, &self.plans[index], &mut next);
        }
        if self.tick.is_multiple_of(seconds(1)) {
            next.stuck_s = self.stuck_s(index);
        }
        next
    }

    /// What the driver does from now on.
    fn decide(&self, index: usize, next: &mut Vehicle) {
        let plan = &self.plans[index];
        self.err(index, plan, next);
        self.enter_or_wait(index, plan, next);
        if next.is_due(self.tick, INDICATE_TICKS) {
            next.flags = next.flags & !(Vehicle::TURNS_LEFT | Vehicle::TURNS_RIGHT) | self.turn(plan);
        }
        let seeker = self.seeker(index);
        self.call(index, plan, next);
        if !next.lapse.is_to_kerb() {
            self.decide_manoeuvre(index, plan, &seeker, next);
        }
        let side = self.side(index, plan, &seeker);
        let halt_mps2 = self.lapse_mps2(next).min(self.call_mps2(index, plan, next));
        let halt_mps2 = halt_mps2.min(self.falls_back_mps2(index, plan, &seeker));
        let behind = self.behind_leader_mps2(index, plan, next).min(halt_mps2);
        let wanted = self.acceleration(index, plan, next, &seeker, side).min(behind);
        let forbearance_mps2 = self.forbearance_mps2(index, plan, next);
        let accel = wanted.min(forbearance_mps2.unwrap_or(f32::INFINITY)).max(-self.drivers[index].hardest_mps2);
        next.drift_aim = side.drift_aim(next);
        let accel = self.last_look(index, next, accel, forbearance_mps2.is_none());
        let was_braking = next.flags & Vehicle::BRAKING != 0;
        let braking = next.speed_mps < 0.1 || accel < if was_braking { -0.3 } else { -0.8 };
        next.flags = if braking { next.flags | Vehicle::BRAKING } else { next.flags & !Vehicle::BRAKING };
        next.accel_cmps2 = ops::round(accel * 100.0) as i16;
    }

    pub(super) fn steps_of(&self, plan: &Plan) -> &[Step] {
        &self.steps[plan.steps.0 as usize..plan.steps.1 as usize]
    }

    /// The flag of the turn that a vehicle takes at the junction right before it, or in it.
    fn turn(&self, plan: &Plan) -> u8 {
        let near = self.steps_of(plan).iter().take_while(|step| step.start_m < INDICATE_M);
        let mut inside = near.map(|step| &self.map.lanes[step.lane as usize]).filter(|lane| lane.junction.is_some());
        match inside.next().map(|lane| lane.turn) {
            Some(Turn::Left) => Vehicle::TURNS_LEFT,
            Some(Turn::Right) => Vehicle::TURNS_RIGHT,
            _ => 0,
        }
    }

    fn acceleration(&self, index: usize, plan: &Plan, next: &Vehicle, seeker: &Seeker, side: Side) -> f32 {
        let driver = &self.drivers[index];
        let steps = self.steps_of(plan);
        let v = next.speed_mps;
        let mut accel = self.free_acceleration(next, driver, steps).min(self.zip(index, steps, next, seeker.horizon_m));
        accel = accel.min(self.heed_bends(index, steps, next));
        let mut follow = |gap_m: f32, speed_mps: f32| accel = accel.min(follow_idm(driver, v, gap_m, speed_mps));
        self.heed_manoeuvres(index, plan, seeker, |m| side.after(seeker.offset_m, m), &mut follow);
        let mut room = f32::MAX;
        let around = self.hazards.around(seeker.position, seeker.horizon_m + REACH_M);
        for hazard in around.filter(|h| h.vehicle.is_none()) {
            let Some(seen) = sight(self.map, steps, seeker, hazard) else { continue };
            let ahead_m = if hazard.stands() { seen.gap_m.max(0.0) } else { 0.0 };
            let offset_m = side.after(seeker.offset_m, ahead_m);
            let slow_mps = if hazard.stands() { v } else { f32::MAX };
            let blocks = seen.blocks_at(offset_m, seeker.half.y, slow_mps);
            if blocks {
                follow(seen.gap_m, seen.speed_mps);
                if hazard.stands() {
                    room = room.min(self.room_to_pass(index, plan, v, seen.gap_m));
                }
            }
        }
        self.conflicts(index, plan, steps, next, &mut follow);
        accel = accel.min(self.lets_in(index, plan));
        let wall_m = self.wall(index, plan, steps, next);
        let stop = (stopping_speed(wall_m, driver.brake_mps2) - v) / STOP_S;
        accel.min(room).min(stop).max(-driver.hardest_mps2)
    }

    pub(super) fn seeker(&self, index: usize) -> Seeker {
        let (vehicle, driver) = (&self.vehicles[index], &self.drivers[index]);
        Seeker {
            position: self.bodies[index].position,
            offset_m: vehicle.offset_m + leads_m(vehicle, driver),
            speed_mps: vehicle.speed_mps,
            half: driver.size_m.truncate() * 0.5,
            horizon_m: plan::horizon_m(vehicle.speed_mps, driver),
        }
    }

    /// Where across its lane a vehicle likes to drive, metres to the left of the middle: where its lane
    /// ends over the border to the lane beside it, not to oncoming traffic.
    pub(super) fn likes_m(&self, index: usize) -> f32 {
        let (vehicle, driver) = (&self.vehicles[index], &self.drivers[index]);
        let lane = &self.map.lanes[vehicle.lane as usize];
        let keeps_m = driver.keeps_to_m(lane.points[lane.segment(vehicle.s_m).0].half_width_m, self.ways.kerb);
        if self.ways.lanes[vehicle.lane as usize].ends_m.is_none() {
            return keeps_m;
        }
        let half_m = driver.size_m.x * 0.5;
        let [tail, front] = [-half_m, half_m].map(|m| lane.at(vehicle.s_m + m).half_width_m);
        let over_m = (driver.size_m.y * 0.5 + EDGE_M - tail.min(front)).max(0.0);
        match (lane.left, lane.right) {
            (None, Some(_)) => keeps_m.min(-over_m),
            (Some(_), None) => keeps_m.max(over_m),
            _ => keeps_m,
        }
    }

    fn side(&self, index: usize, plan: &Plan, seeker: &Seeker) -> Side {
        let (vehicle, side) = (&self.vehicles[index], self.wanted_side(index, plan, seeker));
        // Who makes room may have somebody on the lane beside.
        let aside_m = side.aim_m - self.likes_m(index);
        let makes_room = !vehicle.manoeuvre.passes() && aside_m != 0.0;
        let alongside = makes_room && beside(self.map, vehicle.lane, aside_m > 0.0).is_some();
        if vehicle.manoeuvre.is_between_lanes() || alongside {
            Side { aim_m: self.beside_others(index, plan, seeker, side.aim_m), ..side }
        } else {
            side
        }
    }

    fn wanted_side(&self, index: usize, plan: &Plan, seeker: &Seeker) -> Side {
        if let Some(aim_m) = self.kerb_m(index) {
            return Side { aim_m, drift: PASS_DRIFT };
        }
        let (vehicle, likes_m) = (&self.vehicles[index], self.likes_m(index));
        let passing = vehicle.manoeuvre.passes().then(|| vehicle.manoeuvre.side());
        let beside_m = passing.and_then(|side| {
            let passed = self.passed(index, plan, seeker, side)?;
            let aim_m = self.beside_m(index, plan, seeker, &passed, side)?;
            Some(self.within_border(index, plan, seeker, aim_m, side))
        });
        if let Some(aim_m) = beside_m {
            return Side { aim_m, drift: pass_drift(vehicle.speed_mps) };
        }
        let standing = self.hazards.free().iter().filter(|h| h.stands());
        let forward = (self.bodies[index].rotation * glam::Vec3::X).truncate();
        // Who comes the other way and reaches over the border is given room.
        let coming = self.changing.iter().filter(|h| h.forward.dot(forward) < -0.3);
        let aim_m = side(self.map, self.steps_of(plan), seeker, standing.chain(coming), likes_m);
        let drift = match vehicle.manoeuvre {
            manoeuvre if manoeuvre.moves() => drift(vehicle.speed_mps, seeker.half.x),
            manoeuvre if manoeuvre.passes() => pass_drift(vehicle.speed_mps),
            // The front of a bus that turned more would swing out of its lane.
            _ if aim_m == likes_m && vehicle.lapse != Lapse::PullsOut => DRIFT,
            _ => PASS_DRIFT,
        };
        Side { aim_m, drift }
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
            aim = aim.min(ops::sqrt(reachable));
        }
        let ratio = next.speed_mps / aim.max(0.1);
        if ratio <= 1.0 {
            driver.accel_mps2 * (1.0 - ratio * ratio * ratio * ratio)
        } else {
            ((aim - next.speed_mps) / ADAPT_S).max(-1.5 * driver.brake_mps2)
        }
    }

    /// Distance from the front to the first place at which the vehicle must not go on, metres.
    fn wall(&self, index: usize, plan: &Plan, steps: &[Step], next: &Vehicle) -> f32 {
        let driver = &self.drivers[index];
        let front_m = driver.size_m.x * 0.5;
        let crossing = next.flags & Vehicle::CROSSING != 0;
        let heeds_waiting = !crossing && next.stuck_s < crosswalk::HEED_S && !self.is_honked_at(index);
        let mut wall_m = plan.dead_end_m.map_or(f32::MAX, |m| m - front_m - 1.0);
        if let Some(line) = plan.line.filter(|_| next.flags & Vehicle::GRANTED == 0) {
            let (line_m, back_m) = (line.ahead_m - LINE_MARGIN_M, line.back_m);
            // Who rolls over where it should wait stands there, and not at the line.
            let stoppable =
                plan::braking_needed(next.speed_mps, (line_m - back_m).max(0.0) + 0.3) < CROSSWALK_BRAKE_MPS2;
            wall_m = wall_m.min(if stoppable { line_m - back_m } else { line_m });
        }
        for step in steps {
            for span in &self.ways.lanes[step.lane as usize].crosswalks {
                let ahead_m = step.start_m + span.near_m - front_m - LINE_MARGIN_M;
                if ahead_m > wall_m || ahead_m < -1.0 {
                    continue;
                }
                let place = || self.map.lanes[step.lane as usize].straight_on(span.near_m);
                let stoppable = plan::braking_needed(next.speed_mps, ahead_m + 0.3) < CROSSWALK_BRAKE_MPS2;
                if stoppable && crosswalk::is_claimed(self.claims, span.crosswalk, heeds_waiting, place) {
                    wall_m = ahead_m;
                }
            }
        }
        if crossing { wall_m } else { self.clear_of_crosswalks(plan, steps, next, driver, wall_m) }
    }

    /// The same so that the vehicle stands on no crosswalk, behind its leader or before `wall_m`.
    fn clear_of_crosswalks(&self, plan: &Plan, steps: &[Step], next: &Vehicle, driver: &Driver, wall_m: f32) -> f32 {
        let behind = |leader: plan::Leader| leader.gap_m + stopping_m(leader.speed_mps) - driver.gap_m;
        let stop_m = plan.leader.map_or(f32::MAX, behind).min(wall_m);
        let clear_m = zebra::kept_clear(self.ways, steps, driver, stop_m);
        let stoppable = plan::braking_needed(next.speed_mps, clear_m + 0.3) < CROSSWALK_BRAKE_MPS2;
        if clear_m < stop_m && stoppable { clear_m } else { wall_m }
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

    /// Drives on for a tick as the driver holds pedals and wheel.
    fn roll(&self, driver: &Driver, next: &mut Vehicle) {
        let accel = f32::from(next.accel_cmps2) * 0.01;
        let before = next.speed_mps;
        next.speed_mps = (before + accel * TICK_S).max(0.0);
        if accel < 0.05 && next.speed_mps < 0.02 {
            next.speed_mps = 0.0;
        }
        let moved_m = 0.5 * (before + next.speed_mps) * TICK_S;
        let steered = steered(driver, next.s_m, moved_m);
        next.s_m += moved_m;
        let turns = moved_m / PEDAL_M;
        next.phase = next.phase.wrapping_add((turns * 65536.0) as u16);
        self.change_lane(driver, next);
        if moved_m > 0.0 {
            next.drift += (next.drift_aim - next.drift).clamp(-steered, steered);
            next.offset_m += f32::from(next.drift) * 0.01 * moved_m;
        }
    }

    /// Takes the lanes that follow, and clears what belonged to the junction left behind.
    pub(super) fn change_lane(&self, driver: &Driver, next: &mut Vehicle) {
        loop {
            let length_m = self.map.lanes[next.lane as usize].length_m;
            if next.s_m < length_m {
                break;
            }
            let mut journey = Journey::of(self.ways, self.seed, next);
            let Some(onward) = journey.next_lane(next.lane) else {
                next.s_m = length_m;
                next.speed_mps = 0.0;
                break;
            };
            // At the same place in the world, however the lanes join.
            let end = self.map.lanes[next.lane as usize].straight_on(length_m);
            let at = end.beside(next.offset_m);
            let place = self.map.lanes[onward.lane as usize].straight_on(onward.at_m);
            next.offset_m = (at - place.position).truncate().dot(place.left());
            next.s_m += onward.at_m - length_m;
            next.before = if end.joins(&place) { next.lane } else { onward.lane };
            next.lane = onward.lane;
            journey.enter(next.lane);
            next.trips = journey.trips;
            if self.ways.lanes[next.lane as usize].zone.is_some() {
                next.flags &= !(Vehicle::GRANTED | Vehicle::ASKING | Vehicle::HALTED);
                next.flags |= Vehicle::CROSSING;
                next.wait_ticks = 0;
                if matches!(next.lapse, Lapse::RunsRed | Lapse::Rolls) {
                    next.lapse = Lapse::None;
                }
            }
        }
        let outside = self.ways.lanes[next.lane as usize].zone.is_none();
        if outside && next.s_m > swept_half_m(driver.size_m) {
            next.flags &= !Vehicle::CROSSING;
        }
    }
}

/// Acceleration behind somebody: the interaction part of the intelligent driver model; the caller
/// takes the lesser of this and the free part, as IDM+ does (Schakel, van Arem and Netten 2010). m/s².
pub(super) fn follow_idm(driver: &Driver, speed_mps: f32, gap_m: f32, leader_mps: f32) -> f32 {
    if gap_m < 0.3 {
        return -driver.hardest_mps2;
    }
    let closing = speed_mps - leader_mps;
    let root = 2.0 * ops::sqrt(driver.accel_mps2 * driver.brake_mps2);
    let wanted = driver.gap_m + (speed_mps * driver.headway_s + speed_mps * closing / root).max(0.0);
    let ratio = wanted / gap_m;
    driver.accel_mps2 * (1.0 - ratio * ratio)
}
