//! What a driver did about a hazard, and when.

use kernel::time::Tick;
use kernel::{Controls, Seat};
use replay::Log;
use serde::Serialize;

use super::log::{controls, is_pressed, ms};
use super::steering;

/// A brake that is pressed further by more than this is a reaction, fraction of its travel.
const BRAKE: f32 = 0.05;
/// So is an accelerator that is released by more than this, fraction of its travel.
const RELEASE: f32 = 0.10;
/// And a wheel that has turned by more than this, degrees of the steering wheel.
const TURN_DEG: f32 = 15.0;

/// What a driver did about a hazard; times from its onset, milliseconds.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Response {
    /// To the first change of brake, accelerator or steering.
    pub reaction_ms: Option<u64>,
    /// What changed: `brake`, `accelerator` or `steering`.
    pub by: Option<&'static str>,
    /// To the press of "I see it".
    pub seen_ms: Option<u64>,
}

impl Response {
    /// That of a driver after an onset, up to a tick.
    pub fn of(log: &Log, seat: Seat, onset: Tick, until: Tick) -> Self {
        let at_onset = log.input(onset).map(|input| *controls(input, seat)).unwrap_or_default();
        let changed = |tick| Some((tick, change(&at_onset, controls(log.input(tick)?, seat))?));
        let reaction = (onset + 1..=until).find_map(changed);
        let seen = (onset + 1..=until).find(|tick| is_pressed(log, seat, *tick));
        Self {
            reaction_ms: reaction.map(|(tick, _)| ms(tick - onset)),
            by: reaction.map(|(_, by)| by),
            seen_ms: seen.map(|tick| ms(tick - onset)),
        }
    }
}

/// What has changed since the onset by more than its threshold.
fn change(before: &Controls, now: &Controls) -> Option<&'static str> {
    let pulled = now.has(Controls::HAND_BRAKE) && !before.has(Controls::HAND_BRAKE);
    if pulled || now.brake_fraction() - before.brake_fraction() > BRAKE {
        return Some("brake");
    }
    if before.throttle_fraction() - now.throttle_fraction() > RELEASE {
        return Some("accelerator");
    }
    let turned_deg = steering::wheel_deg(now) - steering::wheel_deg(before);
    (turned_deg.abs() > TURN_DEG).then_some("steering")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held(steer: f32, throttle: f32, brake: f32) -> Controls {
        Controls::from_fractions(steer, throttle, brake)
    }

    #[test]
    fn each_control_has_its_threshold() {
        let cruising = held(0.1, 0.5, 0.1);
        assert_eq!(change(&cruising, &held(0.13, 0.41, 0.14)), None);
        assert_eq!(change(&cruising, &held(0.1, 0.5, 0.16)), Some("brake"));
        assert_eq!(change(&cruising, &held(0.1, 0.39, 0.1)), Some("accelerator"));
        assert_eq!(change(&cruising, &held(0.06, 0.5, 0.1)), Some("steering"));
        assert_eq!(change(&cruising, &held(0.1, 0.9, 0.0)), None, "going on faster is no reaction");
        let pulled = Controls { flags: Controls::HAND_BRAKE, ..cruising };
        assert_eq!((change(&cruising, &pulled), change(&pulled, &pulled)), (Some("brake"), None));
    }
}
