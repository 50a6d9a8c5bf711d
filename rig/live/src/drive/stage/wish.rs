//! What the operators' keys ask for.

use replay::{Annotation, Label};

/// Why time stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pause {
    /// The operators asked for it.
    Asked,
    /// A seat is without its unit, or no window of the rig has the keyboard.
    UnitLost,
    /// Somebody asked for the end of the session, and is to confirm it.
    Ending,
}

/// What a key asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Nothing, or something that the stage has done itself.
    Nothing,
    /// Start the run.
    Start,
    /// Let the units change seats.
    Swap,
    /// Switch force feedback off or on.
    Force,
    /// Play no sound, or play it again.
    Mute,
    /// Let time stand.
    Pause(Pause),
    /// Let time go on.
    Resume,
    /// End the run, and ask why.
    BreakOff,
    /// The takeover that is on is of this kind.
    Label(Label),
    /// End the run with this said about it, if anything.
    Finish(Option<Annotation>),
    /// Keep the answers to the questions.
    Answered,
    /// End the session.
    Quit,
}
