//! Cutting in, and pulling out from the kerb: others have to brake hard, but can.

use crate::map_data::Projection;

use super::change::GAP_M;
use super::drive::View;
use super::hazard::sight;
use super::manoeuvre::Manoeuvre;
use super::plan::{Plan, braking_needed};
use super::traits::Driver;
use super::vehicle::Vehicle;

/// Braking that is asked of others, m/s².
const ASKED_MPS2: f32 = 4.0;
/// Room that is left then, metres.
const LEFT_M: f32 = 1.5;
/// Slower than this nobody cuts in, m/s.
const LEAST_MPS: f32 = 5.0;
/// Whoever is nearer than this beside the kerb is waited for, metres.
const BESIDE_M: f32 = 2.0;
/// And whoever has to brake harder than this where one pulls out without a look, as the vehicle still stands, m/s².
pub(super) const PULL_OUT_MPS2: f32 = 5.0;

impl View<'_> {
    /// Where a vehicle would be on a lane beside its own, if it can change there right before somebody who has to brake
    /// harder for it than for other changes, and who can.
    pub(super) fn cut_in(&self, index: usize, plan: &Plan) -> Option<(i8, Projection)> {
        let vehicle = &self.vehicles[index];
        if vehicle.manoeuvre != Manoeuvre::Keep || vehicle.speed_mps < LEAST_MPS || vehicle.kind.size_m().x > 5.0 {
            return None;
        }
        [1, -1].into_iter().find_map(|side| {
            let there = self.target(index, plan, side)?;
            (self.is_bearable(index, &there) && !self.is_safe(index, &there)).then_some((side, there))
        })
    }

    /// Whether those before and behind have at least so much room that nobody is hit.
    fn is_bearable(&self, index: usize, there: &Projection) -> bool {
        let vehicle = &self.vehicles[index];
        let bears = |_: &Driver, mps: f32, gap_m: f32, ahead_mps: f32| {
            gap_m > GAP_M && braking_needed((mps - ahead_mps).max(0.0), gap_m - LEFT_M) < ASKED_MPS2
        };
        let driver = &self.drivers[index];
        let ahead = self.ahead(index, there.lane, there.s_m);
        let behind = self.behind(index, there.lane, there.s_m);
        ahead.is_none_or(|n| bears(driver, vehicle.speed_mps, n.gap_m, n.speed_mps))
            && behind.is_none_or(|n| bears(driver, n.speed_mps, n.gap_m, vehicle.speed_mps))
            && self.is_free_of_hazards(index, there, bears)
            && self.is_first(index)
    }

    /// Changes lanes at once, if that is still possible.
    pub(super) fn barge_in(&self, index: usize, plan: &Plan, next: &mut Vehicle) {
        let granted = next.flags & Vehicle::GRANTED != 0;
        if let Some((side, there)) =
            self.cut_in(index, plan).filter(|_| !granted && next.lane == self.vehicles[index].lane)
        {
            next.manoeuvre = Manoeuvre::signal_to(side);
            self.take_lane(&there, next);
        }
    }

    /// Whether nobody is beside a vehicle that has halted at the kerb, nor so near behind that he would have to brake harder
    /// than that.
    pub(super) fn can_pull_out(&self, index: usize, most_mps2: f32) -> bool {
        let (vehicle, seeker, plan) = (&self.vehicles[index], self.seeker(index), &self.plans[index]);
        let likes_m = self.likes_m(index);
        let steps = self.steps_of(plan);
        let mut seen = self
            .near(index, &seeker)
            .chain(self.hazards.free().first())
            .filter_map(|h| sight(self.map, steps, &seeker, h));
        let beside = seen.any(|seen| seen.gap_m < BESIDE_M && seen.obstructs(likes_m, seeker.half.y));
        let stops = |mps: f32, gap_m: f32| braking_needed(mps, gap_m - LEFT_M) < most_mps2;
        let behind = self.behind(index, vehicle.lane, vehicle.s_m);
        let there = self.map.project(vehicle.lane, self.bodies[index].position);
        !beside
            && behind.is_none_or(|n| stops(n.speed_mps, n.gap_m))
            && self.is_free_of_hazards(index, &there, |_, mps, gap_m, _| mps < 0.1 || stops(mps, gap_m))
    }
}
