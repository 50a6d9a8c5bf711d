//! How the rig keeps up with the clock on the wall, as a message of our own. Files have no such figures: in them
//! time is simulated.

use foxglove::Encode;

use crate::figures::TickFigures;

/// Which run it is, and how late.
#[derive(Clone, Debug, PartialEq, Encode)]
pub struct Rig {
    /// Number of the run, from 1.
    pub run: u32,
    /// Number of the tick.
    pub tick: u64,
    /// How late the tick began, milliseconds.
    pub late_ms: f64,
    /// By how much the run has fallen behind real time, milliseconds.
    pub slowed_ms: f64,
}

impl Rig {
    /// What a drive tells as it goes.
    pub fn of(figures: &TickFigures) -> Self {
        let milliseconds = |us: u64| us as f64 / 1e3;
        Self {
            run: figures.run,
            tick: figures.tick,
            late_ms: milliseconds(figures.late_us),
            slowed_ms: milliseconds(figures.slowed_us),
        }
    }
}
