//! What a driver does wrong at the moment.

use crate::state_enum;

state_enum! {
    /// A mistake that goes on.
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
    }
}
