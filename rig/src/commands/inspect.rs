//! Says what is in a recording or case.

use crate::cli::InspectArgs;
use crate::exit::Verdict;

/// Runs `aeye inspect`.
pub fn run(_args: &InspectArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
