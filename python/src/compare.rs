//! Checkpoints side by side over corner cases.

use std::path::PathBuf;

use base::failure::Failed;
use base::json::json_line;
use lab::compare::{Gate, Options};
use pyo3::prelude::*;

use crate::errors::input;
use crate::external::{Checkpoint, Raised};
use crate::values::{OneOrMore, jobs_at_once, picture_size, share};
use crate::work::{shared, tabled, work};

/// Which corner cases a checkpoint fixes and breaks against another, as `aeye compare` does, and gives what that prints with
/// `--json`; `cases` of it is a table. `compare.json` and `report.html` go to the folder `out`; the same call with more cases
/// or checkpoints looks only at those. Ctrl-C ends it.
///
/// `cases` are files, or folders with cases anywhere below; `checkpoints` two or more, the first of which is the baseline:
/// `early`, `full`, `truth`, ONNX files or `External`. `gates` are conditions on all others, as in `ped_iou>=0.5`, and
/// `no_worse_than` names a checkpoint than which no other may be worse; `gates` of what is given says which were passed. Pictures
/// have the `size`, (width, height) (None: that of the first network). `jobs` frames are looked at at the same time
/// (None: one a core); the results do not depend on it.
///
/// With `shard`, (i, n), it looks at every n-th file alone and gives what `aeye compare --shard --json` prints; folders of all shards,
/// copied into one, are what the same call without `shard` finishes.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there, EngineError where no case can be drawn.
#[pyfunction]
#[pyo3(signature = (cases, checkpoints, out, *, gates = None, no_worse_than = None, size = None, jobs = None, shard = None))]
#[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
pub fn compare<'py>(
    py: Python<'py>,
    cases: OneOrMore<PathBuf>,
    checkpoints: Vec<Checkpoint<'py>>,
    out: PathBuf,
    gates: Option<Vec<String>>,
    no_worse_than: Option<String>,
    size: Option<(u32, u32)>,
    jobs: Option<u16>,
    shard: Option<(u32, u32)>,
) -> PyResult<Bound<'py, PyAny>> {
    let raised = Raised::default();
    let gate = |text: &String| text.parse::<Gate>().map_err(input);
    let options = Options {
        files: cases.list(),
        verdict: Vec::new(),
        checkpoint: checkpoints.iter().map(|checkpoint| checkpoint.choice(&raised)).collect::<PyResult<_>>()?,
        gate: gates.iter().flatten().map(gate).collect::<PyResult<_>>()?,
        no_worse_than,
        size: size.map(picture_size).transpose()?,
        jobs: jobs.map(jobs_at_once).transpose()?,
        out,
    };
    if let Some(share) = shard.map(share).transpose()? {
        return shared(py, &raised, |interrupt| lab::compare::compare_shard(&options, share, interrupt));
    }
    let line = raised.or(work(py, |interrupt| {
        let compared = lab::compare::compare(&options, interrupt)?;
        Failed::check(&compared.summary.failed, compared.summary.cases.len())?;
        json_line(&compared)
    }))?;
    tabled(py, &line, "cases")
}
