//! Windows of recordings and cases drawn again and looked at through checkpoints.

use base::failure::Failed;
use base::progress::Interrupt;
use lab::rerender::{Options, rerender, rerender_shard};

use crate::cli::RerenderArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye rerender`.
pub fn run(args: &RerenderArgs, json: bool) -> anyhow::Result<Verdict> {
    let RerenderArgs { files, checkpoint, last, fps, size, imaging, cameras, jobs, shard, out } = args.clone();
    let options = Options { files, checkpoint, last, fps, size, imaging: imaging.into(), cameras, jobs, out };
    let interrupt = Interrupt::listen();
    if let Some(share) = shard {
        return super::share(json, &rerender_shard(&options, share, &interrupt)?);
    }
    let summary = rerender(&options, &interrupt)?;
    print::result(json, &summary)?;
    Failed::check(&summary.failed, summary.files)?;
    Ok(Verdict::Ok)
}
