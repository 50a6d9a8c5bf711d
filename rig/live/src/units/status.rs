//! How a seat's unit is, and what happens to it.

use std::fmt;

use kernel::Seat;
use kernel::time::Tick;
use replay::{Note, NoteKind};

/// How a unit is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnitState {
    /// No device has been there yet.
    Waiting {
        /// What would end that.
        waits_for: String,
    },
    /// The device is there and has not been moved enough.
    Arming {
        /// What the driver has still to do.
        to_do: Vec<&'static str>,
    },
    /// Its controls are its driver's.
    Armed,
    /// The device is gone.
    Lost,
    /// No window of the rig has the keyboard.
    Unfocused,
}

/// How a seat's unit is, for people to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitStatus {
    /// Name of the device.
    pub unit: String,
    /// Where it is: the device's path, or the keys of its half of the keyboard; empty for a bot.
    pub place: String,
    /// How it is.
    pub state: UnitState,
}

impl UnitStatus {
    /// What its driver has to do or to wait for, if it is not armed.
    pub fn trouble(&self) -> Option<String> {
        match &self.state {
            UnitState::Armed => None,
            UnitState::Waiting { waits_for } => Some(format!("waiting for {waits_for}")),
            UnitState::Arming { to_do } => Some(format!("to arm it, {}", to_do.join(", "))),
            UnitState::Lost => Some("lost, plug it in again".into()),
            UnitState::Unfocused => Some("lost, click a window of the rig".into()),
        }
    }
}

impl fmt::Display for UnitStatus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.unit, self.trouble().as_deref().unwrap_or("armed"))
    }
}

/// What can happen to a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitEventKind {
    /// A device was bound to the seat.
    Bound,
    /// Wheel and pedals have moved: the driver has control.
    Armed,
    /// The device is gone.
    Lost,
    /// The device that was gone is back or replaced, and has to be armed again.
    Returned,
}

/// Something that happened to a seat's unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitEvent {
    /// Whose unit.
    pub seat: Seat,
    /// What happened.
    pub kind: UnitEventKind,
    /// Name of the device.
    pub unit: String,
}

impl UnitEvent {
    /// The event as it is recorded. `tick` is the tick that gets the controls which were polled with it.
    pub fn note(&self, tick: Tick) -> Note {
        let kind = match self.kind {
            UnitEventKind::Bound => NoteKind::UnitBound,
            UnitEventKind::Armed => NoteKind::UnitArmed,
            UnitEventKind::Lost => NoteKind::UnitLost,
            UnitEventKind::Returned => NoteKind::UnitReturned,
        };
        Note { tick, kind, seat: Some(self.seat) }
    }
}
