//! What a vehicle does across its lane.

use crate::state_enum;

state_enum! {
    /// A manoeuvre across the lanes.
    pub enum Manoeuvre {
        /// Keeps its place in its lane.
        Keep = 0,
        /// Signals to the left and looks for a gap there.
        SignalLeft = 1,
        /// Signals to the right and looks for a gap there.
        SignalRight = 2,
        /// Is moving over to its lane from the one to the right of it.
        MoveLeft = 3,
        /// Is moving over to its lane from the one to the left of it.
        MoveRight = 4,
        /// Passes somebody on the left, over the border of its lane if need be.
        PassLeft = 5,
        /// Passes somebody on the right.
        PassRight = 6,
    }
}

impl Manoeuvre {
    /// 1 to the left, -1 to the right, 0 for none.
    pub fn side(self) -> i8 {
        match self {
            Self::Keep => 0,
            Self::SignalLeft | Self::MoveLeft | Self::PassLeft => 1,
            Self::SignalRight | Self::MoveRight | Self::PassRight => -1,
        }
    }

    /// Signals, but has not begun to move.
    pub fn signals(self) -> bool {
        matches!(self, Self::SignalLeft | Self::SignalRight)
    }

    /// Moves over to another lane.
    pub fn moves(self) -> bool {
        matches!(self, Self::MoveLeft | Self::MoveRight)
    }

    /// Passes somebody.
    pub fn passes(self) -> bool {
        matches!(self, Self::PassLeft | Self::PassRight)
    }

    /// Between two lanes, or over the border of its own.
    pub fn is_between_lanes(self) -> bool {
        self.moves() || self.passes()
    }

    pub(super) fn signal_to(side: i8) -> Self {
        if side > 0 { Self::SignalLeft } else { Self::SignalRight }
    }

    pub(super) fn move_to(side: i8) -> Self {
        if side > 0 { Self::MoveLeft } else { Self::MoveRight }
    }

    pub(super) fn pass_on(side: i8) -> Self {
        if side > 0 { Self::PassLeft } else { Self::PassRight }
    }
}
