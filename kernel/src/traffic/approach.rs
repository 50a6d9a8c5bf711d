//! What a vehicle does before a junction: it asks to enter, waits at the line, and gives back what it was granted.

use crate::map_data::{LaneId, StopKind};
use crate::time::seconds;

use super::drive::View;
use super::hazard::{Seeker, side, sight};
use super::junction::{self, Signal};
use super::lapse::Lapse;
use super::lists::Entry;
use super::plan::{Line, Plan};
use super::roundabout::Roundabout;
use super::step::{LINE_MARGIN_M, Step};
use super::vehicle::{DECIDE_TICKS, Vehicle};

/// How long a vehicle stands at a stop sign.
const HALT_TICKS: u16 = seconds(1) as u16;
/// Who waits for so long at an open line gives up his goal for another.
const RETHINK_TICKS: u16 = seconds(15) as u16;
/// Before it asks for a junction a vehicle looks this far for what stands in its way, metres.
const STANDING_M: f32 = 60.0;
/// Slower than this it stands, or comes the other way, m/s.
const STANDS_MPS: f32 = 0.5;

impl View<'_> {
    /// Asks for grants, gives them back, waits and halts.
    pub(super) fn enter_or_wait(&self, index: usize, plan: &Plan, next: &mut Vehicle) {
        let Some(line) = &plan.line else {
            next.flags &= !(Vehicle::GRANTED | Vehicle::ASKING);
            next.wait_ticks = 0;
            return;
        };
        let steps = self.steps_of(plan);
        let signal = junction::signal(self.map, self.lights, next, steps, line);
        if next.lapse == Lapse::RunsRed {
            next.flags |= Vehicle::GRANTED;
        } else if next.flags & Vehicle::GRANTED != 0 {
            let keeps = junction::near_enough(next, line, 6.0) && !self.lost_use(index, plan, line, next);
            if junction::must_stop(signal, next, line, self.pace_mps(plan, line, next)) || !keeps {
                next.flags &= !Vehicle::GRANTED;
            }
        } else if self.asks(index, plan, line, signal, next) {
            // The others have to have heard of it.
            let heard = self.members.asking(line.zone, index);
            let granted = |asking| self.members.grants(self.ways, asking, &steps[line.inside.0..line.inside.1]);
            next.flags |= if heard.is_some_and(granted) { Vehicle::GRANTED } else { Vehicle::ASKING };
        } else {
            next.flags &= !Vehicle::ASKING;
        }
        if next.flags & Vehicle::GRANTED != 0 {
            next.flags &= !Vehicle::ASKING;
        }
        self.wait(index, line, signal, steps, next);
    }

    /// How fast a vehicle gets to its line at most: as fast as the one before it there.
    fn pace_mps(&self, plan: &Plan, line: &Line, next: &Vehicle) -> f32 {
        let before = plan.leader.filter(|leader| leader.gap_m < line.ahead_m);
        before.map_or(next.speed_mps, |leader| next.speed_mps.min(leader.speed_mps))
    }

    /// Whether one that stands before the line with a grant cannot use it any more: there is no room beyond the junction, or
    /// somebody without one slipped in before it.
    fn lost_use(&self, index: usize, plan: &Plan, line: &Line, next: &Vehicle) -> bool {
        let waits = next.speed_mps < 0.1 && line.ahead_m > 0.0 && !line.passed;
        waits && !(self.leads(plan, line) && self.has_room(index, plan, line, next, || f32::MAX))
    }

    /// Whether there is room for a vehicle, if the junction before it belongs to a roundabout that it enters or drives round.
    fn has_room_to_circulate(&self, index: usize, plan: &Plan, line: &Line, next: &Vehicle) -> Option<bool> {
        let (steps, driver) = (self.steps_of(plan), &self.drivers[index]);
        let circle = |step: usize| self.ways.lanes[steps[step].lane as usize].circle;
        if circle(line.approach).is_some() {
            return circle(line.inside.0).map(|_| true);
        }
        let roundabout = &self.ways.roundabouts[line.enters(self.ways, steps)? as usize];
        let others = self.taking(roundabout).filter(|entry| entry.vehicle as usize != index);
        let taken_m = others.map(|entry| 2.0 * entry.half_m + driver.gap_m).sum();
        Some(roundabout.has_room(taken_m, driver.size_m.x + driver.gap_m, next.wait_ticks))
    }

    /// From a vehicle's middle to where the junction before it ends, metres.
    fn end_m(&self, plan: &Plan, line: &Line) -> f32 {
        let last = self.steps_of(plan)[line.inside.1 - 1];
        last.start_m + self.map.lanes[last.lane as usize].length_m
    }

    /// All who are on the way round, come in, or may.
    fn taking(&self, roundabout: &Roundabout) -> impl Iterator<Item = &Entry> {
        let on = |lane: &LaneId| {
            // Who reaches over an end stands in two lists.
            let length_m = self.map.lanes[*lane as usize].length_m;
            self.lists.on(*lane).iter().filter(move |entry| (0.0..length_m).contains(&entry.s_m))
        };
        let may = |entry: &&Entry| self.vehicles[entry.vehicle as usize].flags & Vehicle::GRANTED != 0;
        let (inside, before) = roundabout.lanes();
        inside.flat_map(on).chain(before.flat_map(on).filter(may))
    }

    /// Whether there is room beyond the junction, as far as something stands in the way `stands_m` from a vehicle's middle.
    fn has_room(&self, index: usize, plan: &Plan, line: &Line, next: &Vehicle, stands_m: impl Fn() -> f32) -> bool {
        let known = (self.map, self.ways, self.lists, self.vehicles);
        let (steps, driver) = (self.steps_of(plan), &self.drivers[index]);
        let beyond = || junction::has_room(known, plan, line, steps, index, driver, stands_m());
        match self.has_room_to_circulate(index, plan, line, next) {
            Some(room) => room && stands_m() > self.end_m(plan, line) + driver.size_m.x + driver.gap_m,
            None => beyond(),
        }
    }

    /// The vehicle behind a junction that leaves one which waits before it no room.
    pub(super) fn takes_room(&self, index: usize) -> Option<usize> {
        let (plan, vehicle) = (&self.plans[index], &self.vehicles[index]);
        let line = plan.line.filter(|_| vehicle.wait_ticks > 0 && vehicle.flags & Vehicle::GRANTED == 0)?;
        let circulates = self.has_room_to_circulate(index, plan, &line, vehicle).is_some();
        if circulates || self.has_room(index, plan, &line, vehicle, || f32::MAX) {
            return None;
        }
        let ahead = self.steps_of(plan)[line.inside.0..].iter().flat_map(|step| self.lists.on(step.lane));
        ahead.map(|entry| entry.vehicle as usize).find(|other| *other != index)
    }

    fn wait(&self, index: usize, line: &Line, signal: Signal, steps: &[Step], next: &mut Vehicle) {
        let stop = self.map.lanes[steps[line.approach].lane as usize].stop;
        let sign = stop.is_some_and(|stop| stop.kind == StopKind::Stop);
        let at_line = line.hold_m < LINE_MARGIN_M + 2.0 && next.speed_mps < 0.3;
        if at_line && (sign || signal == Signal::Open) {
            next.wait_ticks = next.wait_ticks.saturating_add(u16::from(DECIDE_TICKS));
            if signal == Signal::Open && self.is_honked_at(index) {
                next.wait_ticks = next.wait_ticks.max(junction::PATIENCE_TICKS + u16::from(DECIDE_TICKS));
            }
            if next.wait_ticks.is_multiple_of(RETHINK_TICKS) && next.flags & Vehicle::GRANTED == 0 {
                // No way through: somewhere else, perhaps by another turn.
                next.trips = next.trips.wrapping_add(1);
            }
        } else if !at_line {
            next.wait_ticks = 0;
        }
        if sign && (next.wait_ticks >= HALT_TICKS || self.rolls(line, steps[line.approach].lane, next)) {
            next.flags |= Vehicle::HALTED;
        }
    }

    /// Whether nobody is between a vehicle and its line who may not enter.
    fn leads(&self, plan: &Plan, line: &Line) -> bool {
        plan.leader.is_none_or(|leader| {
            let ahead = &self.vehicles[leader.vehicle as usize];
            leader.gap_m > line.ahead_m || ahead.flags & (Vehicle::GRANTED | Vehicle::CROSSING) != 0
        })
    }

    /// Whether a vehicle wants to enter the junction before it now.
    fn asks(&self, index: usize, plan: &Plan, line: &Line, signal: Signal, next: &Vehicle) -> bool {
        let steps = self.steps_of(plan);
        let room = || self.has_room(index, plan, line, next, || self.standing_m(index, steps));
        let free = || room() && self.comes_out_of_bend(index, &steps[line.inside.1..]).is_none();
        junction::near_enough(next, line, 0.0) && signal == Signal::Open && self.leads(plan, line) && free()
    }

    /// From a vehicle's middle to the nearest thing that stands in its way and cannot be passed, metres. Who passes somebody
    /// on the lane that it wants to leave by is such a thing: both would wait for each other.
    fn standing_m(&self, index: usize, steps: &[Step]) -> f32 {
        let seeker = Seeker { speed_mps: 0.0, horizon_m: STANDING_M, ..self.seeker(index) };
        let free = self.hazards.free();
        let standing = || free.iter().filter(|h| h.stands());
        let aim_m = side(self.map, steps, &seeker, standing(), seeker.offset_m);
        let others = self.changing.iter().filter(|h| h.position != seeker.position);
        let seen = standing().chain(others).filter_map(|h| sight(self.map, steps, &seeker, h));
        let blocking = seen.filter(|seen| seen.speed_mps < STANDS_MPS && seen.blocks(aim_m, seeker.half.y));
        blocking.map(|seen| seen.gap_m + seeker.half.x).fold(f32::MAX, f32::min)
    }
}
