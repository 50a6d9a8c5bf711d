//! Simulates recordings again and compares every tick.

use crate::cli::VerifyArgs;
use crate::exit::Verdict;

/// Runs `aeye verify`.
pub fn run(_args: &VerifyArgs, _json: bool) -> anyhow::Result<Verdict> {
    todo!()
}
