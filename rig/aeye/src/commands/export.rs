//! Recordings and cases as files for the programs of others.

use base::failure::Failed;
use base::progress::Interrupt;
use lab::export::{Format, Options, export};

use crate::cli::ExportArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye export`.
pub fn run(args: &ExportArgs, json: bool) -> anyhow::Result<Verdict> {
    let ExportArgs { files, format, camera, checkpoint, last, from, to, fps, size, imaging, cameras, jobs, out } =
        args.clone();
    let format = format.unwrap_or_else(|| Format::of_file(&out));
    let imaging = imaging.into();
    let options = Options { files, format, camera, checkpoint, last, from, to, fps, size, imaging, cameras, jobs, out };
    let summary = export(&options, &Interrupt::listen())?;
    print::result(json, &summary)?;
    Failed::check(&summary.failed, summary.exports.len())?;
    Ok(Verdict::Ok)
}
