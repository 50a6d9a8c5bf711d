//! What a driver did about a hazard, and when.
//!
//! Response times are told apart by their begin and end (SAE J2944, 2015). Here one ends with the first change beyond all
//! positions of the second before the onset, by a threshold, and towards avoiding: to brake, to release the
//! accelerator, or to steer otherwise than the route asks. To which side is left open, as behind somebody who crosses is
//! avoiding as well.

use std::ops::RangeInclusive;

use kernel::time::{TICK_HZ, Tick};
use kernel::{Controls, Seat};
use replay::Log;
use serde::Serialize;

use super::following::Following;
use super::log::{controls, is_pressed, ms};
use super::steering;

/// What a driver does in this time before an onset is his driving without the hazard.
const BEFORE_TICKS: Tick = TICK_HZ as Tick;
/// So is what he does in the first 0.1 s after it: nobody answers sooner (Luce 1986).
const SOONEST_TICKS: Tick = TICK_HZ as Tick / 10;
/// Who follows the route may do so this late: a look, a mask that is old, and the turning of the wheel.
const LATE_TICKS: usize = TICK_HZ as usize / 2;
/// A brake that is pressed further by more than this is a reaction, fraction of its travel.
const BRAKE: f32 = 0.05;
/// So is an accelerator that is released by more than this, fraction of its travel.
const RELEASE: f32 = 0.10;
/// And a wheel that has turned by more than this, degrees of the steering wheel.
const TURN_DEG: f32 = 15.0;

/// What a driver did about a hazard; times from its onset, milliseconds.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Response {
    /// To the first change of brake, accelerator or steering towards avoiding it.
    pub reaction_ms: Option<u64>,
    /// What changed: `brake`, `accelerator` or `steering`.
    pub by: Option<&'static str>,
    /// To the press of "I see it".
    pub seen_ms: Option<u64>,
}

impl Response {
    /// That of a driver from an onset to a tick. `following` is what the route asks for at each tick after the log's
    /// first: of the semantic driver, as the safety driver's wheel does not steer until the takeover.
    pub fn of(log: &Log, seat: Seat, (onset, until): (Tick, Tick), following: &[Following]) -> Self {
        let driving = Driving::over(log, seat, onset.saturating_sub(BEFORE_TICKS)..=onset + SOONEST_TICKS);
        let asked = |tick: Tick| match seat {
            Seat::Semantic => asked_up_to(following, (tick - log.first_tick()) as usize),
            Seat::Safety => Following::default(),
        };
        let changed = |tick| Some((tick, driving.change(controls(log.input(tick)?, seat), asked(tick))?));
        let reaction = (onset + 1..=until).find_map(changed);
        let seen = (onset + 1..=until).find(|tick| is_pressed(log, seat, *tick));
        Self {
            reaction_ms: reaction.map(|(tick, _)| ms(tick - onset)),
            by: reaction.map(|(_, by)| by),
            seen_ms: seen.map(|tick| ms(tick - onset)),
        }
    }
}

/// What the route asks for with one of the ticks, counted from the log's first, or asked for just before it.
fn asked_up_to(following: &[Following], tick: usize) -> Following {
    let known = &following[..tick.min(following.len())];
    let late = &known[known.len().saturating_sub(LATE_TICKS)..];
    late.iter().copied().reduce(Following::or).unwrap_or_default()
}

/// The furthest positions of a driver's controls over some time.
struct Driving {
    hand_brake: bool,
    brake: f32,
    throttle: f32,
    wheel_deg: RangeInclusive<f32>,
}

impl Driving {
    /// Over those of these ticks that the log holds; at rest if it holds none.
    fn over(log: &Log, seat: Seat, ticks: RangeInclusive<Tick>) -> Self {
        let held = ticks.filter_map(|tick| Some(*controls(log.input(tick)?, seat)));
        held.map(|held| Self::at(&held)).reduce(Self::and).unwrap_or_else(|| Self::at(&Controls::default()))
    }

    fn at(held: &Controls) -> Self {
        let deg = steering::wheel_deg(held);
        Self {
            hand_brake: held.has(Controls::HAND_BRAKE),
            brake: held.brake_fraction(),
            throttle: held.throttle_fraction(),
            wheel_deg: deg..=deg,
        }
    }

    fn and(self, other: Self) -> Self {
        let (a, b) = (self.wheel_deg, other.wheel_deg);
        Self {
            hand_brake: self.hand_brake || other.hand_brake,
            brake: self.brake.max(other.brake),
            throttle: self.throttle.min(other.throttle),
            wheel_deg: a.start().min(*b.start())..=a.end().max(*b.end()),
        }
    }

    /// What is beyond them by more than its threshold, and avoids.
    fn change(&self, now: &Controls, asked: Following) -> Option<&'static str> {
        let pulled = now.has(Controls::HAND_BRAKE) && !self.hand_brake;
        if pulled || now.brake_fraction() - self.brake > BRAKE {
            return Some("brake");
        }
        if self.throttle - now.throttle_fraction() > RELEASE {
            return Some("accelerator");
        }
        let deg = steering::wheel_deg(now);
        let least_deg = self.wheel_deg.start().min(asked.least_deg) - TURN_DEG;
        let most_deg = self.wheel_deg.end().max(asked.most_deg) + TURN_DEG;
        (!(least_deg..=most_deg).contains(&deg)).then_some("steering")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held(steer: f32, throttle: f32, brake: f32) -> Controls {
        Controls::from_fractions(steer, throttle, brake)
    }

    #[test]
    fn each_control_has_its_threshold() {
        let change = |before: &Controls, now: &Controls| Driving::at(before).change(now, Following::default());
        let cruising = held(0.1, 0.5, 0.1);
        assert_eq!(change(&cruising, &held(0.13, 0.41, 0.14)), None);
        assert_eq!(change(&cruising, &held(0.1, 0.5, 0.16)), Some("brake"));
        assert_eq!(change(&cruising, &held(0.1, 0.39, 0.1)), Some("accelerator"));
        assert_eq!(change(&cruising, &held(0.14, 0.5, 0.1)), Some("steering"));
        assert_eq!(change(&cruising, &held(-0.02, 0.5, 0.1)), None, "the route is straight ahead");
        assert_eq!(change(&cruising, &held(-0.04, 0.5, 0.1)), Some("steering"));
        assert_eq!(change(&cruising, &held(0.1, 0.9, 0.0)), None, "going on faster is no reaction");
        let pulled = Controls { flags: Controls::HAND_BRAKE, ..cruising };
        assert_eq!((change(&cruising, &pulled), change(&pulled, &pulled)), (Some("brake"), None));
    }

    #[test]
    fn what_the_route_asks_for_and_what_was_done_before_is_no_change() {
        let cruising = Driving::at(&held(0.0, 0.5, 0.0));
        let curve = Following { least_deg: -120.0, most_deg: 0.0 };
        assert_eq!(cruising.change(&held(-0.29, 0.5, 0.0), curve), None);
        assert_eq!(cruising.change(&held(-0.31, 0.5, 0.0), curve), Some("steering"), "further than the curve");
        assert_eq!(cruising.change(&held(0.04, 0.5, 0.0), curve), Some("steering"), "out of the curve");
        let swinging = cruising.and(Driving::at(&held(0.05, 0.3, 0.2)));
        assert_eq!(swinging.change(&held(0.08, 0.21, 0.24), Following::default()), None);
        assert_eq!(swinging.change(&held(0.09, 0.5, 0.0), Following::default()), Some("steering"));
    }
}
