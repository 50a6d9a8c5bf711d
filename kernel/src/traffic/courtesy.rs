//! Courtesy: who opens a gap for those who signal, and who hears the horn.

use crate::rng::{Stream, unit};
use crate::time::{Tick, seconds};

use super::asking::Asking;
use super::drive::{View, follow_idm};
use super::horn::VEHICLES_ASIDE_M;
use super::manoeuvre::Manoeuvre;
use super::plan::Plan;
use super::vehicle::Vehicle;

/// Share of those asked who open a gap, drawn anew for each pair after some seconds (assumption: one in two).
const COURTEOUS: f32 = 0.5;
const DRAW_TICKS: Tick = seconds(8);
/// Braking for that at most: what is felt as comfortable, m/s².
const GIVE_MPS2: f32 = 1.5;
/// Who signals is let in from a gap of so much on, metres and seconds.
const ASKED_M: f32 = 6.0;
const ASKED_S: f32 = 1.2;
/// Nobody stands longer for it, s.
const PATIENT_S: u8 = 10;
/// Nobody slows down by more than this for it, m/s.
const SLOWER_MPS: f32 = 5.0;

impl View<'_> {
    /// The greatest acceleration of a vehicle that opens a gap for one who signals to its lane, m/s².
    pub(super) fn lets_in(&self, index: usize, plan: &Plan) -> f32 {
        let vehicle = &self.vehicles[index];
        let busy = vehicle.flags & (Vehicle::GRANTED | Vehicle::CROSSING) != 0 || vehicle.manoeuvre != Manoeuvre::Keep;
        if self.asking.is_empty() || busy || vehicle.stuck_s >= PATIENT_S {
            return f32::MAX;
        }
        let driver = &self.drivers[index];
        let reach_m = ASKED_M + ASKED_S * vehicle.speed_mps;
        let gives = |asking: &Asking| {
            let step = self.steps_of(plan).iter().take(2).find(|step| step.lane == asking.lane)?;
            let ahead_m = step.start_m + asking.s_m - driver.size_m.x * 0.5;
            let gap_m = ahead_m - asking.half_m;
            let asked = ahead_m > 0.0 && gap_m < reach_m && plan.leader.is_none_or(|l| l.gap_m > gap_m);
            let bears = vehicle.speed_mps - asking.speed_mps < SLOWER_MPS;
            let courteous = asking.owed || self.is_courteous(vehicle.id, asking.id);
            let gives = asked && bears && courteous && !self.is_honked_at(index);
            gives.then(|| follow_idm(driver, vehicle.speed_mps, gap_m, asking.speed_mps).max(-GIVE_MPS2))
        };
        self.asking.iter().filter(|asking| asking.id != vehicle.id).filter_map(gives).fold(f32::MAX, f32::min)
    }

    fn is_courteous(&self, id: u16, asking: u16) -> bool {
        let pair = u64::from(id) << 16 | u64::from(asking);
        unit(self.seed, Stream::Courtesy, pair, self.tick / DRAW_TICKS) < COURTEOUS
    }

    /// Whether the ego car sounds its horn at a vehicle.
    pub(super) fn is_honked_at(&self, index: usize) -> bool {
        self.horn.is_some_and(|horn| horn.is_for(self.bodies[index].position.truncate(), VEHICLES_ASIDE_M))
    }
}
