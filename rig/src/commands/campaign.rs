//! Simulated drives in parallel, resumable, and their figures.

use crate::cli::CampaignArgs;
use crate::exit::Verdict;

/// Runs `aeye campaign`.
pub fn run(_args: &CampaignArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
