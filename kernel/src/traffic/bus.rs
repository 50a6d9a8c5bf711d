//! Buses at their stops: who passes one on its lane draws up at the kerb, stands there for a while, and is let out again.

use crate::actor::ActorKind;
use crate::rng::{Stream, below};
use crate::time::{Tick, seconds};

use super::drive::View;
use super::lapse::Lapse;
use super::manoeuvre::Manoeuvre;
use super::plan::{Plan, braking_needed, stopping_speed};
use super::vehicle::Vehicle;

/// Braking to a stop, which those who stand in the bus bear, m/s², and at most where the stop came late.
const CALL_MPS2: f32 = 1.2;
const LATE_MPS2: f32 = 2.0;
/// A bus signals to the kerb from here on, metres before the place where it would have to brake.
const SIGNAL_M: f32 = 15.0;
/// Nearer than this a stop is the one just left, metres.
const LEFT_M: f32 = 8.0;
/// At its stop is a bus whose front is this near to it, and not farther beyond it, metres.
const AT_STOP_M: f32 = 1.5;
const BEYOND_M: f32 = 1.0;
/// Least and most time at a stop, tenths of a second: 10 to 20 s as the Transit Capacity and Quality of Service Manual
/// (2013) gives for stops outside centres.
const DWELL_DS: [u8; 2] = [100, 200];
/// It signals this long before it drives off, tenths of a second.
const SIGNAL_DS: u8 = 30;
/// While somebody stands at the door its clock goes slower by so many times in the last 4 s before that: it waits for 12 s
/// more at most.
const LAST_CALL_DS: std::ops::RangeInclusive<u8> = SIGNAL_DS + 1..=SIGNAL_DS + 40;
const SLOWED: Tick = 4;
/// Ticks in a tenth of a second.
const DS_TICKS: Tick = 6;
/// Nobody has to brake harder for a bus that drives off, m/s².
const PULL_OUT_MPS2: f32 = 2.5;
/// A driver takes up the speed that the stop asks for within this time, s.
const ADAPT_S: f32 = 0.4;
/// Back where it likes to drive within so much, metres.
const BACK_M: f32 = 0.3;

impl View<'_> {
    /// Draws a bus up at the stop before it, and ends its driving off.
    pub(super) fn call(&self, index: usize, plan: &Plan, next: &mut Vehicle) {
        if next.kind != ActorKind::Bus {
            return;
        }
        let stop_m = self.stop_ahead_m(index, plan);
        match (next.lapse, stop_m) {
            (Lapse::None, Some(m)) if self.comes_to(m, next) => next.lapse = Lapse::Calls,
            (Lapse::Calls, None) => next.lapse = Lapse::None,
            (Lapse::Calls, Some(m)) if m < AT_STOP_M && next.speed_mps < 0.1 => {
                let [least, most] = DWELL_DS;
                let drawn = below(self.seed, Stream::Lapse, u64::from(next.id), self.tick, u32::from(most - least));
                (next.lapse, next.lapse_left) = (Lapse::Boards, least + drawn as u8);
            }
            (Lapse::Departs, _) => {
                let back = (next.offset_m - self.likes_m(index)).abs() < BACK_M;
                if back && stop_m.is_none_or(|m| m > LEFT_M) {
                    next.lapse = Lapse::None;
                }
            }
            _ => {}
        }
        match next.lapse {
            Lapse::Calls => self.indicate(self.ways.kerb, next),
            Lapse::Departs => self.indicate(-self.ways.kerb, next),
            _ => {}
        }
    }

    /// The greatest acceleration of a bus on its way to a stop, m/s².
    pub(super) fn call_mps2(&self, index: usize, plan: &Plan, next: &Vehicle) -> f32 {
        let stop_m = if next.lapse == Lapse::Calls { self.stop_ahead_m(index, plan) } else { None };
        stop_m.map_or(f32::MAX, |m| ((stopping_speed(m, CALL_MPS2) - next.speed_mps) / ADAPT_S).max(-LATE_MPS2))
    }

    /// The next state of a bus that stands at a stop.
    pub(super) fn board(&self, index: usize, next: &mut Vehicle) {
        if next.is_due(self.tick, DS_TICKS) {
            let holds = LAST_CALL_DS.contains(&next.lapse_left) && self.is_awaited(next);
            if !holds || next.is_due(self.tick, SLOWED * DS_TICKS) {
                next.lapse_left = next.lapse_left.saturating_sub(1);
            }
            if next.lapse_left == 0 && self.can_pull_out(index, PULL_OUT_MPS2) {
                next.lapse = Lapse::Departs;
            }
        }
        next.flags &= !(Vehicle::TURNS_LEFT | Vehicle::TURNS_RIGHT);
        if next.wants_out() || next.lapse == Lapse::Departs {
            self.indicate(-self.ways.kerb, next);
        }
    }

    fn indicate(&self, side: i8, next: &mut Vehicle) {
        next.flags &= !(Vehicle::TURNS_LEFT | Vehicle::TURNS_RIGHT);
        next.flags |= if side > 0 { Vehicle::TURNS_LEFT } else { Vehicle::TURNS_RIGHT };
    }

    /// Whether a bus draws up at the stop so far before its front.
    fn comes_to(&self, stop_m: f32, next: &Vehicle) -> bool {
        let braking_m = next.speed_mps * next.speed_mps / (2.0 * CALL_MPS2);
        let may = next.manoeuvre == Manoeuvre::Keep && next.flags & Vehicle::CROSSING == 0;
        may && stop_m > LEFT_M && stop_m < braking_m + SIGNAL_M && braking_needed(next.speed_mps, stop_m) < LATE_MPS2
    }

    /// From the front of a vehicle to the next stop on its way before any junction, metres.
    fn stop_ahead_m(&self, index: usize, plan: &Plan) -> Option<f32> {
        let front_m = self.drivers[index].size_m.x * 0.5;
        let outside = |step: &&super::step::Step| self.ways.lanes[step.lane as usize].zone.is_none();
        self.steps_of(plan).iter().take_while(outside).find_map(|step| {
            let stops = &self.map.bus_stops;
            let first = stops.partition_point(|stop| stop.lane < step.lane);
            let here = stops[first..].iter().take_while(|stop| stop.lane == step.lane);
            here.map(|stop| step.start_m + stop.s_m - front_m).find(|ahead_m| *ahead_m > -BEYOND_M)
        })
    }
}

impl Vehicle {
    /// Time until the doors of a bus at its stop shut, tenths of a second; None where they are shut.
    pub(super) fn doors_open_ds(&self) -> Option<u8> {
        (self.lapse == Lapse::Boards && self.lapse_left > SIGNAL_DS).then(|| self.lapse_left - SIGNAL_DS)
    }

    /// Stands at a bus stop and is about to leave it.
    pub(super) fn wants_out(&self) -> bool {
        self.lapse == Lapse::Boards && self.lapse_left <= SIGNAL_DS
    }
}

const _: () = assert!(seconds(1) == 10 * DS_TICKS);
