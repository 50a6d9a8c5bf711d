//! How good networks are.

use std::path::PathBuf;
use std::slice;

use base::json::json_line;
use lab::eval::{self, Summary};
use pyo3::prelude::*;

use crate::external::{Checkpoint, Raised};
use crate::given::{Given, Whole};
use crate::values::{check_there, jobs_at_once};
use crate::work::{parsed, work};

/// Measures a checkpoint (`early`, `full`, `truth`, an ONNX file or an `External`) on a split of a dataset in the layout of Cityscapes.
/// Gives what `aeye eval --json` prints: IoU of each class, confusion matrix, recall of pedestrians. `jobs` frames are
/// looked at at the same time (None: one a core); the result does not depend on it. Ctrl-C ends it.
///
/// Raises FileError where checkpoint or dataset is not there, InputError for a checkpoint that cannot be, EngineError where the
/// dataset has no such split, or is not whole.
#[pyfunction]
#[pyo3(
    signature = (checkpoint, dataset, *, split = Given::of("val".to_owned()), jobs = None),
    text_signature = "(checkpoint, dataset, *, split='val', jobs=None)"
)]
pub fn evaluate<'py>(
    py: Python<'py>,
    checkpoint: Given<Checkpoint<'py>>,
    dataset: PathBuf,
    split: Given<String>,
    jobs: Option<Given<Whole>>,
) -> PyResult<Bound<'py, PyAny>> {
    let raised = Raised::default();
    let choice = checkpoint.named("checkpoint")?.choice(&raised)?;
    let (split, jobs) = (split.named("split")?, jobs_at_once(jobs)?);
    check_there(slice::from_ref(&dataset))?;
    let line = raised.or(work(py, |interrupt| {
        let evaluation = eval::evaluate(&choice, &dataset, &split, jobs, interrupt)?;
        json_line(&Summary::new(&evaluation, &dataset, &split))
    }))?;
    parsed(py, &line)
}
