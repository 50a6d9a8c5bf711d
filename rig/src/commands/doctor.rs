//! Says what this machine has and how fast it is.

use crate::exit::Verdict;

/// Runs `aeye doctor`.
pub fn run(_json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
