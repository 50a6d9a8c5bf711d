//! Where the elements of a gamepad are that a driver uses, whoever made it.

/// What a finger pulls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// An axis with this code, at its least value when it is let go of.
    Axis(u16),
    /// A button with this code: all or nothing.
    Button(u16),
}

/// The codes behind the elements of a gamepad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Axis of the left stick, to the right.
    pub left_stick_x: u16,
    /// The right trigger.
    pub right_trigger: Trigger,
    /// The left trigger.
    pub left_trigger: Trigger,
    /// The lower of the four buttons on the right (A, or a cross).
    pub south: Option<u16>,
    /// The right one (B, or a circle).
    pub east: Option<u16>,
    /// The left one (X, or a square).
    pub west: Option<u16>,
    /// The upper one (Y, or a triangle).
    pub north: Option<u16>,
    /// Above the triggers, left and right, where these are no pedals.
    pub shoulders: [Option<u16>; 2],
    /// The small ones in the middle: select (back) and start.
    pub middle: [Option<u16>; 2],
}
