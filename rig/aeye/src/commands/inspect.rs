//! Says what is in a recording or case.

use base::failure::Failed;
use lab::inspect::{Options, inspect};

use crate::cli::InspectArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye inspect`.
pub fn run(args: &InspectArgs, json: bool) -> anyhow::Result<Verdict> {
    let InspectArgs { files, reveal, jobs } = args.clone();
    let inspected = inspect(&Options { files, reveal, jobs }, |contents| print::result(json, contents))?;
    // A text about several of which one is left would say the same twice.
    let overall = inspected.overall.as_ref().filter(|_| json || inspected.read > 1);
    overall.into_iter().try_for_each(|overall| print::result(json, overall))?;
    Failed::check(&inspected.failed, inspected.read)?;
    Ok(Verdict::of_check(inspected.diverged.is_empty()))
}
