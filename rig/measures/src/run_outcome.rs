//! How a run ended.

use kernel::arbiter::Outcome;
use replay::{Label, Log};
use serde::{Serialize, Serializer};

/// How a run ended, by the world or by the operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunOutcome {
    /// As the world says.
    Ended(Outcome),
    /// From outside.
    Stopped,
    /// Operators set it aside, with a label that is no corner case's.
    SetAside(Label),
}

impl RunOutcome {
    /// That of a log.
    pub fn of(log: &Log) -> Self {
        let label = log.annotation.as_ref().map(|said| said.label);
        let ended = log.summary.as_ref().and_then(|summary| summary.outcome);
        match (label.filter(|label| !label.is_case()), ended) {
            (Some(label), _) => Self::SetAside(label),
            (None, Some(outcome)) => Self::Ended(outcome),
            (None, None) => Self::Stopped,
        }
    }

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ended(Outcome::Intervened) => "intervened",
            Self::Ended(Outcome::Missed) => "missed",
            Self::Ended(Outcome::Censored) => "censored",
            Self::Stopped => "stopped",
            Self::SetAside(label) => label.name(),
        }
    }

    /// What it means, for those who read it for the first time.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Ended(Outcome::Intervened) => "the safety driver took over: a corner case",
            Self::Ended(Outcome::Missed) => "a collision that nobody prevented: a corner case",
            Self::Ended(Outcome::Censored) => "its time or its road was over, without a corner case",
            Self::Stopped => "ended from outside, without a corner case",
            Self::SetAside(Label::DriverError) => {
                "an error of the driver's, by the operators: no corner case, its kilometres count"
            }
            Self::SetAside(Label::TechnicalFault) => "the rig failed, by the operators: it does not count",
            Self::SetAside(_) => "discarded by the operators: it does not count",
        }
    }
}

impl std::fmt::Display for RunOutcome {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl Serialize for RunOutcome {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
