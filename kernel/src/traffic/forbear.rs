//! Who may cross a junction without lights brakes all the same for the ego car that comes across, and is in it or cannot stop
//! before it any more: it hears of no grant, and nobody insists on a right of way (StVO § 1, § 11).

use super::drive::View;
use super::hazard::Hazard;
use super::plan::Plan;
use super::vehicle::Vehicle;

/// How far ahead both are expected to go on as they do, in steps; and how long who brakes waits for the ego car to be past,
/// seconds.
const FORESEEN_S: f32 = 2.5;
const PAST_S: f32 = 5.0;
const STEP_S: f32 = 0.25;
/// Who is turned from the other's direction, or against it, by more than 40 degrees (cosine) comes across.
const ACROSS_COS: f32 = 0.77;
/// Slower than this the last look is enough, m/s.
const SLOW_MPS: f32 = 2.0;
/// Room that is left between the two, metres.
const ROOM_M: f32 = 0.5;
/// Braking that is tried out, as shares of the hardest.
const TRIED: [f32; 4] = [0.25, 0.5, 0.75, 1.0];

/// A vehicle that goes on as it does, or brakes so much.
#[derive(Clone, Copy)]
struct Going<'a> {
    index: usize,
    next: &'a Vehicle,
    brake_mps2: f32,
}

impl Going<'_> {
    /// The way of `time_s` seconds, metres.
    fn way_m(&self, time_s: f32) -> f32 {
        let mps = self.next.speed_mps;
        let stands_s = if self.brake_mps2 > 0.0 { mps / self.brake_mps2 } else { f32::INFINITY };
        let time_s = time_s.min(stands_s);
        (mps - 0.5 * self.brake_mps2 * time_s) * time_s
    }
}

impl View<'_> {
    /// Acceleration by which a vehicle that may cross a junction does not meet the ego car, m/s²: the least braking, infinite
    /// where it needs none. `None` where the ego car does not come across.
    pub(super) fn forbearance_mps2(&self, index: usize, plan: &Plan, next: &Vehicle) -> Option<f32> {
        let may_cross = next.flags & (Vehicle::GRANTED | Vehicle::CROSSING) != 0;
        let may_meet = may_cross && self.ego_enters && next.speed_mps > SLOW_MPS && !self.has_lights(plan, next);
        let ego = self.hazards.free().first().filter(|ego| may_meet && !ego.stands())?;
        if !self.comes_across(index, next, ego) {
            return None;
        }
        let hardest_mps2 = self.drivers[index].hardest_mps2;
        // It stays as far beside the middle of its lane as it is.
        let steady = Vehicle { drift: 0, drift_aim: 0, ..*next };
        let goes_on = Going { index, next: &steady, brake_mps2: 0.0 };
        let is_clear = |room_m| !self.meets(goes_on, ego, FORESEEN_S, room_m);
        if is_clear(ROOM_M) {
            return Some(f32::INFINITY);
        }
        let helps = |brake_mps2: &f32| !self.meets(Going { brake_mps2: *brake_mps2, ..goes_on }, ego, PAST_S, ROOM_M);
        let least_mps2 = TRIED.into_iter().map(|share| share * hardest_mps2).find(helps);
        // Who would stop in its way goes on, if that touches nobody.
        let brakes = || if is_clear(0.0) { f32::INFINITY } else { -hardest_mps2 };
        Some(least_mps2.map_or_else(brakes, |mps2| -mps2))
    }

    /// Whether lights order the junction in which a vehicle is, or before it.
    fn has_lights(&self, plan: &Plan, next: &Vehicle) -> bool {
        let steps = self.steps_of(plan);
        let ahead = plan.line.map(|line| (steps[line.approach].lane, steps[line.inside.0].lane));
        [Some((next.before, next.lane)), ahead]
            .into_iter()
            .flatten()
            .any(|(a, b)| self.map.light_between(a, b).is_some())
    }

    /// Whether the ego car is near, and its way across that of a vehicle.
    fn comes_across(&self, index: usize, next: &Vehicle, ego: &Hazard) -> bool {
        let now = Hazard::of_body(&self.bodies[index]);
        let reach_m = FORESEEN_S * (next.speed_mps + ego.velocity.length()) + now.half.x + ego.half.x;
        now.is_level_with(ego.position.z)
            && now.position.distance_squared(ego.position) < reach_m * reach_m
            && now.forward.dot(ego.forward).abs() < ACROSS_COS
    }

    /// Whether a vehicle comes nearer to the ego car than `room_m` within some seconds.
    fn meets(&self, vehicle: Going<'_>, ego: &Hazard, within_s: f32, room_m: f32) -> bool {
        let Going { index, next, .. } = vehicle;
        (1..=(within_s / STEP_S) as u32).any(|step| {
            let time_s = step as f32 * STEP_S;
            let then = self.rolled(index, next, vehicle.way_m(time_s), 0);
            then.is_within(&ego.after(time_s), room_m)
        })
    }
}
