//! Statistics of recordings, checkpoint by checkpoint.

use base::failure::Failed;
use lab::redrive::is_judged;
use measures::statistics::{CheckpointStatistics, Choice, of_recordings, table};

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
        let columns = summary.checkpoints.iter();
        let rates = table(columns.map(|c| (c.checkpoint.as_str(), &c.statistics, c.against_reference.as_ref())));
        rates + &set_aside(&summary.checkpoints)
    })?;
    Failed::check(&summary.failed, summary.checkpoints.iter().map(|c| c.statistics.rides).sum())?;
    Ok(Verdict::Ok)
}

/// What operators set aside, a line for each checkpoint with such runs.
fn set_aside(checkpoints: &[CheckpointStatistics]) -> String {
    let with = checkpoints.iter().filter(|statistics| !statistics.set_aside.is_empty());
    let line = |c: &CheckpointStatistics| {
        let words: Vec<String> = c.set_aside.iter().map(ToString::to_string).collect();
        format!("\nset aside by operators: {} {}", c.checkpoint, words.join(", "))
    };
    with.map(line).collect()
}
