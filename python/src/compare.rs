//! Checkpoints side by side over corner cases.

use std::path::PathBuf;

use base::failure::Failed;
use base::json::json_line;
use lab::compare::{Gate, Options};
use pyo3::prelude::*;

use crate::errors::input;
use crate::external::{Checkpoint, Raised, choices};
use crate::given::{Given, OneOrMore, Pair, Whole, named};
use crate::library::{Words, verdicts};
use crate::values::{self, check_there, jobs_at_once, picture_size, share};
use crate::work::{shared, tabled, work};

/// Which corner cases a checkpoint fixes and breaks against another, as `aeye compare` does, and gives what that prints with
/// `--json`; `cases` of it is a table. `compare.json` and `report.html` go to the folder `out`; the same call with more cases
/// or checkpoints looks only at those. Ctrl-C ends it.
///
/// `cases` are files, or folders with cases anywhere below; `checkpoints` two or more, the first of which is the baseline:
/// `early`, `full`, `truth`, ONNX files or `External`. Only those cases count on whose takeover a campaign came to one of the
/// verdicts `verdict`, where it is given. `gates` are conditions on all others, as in `ped_iou>=0.5`, and `no_worse_than`
/// names a checkpoint than which no other may be worse; `gates` of what is given says which were passed. Pictures have the
/// `size`, (width, height) (None: that of the first network), and the `quality` `plain`, `standard` or `fine` (None: the usual), and lens
/// and chip do to them what `sensor` says, as in `noise=4,k1=-0.1` (None: nothing). `jobs` frames are looked at at the same time (None: one a
/// core); the results do not depend on it.
///
/// With `shard`, (i, n), it looks at every n-th file alone and gives what `aeye compare --shard --json` prints; folders of all shards,
/// copied into one, are what the same call without `shard` finishes.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there, EngineError where no case can be drawn.
#[pyfunction]
#[pyo3(signature = (cases, checkpoints, out, *, verdict = None, gates = None, no_worse_than = None, size = None, quality = None, sensor = None, jobs = None, shard = None))]
#[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
pub fn compare<'py>(
    py: Python<'py>,
    cases: Given<OneOrMore<PathBuf>>,
    checkpoints: Given<OneOrMore<Checkpoint<'py>>>,
    out: PathBuf,
    verdict: Words,
    gates: Option<Given<OneOrMore<String>>>,
    no_worse_than: Option<Given<String>>,
    size: Option<Given<Pair>>,
    quality: Option<Given<String>>,
    sensor: Option<Given<String>>,
    jobs: Option<Given<Whole>>,
    shard: Option<Given<Pair>>,
) -> PyResult<Bound<'py, PyAny>> {
    let raised = Raised::default();
    let gate = |text: &String| text.parse::<Gate>().map_err(input);
    let gates = named(gates, "gates")?.map_or_else(Vec::new, OneOrMore::list);
    let options = Options {
        files: cases.named("cases")?.list(),
        verdict: verdicts(verdict)?,
        checkpoint: choices(Some(checkpoints.named("checkpoints")?), &raised)?,
        gate: gates.iter().map(gate).collect::<PyResult<_>>()?,
        no_worse_than: named(no_worse_than, "no_worse_than")?,
        size: size.map(|size| picture_size(size, "size")).transpose()?,
        imaging: values::imaging(quality, sensor)?,
        jobs: jobs_at_once(jobs)?,
        out,
    };
    let share = share(shard)?;
    check_there(&options.files)?;
    if let Some(share) = share {
        return shared(py, &raised, |interrupt| lab::compare::compare_shard(&options, share, interrupt));
    }
    let line = raised.or(work(py, |interrupt| {
        let compared = lab::compare::compare(&options, interrupt)?;
        Failed::check(&compared.summary.failed, compared.summary.cases.len())?;
        json_line(&compared)
    }))?;
    tabled(py, &line, "cases")
}
