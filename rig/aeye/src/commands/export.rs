//! Recordings and cases as files for viewers of robot logs.

use base::progress::Interrupt;
use lab::export::{Options, export};

use crate::cli::ExportArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye export`.
pub fn run(args: &ExportArgs, json: bool) -> anyhow::Result<Verdict> {
    let ExportArgs { files, checkpoint, last, from, to, fps, size, out } = args.clone();
    let options = Options { files, checkpoint, last, from, to, fps, size, out };
    print::result(json, &export(&options, &Interrupt::listen()?)?)?;
    Ok(Verdict::Ok)
}
