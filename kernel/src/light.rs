//! What a traffic light shows.

use crate::state_enum;

state_enum! {
    /// Phase of a traffic light.
    pub enum LightPhase {
        /// Stop.
        Red = 0,
        /// Stop if it can be done safely.
        Yellow = 1,
        /// Go.
        Green = 2,
    }
}
