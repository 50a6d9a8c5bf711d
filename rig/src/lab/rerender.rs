//! Renders the window of a recording or case through checkpoints.

use crate::cli::RerenderArgs;
use crate::exit::Verdict;

/// Runs `aeye rerender`.
pub fn run(_args: &RerenderArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
