//! Statistics of recordings, checkpoint by checkpoint.

use base::failure::Failed;
use lab::redrive::is_judged;
use measures::statistics::{Choice, of_recordings, table};

use crate::cli::StatisticsArgs;
use crate::exit::Verdict;
use crate::print::print;

/// Runs `aeye statistics`.
pub fn run(args: &StatisticsArgs, json: bool) -> anyhow::Result<Verdict> {
    let StatisticsArgs { files, reference, reveal, jobs, verdict } = args;
    let summary = of_recordings(
        files,
        Choice { reference: reference.as_deref(), reveal: *reveal, jobs: *jobs, ..Choice::default() },
        |path, recording| verdict.is_empty() || is_judged(path, recording.digest(), verdict),
    )?;
    print(json, &summary, || {
        table(summary.checkpoints.iter().map(|c| (c.checkpoint.as_str(), &c.statistics, c.against_reference.as_ref())))
    })?;
    Failed::check(&summary.failed, summary.checkpoints.iter().map(|c| c.statistics.rides).sum())?;
    Ok(Verdict::Ok)
}
