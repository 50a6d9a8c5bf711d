//! Why there is no world.

use crate::state::DecodeError;
use crate::time::Tick;

/// Why a world cannot start or resume.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// The scenario does not fit the map.
    #[error("scenario does not fit map {map}: {reason}")]
    Scenario {
        /// The map's name.
        map: String,
        /// What does not fit.
        reason: String,
    },
    /// The keyframe's bytes are no state.
    #[error("keyframe of tick {tick}: {source}")]
    Keyframe {
        /// Tick of the keyframe.
        tick: Tick,
        /// What is wrong with its bytes.
        source: DecodeError,
    },
    /// The keyframe's state is not one of this map and scenario.
    #[error("keyframe of tick {tick}: {reason}")]
    State {
        /// Tick of the keyframe.
        tick: Tick,
        /// What does not fit.
        reason: String,
    },
}
