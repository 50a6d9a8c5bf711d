//! Trains a checkpoint from a dataset folder.

use crate::cli::TrainArgs;
use crate::exit::Verdict;

/// Runs `aeye train`.
pub fn run(_args: &TrainArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
