//! Human-machine measures: functions of a log and its map alone, so that they mean the same for people
//! and bots, live and headless.
//!
//! A *hazard* begins at the first tick at which, by the truth, the ego car is predicted to touch an
//! actor or parked car within 2 s (predicted encroachment, Westhofen et al. 2022): it keeps to its
//! route at its present speed, or goes on braking; vehicles keep to their lanes, people to their
//! direction. Times are counted from there.

mod following;
mod log;
mod mistakes;
mod reactions;
mod screen;
mod steering;
mod tally;
mod text;
mod truth;

use std::sync::Arc;

use kernel::time::{TICK_HZ, Tick};
use kernel::{RoadNetwork, Seat};
use replay::{Error, Log};
use serde::Serialize;

use log::{end_of_driving, is_pressed, ms};

pub use crate::stats::Spread;
use base::words;

pub use following::Following;
pub use mistakes::Mistake;
pub use reactions::Response;
pub use screen::ScreenAge;
pub use tally::Tally;
pub use text::lines;
pub use truth::{Episode, Truth};

/// A hazard counts as answered within this time, unless it lasts longer or another one begins.
const ANSWER_TICKS: Tick = 3 * TICK_HZ as Tick;

/// What a recording says about how its drivers and the rig worked together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Measures {
    /// Hazards up to the intervention or the end, and what came of them.
    pub hazards: Vec<HazardTimes>,
    /// Kilometres over which they were counted: of a case only what it holds of its recording.
    pub km: f64,
    /// Every press of "I see it".
    pub seen: Vec<Press>,
    /// Age of the mask on the screen while the car moves; `None` where there was none.
    pub mask_age: Option<ScreenAge>,
    /// Steering-wheel reversals a minute of each driver, up to the intervention or the end.
    pub steering_reversals_per_min: Seats<f64>,
    /// Time over which they were counted, seconds: of a case only what it holds of its recording.
    pub steering_s: f64,
}

/// A hazard and the times from its onset, milliseconds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HazardTimes {
    /// When and what.
    #[serde(flatten)]
    pub episode: Episode,
    /// What the semantic driver did.
    pub semantic: Response,
    /// What the safety driver did.
    pub safety: Response,
    /// To the intervention, if this hazard led to it.
    pub intervention_ms: Option<u64>,
}

/// A press of "I see it".
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Press {
    /// The tick whose input was the first with the button down.
    pub tick: Tick,
    /// `semantic` or `safety`.
    pub seat: &'static str,
}

/// The same for both seats.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Seats<T> {
    /// The semantic driver's.
    pub semantic: T,
    /// The safety driver's.
    pub safety: T,
}

impl Measures {
    /// Those of a log, by simulating it again. Fails where a tick differs from the log, or where the
    /// log was made by another kernel.
    pub fn of(log: &Log, network: &Arc<RoadNetwork>) -> Result<Self, Error> {
        Ok(Self::with_truth(log, truth::find(log, network)?))
    }

    /// Those of a log whose truth is known.
    pub fn with_truth(log: &Log, Truth { episodes, km, moving, following }: Truth) -> Self {
        let rate = |seat| steering::reversals_per_min(log, seat);
        let mut onsets = episodes.iter().skip(1).map(|e| e.onset).collect::<Vec<_>>().into_iter();
        let times = |episode: Episode| {
            let next = onsets.next().map_or(Tick::MAX, |onset| onset - 1);
            let until = episode.end.max(episode.onset + ANSWER_TICKS).min(next).min(end_of_driving(log));
            HazardTimes::of(log, episode, until, &following)
        };
        Self {
            hazards: episodes.into_iter().map(times).collect(),
            km,
            seen: presses(log),
            mask_age: screen::age(log, &moving),
            steering_reversals_per_min: Seats { semantic: rate(Seat::Semantic), safety: rate(Seat::Safety) },
            steering_s: steering::driven_ticks(log) as f64 / f64::from(TICK_HZ),
        }
    }

    /// The hazard that led to the intervention.
    pub fn decisive(&self) -> Option<&HazardTimes> {
        self.hazards.iter().find(|hazard| hazard.intervention_ms.is_some())
    }
}

impl HazardTimes {
    /// What came of a hazard up to a tick.
    fn of(log: &Log, episode: Episode, until: Tick, following: &[Following]) -> Self {
        let onset = episode.onset;
        let response = |seat| Response::of(log, seat, (onset, until), following);
        let intervention = log.intervention.map(|i| i.tick).filter(|tick| (onset..=until).contains(tick));
        Self {
            semantic: response(Seat::Semantic),
            safety: response(Seat::Safety),
            intervention_ms: intervention.map(|tick| ms(tick - onset)),
            episode,
        }
    }
}

/// Presses of "I see it" up to the end of driving.
fn presses(log: &Log) -> Vec<Press> {
    let ticks = log.first_tick() + 1..=end_of_driving(log);
    let pressed = |tick| {
        let seats = [Seat::Semantic, Seat::Safety].into_iter();
        seats.filter(move |seat| is_pressed(log, *seat, tick)).map(move |seat| Press { tick, seat: words::seat(seat) })
    };
    ticks.flat_map(pressed).collect()
}

#[cfg(test)]
mod tests;
