//! What the threads of a live drive show each other. Nobody waits for a reader.

use std::sync::Arc;

use base::newest::Newest;
use kernel::arbiter::Phase;
use kernel::events::Hud;
use kernel::scenario::Rules;
use kernel::time::Tick;
use kernel::{Seat, TickInput};
use study::protocol::Progress;
use viewers::events::Events;
use viewers::feed::{Feed, View};
use viewers::figures::TickFigures;

use super::alert::Alert;
use super::stage::{Press, Stage};
use super::strip::Strip;
use super::traces::Traces;
use crate::units::Key;

/// The newest of everything that is looked at.
#[derive(Debug, Default)]
pub struct Board {
    /// What there is to see, also for onlookers.
    pub feed: Arc<Feed>,
    /// How the session is.
    pub status: Newest<Status>,
    /// The corner case that was cut last.
    pub strip: Newest<Strip>,
    /// What is plotted of the run.
    pub traces: Newest<Traces>,
}

/// What the simulation hears from the windows and the other threads.
#[derive(Debug)]
pub enum Message {
    /// A key of one of the seats went down or up.
    SeatKey(Key, bool),
    /// A window lost the keyboard, and with it the keys that are held.
    KeysReleased,
    /// Whether one of the windows has the keyboard.
    Focus(bool),
    /// A key of the operators went down; `true` when it is held and repeats.
    Press(Press, bool),
    /// A view came onto a driver's screen, microseconds since the session began.
    Shown(Seat, Arc<View>, u64),
    /// A corner case was cut, or a run came to its figures.
    Note(String),
    /// Somebody wants to close a window.
    Closed,
    /// The windows are gone.
    Gone,
    /// A thread cannot go on.
    Failed(anyhow::Error),
}

/// What is to be drawn anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wake {
    /// The semantic driver's window.
    Semantic,
    /// The safety driver's window.
    Safety,
    /// The control centre.
    Centre,
    /// Every window.
    All,
    /// Nothing: the session is over.
    Over,
}

/// How a session is.
#[derive(Clone, Debug)]
pub struct Status {
    /// Where it stands.
    pub stage: Stage,
    /// Number of the run, from 1.
    pub run: u32,
    /// The world's tick.
    pub tick: Tick,
    /// What both drivers see besides the picture.
    pub hud: Hud,
    /// Where the arbitration stands.
    pub phase: Phase,
    /// Who steers.
    pub steering: Seat,
    /// Who has the pedals.
    pub pedals: Seat,
    /// Flags of the controls that reach the car.
    pub flags: u8,
    /// Both drivers' controls.
    pub input: TickInput,
    /// Distance driven in this run, millimetres.
    pub odometer_mm: u64,
    /// What the finished runs came to.
    pub totals: Totals,
    /// The same by person and seat, a line each; none without a plan.
    pub tally: Arc<[String]>,
    /// Seconds that are left of a break.
    pub rest_s: Option<u32>,
    /// Where people are to answer questions about the run before.
    pub link: Option<String>,
    /// What the car did wrong, or what happened to it, a moment ago.
    pub alert: Option<Alert>,
    /// How late the last tick began, microseconds.
    pub late_us: u64,
    /// By how much the run has fallen behind real time, microseconds.
    pub slowed_us: u64,
    /// Age of the mask on the semantic driver's screen, microseconds.
    pub mask_age_us: Option<u64>,
    /// Age of the image on the safety driver's screen, microseconds.
    pub image_age_us: Option<u64>,
    /// The latest events, newest last.
    pub events: Events,
    /// How the units of both seats are, semantic driver's first.
    pub units: [String; 2],
    /// What the drivers have to do about their units; none while both are armed.
    pub units_note: Option<String>,
    /// What was found to drive with, what each seat uses, and how to change that, a line each.
    pub setup: Arc<[String]>,
    /// How force feedback is.
    pub force: String,
    /// Where what is heard is played.
    pub sound: String,
    /// What the run is about.
    pub about: Arc<About>,
}

impl Status {
    /// What onlookers are told.
    pub fn figures(&self) -> TickFigures {
        TickFigures {
            run: self.run,
            tick: self.tick,
            phase: self.phase,
            steering: self.steering,
            pedals: self.pedals,
            input: Some(self.input),
            speed_mps: self.hud.speed_mps,
            limit_mps: self.hud.limit_mps,
            odometer_mm: self.odometer_mm,
            mask_age_us: self.mask_age_us,
            late_us: self.late_us,
            slowed_us: self.slowed_us,
            events: self.events.clone(),
        }
    }
}

/// What the finished runs came to, with those recorded under the same name before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Runs.
    pub runs: u32,
    /// Distance, millimetres.
    pub odometer_mm: u64,
    /// Simulated time, ticks.
    pub ticks: Tick,
    /// Corner cases.
    pub cases: u32,
}

impl Totals {
    /// Of all runs that count.
    pub fn of(progress: &Progress) -> Self {
        progress.runs().filter(|ended| ended.counts).fold(Self::default(), |sum, ended| Self {
            runs: sum.runs + 1,
            odometer_mm: sum.odometer_mm + ended.odometer_mm,
            ticks: sum.ticks + ended.ticks,
            cases: sum.cases + u32::from(ended.is_case),
        })
    }
}

/// What does not change in a run.
#[derive(Clone, Debug)]
pub struct About {
    /// Name of the checkpoint; in a blind session, that it is one.
    pub checkpoint: String,
    /// Name of the map.
    pub map: String,
    /// What counts as an intervention, among others.
    pub rules: Rules,
    /// Pseudonyms of the operators, first of whoever began as the semantic driver.
    pub operators: [Option<String>; 2],
    /// Whether the drives are to get used to the rig and do not count.
    pub is_familiarisation: bool,
    /// Which trial of a plan it is; none without a plan.
    pub trial: Option<String>,
}
