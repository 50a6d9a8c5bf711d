//! Simulated drives in parallel. Run `i` follows from the campaign's seed and `i` alone, so that the
//! results do not depend on how many worlds run at the same time, or on interruptions.

mod drive;
mod driver;
mod figures;
mod workers;

use std::path::PathBuf;

use kernel::Scenario;
use kernel::rng::{self, Stream};
use measures::statistics::Sampling;
use serde::Serialize;

pub use drive::{Options, drive};
pub use figures::{CampaignFigures, RunLine, figures};
pub use workers::drive_all;

use base::maps::Map;

/// A campaign that so many runs in a row bring no further would never end.
const STALLED_RUNS: usize = 200;
/// Metres a run that a car creeps without getting anywhere, at most.
const CREEP_M: u64 = 5;

/// When a campaign is over; counted for each checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
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
    fn is_out_of_reach(&self, runs: &[RunLine]) -> bool {
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
}

/// Everything that decides what a campaign's runs are.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Maps, in turn.
    pub maps: Vec<Map>,
    /// What every run has in common, if not the default of its map and seed.
    pub scenario: Option<Scenario>,
    /// People on foot, if not as many as the scenario says.
    pub pedestrians: Option<u16>,
    /// Longest simulated time of a run, seconds.
    pub run_seconds: u32,
    /// Seed of the campaign.
    pub seed: u64,
    /// When it is over.
    pub until: Until,
    /// Where the files go.
    pub out: PathBuf,
}

impl Plan {
    /// Which of the maps a run is on.
    pub fn map_index(&self, run: u32) -> usize {
        run as usize % self.maps.len()
    }

    /// The scenario of a run.
    pub fn scenario_of(&self, run: u32) -> Scenario {
        let map = &self.maps[self.map_index(run)];
        let seed = rng::bits(self.seed, Stream::Scenario, u64::from(run), 0) >> 32;
        let mut scenario = self.scenario.clone().unwrap_or_else(|| map.scenario(seed));
        scenario.map = map.network.name.clone();
        scenario.seed = seed;
        scenario.rules.max_seconds = self.run_seconds;
        scenario.traffic.pedestrians = self.pedestrians.unwrap_or(scenario.traffic.pedestrians);
        scenario
    }

    /// File of a run's recording.
    pub fn recording_path(&self, checkpoint: &str, run: u32) -> PathBuf {
        self.out.join(format!("{checkpoint}-{run:04}.mcap"))
    }

    /// File of what would have happened without a run's intervention.
    pub fn counterfactual_path(&self, checkpoint: &str, run: u32) -> PathBuf {
        self.out.join(format!("{checkpoint}-{run:04}.counterfactual.json"))
    }

    /// File of a run's corner case.
    pub fn case_path(&self, checkpoint: &str, run: u32) -> PathBuf {
        self.out.join(format!("{checkpoint}-{run:04}.case.mcap"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use measures::run_figures::RunFigures;
    use measures::statistics::Ride;

    fn runs(each: impl IntoIterator<Item = (f64, bool)>) -> Vec<RunLine> {
        let figures = |km| RunFigures {
            map: "city".into(),
            seed: 1,
            km,
            minutes: 1.0,
            outcome: "censored",
            familiarisation: false,
            label: None,
            comment: None,
            perception_caused: None,
        };
        let run = |(km, is_case): (f64, bool)| RunLine {
            file: "a.mcap".into(),
            case: is_case.then(|| "a.case.mcap".into()),
            checkpoint: "full".into(),
            without_intervention: None,
            figures: figures(km),
            ride: None,
        };
        each.into_iter().map(run).collect()
    }

    #[test]
    fn a_campaign_that_gets_nowhere_is_given_up_and_a_slow_one_is_not() {
        let nothing = || std::iter::repeat_n((0.0, false), STALLED_RUNS);
        let stalled = runs(std::iter::once((1.1, true)).chain(nothing()));
        let slow = runs(nothing().chain([(1.1, true)]));
        for until in [Until::Km(2.0), Until::Cases(2)] {
            assert!(until.is_out_of_reach(&stalled) && until.is_out_of_reach(&runs(nothing())), "{until:?}");
            assert!(!until.is_out_of_reach(&stalled[..STALLED_RUNS]) && !until.is_out_of_reach(&slow), "{until:?}");
        }
        assert!(!Until::Runs(1000).is_out_of_reach(&stalled));
        assert!(Until::PedestrianCases(1).is_out_of_reach(&slow), "no case is labelled walker");
    }

    #[test]
    fn figures_know_what_ended_the_campaign() {
        let rides = |km: f64| Ride { km, minutes: km, is_case: true, label: None, perception_caused: None };
        let mut lines = runs([(2.0, true), (3.0, true)]);
        lines.iter_mut().for_each(|line| line.ride = Some(rides(line.figures.km)));
        let of = |until| figures(1, until, &["full".to_owned()], lines.clone());
        let high = |until| of(until).checkpoints[0].statistics.cases_per_km_95.1;
        assert!(high(Until::Cases(2)) < high(Until::Km(5.0)) && high(Until::Km(5.0)) == high(Until::Runs(2)));
        let json = |until| serde_json::to_value(of(until)).expect("it has names");
        let (by_cases, by_km) = (json(Until::PedestrianCases(2)), json(Until::Km(5.0)));
        assert_eq!((&by_cases["until"]["pedestrian_cases"], &by_km["until"]["km"]), (&2.into(), &5.0.into()));
        assert_eq!(
            (&by_cases["checkpoints"][0]["sampling"], &by_km["checkpoints"][0]["sampling"]),
            (&"cases".into(), &"length".into())
        );
    }
}
