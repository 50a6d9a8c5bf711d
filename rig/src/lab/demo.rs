//! The main job from end to end, with a report.

use crate::cli::DemoArgs;
use crate::exit::Verdict;

/// Runs `aeye demo`.
pub fn run(_args: &DemoArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
