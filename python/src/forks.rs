//! Corner cases driven on.

use std::path::PathBuf;

use base::failure::Failed;
use base::json::json_line;
use lab::redrive as forks;
use pyo3::prelude::*;

use crate::errors::input;
use crate::external::{Checkpoint, Raised, choices};
use crate::given::{Given, OneOrMore, Pair, Whole, named};
use crate::values::{check_there, jobs_at_once, share, whole_seconds};
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
#[pyo3(
    signature = (
        files, out, *, without_intervention = false, checkpoint = None, recorded = None, vary = Given::of(Whole(0)),
        after = Given::of(10.0), jobs = None, shard = None
    ),
    text_signature = "(files, out, *, without_intervention=False, checkpoint=None, recorded=None, vary=0, after=10.0, \
                      jobs=None, shard=None)"
)]
#[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
pub fn redrive<'py>(
    py: Python<'py>,
    files: Given<OneOrMore<PathBuf>>,
    out: PathBuf,
    without_intervention: bool,
    checkpoint: Option<Given<Checkpoint<'py>>>,
    recorded: Option<Given<OneOrMore<Checkpoint<'py>>>>,
    vary: Given<Whole>,
    after: Given<f64>,
    jobs: Option<Given<Whole>>,
    shard: Option<Given<Pair>>,
) -> PyResult<Bound<'py, PyAny>> {
    if without_intervention == checkpoint.is_some() {
        return Err(input("expected either without_intervention=True or a checkpoint".to_owned()));
    }
    let raised = Raised::default();
    let options = forks::Options {
        files: files.named("files")?.list(),
        without_intervention,
        checkpoint: named(checkpoint, "checkpoint")?.map(|checkpoint| checkpoint.choice(&raised)).transpose()?,
        recorded: choices(named(recorded, "recorded")?, &raised)?,
        reveal: false,
        vary: vary.within("vary", 0..=30)?,
        seconds: whole_seconds(after, "after", 1..=60)?,
        jobs: jobs_at_once(jobs)?,
        out,
    };
    let share = share(shard)?;
    check_there(&options.files)?;
    if let Some(share) = share {
        return shared(py, &raised, |interrupt| forks::redrive_shard(&options, share, interrupt));
    }
    let line = raised.or(work(py, |interrupt| {
        let done = forks::redrive(&options, interrupt)?;
        Failed::check(&done.failed, done.files)?;
        json_line(&done)
    }))?;
    tabled(py, &line, "forks")
}
