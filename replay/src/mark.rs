//! What a recording says of the state at the end of each block.

use kernel::StateHash;
use kernel::time::Tick;
use kernel::world::PARTS;

/// The state of things after the last tick of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mark {
    /// The tick.
    pub tick: Tick,
    /// Full hash of that tick.
    pub hash: StateHash,
    /// A hash for each of [`PARTS`].
    pub parts: [u64; PARTS.len()],
    /// Distance driven so far, millimetres.
    pub odometer_mm: u64,
}
