//! What a driver does wrong at the moment, and what takes him to the kerb and back.

use crate::state_enum;

state_enum! {
    /// A mistake that goes on, or a halt at the kerb.
    pub enum Lapse {
        /// None.
        None = 0,
        /// Drives through a light that has turned red.
        RunsRed = 1,
        /// Rolls over the line of a stop sign.
        Rolls = 2,
        /// Brakes hard for no reason.
        BrakesHard = 3,
        /// Changes lanes right before somebody.
        CutsIn = 4,
        /// Halts at the kerb, which is none yet.
        Parks = 5,
        /// Has halted there.
        Halts = 6,
        /// Drives off from the kerb without a look.
        PullsOut = 7,
        /// Has run into another vehicle.
        Crashed = 8,
        /// A bus draws up at the stop before it.
        Calls = 9,
        /// A bus stands at a stop.
        Boards = 10,
        /// A bus drives off from a stop.
        Departs = 11,
    }
}

impl Lapse {
    /// Is a mistake, or comes of one: buses at their stops make none.
    pub fn endangers(self) -> bool {
        !matches!(self, Self::None | Self::Crashed | Self::Calls | Self::Boards | Self::Departs)
    }

    /// Draws up at the kerb.
    pub fn is_to_kerb(self) -> bool {
        matches!(self, Self::Parks | Self::Calls)
    }
}
