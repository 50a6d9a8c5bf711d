//! How far a story has come: a part of the world's state.

use crate::signals::HeldLight;
use crate::time::Tick;
use crate::{state, state_enum};

use super::actor::StoryActor;
use super::spot::Spot;

state_enum! {
    /// How far an element has come.
    pub enum Progress {
        /// It waits.
        Standby = 0,
        /// It goes on.
        Running = 1,
        /// It is over.
        Complete = 2,
    }
}

state_enum! {
    /// How it came there.
    pub enum Change {
        /// Not yet at all.
        None = 0,
        /// It began.
        Started = 1,
        /// It came to its end.
        Ended = 2,
        /// Others ended it.
        Stopped = 3,
        /// It was skipped.
        Skipped = 4,
    }
}

state! {
    /// Where an act, a group or an event stands.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Mark {
        /// How far it has come.
        pub progress: Progress,
        /// Its last change.
        pub change: Change,
        /// When that was.
        pub at: Tick,
        /// When it began last, 0 if it did not: it may be over in the same tick.
        pub began: Tick,
        /// How many times it was over.
        pub times: u16,
    }
}

state! {
    /// Where what one role does in an event stands.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Deed {
        /// How far it has come.
        pub mark: Mark,
        /// What it changes was so at its beginning: m/s, or metres to the left.
        pub from: f32,
        /// And shall be so.
        pub to: f32,
        /// How long it takes: seconds or metres.
        pub takes: f32,
        /// How far the role has come since its beginning, metres.
        pub gone_m: f32,
        /// The corners of a line that is told by where others were at its beginning.
        pub line: Vec<Spot>,
    }
}

state! {
    /// What a condition was in the tick before, and since when it counts.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    pub struct Met {
        /// Whether it held; nothing before it was looked at.
        pub held: Option<bool>,
        /// When it was met, for those that count later.
        pub since: Option<Tick>,
    }
}

state! {
    /// Where a programme of lights is.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Cycle {
        /// The number of its phase.
        pub phase: u16,
        /// When that ends.
        pub until: Tick,
    }
}

state! {
    /// How far a story has come.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct StoryState {
        /// Who plays, in the order of the cast; the ego car is a mirror of the real one.
        pub actors: Vec<StoryActor>,
        /// Its acts.
        pub acts: Vec<Mark>,
        /// The groups of all acts.
        pub groups: Vec<Mark>,
        /// The events of all groups.
        pub events: Vec<Mark>,
        /// What each role does in all events.
        pub deeds: Vec<Deed>,
        /// All conditions.
        pub conditions: Vec<Met>,
        /// Lights that it holds, by ascending group.
        pub lights: Vec<HeldLight>,
        /// Where its programmes of lights are.
        pub cycles: Vec<Cycle>,
        /// It drives the ego car.
        pub carries_ego: bool,
        /// The trigger that ends it was met.
        pub over: bool,
    }
}

impl Mark {
    /// Nothing happened yet.
    pub const NEW: Self = Self { progress: Progress::Standby, change: Change::None, at: 0, began: 0, times: 0 };

    /// Goes on.
    pub fn runs(&self) -> bool {
        self.progress == Progress::Running
    }

    /// Is over.
    pub fn is_complete(&self) -> bool {
        self.progress == Progress::Complete
    }

    /// Changes at a tick.
    pub fn turn(&mut self, progress: Progress, change: Change, at: Tick) {
        (self.progress, self.change, self.at) = (progress, change, at);
        if change == Change::Started {
            self.began = at;
        }
        if matches!(change, Change::Ended | Change::Stopped | Change::Skipped) {
            self.times = self.times.saturating_add(1);
        }
    }
}

impl Deed {
    /// Nothing was done yet.
    pub const NEW: Self = Self { mark: Mark::NEW, from: 0.0, to: 0.0, takes: 0.0, gone_m: 0.0, line: Vec::new() };
}
