//! What drivers see of the vehicle ahead: late, and not quite as it is.
//!
//! Errors of the human driver model (Treiber, Kesting and Helbing 2006): the gap is misjudged by 5 %, the closing speed by
//! 1 % of the gap a second, both for about 20 s. They are functions of time: values drawn for every 20 s, and a line between.

use crate::ops;
use crate::rng::{Stream, bits, unit};
use crate::time::{TICK_HZ, Tick, seconds};

use super::drive::{View, follow_idm};
use super::plan::{Leader, Plan};
use super::rates::HazardRates;
use super::traits::Driver;
use super::vehicle::{DECIDE_TICKS, Vehicle};

/// Standard deviation of the gap as it is judged, relative, and of the closing speed, m/s for each metre.
const GAP_ERROR: f32 = 0.05;
const SPEED_ERROR_PER_S: f32 = 0.01;
/// Errors last about so long.
const ERROR_TICKS: Tick = seconds(20);
/// Half of the width of an even distribution with a standard deviation of one.
const EVEN: f32 = 1.732_050_8;
/// Reaction times to brake lights (Green 2000): half of all are below the first, s; logarithmic deviation.
const REACTION_S: f32 = 0.9;
const REACTION_SPREAD: f32 = 0.2;
/// Longest one, s.
const REACTION_MOST_S: f32 = 2.0;
/// Braking from which on a driver has to take notice, m/s².
const NOTICED_MPS2: f32 = -0.8;
/// What is done until then, m/s².
const LATE_MPS2: f32 = -0.5;
/// Who would have to brake harder than this if the one ahead stopped as hard as it can, reacts at once, m/s².
const LOOMS_MPS2: f32 = 4.0;
const AHEAD_MPS2: f32 = 8.0;
/// Random numbers of a driver.
const REACTION: u64 = 65;
const ERRORS: u64 = 1 << 40;

impl HazardRates {
    /// Ticks until a driver reacts.
    pub(super) fn reaction_ticks(&self, seed: u64, id: u16) -> u8 {
        let t = |k| unit(seed, Stream::Trait, u64::from(id), REACTION + k);
        // The sum of twelve is close to a normal distribution.
        let normal = (0..12).map(t).sum::<f32>() - 6.0;
        let reaction_s = REACTION_S * ops::exp(REACTION_SPREAD * normal) * self.inattention;
        (reaction_s.min(REACTION_MOST_S) * TICK_HZ as f32) as u8
    }
}

impl View<'_> {
    /// Acceleration behind the vehicle ahead, m/s²: as the driver sees that, once it is noticed. Counts for how long it
    /// is not.
    pub(super) fn behind_leader_mps2(&self, index: usize, plan: &Plan, next: &mut Vehicle) -> f32 {
        let waited = std::mem::take(&mut next.late_ticks);
        // Who passes looks for everybody where they are.
        let leader = plan.leader.filter(|_| !self.vehicles[index].manoeuvre.passes());
        let Some(leader) = leader else { return f32::MAX };
        let driver = &self.drivers[index];
        let (gap_m, speed_mps) = self.perceived(next.id, &leader);
        let wished = follow_idm(driver, next.speed_mps, gap_m, speed_mps);
        let notices = waited >= driver.reaction_ticks || next.flags & Vehicle::BRAKING != 0;
        if notices || wished > NOTICED_MPS2 || looms(driver, next.speed_mps, &leader) {
            return wished;
        }
        next.late_ticks = waited + DECIDE_TICKS;
        LATE_MPS2
    }

    /// Gap to the vehicle ahead and its speed, as the driver sees them.
    fn perceived(&self, id: u16, leader: &Leader) -> (f32, f32) {
        if self.rates.inattention == 0.0 {
            return (leader.gap_m, leader.speed_mps);
        }
        let [gap, speed] = self.errors(id);
        let scale = EVEN * self.rates.inattention;
        let speed_mps = leader.speed_mps + SPEED_ERROR_PER_S * scale * speed * leader.gap_m;
        (leader.gap_m * (1.0 + GAP_ERROR * scale * gap), speed_mps.max(0.0))
    }

    /// The present errors of a driver, each in [-1, 1].
    fn errors(&self, id: u16) -> [f32; 2] {
        // Not all at the same time.
        let at = self.tick + Tick::from(id) * 37;
        let (window, share) = (at / ERROR_TICKS, (at % ERROR_TICKS) as f32 / ERROR_TICKS as f32);
        let [from, to] = [window, window + 1].map(|w| bits(self.seed, Stream::Lapse, ERRORS | u64::from(id), w));
        [0, 32].map(|shift| {
            let value = |drawn: u64| ((drawn >> shift) as u32 >> 8) as f32 / (1u32 << 23) as f32 - 1.0;
            value(from) + (value(to) - value(from)) * share
        })
    }
}

/// Whether a driver would have to brake hard if the vehicle ahead stopped as hard as it can.
fn looms(driver: &Driver, speed_mps: f32, leader: &Leader) -> bool {
    let room_m = leader.gap_m - driver.gap_m * 0.5 + leader.speed_mps * leader.speed_mps / (2.0 * AHEAD_MPS2);
    room_m <= 0.0 || speed_mps * speed_mps > 2.0 * LOOMS_MPS2 * room_m
}
