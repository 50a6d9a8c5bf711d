//! Who stands without a reason, and for how long.
//!
//! Once a second every vehicle that stands follows the queue before it to its head; who waits at a junction for room behind it
//! is one of the queue there, and who waits before a narrow bend stands behind who goes through it. It has a reason when the
//! head moves, waits for a light, or is held up by the ego car; otherwise the second counts. Who moves begins anew.

use super::drive::View;
use super::hazard::{Hazard, sight};
use super::junction::{Signal, signal};
use super::plan::Plan;
use super::vehicle::Vehicle;

/// A vehicle that has stood this long without a reason is told, s.
pub(super) const STUCK_S: u8 = 60;
/// One that is the head of its queue leaves the map after this, unseen by the ego car, s.
pub(super) const DISSOLVE_S: u8 = 120;
/// And after this though it is seen, s.
pub(super) const DISSOLVE_SEEN_S: u8 = 160;
/// Whoever becomes the head of a queue has at least this long to drive on, s.
const LAST_CHANCE_S: u8 = 5;
/// Slower than this a vehicle stands, m/s.
const STANDS_MPS: f32 = 0.1;
/// It stands behind another at a gap of at most this, metres.
const BEHIND_M: f32 = 6.0;
/// And behind the ego car, from which it keeps off to pass it, metres.
const BEHIND_EGO_M: f32 = 26.0;
/// Or so near beside it that it could not move on without touching it, metres.
const BESIDE_EGO_M: f32 = 0.3;
/// It waits at a light no farther from its line than this, metres.
const AT_LIGHT_M: f32 = 12.0;
/// Longest queue that is followed, vehicles.
const LONGEST_QUEUE: usize = 64;

impl View<'_> {
    /// Seconds for which a vehicle has now stood without a reason.
    pub(super) fn stuck_s(&self, index: usize) -> u8 {
        let vehicle = &self.vehicles[index];
        if vehicle.speed_mps >= STANDS_MPS {
            return 0;
        }
        let count = vehicle.stuck_s.saturating_add(1);
        match self.queue_head(index) {
            None => vehicle.stuck_s,
            Some(head) if head == index => count,
            Some(_) => count.min(DISSOLVE_S - LAST_CHANCE_S),
        }
    }

    /// The vehicle for which one stands that stands: the first of its queue, or the one of a ring of
    /// queues whose id is least. None where that one has a reason.
    fn queue_head(&self, index: usize) -> Option<usize> {
        let mut at = index;
        let mut least = index;
        for _ in 0..LONGEST_QUEUE {
            if self.has_reason(at) {
                return None;
            }
            let Some(leader) = self.stands_behind(at) else { return Some(at) };
            if self.vehicles[leader].speed_mps >= STANDS_MPS {
                return None;
            }
            if leader == index {
                return Some(least);
            }
            at = leader;
            least = if self.vehicles[at].id < self.vehicles[least].id { at } else { least };
        }
        Some(least)
    }

    fn stands_behind(&self, index: usize) -> Option<usize> {
        let leader = self.plans[index].leader.filter(|leader| leader.gap_m < BEHIND_M);
        let leader = leader.map(|leader| leader.vehicle as usize);
        leader.or_else(|| self.takes_room(index)).or_else(|| self.lets_through_bend(index))
    }

    /// The vehicle which one lets through a narrow bend, right before that or before the junction at it.
    fn lets_through_bend(&self, index: usize) -> Option<usize> {
        let (plan, vehicle) = (&self.plans[index], &self.vehicles[index]);
        let steps = self.steps_of(plan);
        let bend = self.bend_to_wait_at(index, steps, vehicle).filter(|(bend_m, _)| *bend_m < BEHIND_M);
        let waits = plan.line.filter(|_| vehicle.flags & Vehicle::GRANTED == 0);
        let beyond = || self.comes_out_of_bend(index, &steps[waits?.inside.1..]);
        bend.map(|(_, first)| first).or_else(beyond)
    }

    fn has_reason(&self, index: usize) -> bool {
        let plan = &self.plans[index];
        self.waits_at_light(index, plan) || self.behind_ego(index, plan) || self.beside_ego(index)
    }

    fn waits_at_light(&self, index: usize, plan: &Plan) -> bool {
        let Some(line) = plan.line.filter(|line| line.hold_m < AT_LIGHT_M && !line.passed) else { return false };
        let steps = self.steps_of(plan);
        let light = self.map.light_between(steps[line.approach].lane, steps[line.inside.0].lane);
        light.is_some() && signal(self.map, self.lights, &self.vehicles[index], steps, &line) != Signal::Open
    }

    fn behind_ego(&self, index: usize, plan: &Plan) -> bool {
        let seeker = self.seeker(index);
        let seen = self.hazards.free().first().and_then(|ego| sight(self.map, self.steps_of(plan), &seeker, ego));
        seen.is_some_and(|seen| seen.gap_m < BEHIND_EGO_M && seen.blocks(seeker.offset_m, seeker.half.y))
    }

    fn beside_ego(&self, index: usize) -> bool {
        let me = Hazard::of_body(&self.bodies[index]);
        self.hazards.free().first().is_some_and(|ego| me.is_within(ego, BESIDE_EGO_M))
    }
}
