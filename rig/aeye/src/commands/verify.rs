//! Simulates recordings again and compares every tick.

use base::failure::Failed;
use lab::verify::{Options, verify};

use crate::cli::VerifyArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye verify`.
pub fn run(args: &VerifyArgs, json: bool) -> anyhow::Result<Verdict> {
    let VerifyArgs { files, rewind, against, jobs } = args.clone();
    let verified = verify(&Options { files, rewind, against, jobs }, |checked| print::result(json, checked))?;
    Failed::check(&verified.failed, verified.checked)?;
    Ok(Verdict::of_check(verified.diverged.is_empty()))
}
