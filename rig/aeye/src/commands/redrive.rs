//! Corner cases driven on from before the intervention.

use base::failure::Failed;
use base::progress::Interrupt;
use lab::redrive::{Options, redrive, redrive_shard};

use crate::cli::RedriveArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye redrive`.
pub fn run(args: &RedriveArgs, json: bool) -> anyhow::Result<Verdict> {
    let RedriveArgs {
        files, without_intervention, checkpoint, recorded, reveal, vary, seconds, jobs, shard, out, ..
    } = args.clone();
    let options = Options { files, without_intervention, checkpoint, recorded, reveal, vary, seconds, jobs, out };
    let interrupt = Interrupt::listen();
    if let Some(share) = shard {
        return super::share(json, &redrive_shard(&options, share, &interrupt)?);
    }
    let summary = redrive(&options, &interrupt)?;
    print::result(json, &summary)?;
    Failed::check(&summary.failed, summary.files)?;
    Ok(Verdict::Ok)
}
