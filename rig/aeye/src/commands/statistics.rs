//! Statistics of recordings, checkpoint by checkpoint.

use measures::statistics::{CheckpointStatistics, of_recordings, table};
use serde::Serialize;

use crate::cli::StatisticsArgs;
use crate::exit::Verdict;
use crate::print::print;

/// What the command prints.
#[derive(Serialize)]
struct Summary {
    checkpoints: Vec<CheckpointStatistics>,
}

/// Runs `aeye statistics`.
pub fn run(args: &StatisticsArgs, json: bool) -> anyhow::Result<Verdict> {
    let checkpoints = of_recordings(&args.files, args.reference.as_deref(), args.reveal)?;
    let summary = Summary { checkpoints };
    print(json, &summary, || {
        table(summary.checkpoints.iter().map(|c| (c.checkpoint.as_str(), &c.statistics, c.against_reference.as_ref())))
    })?;
    Ok(Verdict::Ok)
}
