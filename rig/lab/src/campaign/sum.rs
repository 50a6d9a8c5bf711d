//! From the runs of a campaign to its figures.

use std::fmt;

use base::words;

use super::figures::{CampaignFigures, figures};
use super::run_line::RunLine;
use super::until::Goal;
use crate::share::Share;

/// The runs of one checkpoint, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Driven {
    /// Its name.
    pub checkpoint: String,
    /// What is kept of each.
    pub runs: Vec<RunLine>,
}

/// Fewer runs are there than the figures of a campaign need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TooFew(String);

impl TooFew {
    /// Runs by their numbers, checkpoint by checkpoint, which so many shards were to drive.
    pub fn runs(runs: &[(String, Vec<u32>)], of: u32) -> Self {
        let numbers = |numbers: &[u32]| numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        let each: Vec<_> = runs.iter().map(|(checkpoint, runs)| format!("{checkpoint} {}", numbers(runs))).collect();
        let mut shares: Vec<Share> = runs.iter().flat_map(|(_, runs)| runs).map(|run| Share::with(*run, of)).collect();
        shares.sort_unstable();
        shares.dedup();
        let shares: Vec<_> = shares.iter().map(Share::to_string).collect();
        Self(format!("runs are missing: {}; expected all of --shard {}", each.join("; "), shares.join(", ")))
    }
}

impl fmt::Display for TooFew {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for TooFew {}

/// The figures of a campaign, all of whose runs are there up to its goal.
pub fn sum_up(seed: u64, goal: Goal, driven: Vec<Driven>) -> Result<CampaignFigures, TooFew> {
    if let Some(Driven { checkpoint, runs }) = driven.iter().find(|driven| !goal.until.is_met(&driven.runs)) {
        let (count, words) = (words::count(runs.len(), "run"), goal.until.words(runs));
        return Err(TooFew(format!("{checkpoint}: {count} came to {words}; expected a greater --runs")));
    }
    let names: Vec<String> = driven.iter().map(|driven| driven.checkpoint.clone()).collect();
    Ok(figures(seed, goal.until, &names, driven.into_iter().flat_map(|driven| driven.runs).collect()))
}
