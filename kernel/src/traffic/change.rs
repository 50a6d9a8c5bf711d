//! Changes of lane: MOBIL (Kesting, Treiber and Helbing 2007). Whoever gains more than the others lose
//! changes, if nobody has to brake hard for it; a lane that leads to the goal is worth the more the nearer
//! the next junction is. A change is signalled first. The vehicle then belongs to the other lane, beside
//! whose middle it starts, and stands in the list of the one it leaves until it is clear of that.

use crate::map_data::{LaneId, Projection};
use crate::time::Tick;

use super::drive::{View, follow_idm};
use super::hazard::{Hazard, Seeker, sight};
use super::journey::Journey;
use super::lapse::Lapse;
use super::lists::Entry;
use super::manoeuvre::Manoeuvre;
use super::pass;
use super::plan::Plan;
use super::routes::{CHANGE_S, Class};
use super::sideways::{beside, drift};
use super::traits::Driver;
use super::vehicle::{DECIDE_TICKS, Vehicle};

/// Acceleration that a change has to gain, m/s².
const THRESHOLD_MPS2: f32 = 0.2;
/// Nobody has to brake harder for one who changes, m/s².
const SAFE_MPS2: f32 = 2.5;
/// A lane that leads to the goal is worth this right before the junction, and a fifth of it so far before it.
const ROUTE_MPS2: f32 = 3.0;
const ROUTE_M: f32 = 250.0;
/// Gap to others that is left at least, metres.
pub(super) const GAP_M: f32 = 2.5;
/// The same before one behind who stands, so that two who want to change places do not wait for each other, metres.
const STANDING_GAP_M: f32 = 1.0;
/// Vehicles think about changes so often.
const CONSIDER_TICKS: Tick = 30;
/// They signal for so long before they change.
const SIGNAL_TICKS: u8 = 60;
/// Then they look for a gap so often.
const GAP_TICKS: Tick = 6;
/// Slower than this nobody changes, and no long vehicle, m/s.
const LEAST_MPS: f32 = 1.5;
const LONG_LEAST_MPS: f32 = 4.0;
/// Who is slower than this stands, m/s.
const STANDS_MPS: f32 = 0.1;
/// Past what stands in the lane after so much of a change, metres.
const CLEAR_M: f32 = 2.8;
/// Width of a lane for which a change has room, metres.
const LANE_M: f32 = 3.5;
/// A lane narrower than twice this is none to change to, metres.
const LEAST_HALF_M: f32 = 1.3;
/// A lane that ends within this beyond the change is none either, metres.
const LASTING_M: f32 = 60.0;
/// A change is over at this distance from where the vehicle wants to drive, metres.
const THERE_M: f32 = 0.2;
/// Before those who come the other way one stands so far off, and by their length, metres.
const ONCOMING_M: f32 = 4.0;
/// Who is nearer ahead than this is beside, and kept off so far to the side, metres.
const BESIDE_M: f32 = 1.0;
const ASIDE_M: f32 = 0.4;
/// People on the road so near ahead, metres and seconds, and aside, metres, are let by before a change.
const PEOPLE_M: f32 = 20.0;
const PEOPLE_S: f32 = 4.0;
const PEOPLE_ASIDE_M: f32 = 9.0;
/// How far others are looked for, metres, over so many lanes at most ahead and behind.
const REACH_M: f32 = 80.0;
const LANES: usize = 4;
const LANES_BEHIND: u32 = 24;
/// Of vehicles nearer to each other than this, one changes at a time, metres.
const APART_M: f32 = 30.0;

/// Somebody ahead or behind on a lane.
#[derive(Clone, Copy)]
pub(super) struct Near {
    /// Index of the vehicle.
    pub vehicle: u32,
    /// From bumper to bumper, metres; negative beside.
    pub gap_m: f32,
    pub speed_mps: f32,
}

impl View<'_> {
    /// Whether a vehicle wishes to change lanes or to pass somebody, and whether it has done so.
    pub(super) fn decide_manoeuvre(&self, index: usize, plan: &Plan, seeker: &Seeker, next: &mut Vehicle) {
        let considers = next.is_due(self.tick, CONSIDER_TICKS);
        let side = next.manoeuvre.side();
        next.manoeuvre = match next.manoeuvre {
            Manoeuvre::Keep if considers && next.lapse != Lapse::CutsIn => {
                next.signal_ticks = 0;
                self.wish(index, plan, seeker)
            }
            signal if signal.signals() => {
                next.signal_ticks = next.signal_ticks.saturating_add(DECIDE_TICKS);
                let pays = !considers || self.gain_mps2(index, plan, seeker, side) > THRESHOLD_MPS2 * 0.5;
                if pays { signal } else { Manoeuvre::Keep }
            }
            over if over != Manoeuvre::Keep => {
                next.signal_ticks = next.signal_ticks.saturating_add(DECIDE_TICKS);
                let passes = over.passes() && self.passed(index, plan, seeker, side).is_some();
                let is_there = (next.offset_m - self.likes_m(index)).abs() < THERE_M;
                if is_there && !passes { Manoeuvre::Keep } else { over }
            }
            keep => keep,
        };
    }

    fn wish(&self, index: usize, plan: &Plan, seeker: &Seeker) -> Manoeuvre {
        let gains = [1, -1].map(|side| (side, self.gain_mps2(index, plan, seeker, side)));
        let best = gains.into_iter().filter(|(_, gain)| *gain > THRESHOLD_MPS2);
        match best.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((side, _)) => Manoeuvre::signal_to(side),
            None => self.wish_to_pass(index, plan, seeker).map_or(Manoeuvre::Keep, Manoeuvre::pass_on),
        }
    }

    /// Moves a vehicle that wishes to change to the other lane, if that is safe now.
    pub(super) fn move_over(&self, index: usize, plan: &Plan, next: &mut Vehicle) {
        if next.lapse == Lapse::CutsIn && next.manoeuvre == Manoeuvre::Keep {
            return self.barge_in(index, plan, next);
        }
        let vehicle = &self.vehicles[index];
        let turn = next.is_due(self.tick, GAP_TICKS);
        // A grant is for the way from this lane.
        let granted = next.flags & Vehicle::GRANTED != 0;
        let ready = next.manoeuvre.signals() && next.signal_ticks >= SIGNAL_TICKS && !granted;
        if !ready || !turn || next.lane != vehicle.lane || self.people_are_ahead(index) {
            return;
        }
        let Some(there) = self.target(index, plan, next.manoeuvre.side()).filter(|there| self.is_safe(index, there))
        else {
            return;
        };
        self.take_lane(&there, next);
    }

    /// Goes over to a lane, beside whose middle the vehicle is then.
    pub(super) fn take_lane(&self, there: &Projection, next: &mut Vehicle) {
        let position = self.map.lanes[next.lane as usize].straight_on(next.s_m).beside(next.offset_m);
        let there = self.map.project(there.lane, position);
        (next.lane, next.before) = (there.lane, there.lane);
        (next.s_m, next.offset_m) = (there.s_m, there.lateral_m);
        next.manoeuvre = Manoeuvre::move_to(next.manoeuvre.side());
        (next.signal_ticks, next.wait_ticks) = (0, 0);
        next.flags &= !(Vehicle::ASKING | Vehicle::HALTED);
    }

    /// Tells `follow` the gap to whoever is in the way of a vehicle while it or another is between lanes, and its
    /// speed. `offset_at` tells where across its lane it will be after so many metres.
    pub(super) fn heed_manoeuvres(
        &self,
        index: usize,
        plan: &Plan,
        seeker: &Seeker,
        offset_at: impl Fn(f32) -> f32,
        follow: &mut impl FnMut(f32, f32),
    ) {
        let forward = (self.bodies[index].rotation * glam::Vec3::X).truncate();
        let between = self.vehicles[index].manoeuvre.is_between_lanes();
        let heed = |hazard: &Hazard| {
            let Some(seen) = sight(self.map, self.steps_of(plan), seeker, hazard) else { return };
            let comes_mps = -seen.speed_mps;
            let (mut gap_m, mut ahead_m, mut slow_mps) = (seen.gap_m, seen.gap_m, f32::MAX);
            if hazard.forward.dot(forward) < -0.3 {
                // Each drives a part of the way to where they meet.
                let mps = seeker.speed_mps.max(LEAST_MPS);
                ahead_m *= mps / (mps + comes_mps.max(0.0));
                // Who comes between lanes needs room to get back into its own.
                gap_m -= if between { 0.0 } else { ONCOMING_M + 2.0 * hazard.half.x };
                slow_mps = seeker.speed_mps + hazard.velocity.length();
            }
            if seen.blocks_at(offset_at(ahead_m.max(0.0)), seeker.half.y, slow_mps) {
                follow(gap_m, seen.speed_mps);
            }
        };
        if between {
            self.near(index, seeker).for_each(heed);
        } else {
            let reach_m = seeker.horizon_m + 20.0;
            let near = |h: &&Hazard| h.position.distance_squared(seeker.position) < reach_m * reach_m;
            self.changing.iter().filter(near).for_each(heed);
        }
    }

    /// All other vehicles that may be in the way of one.
    pub(super) fn near(&self, index: usize, seeker: &Seeker) -> impl Iterator<Item = &Hazard> {
        let other = move |h: &&Hazard| h.vehicle.is_some_and(|i| i as usize != index);
        self.hazards.around(seeker.position, seeker.horizon_m + 20.0).filter(other)
    }

    /// Where across its lane a vehicle between lanes can drive that wants to be at `aim_m`: it does not move into
    /// anybody beside it.
    pub(super) fn beside_others(&self, index: usize, plan: &Plan, seeker: &Seeker, aim_m: f32) -> f32 {
        let (mut least_m, mut most_m) = (f32::MIN, f32::MAX);
        for hazard in self.near(index, seeker).chain(self.hazards.free()) {
            let Some(seen) = sight(self.map, self.steps_of(plan), seeker, hazard) else { continue };
            if seen.gap_m < BESIDE_M && seen.middle_m() < seeker.offset_m {
                least_m = least_m.max(seen.edge_m(1.0) + seeker.half.y + ASIDE_M);
            } else if seen.gap_m < BESIDE_M {
                most_m = most_m.min(seen.edge_m(-1.0) - seeker.half.y - ASIDE_M);
            }
        }
        if least_m < most_m { aim_m.clamp(least_m, most_m) } else { seeker.offset_m }
    }

    /// Where a vehicle would be on the lane beside its own, if a change is possible.
    pub(super) fn target(&self, index: usize, plan: &Plan, side: i8) -> Option<Projection> {
        let (vehicle, driver) = (&self.vehicles[index], &self.drivers[index]);
        let lane = beside(self.map, vehicle.lane, side > 0)?;
        let (from, to) = (&self.ways.lanes[vehicle.lane as usize], &self.ways.lanes[lane as usize]);
        let busy =
            vehicle.flags & (Vehicle::GRANTED | Vehicle::CROSSING) != 0 || from.zone.is_some() || to.zone.is_some();
        let bound = vehicle.kind.is_pedalled() && side != self.ways.kerb;
        if busy || bound || !Class::of(vehicle.kind).may_use(&self.map.lanes[lane as usize]) {
            return None;
        }
        let needed_m = LANE_M / drift(vehicle.speed_mps, driver.size_m.x * 0.5) + 0.5 * driver.size_m.x;
        if plan.line.is_some_and(|line| line.hold_m < needed_m) || plan.dead_end_m.is_some_and(|m| m < needed_m) {
            return None;
        }
        // Too near to its end to be off it in time, a lane is left by leaning over the border.
        if from.ends_m.is_some_and(|m| m - vehicle.s_m < needed_m) {
            return None;
        }
        let there = self.map.project(lane, self.bodies[index].position);
        let target = &self.map.lanes[lane as usize];
        let [here_m, then_m] = [there.s_m, there.s_m + needed_m].map(|s_m| target.at(s_m).half_width_m);
        let wide = here_m.min(then_m) > LEAST_HALF_M;
        let leads_on = target.length_m - there.s_m > needed_m || !to.onward.is_empty();
        let leads_on = leads_on && to.ends_m.is_none_or(|m| m - there.s_m > needed_m + LASTING_M);
        (wide && leads_on).then_some(there)
    }

    /// What a change would gain by MOBIL, m/s²; not finite where it is not possible.
    fn gain_mps2(&self, index: usize, plan: &Plan, seeker: &Seeker, side: i8) -> f32 {
        let vehicle = &self.vehicles[index];
        let blocked = self.blocked(index, plan, seeker);
        let least_mps = if Class::of(vehicle.kind) == Class::Long { LONG_LEAST_MPS } else { LEAST_MPS };
        let clear_m = CLEAR_M / drift(vehicle.speed_mps, seeker.half.x);
        let moves = blocked.map_or(vehicle.speed_mps >= least_mps, |(gap_m, _)| gap_m > clear_m);
        let Some(there) = self.target(index, plan, side).filter(|_| moves) else { return f32::NEG_INFINITY };
        // Nobody drives up to what stands.
        let kept_m = |mps: f32| if mps < LEAST_MPS { pass::swing_out_m(&self.drivers[index]) } else { 0.0 };
        let kept_off = blocked.map(|(gap_m, mps)| (gap_m - kept_m(mps), mps));
        let gap = |near: Option<Near>| near.map(|n| (n.gap_m, n.speed_mps));
        let ahead = self.ahead(index, there.lane, there.s_m);
        let here_ahead = plan.leader.map(|l| (l.gap_m, l.speed_mps));
        let here = self.pace_mps2(index, vehicle.lane, here_ahead).min(self.pace_mps2(index, vehicle.lane, kept_off));
        let meets = self.hazard_ahead(index, &there).map(|(gap_m, mps)| (gap_m - kept_m(mps), mps));
        let then = self.pace_mps2(index, there.lane, gap(ahead)).min(self.pace_mps2(index, there.lane, meets));
        let own = then - here;
        // Those behind: between whom this one is now, and between whom it would be.
        let length_m = self.drivers[index].size_m.x;
        let loses = |behind: Option<Near>, lane: LaneId, ahead: Option<(f32, f32)>| {
            let Some(behind) = behind else { return 0.0 };
            let i = behind.vehicle as usize;
            let without = ahead.map(|(gap_m, mps)| (gap_m + behind.gap_m + length_m, mps));
            let loss =
                self.pace_mps2(i, lane, without) - self.pace_mps2(i, lane, Some((behind.gap_m, vehicle.speed_mps)));
            // Who would have to brake harder than is safe is waited for, not given up.
            loss.clamp(-SAFE_MPS2, SAFE_MPS2)
        };
        let new = loses(self.behind(index, there.lane, there.s_m), there.lane, gap(ahead));
        let old = loses(self.behind(index, vehicle.lane, vehicle.s_m), vehicle.lane, here_ahead);
        own - self.politeness * (new - old) + self.route_mps2(vehicle, plan, there.lane)
    }

    /// What of the ego car and loose actors is in the way of a vehicle, as (gap, speed).
    fn blocked(&self, index: usize, plan: &Plan, seeker: &Seeker) -> Option<(f32, f32)> {
        let likes_m = self.likes_m(index);
        let seen = self.hazards.free().iter().filter_map(|h| sight(self.map, self.steps_of(plan), seeker, h));
        let blocking = seen.filter(|seen| seen.blocks(likes_m, seeker.half.y));
        blocking.map(|seen| (seen.gap_m, seen.speed_mps)).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// What of the ego car and loose actors is ahead of a place on another lane, as (gap, speed).
    fn hazard_ahead(&self, index: usize, there: &Projection) -> Option<(f32, f32)> {
        let half_m = self.drivers[index].size_m.x * 0.5;
        let lane = &self.map.lanes[there.lane as usize];
        let ahead = self.hazards.free().iter().filter_map(|hazard| {
            let near = hazard.position.distance_squared(self.bodies[index].position) < REACH_M * REACH_M;
            let at = near.then(|| self.map.project(there.lane, hazard.position))?;
            let place = lane.straight_on(at.s_m);
            let on_it = at.distance_m < place.half_width_m + hazard.half.y && at.s_m > there.s_m;
            let gap_m = at.s_m - there.s_m - half_m - hazard.half.x;
            on_it.then(|| (gap_m, hazard.velocity.dot(place.forward.truncate())))
        });
        ahead.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// What another lane is worth because of the way to the goal, m/s².
    fn route_mps2(&self, vehicle: &Vehicle, plan: &Plan, lane: LaneId) -> f32 {
        let journey = Journey::of(self.ways, self.seed, vehicle);
        let (here_s, there_s) = (journey.seconds(vehicle.lane), journey.seconds(lane));
        let worth = match (here_s.is_finite(), there_s.is_finite()) {
            (true, false) => return f32::NEG_INFINITY,
            (true, true) => ((here_s - there_s) / CHANGE_S).clamp(-1.0, 1.0),
            // No way leads to the goal from here, so that any lane is as good.
            (false, _) => 0.0,
        };
        let end_m = self.ways.lanes[vehicle.lane as usize].ends_m.map_or(ROUTE_M, |m| m - vehicle.s_m);
        let near_m = plan.line.map_or(ROUTE_M, |line| line.hold_m).min(end_m);
        let near = (1.0 - near_m / ROUTE_M).clamp(0.2, 1.0);
        // Bicycles change to the kerb alone.
        let slow_mps2 = if vehicle.kind.is_pedalled() { ROUTE_MPS2 } else { 0.0 };
        slow_mps2 + worth * ROUTE_MPS2 * near
    }

    /// Acceleration of a vehicle on a lane behind somebody, as (gap, speed), m/s².
    fn pace_mps2(&self, index: usize, lane: LaneId, ahead: Option<(f32, f32)>) -> f32 {
        let (driver, speed_mps) = (&self.drivers[index], self.vehicles[index].speed_mps);
        let wish_mps = (self.map.lanes[lane as usize].speed_limit_mps * driver.limit_share).min(driver.top_mps);
        let ratio = (speed_mps / wish_mps.max(0.1)).min(1.1);
        let free = driver.accel_mps2 * (1.0 - ratio * ratio * ratio * ratio);
        ahead.map_or(free, |(gap_m, mps)| free.min(follow_idm(driver, speed_mps, gap_m, mps).max(-driver.hardest_mps2)))
    }

    /// Whether nobody has to brake hard when a vehicle changes to a place now, and nobody else goes there.
    pub(super) fn is_safe(&self, index: usize, there: &Projection) -> bool {
        let (vehicle, driver) = (&self.vehicles[index], &self.drivers[index]);
        let safe =
            |who: &Driver, mps: f32, gap_m: f32, ahead_mps: f32| follow_idm(who, mps, gap_m, ahead_mps) > -SAFE_MPS2;
        let bears =
            |who: &Driver, mps: f32, gap_m: f32, ahead_mps: f32| gap_m > GAP_M && safe(who, mps, gap_m, ahead_mps);
        let leaves = |n: &Near| n.gap_m > if n.speed_mps < STANDS_MPS { STANDING_GAP_M } else { GAP_M };
        let ahead = self.ahead(index, there.lane, there.s_m);
        let behind = self.behind(index, there.lane, there.s_m);
        let free = ahead.is_none_or(|n| bears(driver, vehicle.speed_mps, n.gap_m, n.speed_mps))
            && behind.is_none_or(|n| {
                leaves(&n) && safe(&self.drivers[n.vehicle as usize], n.speed_mps, n.gap_m, vehicle.speed_mps)
            });
        free && self.is_free_of_hazards(index, there, bears) && self.is_first(index)
    }

    /// Whether people are on the road ahead, who count on vehicles to keep their lanes.
    fn people_are_ahead(&self, index: usize) -> bool {
        let (me, mps) = (&self.bodies[index], self.vehicles[index].speed_mps);
        let forward = (me.rotation * glam::Vec3::X).truncate();
        self.hazards.people().iter().any(|person| {
            let to = (person.position - me.position).truncate();
            let ahead_m = to.dot(forward);
            ahead_m > 0.0 && ahead_m < PEOPLE_M + PEOPLE_S * mps && forward.perp_dot(to).abs() < PEOPLE_ASIDE_M
        })
    }

    /// Whether the ego car and loose actors leave room on the other lane.
    pub(super) fn is_free_of_hazards(
        &self,
        index: usize,
        there: &Projection,
        bears: impl Fn(&Driver, f32, f32, f32) -> bool,
    ) -> bool {
        let (vehicle, driver, body) = (&self.vehicles[index], &self.drivers[index], &self.bodies[index]);
        let lane = &self.map.lanes[there.lane as usize];
        self.hazards.free().iter().all(|hazard| {
            let apart = hazard.position - body.position;
            if apart.length_squared() > REACH_M * REACH_M {
                return true;
            }
            let at = self.map.project(there.lane, hazard.position);
            let place = lane.straight_on(at.s_m);
            let along_mps = hazard.velocity.dot(place.forward.truncate());
            let half_m = hazard.half.length() + driver.size_m.x * 0.5;
            let ahead_m = at.s_m - there.s_m;
            let gap_m = ahead_m.abs() - half_m;
            at.distance_m > place.half_width_m + hazard.half.y + 0.5
                || if ahead_m > 0.0 {
                    bears(driver, vehicle.speed_mps, gap_m, along_mps)
                } else {
                    bears(driver, along_mps, gap_m, vehicle.speed_mps)
                }
        })
    }

    /// Whether no other one near may change lanes in this tick before a vehicle.
    pub(super) fn is_first(&self, index: usize) -> bool {
        let place = self.bodies[index].position;
        let ready = |i: u32| {
            let other = &self.vehicles[i as usize];
            other.manoeuvre.signals() && other.signal_ticks.saturating_add(DECIDE_TICKS) >= SIGNAL_TICKS
        };
        !self.hazards.around(place, APART_M).filter_map(|h| h.vehicle).any(|i| (i as usize) < index && ready(i))
    }

    /// Who is ahead of a place on a lane and on the way that a vehicle would take from there.
    pub(super) fn ahead(&self, index: usize, lane: LaneId, s_m: f32) -> Option<Near> {
        let vehicle = &self.vehicles[index];
        let (mut lane, mut start_m) = (lane, -s_m);
        let mut journey = Journey::of(self.ways, self.seed, vehicle);
        for _ in 0..LANES {
            let is_ahead = |e: &&Entry| e.vehicle as usize != index && start_m + e.s_m > 0.0;
            if let Some(e) = self.lists.on(lane).iter().find(is_ahead) {
                let gap_m = start_m + e.s_m - e.half_m - self.drivers[index].size_m.x * 0.5;
                return Some(Near { vehicle: e.vehicle, gap_m, speed_mps: e.speed_mps });
            }
            start_m += self.map.lanes[lane as usize].length_m;
            let next = journey.next_lane(lane).filter(|_| start_m < REACH_M)?;
            journey.enter(next.lane);
            (lane, start_m) = (next.lane, start_m - next.at_m);
        }
        None
    }

    /// Who is behind a place on a lane: the nearest on it, or on those that lead there.
    pub(super) fn behind(&self, index: usize, lane: LaneId, s_m: f32) -> Option<Near> {
        self.behind_within(index, lane, s_m, &mut { LANES_BEHIND })
    }

    fn behind_within(&self, index: usize, lane: LaneId, s_m: f32, lanes: &mut u32) -> Option<Near> {
        *lanes = lanes.checked_sub(1)?;
        let is_behind = |e: &&Entry| e.vehicle as usize != index && e.s_m <= s_m;
        if let Some(e) = self.lists.on(lane).iter().rev().find(is_behind) {
            let gap_m = s_m - e.s_m - e.half_m - self.drivers[index].size_m.x * 0.5;
            return Some(Near { vehicle: e.vehicle, gap_m, speed_mps: e.speed_mps });
        }
        if s_m > REACH_M {
            return None;
        }
        let length_m = |id: LaneId| self.map.lanes[id as usize].length_m;
        let mut nearest: Option<Near> = None;
        for &before in &self.map.lanes[lane as usize].predecessors {
            let found = self.behind_within(index, before, s_m + length_m(before), lanes);
            nearest = found.into_iter().chain(nearest).min_by(|a, b| a.gap_m.total_cmp(&b.gap_m));
        }
        nearest
    }
}
