//! Corner cases driven on from before the intervention.

use lab::redrive::{Options, redrive};

use crate::cli::RedriveArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye redrive`.
pub fn run(args: &RedriveArgs, json: bool) -> anyhow::Result<Verdict> {
    let RedriveArgs { files, without_intervention, checkpoint, recorded, reveal, vary, seconds, out } = args.clone();
    let options = Options { files, without_intervention, checkpoint, recorded, reveal, vary, seconds, out };
    print::result(json, &redrive(&options)?)?;
    Ok(Verdict::Ok)
}
