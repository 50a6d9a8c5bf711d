//! The natural dataset: frames with ground truth from simulated drives.

use crate::cli::NaturalArgs;
use crate::exit::Verdict;

/// Runs `aeye dataset natural`.
pub fn run(_args: &NaturalArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
