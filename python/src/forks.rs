//! Corner cases driven on.

use std::path::PathBuf;

use base::failure::Failed;
use base::json::json_line;
use lab::redrive as forks;
use pyo3::prelude::*;

use crate::errors::input;
use crate::external::{Checkpoint, Raised};
use crate::values::{OneOrMore, jobs_at_once, share, whole_seconds};
use crate::work::{shared, tabled, work};

/// Drives recordings or cases on from before their intervention, as `aeye redrive` does, and gives what that prints with
/// `--json`; `forks` of it is a table. Their recordings go to the folder `out`. Ctrl-C ends it; what was driven stays.
///
/// Either `without_intervention`: what would have happened if the safety driver had done nothing? Or through a
/// `checkpoint` (`early`, `full`, `truth`, an ONNX file or an `External`): is there an intervention again? `recorded` are those
/// among which checkpoints of the recordings may be found. Each file has `vary` further forks, 0 to 30, and a fork goes on for `after`
/// seconds, 1 to 60.
///
/// With `shard`, (i, n), it drives every n-th file alone and gives what `aeye redrive --shard --json` prints; folders of all shards,
/// copied into one, are what the same call without `shard` finishes.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there, EngineError where none of them can be
/// driven on.
#[pyfunction]
#[pyo3(signature = (
    files, out, *, without_intervention = false, checkpoint = None, recorded = None, vary = 0, after = 10.0, jobs = None,
    shard = None
))]
#[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
pub fn redrive<'py>(
    py: Python<'py>,
    files: OneOrMore<PathBuf>,
    out: PathBuf,
    without_intervention: bool,
    checkpoint: Option<Checkpoint<'py>>,
    recorded: Option<OneOrMore<Checkpoint<'py>>>,
    vary: u16,
    after: f64,
    jobs: Option<u16>,
    shard: Option<(u32, u32)>,
) -> PyResult<Bound<'py, PyAny>> {
    if without_intervention == checkpoint.is_some() {
        return Err(input("expected either without_intervention=True or a checkpoint".to_owned()));
    }
    if vary > 30 {
        return Err(input(format!("vary={vary}; expected 0 to 30")));
    }
    let raised = Raised::default();
    let choice = |checkpoint: &Checkpoint<'_>| checkpoint.choice(&raised);
    let recorded = recorded.map(|recorded| recorded.list().iter().map(choice).collect()).transpose()?;
    let options = forks::Options {
        files: files.list(),
        without_intervention,
        checkpoint: checkpoint.as_ref().map(choice).transpose()?,
        recorded: recorded.unwrap_or_default(),
        reveal: false,
        vary,
        seconds: whole_seconds(after, "after", 1..=60)?,
        jobs: jobs.map(jobs_at_once).transpose()?,
        out,
    };
    if let Some(share) = shard.map(share).transpose()? {
        return shared(py, &raised, |interrupt| forks::redrive_shard(&options, share, interrupt));
    }
    let line = raised.or(work(py, |interrupt| {
        let done = forks::redrive(&options, interrupt)?;
        Failed::check(&done.failed, done.files)?;
        json_line(&done)
    }))?;
    tabled(py, &line, "forks")
}
