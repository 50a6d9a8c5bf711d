//! What decided how much was driven, which exact intervals and tests depend on.

use serde::Serialize;

use crate::stats;

/// What decided how much was driven.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sampling {
    /// A length that was fixed beforehand: how many corner cases there are is Poisson's.
    Length,
    /// The number of corner cases, of all or of one kind: rides ended with the last of them.
    Cases,
    /// The number of rides. Taken as if their length had been fixed, though rides with a corner case are shorter.
    Rides,
    /// Recordings do not say; taken as if their length had been fixed.
    #[default]
    Unknown,
}

impl Sampling {
    /// What the intervals and tests rest on, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Length => "exact for a length that was fixed beforehand",
            Self::Cases => "exact for drives that ended with the last corner case",
            Self::Rides => "approximate: the number of rides was fixed, they are exact if the length was",
            Self::Unknown => "assuming that the length was fixed beforehand, which recordings do not say",
        }
    }

    /// 95 % interval of the expected events in the exposure that had so many.
    pub fn interval(self, events: u64) -> (f64, f64) {
        match self {
            Self::Cases => stats::inverse_interval(events),
            Self::Length | Self::Rides | Self::Unknown => stats::poisson_interval(events),
        }
    }
}
