//! What a campaign came to, computed from its recordings alone.

use std::collections::BTreeMap;

use measures::run_figures::RunFigures;
use measures::statistics::{Comparison, Ride, Statistics};
use replay::{Label, Recording};
use serde::Serialize;

use super::{Plan, Until};
use crate::redrive::Counterfactual;

/// A run in `campaign.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunLine {
    /// File of the recording, in the campaign's folder.
    pub file: String,
    /// File of the corner case, if there is one.
    pub case: Option<String>,
    /// What the semantic driver looked at.
    pub checkpoint: String,
    /// What would have happened without the intervention, if there was one.
    pub without_intervention: Option<Counterfactual>,
    /// Everything else.
    #[serde(flatten)]
    pub figures: RunFigures,
    /// How it counts.
    #[serde(skip)]
    pub ride: Option<Ride>,
}

impl RunLine {
    /// That of a recording; `has_case` says whether a corner case was cut from it.
    pub fn new(plan: &Plan, checkpoint: &str, run: u32, recording: &Recording, has_case: bool) -> Self {
        let name = |path: std::path::PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self {
            file: name(plan.recording_path(checkpoint, run)),
            case: has_case.then(|| name(plan.case_path(checkpoint, run))),
            checkpoint: checkpoint.to_owned(),
            without_intervention: None,
            figures: RunFigures::of(recording),
            ride: Ride::of(recording),
        }
    }

    /// Whether it holds a corner case with the label `walker`.
    pub fn is_pedestrian_case(&self) -> bool {
        self.case.is_some() && self.figures.label == Some(Label::Walker.name())
    }
}

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
