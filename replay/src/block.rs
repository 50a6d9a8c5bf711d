//! One block of the log: the ticks up to a mark, and what happened in them.

use kernel::arbiter::Intervention;
use kernel::events::Event;
use kernel::time::{TICK_HZ, Tick};
use kernel::world::PARTS;
use kernel::{Keyframe, StateHash, TickInput, TickOutput};

use crate::Mark;

/// A block ends at the latest at every multiple of this.
pub(crate) const BLOCK_TICKS: Tick = TICK_HZ as Tick;

/// What happened in a block.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Happenings {
    pub events: Vec<(Tick, Event)>,
    pub intervention: Option<Intervention>,
}

/// The ticks up to a mark.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Block {
    pub first: Tick,
    pub inputs: Vec<TickInput>,
    pub hashes: Vec<u32>,
    /// At the last tick.
    pub mark: Mark,
    pub keyframes: Vec<Keyframe>,
    pub happenings: Happenings,
}

impl Block {
    /// An empty block whose first tick will be `first`, at least 1.
    pub fn starting_at(first: Tick) -> Self {
        let mark = Mark { tick: first - 1, hash: StateHash(0), parts: [0; PARTS.len()], odometer_mm: 0 };
        Self {
            first,
            inputs: Vec::new(),
            hashes: Vec::new(),
            mark,
            keyframes: Vec::new(),
            happenings: Happenings::default(),
        }
    }

    /// Appends a tick.
    pub fn push(&mut self, input: &TickInput, output: &TickOutput, parts: &[u64; PARTS.len()]) {
        self.inputs.push(*input);
        self.hashes.push(output.hash.0 as u32);
        self.mark = Mark { tick: output.tick, hash: output.hash, parts: *parts, odometer_mm: output.odometer_mm };
        self.keyframes.extend(output.keyframe.clone());
        self.happenings.events.extend(output.events.iter().map(|e| (output.tick, *e)));
        self.happenings.intervention = self.happenings.intervention.or(output.intervention);
    }
}
