//! Checkpoints side by side over a library of corner cases.

use base::failure::Failed;
use base::progress::Interrupt;
use base::say::say;
use lab::compare::{Options, compare, compare_shard};

use crate::cli::CompareArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye compare`; says which gates were not passed.
pub fn run(args: &CompareArgs, json: bool) -> anyhow::Result<Verdict> {
    let CompareArgs { files, verdict, checkpoint, gate, no_worse_than, size, imaging, jobs, shard, out } = args.clone();
    let options = Options { files, verdict, checkpoint, gate, no_worse_than, size, imaging: imaging.into(), jobs, out };
    let interrupt = Interrupt::listen();
    if let Some(share) = shard {
        return super::share(json, &compare_shard(&options, share, &interrupt)?);
    }
    let compared = compare(&options, &interrupt)?;
    print::result(json, &compared)?;
    compared.failed().for_each(|passage| say(format_args!("gate: {}", passage.sentence)));
    Failed::check(&compared.summary.failed, compared.summary.cases.len())?;
    Ok(Verdict::of_check(compared.failed().next().is_none()))
}
