//! What a tick gives.

use crate::arbiter::{Applied, Intervention};
use crate::events::Event;
use crate::state::StateHash;
use crate::time::Tick;

use super::keyframe::Keyframe;

/// What a tick gave.
#[derive(Clone, Debug, PartialEq)]
pub struct TickOutput {
    /// The tick that was reached.
    pub tick: Tick,
    /// Hash over the tick's inputs, the state after it, and its outputs.
    pub hash: StateHash,
    /// What the arbitration let through.
    pub applied: Applied,
    /// The intervention, in the tick in which it happens.
    pub intervention: Option<Intervention>,
    /// Events of this tick, in a fixed order.
    pub events: Vec<Event>,
    /// Distance driven so far, millimetres.
    pub odometer_mm: u64,
    /// The state, at keyframe ticks.
    pub keyframe: Option<Keyframe>,
}
