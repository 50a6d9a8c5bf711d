//! When a campaign is over.

use measures::statistics::Sampling;
use serde::{Deserialize, Serialize};

use super::run_line::RunLine;

/// A campaign that so many runs in a row bring no further would never end.
pub const STALLED_RUNS: usize = 200;
/// Metres a run that a car creeps without getting anywhere, at most.
const CREEP_M: u64 = 5;
/// Nobody drives faster over a whole run, m/s: bots keep to 50 km/h.
const FASTEST_MPS: u64 = 15;

/// When a campaign is over; counted for each checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", content = "value", rename_all = "snake_case")]
pub enum Until {
    /// So many runs.
    Runs(u32),
    /// So many kilometres.
    Km(f64),
    /// So many corner cases.
    Cases(u32),
    /// So many corner cases with the label `walker`.
    PedestrianCases(u32),
}

/// When a campaign is over, or has failed to get there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// What is enough.
    pub until: Until,
    /// Runs of each checkpoint that must come to that, if there may not be any number.
    pub most: Option<u32>,
}

impl Goal {
    /// So many runs, or one of the other three within as many runs as are given. `None` where nothing is asked for, more than
    /// one of the three, or what no run needs to be driven for.
    pub fn of(runs: Option<u32>, km: Option<f64>, [cases, pedestrian_cases]: [Option<u32>; 2]) -> Option<Self> {
        let until = match (km, cases, pedestrian_cases) {
            (Some(km), None, None) => Until::Km(km),
            (None, Some(cases), None) => Until::Cases(cases),
            (None, None, Some(cases)) => Until::PedestrianCases(cases),
            (None, None, None) => return runs.filter(|runs| *runs > 0).map(|runs| Until::Runs(runs).into()),
            _ => return None,
        };
        let is_something = match until {
            Until::Km(km) => km > 0.0 && km.is_finite(),
            Until::Runs(count) | Until::Cases(count) | Until::PedestrianCases(count) => count > 0,
        };
        (is_something && runs != Some(0)).then_some(Self { until, most: runs })
    }

    /// The number that no run reaches, if there is one.
    pub fn end(self) -> Option<u32> {
        match self.until {
            Until::Runs(runs) => Some(runs),
            Until::Km(_) | Until::Cases(_) | Until::PedestrianCases(_) => self.most,
        }
    }
}

impl From<Until> for Goal {
    fn from(until: Until) -> Self {
        Self { until, most: None }
    }
}

impl Until {
    /// What exact intervals of its figures rest on. A run ends with its corner case, so a campaign does that stops by
    /// their number; one that stops by kilometres goes on to the end of its last run, by less than a run's length.
    pub fn sampling(self) -> Sampling {
        match self {
            Self::Runs(_) => Sampling::Rides,
            Self::Km(_) => Sampling::Length,
            Self::Cases(_) | Self::PedestrianCases(_) => Sampling::Cases,
        }
    }

    /// Whether these runs, the first of the campaign, are enough.
    pub fn is_met(&self, runs: &[RunLine]) -> bool {
        let (done, of) = self.progress(runs);
        done >= of
    }

    /// Whether the last of these runs brought it no further.
    pub fn is_out_of_reach(&self, runs: &[RunLine]) -> bool {
        let Some(before) = runs.len().checked_sub(STALLED_RUNS) else { return false };
        let gained = self.progress(runs).0 - self.progress(&runs[..before]).0;
        match self {
            Self::Runs(_) => false,
            Self::Km(_) => gained < CREEP_M * STALLED_RUNS as u64,
            Self::Cases(_) | Self::PedestrianCases(_) => gained == 0,
        }
    }

    /// How much of how much is done; kilometres count in metres.
    pub fn progress(&self, runs: &[RunLine]) -> (u64, u64) {
        match *self {
            Self::Runs(n) => (runs.len() as u64, n.into()),
            Self::Km(km) => ((1000.0 * runs.iter().map(|r| r.figures.km).sum::<f64>()) as u64, (1000.0 * km) as u64),
            Self::Cases(n) => (runs.iter().filter(|r| r.case.is_some()).count() as u64, n.into()),
            Self::PedestrianCases(n) => (runs.iter().filter(|r| r.is_pedestrian_case()).count() as u64, n.into()),
        }
    }

    /// As much as a run of so many seconds can bring it further, in what its progress counts.
    pub fn most_of_a_run(&self, run_seconds: u32) -> u64 {
        match self {
            Self::Km(_) => FASTEST_MPS * u64::from(run_seconds),
            Self::Runs(_) | Self::Cases(_) | Self::PedestrianCases(_) => 1,
        }
    }

    /// How much of how much runs came to, as in `2 of 3 corner cases`.
    pub fn words(&self, runs: &[RunLine]) -> String {
        let (done, of) = self.progress(runs);
        match self {
            Self::Runs(_) => format!("{done} of {of} runs"),
            Self::Km(km) => format!("{} of {km} km", done as f64 / 1000.0),
            Self::Cases(_) => format!("{done} of {of} corner cases"),
            Self::PedestrianCases(_) => format!("{done} of {of} corner cases with people on foot"),
        }
    }
}
