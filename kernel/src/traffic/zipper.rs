//! Who goes first where lanes meet outside junctions: the one that is ahead, as in a zipper.
//!
//! Places on two lanes that merge are compared as if they were one lane. Whoever is behind follows the
//! one ahead as a leader, or stops where the lanes come near each other, whatever slows it less; so
//! two queues take turns, and the foremost of all waits for nobody.

use super::drive::{View, follow_idm};
use super::lists::Entry;
use super::meets::Meet;
use super::plan::stopping_speed;
use super::step::{LINE_MARGIN_M, Step};
use super::traits::Driver;
use super::vehicle::Vehicle;

/// Braking from afar for one who goes first, m/s², so that gaps open while both roll.
const EARLY_MPS2: f32 = 1.0;
/// The gap to that one may still be shorter by so much for each metre before that place.
const GAP_OPENS: f32 = 0.2;
/// Braking before a place where lanes meet, m/s².
const BRAKE_MPS2: f32 = 1.2;
/// Time in which that speed is taken up, s.
const ADAPT_S: f32 = 0.3;
/// Whoever is nearer to where lanes cross than this goes first although it stands, metres.
const AT_LINE_M: f32 = 3.0;

/// Where a vehicle is before a stretch on which lanes meet.
struct Approach<'a> {
    driver: &'a Driver,
    vehicle: &'a Vehicle,
    /// From its middle to the start of the lane, metres.
    start_m: f32,
    /// From its front to where it has to wait, metres; not positive when it is over it.
    line_m: f32,
    meet: &'a Meet,
}

impl View<'_> {
    /// The greatest acceleration that those on lanes which meet this vehicle's leave it, m/s².
    pub(super) fn zip(&self, index: usize, steps: &[Step], next: &Vehicle, horizon_m: f32) -> f32 {
        let (driver, half_m) = (&self.drivers[index], self.drivers[index].size_m.x * 0.5);
        let mut accel = f32::MAX;
        for step in steps {
            for meet in &self.ways.lanes[step.lane as usize].meets {
                let [from_m, to_m] = meet.here.map(|m| step.start_m + m);
                let line_m = from_m - half_m - LINE_MARGIN_M;
                // Nobody joins before the place where its own way does.
                if to_m < -half_m || line_m > horizon_m || (step.from_m > 0.0 && meet.here[1] < step.from_m) {
                    continue;
                }
                let approach = Approach { driver, vehicle: next, start_m: step.start_m, line_m, meet };
                let others = self.lists.on(meet.lane).iter().filter(|e| e.vehicle as usize != index);
                accel = others.filter_map(|e| approach.yields_to(e)).fold(accel, f32::min);
            }
        }
        accel
    }
}

impl Approach<'_> {
    /// The acceleration that is left behind another, if that goes first.
    fn yields_to(&self, other: &Entry) -> Option<f32> {
        if other.s_m - other.half_m > self.meet.there[1] {
            return None;
        }
        match self.meet.shift_m {
            Some(shift_m) => self.follows(other, self.start_m + shift_m + other.s_m),
            None => self.waits(other),
        }
    }

    /// Behind one that is `between_m` ahead on a lane alongside, from middle to middle.
    fn follows(&self, other: &Entry, between_m: f32) -> Option<f32> {
        // Told by their fronts, so that whoever is over the line first goes first.
        let lead_m = between_m + other.half_m - self.driver.size_m.x * 0.5;
        let ahead = lead_m > 0.0 || (lead_m == 0.0 && other.id < self.vehicle.id);
        let gap_m = between_m - other.half_m - self.driver.size_m.x * 0.5;
        let opens_m = GAP_OPENS * self.line_m.max(0.0);
        let follow = follow_idm(self.driver, self.vehicle.speed_mps, gap_m + opens_m, other.speed_mps);
        ahead.then(|| if self.line_m > 0.0 { follow.max(self.stop().min(-EARLY_MPS2)) } else { follow })
    }

    /// Before one on a lane that crosses.
    fn waits(&self, other: &Entry) -> Option<f32> {
        let theirs_m = self.meet.there[0] - other.s_m - other.half_m;
        let comes = other.speed_mps > 0.5 || theirs_m < AT_LINE_M;
        // Measured as for the other, so that both say the same.
        let mine_m = self.line_m + LINE_MARGIN_M;
        let first = (theirs_m.max(0.0), other.id) < (mine_m.max(0.0), self.vehicle.id);
        (self.line_m > -LINE_MARGIN_M && comes && first).then(|| self.stop())
    }

    fn stop(&self) -> f32 {
        (stopping_speed(self.line_m, BRAKE_MPS2) - self.vehicle.speed_mps) / ADAPT_S
    }
}
