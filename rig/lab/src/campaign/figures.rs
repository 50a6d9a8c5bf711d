//! What a campaign came to, computed from its recordings alone.

use std::collections::BTreeMap;

use base::json::Typed;
use measures::statistics::{Comparison, Ride, Statistics};
use serde::Serialize;

use super::run_line::RunLine;
use super::until::Until;

/// The figures of one checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckpointFigures {
    /// Its name.
    pub checkpoint: String,
    /// Statistics of its runs.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// How many interventions were necessary, early, needless, or in vain.
    pub interventions: BTreeMap<&'static str, u32>,
    /// Against the first checkpoint; absent for the first itself.
    pub against_first: Option<Comparison>,
}

/// The content of `campaign.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignFigures {
    /// Seed of the campaign.
    pub seed: u64,
    /// What ended it, checkpoint by checkpoint: intervals and tests are those of that design.
    pub until: Until,
    /// Kilometres of all runs.
    pub km: f64,
    /// Corner cases of all runs.
    pub cases: u64,
    /// The figures of each checkpoint.
    pub checkpoints: Vec<CheckpointFigures>,
    /// The runs, in order.
    pub runs: Vec<RunLine>,
}

/// `campaign.json`, and what `aeye campaign` prints.
impl Typed for CampaignFigures {
    const TYPE: &'static str = "aeye.campaign";
}

/// The figures of a campaign's runs.
pub fn figures(seed: u64, until: Until, checkpoints: &[String], runs: Vec<RunLine>) -> CampaignFigures {
    let mut each: Vec<CheckpointFigures> = Vec::new();
    for name in checkpoints {
        let runs = || runs.iter().filter(|run| run.checkpoint == *name);
        let rides: Vec<Ride> = runs().filter_map(|run| run.ride).collect();
        let statistics = Statistics::of(&rides, until.sampling());
        let mut interventions = BTreeMap::new();
        for counterfactual in runs().filter_map(|run| run.without_intervention.as_ref()) {
            *interventions.entry(counterfactual.verdict.name()).or_insert(0) += 1;
        }
        let against_first = each.first().map(|first| Comparison::of(&first.statistics, &statistics));
        each.push(CheckpointFigures { checkpoint: name.clone(), statistics, interventions, against_first });
    }
    let (km, cases) = (each.iter().map(|c| c.statistics.km).sum(), each.iter().map(|c| c.statistics.cases).sum());
    CampaignFigures { seed, until, km, cases, checkpoints: each, runs }
}
