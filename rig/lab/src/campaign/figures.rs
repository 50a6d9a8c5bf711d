//! What a campaign came to, computed from its recordings alone.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use base::json::{self, Typed};
use base::output;
use measures::statistics::{Comparison, Ride, Statistics, table};
use serde::Serialize;

use super::run_line::RunLine;
use super::until::Until;
use crate::machine::Machine;

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
    /// Kinds of machines that drove; absent where all were of one kind.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub machines: Vec<Machine>,
    /// The runs, in order.
    pub runs: Vec<RunLine>,
}

/// `campaign.json`, and what `aeye campaign` prints.
impl Typed for CampaignFigures {
    const TYPE: &'static str = "aeye.campaign";
}

impl CampaignFigures {
    /// Name of the file, in the folder of the campaign.
    pub const FILE: &str = "campaign.json";

    /// Writes `campaign.json` to a folder.
    pub fn write(&self, folder: &Path) -> anyhow::Result<()> {
        output::write_file(&folder.join(Self::FILE), json::json_file(self)?.as_bytes())
    }
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
    CampaignFigures { seed, until, km, cases, checkpoints: each, machines: Vec::new(), runs }
}

impl fmt::Display for CampaignFigures {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.checkpoints.iter();
        let columns = columns.map(|c| (c.checkpoint.as_str(), &c.statistics, c.against_first.as_ref()));
        f.write_str(&table(columns))?;
        for each in self.checkpoints.iter().filter(|each| !each.interventions.is_empty()) {
            let verdicts: Vec<_> = each.interventions.iter().map(|(verdict, n)| format!("{n} {verdict}")).collect();
            write!(f, "\n{}: without the interventions: {}", each.checkpoint, verdicts.join(", "))?;
        }
        Ok(())
    }
}
