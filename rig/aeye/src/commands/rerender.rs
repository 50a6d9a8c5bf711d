//! Windows of recordings and cases drawn again and looked at through checkpoints.

use base::failure::Failed;
use base::progress::Interrupt;
use lab::rerender::{Options, rerender};

use crate::cli::RerenderArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye rerender`.
pub fn run(args: &RerenderArgs, json: bool) -> anyhow::Result<Verdict> {
    let RerenderArgs { files, checkpoint, last, fps, size, jobs, out } = args.clone();
    let options = Options { files, checkpoint, last, fps, size, jobs, out };
    let summary = rerender(&options, &Interrupt::listen())?;
    print::result(json, &summary)?;
    Failed::check(&summary.failed, summary.files)?;
    Ok(Verdict::Ok)
}
