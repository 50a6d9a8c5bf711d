//! Measures a checkpoint on a dataset folder.

use crate::cli::EvalArgs;
use crate::exit::Verdict;

/// Runs `aeye eval`.
pub fn run(_args: &EvalArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
