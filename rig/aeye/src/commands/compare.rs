//! Checkpoints side by side over a library of corner cases.

use base::failure::Failed;
use base::progress::Interrupt;
use base::say::say;
use lab::compare::{Options, compare};

use crate::cli::CompareArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye compare`; says which gates were not passed.
pub fn run(args: &CompareArgs, json: bool) -> anyhow::Result<Verdict> {
    let CompareArgs { files, checkpoint, gate, no_worse_than, size, jobs, out } = args.clone();
    let options = Options { files, checkpoint, gate, no_worse_than, size, jobs, out };
    let compared = compare(&options, &Interrupt::listen())?;
    print::result(json, &compared)?;
    compared.failed().for_each(|passage| say(format_args!("gate: {}", passage.sentence)));
    Failed::check(&compared.summary.failed, compared.summary.cases.len())?;
    Ok(Verdict::of_check(compared.failed().next().is_none()))
}
