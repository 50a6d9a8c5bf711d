//! What a seat is to be driven with, how its unit is, and what happens to it.

use std::fmt;

use kernel::Seat;

/// What a seat is to be driven with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SeatChoice {
    /// Half of the keyboard: the letters for the semantic driver, the arrows for the safety driver.
    Keyboard,
    /// Nothing: a bot drives. The unit counts as armed and gives neutral controls.
    Bot,
}

/// How a unit is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnitState {
    /// Its controls are its driver's.
    Armed,
}

/// How a seat's unit is, for people to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitStatus {
    /// Name of the device.
    pub unit: String,
    /// How it is.
    pub state: UnitState,
}

impl fmt::Display for UnitStatus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.unit)?;
        match &self.state {
            UnitState::Armed => f.write_str("armed"),
        }
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
    /// The device that was gone is back, and has to be armed again.
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
