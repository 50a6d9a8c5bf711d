//! What happened to the rig during a run, beside the world.

use kernel::Seat;
use kernel::time::Tick;

/// Something that happened to the rig. The replayer never reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Note {
    /// The tick whose input was the first that it could change.
    pub tick: Tick,
    /// What happened.
    pub kind: NoteKind,
    /// Whose seat it happened to; none where it happened to all of the rig.
    pub seat: Option<Seat>,
}

/// What can happen to the rig; the discriminant is its code in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum NoteKind {
    /// A device was bound to the seat.
    UnitBound = 0,
    /// The seat's unit was armed.
    UnitArmed = 1,
    /// The seat's device was lost.
    UnitLost = 2,
    /// A device came back to the seat that had lost one.
    UnitReturned = 3,
    /// Time stood from here on: for the operators, or because a seat was without its unit.
    Paused = 4,
    /// Time went on.
    Resumed = 5,
}

impl NoteKind {
    /// Every kind, by code.
    pub const ALL: [Self; 6] =
        [Self::UnitBound, Self::UnitArmed, Self::UnitLost, Self::UnitReturned, Self::Paused, Self::Resumed];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::UnitBound => "unit bound",
            Self::UnitArmed => "unit armed",
            Self::UnitLost => "unit lost",
            Self::UnitReturned => "unit returned",
            Self::Paused => "paused",
            Self::Resumed => "resumed",
        }
    }
}
