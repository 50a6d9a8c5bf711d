//! What a campaign came to, computed from its recordings alone.

use replay::Recording;
use serde::Serialize;

use super::Plan;
use crate::commands::drive::RunFigures;
use crate::stats;

/// A run in `campaign.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunLine {
    /// File of the recording, in the campaign's folder.
    pub file: String,
    /// File of the corner case, if there is one.
    pub case: Option<String>,
    /// What the semantic driver looked at.
    pub checkpoint: String,
    /// Everything else.
    #[serde(flatten)]
    pub figures: RunFigures,
}

impl RunLine {
    /// That of a recording; `has_case` says whether a corner case was cut from it.
    pub fn new(plan: &Plan, checkpoint: &str, run: u32, recording: &Recording, has_case: bool) -> Self {
        let name = |path: std::path::PathBuf| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Self {
            file: name(plan.recording_path(checkpoint, run)),
            case: has_case.then(|| name(plan.case_path(checkpoint, run))),
            checkpoint: checkpoint.to_owned(),
            figures: RunFigures::of(recording),
        }
    }
}

/// Sums over runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Exposure {
    /// Kilometres driven.
    pub km: f64,
    /// Simulated minutes.
    pub minutes: f64,
    /// Corner cases: interventions, and collisions that nobody prevented.
    pub cases: u64,
    /// Corner cases that true masks avoid.
    pub perception_caused: u64,
    /// Corner cases a kilometre.
    pub cases_per_km: f64,
    /// Exact 95 % interval of that rate; unfinished legs count as exposure.
    pub cases_per_km_95: (f64, f64),
}

impl Exposure {
    fn of<'a>(runs: impl Iterator<Item = &'a RunLine> + Clone) -> Self {
        let km = runs.clone().map(|r| r.figures.km).sum::<f64>();
        let cases = runs.clone().filter(|r| r.case.is_some()).count() as u64;
        let (low, high) = stats::poisson_interval(cases);
        let per_km = |n: f64| if km > 0.0 { n / km } else { 0.0 };
        Self {
            km,
            minutes: runs.clone().map(|r| r.figures.minutes).sum(),
            cases,
            perception_caused: runs.filter(|r| r.figures.perception_caused == Some(true)).count() as u64,
            cases_per_km: per_km(cases as f64),
            cases_per_km_95: (per_km(low), per_km(high)),
        }
    }
}

/// The figures of one checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckpointFigures {
    /// Its name.
    pub checkpoint: String,
    /// Sums over its runs.
    #[serde(flatten)]
    pub exposure: Exposure,
    /// Two-sided exact p-value against the first checkpoint: the rates are the same.
    pub p_against_first: Option<f64>,
}

/// The content of `campaign.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CampaignFigures {
    /// Seed of the campaign.
    pub seed: u64,
    /// Sums over all runs.
    #[serde(flatten)]
    pub exposure: Exposure,
    /// The figures of each checkpoint.
    pub checkpoints: Vec<CheckpointFigures>,
    /// The runs, in order.
    pub runs: Vec<RunLine>,
}

/// The figures of a campaign's runs.
pub fn figures(seed: u64, checkpoints: &[String], runs: Vec<RunLine>) -> CampaignFigures {
    let of =
        |name: &String| Exposure::of(runs.iter().filter(|r| r.checkpoint == *name).collect::<Vec<_>>().into_iter());
    let first = checkpoints.first().map(of);
    let each = checkpoints.iter().enumerate().map(|(i, name)| {
        let exposure = of(name);
        let reference = first.as_ref().filter(|_| i > 0);
        let p_against_first =
            reference.and_then(|first| stats::same_rate_p((first.cases, exposure.cases), (first.km, exposure.km)));
        CheckpointFigures { checkpoint: name.clone(), exposure, p_against_first }
    });
    CampaignFigures { seed, exposure: Exposure::of(runs.iter()), checkpoints: each.collect(), runs }
}
