//! The last look: who is slow and would touch another vehicle, or somebody on the road, where it comes to a stand steers straight
//! on or brakes as hard as can be. All else that keeps vehicles apart looks along lanes; this looks at boxes, tails that swing
//! out among them. Long ones heed people on pavements as well, over which their corners sweep.

use glam::Vec2;

use crate::time::TICK_S;

use super::body::Body;
use super::drive::{View, turns_in_m};
use super::hazard::{Hazard, SLOW_MPS};
use super::outline::half_m;
use super::vehicle::{DECIDE_TICKS, Vehicle};

/// Long vehicles, which sweep out of their lanes where these bend, do so up to here, but brake only.
const LONG_MPS: f32 = 11.0;
/// Room to others, metres: who has more keeps that.
const ROOM_M: [f32; 3] = [0.12, 0.04, 0.0];
/// The least of it to the ego car and loose actors: whom physics takes for about to be hit, at 0.06 m, drives no more.
const CLEAR_M: f32 = 0.1;
/// Who leaves vehicles less than the most of that creeps by them, m/s, and takes up that speed in such a time, s.
const CREEP_MPS: f32 = 1.5;
const ADAPT_S: f32 = 0.5;
/// The same beside the ego car and loose actors that are slower than this, m/s, for who leaves them less than so many metres
/// and so many more for each m/s of their own.
const CREEP_BESIDE_MPS: f32 = 0.7;
const WAITS_MPS: f32 = 2.0;
const BESIDE_M: f32 = 0.1;
const BESIDE_S: f32 = 0.08;
/// Who starts looks so far ahead, metres.
const START_M: f32 = 0.12;
/// Longer vehicles sweep over pavements, metres.
const LONG_M: f32 = 5.0;
/// Half of who is on one, without the room that is kept to whom is on the road, metres.
const SLIM_M: f32 = 0.1;
/// The way ahead is looked at in strides of at most this, metres.
const STRIDE_M: f32 = 1.5;

/// The way on which a vehicle comes to a stand, and who is beside it.
struct Brink<'a> {
    now: Hazard,
    ahead_m: f32,
    stop_s: f32,
    others: Vec<&'a Hazard>,
    on_pavements: Vec<Hazard>,
}

impl Brink<'_> {
    /// The same without vehicles that are driven.
    fn but_driven(&self) -> Self {
        let others = self.others.iter().copied().filter(|other| other.vehicle.is_none()).collect();
        Self { others, on_pavements: self.on_pavements.clone(), ..*self }
    }

    fn all(&self) -> impl Iterator<Item = &Hazard> {
        self.others.iter().copied().chain(&self.on_pavements)
    }
}

impl View<'_> {
    /// What is left of the acceleration that a driver wants, m/s²: who would touch somebody steers straight on, if that is
    /// enough, and brakes else. For the ego car too, unless that is seen to already.
    pub(super) fn last_look(&self, index: usize, next: &mut Vehicle, accel_mps2: f32, heeds_ego: bool) -> f32 {
        let (driver, mps) = (&self.drivers[index], next.speed_mps);
        let looks_up_to_mps = if driver.is_long() { LONG_MPS } else { SLOW_MPS };
        if mps > looks_up_to_mps || (mps == 0.0 && accel_mps2 <= 0.0) {
            return accel_mps2;
        }
        let brink = self.brink(index, next, heeds_ego);
        if brink.all().next().is_none() {
            return accel_mps2;
        }
        let accel_mps2 = accel_mps2.min(self.beside_mps2(index, next, &brink));
        let turns = next.drift != 0 || next.drift_aim != 0;
        let free = |aim: i8, room_m: &[f32]| !self.touches(index, next, &brink, aim, room_m);
        if mps > SLOW_MPS {
            return if free(next.drift_aim, &ROOM_M[2..]) { accel_mps2 } else { -driver.hardest_mps2 };
        }
        if free(next.drift_aim, &ROOM_M) {
            accel_mps2
        } else if turns && free(0, &ROOM_M[1..]) {
            next.drift_aim = 0;
            accel_mps2
        } else if !turns && free(0, &ROOM_M[2..]) && !self.touches(index, next, &brink.but_driven(), 0, &ROOM_M) {
            // Both on their ways, long ones come by each other in narrow bends by less than a hand's breadth.
            accel_mps2.min((CREEP_MPS - mps) / ADAPT_S).max(-driver.hardest_mps2)
        } else {
            next.drift_aim = if free(0, &ROOM_M[2..]) { 0 } else { next.drift_aim };
            -driver.hardest_mps2
        }
    }

    /// Acceleration by which a vehicle slows down beside whom it leaves little room; infinite where it need not, m/s².
    fn beside_mps2(&self, index: usize, next: &Vehicle, brink: &Brink<'_>) -> f32 {
        let mps = next.speed_mps;
        let waits = |other: &&&Hazard| other.vehicle.is_none() && !other.walker && other.is_slower(WAITS_MPS);
        let mut waiting = brink.others.iter().filter(waits).peekable();
        if mps <= CREEP_BESIDE_MPS || waiting.peek().is_none() {
            return f32::INFINITY;
        }
        let then = self.rolled(index, next, brink.ahead_m, next.drift_aim);
        if waiting.any(|other| then.is_within(other, BESIDE_M + BESIDE_S * mps)) {
            ((CREEP_BESIDE_MPS - mps) / ADAPT_S).max(-self.drivers[index].hardest_mps2)
        } else {
            f32::INFINITY
        }
    }

    fn brink(&self, index: usize, next: &Vehicle, heeds_ego: bool) -> Brink<'_> {
        let look_s = f32::from(DECIDE_TICKS) * TICK_S;
        let stop_s = next.speed_mps / self.drivers[index].hardest_mps2 + look_s;
        let ahead_m = START_M + next.speed_mps * 0.5 * (stop_s + look_s);
        let now = Hazard::of_body(&self.bodies[index]);
        let reach_m = now.half.length() + ahead_m + ROOM_M[0].max(BESIDE_M + BESIDE_S * next.speed_mps);
        let around = self.hazards.reaching(now.position, reach_m);
        let is_heeded = |h: &Hazard| heeds_ego || !h.is_ego();
        let other = |h: &&Hazard| h.vehicle != Some(index as u32) && h.is_level_with(now.position.z) && is_heeded(h);
        let on_pavements = if now.half.x * 2.0 > LONG_M { self.on_pavements(&now, reach_m) } else { Vec::new() };
        Brink { now, ahead_m, stop_s, others: around.filter(other).collect(), on_pavements }
    }

    /// Whoever is on foot, and not on the road, within reach of a vehicle.
    fn on_pavements(&self, now: &Hazard, reach_m: f32) -> Vec<Hazard> {
        let walked = &self.bodies[self.vehicles.len()..];
        let near = self.crowd.around(now.position, reach_m).map(|i| &walked[i]);
        let near = near.filter(|b| {
            b.position.distance_squared(now.position) < reach_m * reach_m && now.is_level_with(b.position.z)
        });
        let on_road = |id: u32| self.hazards.people().iter().any(|h| h.id == id);
        let slim = |b: &Body| Hazard { half: Vec2::new(SLIM_M + half_m(b.kind), SLIM_M), ..Hazard::of_body(b) };
        near.filter(|b| !on_road(b.id)).map(slim).collect()
    }

    /// Whether a vehicle that steers to a drift comes nearer to anybody than one of `room_m`, who is not so near yet.
    fn touches(&self, index: usize, next: &Vehicle, brink: &Brink<'_>, aim: i8, room_m: &[f32]) -> bool {
        let strides = (brink.ahead_m / STRIDE_M) as u32 + 1;
        (1..=strides).any(|stride| {
            let share = stride as f32 / strides as f32;
            let then = self.rolled(index, next, share * brink.ahead_m, aim);
            let meets = |other: &Hazard, m: f32| {
                if brink.now.is_within(other, m) {
                    let away = |at: &Hazard| at.position.distance_squared(other.position);
                    return m == 0.0 && away(&then) < away(&brink.now);
                }
                then.is_within(other, m) || then.is_within(&other.after(share * brink.stop_s), m)
            };
            let clear_m = |other: &Hazard| (other.vehicle.is_none() && !other.walker).then_some(&CLEAR_M);
            brink.all().any(|other| room_m.iter().chain(clear_m(other)).any(|m| meets(other, *m)))
        })
    }

    /// A vehicle so far ahead on its way, that steers to a drift.
    pub(super) fn rolled(&self, index: usize, vehicle: &Vehicle, ahead_m: f32, aim: i8) -> Hazard {
        let driver = &self.drivers[index];
        let mut then = *vehicle;
        then.s_m += ahead_m;
        self.change_lane(driver, &mut then);
        let steered = (ahead_m / turns_in_m(driver)) as i8;
        then.drift += (aim - vehicle.drift).clamp(-steered, steered);
        then.offset_m += 0.5 * (f32::from(vehicle.drift) + f32::from(then.drift)) * 0.01 * ahead_m;
        Hazard::of_body(&self.ways.vehicle_body(self.seed, &then, driver))
    }
}
