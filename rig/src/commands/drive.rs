//! One run, recorded as it goes.

use crate::cli::DriveArgs;
use crate::exit::Verdict;

/// Runs `aeye drive`.
pub fn run(_args: &DriveArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
