//! Passing bicycles, and whatever stands in the lane: over the border of the lane where nobody comes the
//! other way for as long as that takes.

use glam::Vec2;

use crate::actor::ActorKind;
use crate::geometry::direction;
use crate::map_data::LaneKind;
use crate::ops;

use super::drive::{View, follow_idm};
use super::hazard::{BICYCLE_M, Hazard, Seeker, sight};
use super::junction::stopping_m;
use super::lists::Entry;
use super::plan::Plan;
use super::step::Step;
use super::traits::Driver;
use super::vehicle::Vehicle;

/// Side clearance beyond the least, metres, and to what stands.
const MORE_M: f32 = 0.1;
const STANDING_M: f32 = 0.6;
/// Whom one wants to pass comes into view here, metres.
const REACH_M: f32 = 45.0;
/// Passing begins from a gap of so much on, metres and seconds.
const START_M: f32 = 12.0;
const START_S: f32 = 2.0;
/// By then one is beside whom one passes.
const SWING_OUT_TICKS: u8 = 240;
/// While passing the next one ahead is passed with the first up to this gap, metres and seconds.
const NEXT_M: f32 = 2.0;
const NEXT_S: f32 = 0.3;
/// Only who is slower than one would like to be by this is passed, m/s.
const SLOWER_MPS: f32 = 2.5;
/// Back in front of whom one has passed at this distance, metres.
const AFTER_M: f32 = 4.0;
/// Room for that before the next vehicle, metres.
const ROOM_M: f32 = 12.0;
/// What takes so much longer than computed is still safe, s.
const SPARE_S: f32 = 2.0;
/// Share of the greatest acceleration that is counted with.
const SPEEDING_UP: f32 = 0.8;
/// Those who may come the other way speed up like this, m/s².
const SPEEDS_UP_MPS2: f32 = 1.5;
/// Distance to those who come the other way at the end, metres.
const SPARE_M: f32 = 15.0;
/// Nobody passes where the road bends more than this on the way, radians.
const BEND_RAD: f32 = 0.25;
/// Distance to swing out from before what stands, of cars and of long vehicles, metres, and braking for that, m/s².
const SWING_OUT_M: f32 = 6.0;
const LONG_SWING_OUT_M: f32 = 20.0;
const SWING_OUT_MPS2: f32 = 2.5;
/// What stands nearer than this to a junction waits there, metres.
const QUEUE_M: f32 = 40.0;
/// Bicycles slower than this queue, m/s. Who passes without room before them falls back by so much, m/s, taken up in so long, s.
const QUEUE_MPS: f32 = 1.5;
const FALL_BACK_MPS: f32 = 2.0;
const FALL_BACK_S: f32 = 1.0;
/// From this gap on one is behind whom one passes, metres.
const BEHIND_M: f32 = 0.3;
/// The lane for the other direction is met at this distance beyond the border of one's own, metres.
const ONCOMING_M: f32 = 1.2;
/// Those who come the other way may be so far to the side, metres.
const ASIDE_M: f32 = 9.0;
/// And farther by so much for each metre beyond the way that is looked along.
const BENDS: f32 = 0.5;
/// Roads farther apart in height pass over each other, metres.
const LEVEL_M: f32 = 4.0;
/// Others who pass are not passed within this, metres.
const OTHERS_M: f32 = 40.0;

/// Those whom a vehicle passes, as one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passed {
    /// Where across its lane the vehicle drives beside them, metres to the left of the middle.
    pub aim_m: f32,
    /// From its front to the first one's tail, metres.
    gap_m: f32,
    /// From its middle to the last one's front, metres.
    beyond_m: f32,
    /// Speed of the fastest, m/s, and of the first one.
    speed_mps: f32,
    first_mps: f32,
    /// They ride.
    ride: bool,
}

/// Whether one of two vehicles passes the other, or something else beside it, and is clear of its way. Who passes comes back
/// into the lane, so nobody but a bicycle, which may be whom it passes, rides up beside it.
pub(super) fn apart(vehicles: &[Vehicle], drivers: &[Driver], index: usize, other: &Entry) -> bool {
    let (me, them) = (&vehicles[index], &vehicles[other.vehicle as usize]);
    let half_m = (drivers[index].size_m.y + drivers[other.vehicle as usize].size_m.y) * 0.5;
    let passes = if them.manoeuvre.passes() { me.kind.is_pedalled() } else { me.manoeuvre.passes() };
    passes && (me.offset_m - them.offset_m).abs() > half_m + 0.3
}

impl Passed {
    /// Whether they ride so slowly that those before them must stand or wait: there is no way past.
    fn queues(&self) -> bool {
        self.ride && self.speed_mps < QUEUE_MPS
    }

    /// Both as one; `side` as of [`Manoeuvre::side`](super::manoeuvre::Manoeuvre::side).
    fn with(self, next: &Self, side: f32) -> Self {
        Self {
            aim_m: if side > 0.0 { self.aim_m.max(next.aim_m) } else { self.aim_m.min(next.aim_m) },
            gap_m: self.gap_m.min(next.gap_m),
            beyond_m: self.beyond_m.max(next.beyond_m),
            speed_mps: self.speed_mps.max(next.speed_mps),
            first_mps: self.first_mps,
            ride: self.ride && next.ride,
        }
    }
}

/// The distance that a vehicle keeps from what stands so that it can swing out, metres.
pub(super) fn swing_out_m(driver: &Driver) -> f32 {
    if driver.size_m.x > 5.0 { LONG_SWING_OUT_M } else { SWING_OUT_M }
}

/// Time and distance in which one who speeds up from `from_mps` to `wish_mps` gains so many metres on another.
fn catch_up(driver: &Driver, from_mps: f32, wish_mps: f32, other_mps: f32, gain_m: f32) -> (f32, f32) {
    let accel_mps2 = SPEEDING_UP * driver.accel_mps2;
    let faster_mps = from_mps - other_mps;
    let root = ops::sqrt((faster_mps * faster_mps + 2.0 * accel_mps2 * gain_m).max(0.0));
    let speeding_s = ((root - faster_mps) / accel_mps2).min((wish_mps - from_mps).max(0.0) / accel_mps2);
    let speeding_m = (from_mps + 0.5 * accel_mps2 * speeding_s) * speeding_s;
    let top_mps = from_mps + accel_mps2 * speeding_s;
    let left_m = (gain_m - (speeding_m - other_mps * speeding_s)).max(0.0);
    let rest_s = left_m / (top_mps - other_mps).max(0.5);
    (speeding_s + rest_s, speeding_m + top_mps * rest_s)
}

impl View<'_> {
    /// The bicycles and standing things that a vehicle passes on a side (1: on their left), or could pass.
    pub(super) fn passed(&self, index: usize, plan: &Plan, seeker: &Seeker, side: i8) -> Option<Passed> {
        let side = f32::from(side);
        let passing = self.vehicles[index].manoeuvre.passes();
        let reach_m = match self.vehicles[index].signal_ticks {
            _ if !passing => REACH_M,
            0..SWING_OUT_TICKS => START_M + START_S * seeker.speed_mps,
            _ => NEXT_M + NEXT_S * seeker.speed_mps,
        };
        let steps = self.steps_of(plan);
        let mut found = self.bicycles_ahead(index, steps, seeker, side);
        let likes_m = self.likes_m(index);
        for hazard in self.hazards.free().iter().filter(|h| passing || h.stands()) {
            let Some(seen) = sight(self.map, steps, seeker, hazard) else { continue };
            if seen.gap_m < REACH_M && seen.obstructs(likes_m, seeker.half.y) && (hazard.stands() || seen.gap_m < 0.0) {
                found.push(Passed {
                    aim_m: seen.edge_m(side) + side * (STANDING_M + seeker.half.y),
                    gap_m: seen.gap_m,
                    beyond_m: seen.gap_m + seeker.half.x + seen.length_m,
                    speed_mps: seen.speed_mps.max(0.0),
                    first_mps: seen.speed_mps.max(0.0),
                    ride: false,
                });
            }
        }
        found.sort_unstable_by(|a, b| a.gap_m.total_cmp(&b.gap_m));
        let (first, rest) = found.split_first().filter(|(first, _)| first.gap_m < reach_m)?;
        // Before one who leaves room one gets back into the lane.
        let room_m = 2.0 * seeker.half.x + ROOM_M;
        let mut all = *first;
        for next in rest {
            if next.gap_m + seeker.half.x > all.beyond_m + room_m {
                break;
            }
            all = all.with(next, side);
        }
        Some(all)
    }

    fn bicycles_ahead(&self, index: usize, steps: &[Step], seeker: &Seeker, side: f32) -> Vec<Passed> {
        let near = |step: &&Step| step.start_m < REACH_M + seeker.half.x;
        let entries = steps.iter().take_while(near).flat_map(|s| self.lists.on(s.lane).iter().map(move |e| (s, e)));
        let bicycle = |(step, entry): (&Step, &Entry)| {
            let them = &self.vehicles[entry.vehicle as usize];
            let gap_m = step.start_m + entry.s_m - entry.half_m - seeker.half.x;
            let is_near = gap_m < REACH_M && gap_m + 2.0 * (entry.half_m + seeker.half.x) > -1.0;
            let half_m = self.drivers[entry.vehicle as usize].size_m.y * 0.5;
            let passed = Passed {
                aim_m: them.offset_m + side * (half_m + BICYCLE_M + MORE_M + seeker.half.y),
                gap_m,
                beyond_m: gap_m + seeker.half.x + 2.0 * entry.half_m,
                speed_mps: them.speed_mps,
                first_mps: them.speed_mps,
                ride: true,
            };
            let other = entry.vehicle as usize != index && them.kind.is_pedalled();
            (other && is_near).then_some(passed)
        };
        entries.filter_map(bicycle).collect()
    }

    /// The greatest acceleration behind what stands at `gap_m` where no junction is near: it is kept off so far that it
    /// can be passed.
    pub(super) fn room_to_pass(&self, index: usize, plan: &Plan, speed_mps: f32, gap_m: f32) -> f32 {
        let queues = plan.line.is_some_and(|line| line.hold_m < gap_m + QUEUE_M);
        let vehicle = &self.vehicles[index];
        if queues || vehicle.manoeuvre.passes() || vehicle.kind.is_pedalled() {
            return f32::MAX;
        }
        let driver = &self.drivers[index];
        follow_idm(driver, speed_mps, gap_m - swing_out_m(driver), 0.0).max(-SWING_OUT_MPS2)
    }

    /// The side on which a vehicle passes somebody now, if it wishes to and may.
    pub(super) fn wish_to_pass(&self, index: usize, plan: &Plan, seeker: &Seeker) -> Option<i8> {
        let vehicle = &self.vehicles[index];
        let lane = &self.map.lanes[vehicle.lane as usize];
        let busy = vehicle.flags & (Vehicle::GRANTED | Vehicle::CROSSING) != 0;
        // Long vehicles need more of a bend than their lane.
        let slow = vehicle.kind.is_pedalled() || vehicle.kind == ActorKind::Bus;
        if slow || busy || self.ways.lanes[vehicle.lane as usize].zone.is_some() {
            return None;
        }
        let wish_mps = self.wish_mps(index);
        [(1, lane.left), (-1, lane.right)].into_iter().find_map(|(side, neighbour)| {
            let passed = self.passed(index, plan, seeker, side)?;
            let near = passed.gap_m < START_M + START_S * vehicle.speed_mps && passed.gap_m > 0.5;
            let within = passed.aim_m.abs() + seeker.half.y < lane.at(vehicle.s_m).half_width_m;
            let pays = wish_mps - passed.speed_mps > SLOWER_MPS;
            let may = || within || neighbour.is_none() && self.has_way(index, plan, seeker, &passed, wish_mps, side);
            (near && pays && may()).then_some(side)
        })
    }

    /// Whether the way is free for passing over the border of the lane.
    fn has_way(&self, index: usize, plan: &Plan, seeker: &Seeker, passed: &Passed, wish_mps: f32, side: i8) -> bool {
        let (past_s, past_m) = self.past(index, seeker, passed, wish_mps);
        let (time_s, way_m) = (past_s + SPARE_S, past_m + wish_mps * SPARE_S);
        let ends = plan.line.is_some_and(|line| line.ahead_m < way_m) || plan.dead_end_m.is_some_and(|m| m < way_m);
        let known = self.steps_of(plan).last().map_or(0.0, |s| s.start_m + self.map.lanes[s.lane as usize].length_m);
        !ends
            && known >= way_m
            && self.has_room_after(index, plan, passed, past_m, ROOM_M)
            && self.nobody_comes(index, way_m, time_s, side)
            && self.is_first(index)
            && self.is_open(plan, way_m, side)
    }

    /// The speed that a vehicle would drive at where it is, m/s.
    fn wish_mps(&self, index: usize) -> f32 {
        let (vehicle, driver) = (&self.vehicles[index], &self.drivers[index]);
        let lane = &self.map.lanes[vehicle.lane as usize];
        let curve_mps = self.ways.lanes[vehicle.lane as usize].curve_speed(lane, vehicle.s_m);
        (lane.speed_limit_mps * driver.limit_share).min(driver.top_mps).min(curve_mps)
    }

    /// Time, s, and distance, metres, until a vehicle is past those whom it passes.
    fn past(&self, index: usize, seeker: &Seeker, passed: &Passed, wish_mps: f32) -> (f32, f32) {
        let gain_m = passed.beyond_m + seeker.half.x + AFTER_M;
        catch_up(&self.drivers[index], self.vehicles[index].speed_mps, wish_mps, passed.speed_mps, gain_m)
    }

    /// Where one who passes drives beside the others, metres to the left of the middle. None where it can still stop behind
    /// them and gets back into its lane, since somebody comes, or they queue.
    pub(super) fn beside_m(
        &self,
        index: usize,
        plan: &Plan,
        seeker: &Seeker,
        passed: &Passed,
        side: i8,
    ) -> Option<f32> {
        if !self.stays_behind(index, passed) {
            return Some(passed.aim_m);
        }
        let (past_s, past_m) = self.past(index, seeker, passed, self.wish_mps(index));
        let way_is_free = || self.nobody_comes(index, past_m, past_s, side);
        (!self.has_to_wait(index, plan, seeker, passed) && way_is_free()).then_some(passed.aim_m)
    }

    /// Whether a vehicle can still fall in behind those whom it passes.
    fn stays_behind(&self, index: usize, passed: &Passed) -> bool {
        let closing_mps = (self.vehicles[index].speed_mps - passed.first_mps).max(0.0);
        let stops_m = closing_mps * closing_mps / (2.0 * self.drivers[index].hardest_mps2);
        passed.gap_m >= BEHIND_M + stops_m
    }

    /// Where one drives that would pass at `aim_m`: no farther over the border of its lane, where none for the other direction
    /// lies beside it, than it is.
    pub(super) fn within_border(&self, index: usize, plan: &Plan, seeker: &Seeker, aim_m: f32, side: i8) -> f32 {
        let step = &self.steps_of(plan)[0];
        if self.has_oncoming_lane(step, 0.0, side) {
            return aim_m;
        }
        let (vehicle, side) = (&self.vehicles[index], f32::from(side));
        let border_m = self.map.lanes[vehicle.lane as usize].at(vehicle.s_m).half_width_m - seeker.half.y;
        side * (side * aim_m).min(border_m.max(side * vehicle.offset_m).max(0.0))
    }

    /// Whether those whom a vehicle passes ride in a queue, or the one before them has slowed down, so that there would be no
    /// room before them.
    fn has_to_wait(&self, index: usize, plan: &Plan, seeker: &Seeker, passed: &Passed) -> bool {
        let (_, past_m) = self.past(index, seeker, passed, self.wish_mps(index));
        passed.ride && (passed.queues() || !self.has_room_after(index, plan, passed, past_m, 0.0))
    }

    /// The greatest acceleration of one who passes, m/s²: beside those before whom there is no room it falls back.
    pub(super) fn falls_back_mps2(&self, index: usize, plan: &Plan, seeker: &Seeker) -> f32 {
        let vehicle = &self.vehicles[index];
        let passes = vehicle.manoeuvre.passes() && vehicle.flags & Vehicle::GRANTED == 0;
        let passed = if passes { self.passed(index, plan, seeker, vehicle.manoeuvre.side()) } else { None };
        // Who stands goes on only when the others do, or when this one has gone.
        let waits = |passed: &Passed| {
            let beside = !self.stays_behind(index, passed) && passed.speed_mps > 0.0;
            beside && self.has_to_wait(index, plan, seeker, passed)
        };
        let queue = passed.filter(waits);
        queue.map_or(f32::MAX, |queue| {
            let mps = (queue.speed_mps - FALL_BACK_MPS).max(0.0);
            ((mps - vehicle.speed_mps) / FALL_BACK_S).max(-SWING_OUT_MPS2)
        })
    }

    /// Whether the road goes about straight on for so far, without crosswalks and beside a lane for the other direction.
    fn is_open(&self, plan: &Plan, way_m: f32, side: i8) -> bool {
        let steps = self.steps_of(plan);
        let lanes = &self.map.lanes;
        let heading = |step: &Step, ahead_m: f32| lanes[step.lane as usize].at(ahead_m - step.start_m).heading_rad;
        let first_rad = heading(&steps[0], 0.0);
        steps.iter().take_while(|step| step.start_m < way_m).all(|step| {
            let lane = &lanes[step.lane as usize];
            let to_m = way_m.min(step.start_m + lane.length_m);
            let from_m = step.start_m.max(0.0);
            let spans = &self.ways.lanes[step.lane as usize].crosswalks;
            let crossed = spans.iter().any(|c| (from_m..=to_m).contains(&(step.start_m + c.near_m)));
            let places = [from_m, 0.5 * (from_m + to_m), to_m];
            let straight = places.iter().all(|m| ops::wrap_angle(heading(step, *m) - first_rad).abs() < BEND_RAD);
            let beside = places.iter().all(|m| self.has_oncoming_lane(step, *m, side));
            !crossed && straight && beside
        })
    }

    fn has_oncoming_lane(&self, step: &Step, ahead_m: f32, side: i8) -> bool {
        let lane = &self.map.lanes[step.lane as usize];
        let place = lane.straight_on((ahead_m - step.start_m).clamp(0.0, lane.length_m));
        let forward = place.forward.truncate();
        let there = place.beside(f32::from(side) * (place.half_width_m + ONCOMING_M));
        let beside = self.ways.places.roads().at(there, LaneKind::Driving);
        let comes = |p: &crate::map_data::Projection| {
            direction(self.map.lanes[p.lane as usize].at(p.s_m).heading_rad).dot(forward) < -0.5
        };
        beside.iter().any(comes)
    }

    /// Whether there is room in the lane again before whom one has passed, `past_m` ahead, and `spare_m` more: also if
    /// whoever is there now comes to a stand, as one would block both lanes beside a queue.
    fn has_room_after(&self, index: usize, plan: &Plan, passed: &Passed, past_m: f32, spare_m: f32) -> bool {
        let size_m = self.drivers[index].size_m.x;
        let stays_m = passed.beyond_m + AFTER_M + size_m + spare_m;
        let in_the_way = |step: &Step, e: &Entry| {
            let tail_m = step.start_m + e.s_m - e.half_m;
            let stands_m = tail_m + stopping_m(e.speed_mps);
            let near = tail_m < stays_m || stands_m < past_m + AFTER_M + 0.5 * size_m;
            let kind = self.vehicles[e.vehicle as usize].kind;
            e.vehicle as usize != index && !kind.is_pedalled() && tail_m > -size_m && near
        };
        self.steps_of(plan).iter().all(|step| !self.lists.on(step.lane).iter().any(|e| in_the_way(step, e)))
    }

    /// Whether nobody comes the other way, crosses or passes within the time that passing takes.
    fn nobody_comes(&self, index: usize, way_m: f32, time_s: f32, side: i8) -> bool {
        let me = &self.bodies[index];
        let forward = (me.rotation * glam::Vec3::X).truncate().normalize_or(Vec2::X);
        let limit_mps = self.map.lanes[self.vehicles[index].lane as usize].speed_limit_mps;
        let clear = |other: &Hazard| {
            let to = (other.position - me.position).truncate();
            let (ahead_m, aside_m) = (to.dot(forward), f32::from(side) * forward.perp_dot(to));
            let comes_mps = (-other.velocity.dot(forward)).max(0.0);
            // Who waits or turns into the road speeds up as far as the limit lets it.
            let speeds_up_m = if other.walker { 0.0 } else { 0.5 * SPEEDS_UP_MPS2 * time_s * time_s };
            let comes_m = (comes_mps * time_s + speeds_up_m).min(limit_mps.max(comes_mps) * time_s);
            let same_way = !other.walker && other.forward.dot(forward) > 0.3;
            // The road may bend, the more so beyond the way.
            let bend_m = ahead_m.clamp(0.0, way_m) * BEND_RAD + (ahead_m - way_m).max(0.0) * BENDS;
            let near = -ASIDE_M * 0.5 - bend_m..=ASIDE_M + bend_m;
            let beside = !near.contains(&aside_m) || (other.position.z - me.position.z).abs() > LEVEL_M + bend_m;
            same_way || beside || ahead_m < -5.0 || ahead_m > way_m + comes_m + SPARE_M
        };
        let passes = |other: &Hazard| {
            let near = other.position.distance_squared(me.position) < OTHERS_M * OTHERS_M;
            near && other.vehicle.is_some_and(|i| self.vehicles[i as usize].manoeuvre.passes())
        };
        let others = self.hazards.driven().iter().filter(|h| h.vehicle != Some(index as u32));
        let mut all = self.hazards.free().iter().chain(self.hazards.people()).chain(others);
        all.all(|other| clear(other) && !passes(other))
    }
}
