//! The training sets.

use serde::Serialize;

/// What a network learned from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Set {
    /// Ordinary drives.
    Natural,
    /// With frames that show more pedestrians.
    Pedestrian,
    /// With the frames before takeovers.
    CornerCase,
}

impl Set {
    /// All of them, in the paper's order.
    pub const ALL: [Self; 3] = [Self::Natural, Self::Pedestrian, Self::CornerCase];

    /// As folders and files are called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Natural => "natural",
            Self::Pedestrian => "pedestrian",
            Self::CornerCase => "corner-case",
        }
    }
}
