//! How good networks are.

use std::path::PathBuf;

use base::json::json_line;
use lab::eval::{self, Summary};
use pyo3::prelude::*;

use crate::external::{Checkpoint, Raised};
use crate::values::jobs_at_once;
use crate::work::{parsed, work};

/// Measures a checkpoint (`early`, `full`, `truth`, an ONNX file or an `External`) on a split of a dataset in the layout of Cityscapes.
/// Gives what `aeye eval --json` prints: IoU of each class, confusion matrix, recall of pedestrians. `jobs` frames are
/// looked at at the same time (None: one a core); the result does not depend on it. Ctrl-C ends it.
///
/// Raises FileError where something is missing, InputError where it is not what it should be.
#[pyfunction]
#[pyo3(signature = (checkpoint, dataset, *, split = "val", jobs = None))]
pub fn evaluate<'py>(
    py: Python<'py>,
    checkpoint: Checkpoint<'py>,
    dataset: PathBuf,
    split: &str,
    jobs: Option<u16>,
) -> PyResult<Bound<'py, PyAny>> {
    let raised = Raised::default();
    let choice = checkpoint.choice(&raised)?;
    let jobs = jobs.map(jobs_at_once).transpose()?;
    let line = raised.or(work(py, |interrupt| {
        let evaluation = eval::evaluate(&choice, &dataset, split, jobs, interrupt)?;
        json_line(&Summary::new(&evaluation, &dataset, split))
    }))?;
    parsed(py, &line)
}
