//! The paper from end to end, in one go or in pieces.

use std::io;
use std::path::{Path, PathBuf};

use base::failure::sentence;
use base::json::json_line;
use lab::experiment::{self as stages, Preset, Recipe};
use pyo3::prelude::*;

use crate::errors::{file, input, raise};
use crate::given::{Given, Whole, named};
use crate::values::jobs_at_once;
use crate::work::{parsed, work};

/// Does what a `recipe` says in the folder `out`, or what is left of it there, as `aeye experiment` does, and gives what that
/// prints with `--json`. Ctrl-C ends it; the same call goes on there.
///
/// `recipe` is a preset (`smoke`, `small`, `desk`, `paper`) or a TOML file. `jobs` drives are made at the same time (None: one a
/// core); the results do not depend on it.
///
/// With `piece`, the name of one of `pieces`, that one is done alone, and what `aeye experiment --piece --json` prints is
/// given; other processes may do others in the same folder.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there or cannot be written, EngineError where
/// what a piece needs is not there.
#[pyfunction]
#[pyo3(signature = (recipe, out, *, jobs = None, piece = None))]
pub fn experiment(
    py: Python<'_>,
    recipe: PathBuf,
    out: PathBuf,
    jobs: Option<Given<Whole>>,
    piece: Option<Given<String>>,
) -> PyResult<Bound<'_, PyAny>> {
    let (recipe, jobs, piece) = (chosen(&recipe)?, jobs_at_once(jobs)?, named(piece, "piece")?);
    let line = work(py, |interrupt| match &piece {
        Some(name) => json_line(&stages::piece(&recipe, &out, name, jobs, interrupt)?),
        None => json_line(&stages::run(&recipe, &out, jobs, interrupt)?),
    })?;
    parsed(py, &line)
}

/// The pieces of an experiment that are not done yet in the folder `out` and can be done now, each with what it needs there, as
/// `aeye experiment --pieces --json` prints them. When none is left, `experiment` does the rest.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there.
#[pyfunction]
pub fn pieces(py: Python<'_>, recipe: PathBuf, out: PathBuf) -> PyResult<Vec<Bound<'_, PyAny>>> {
    let recipe = chosen(&recipe)?;
    let lines = work(py, |_| stages::pieces(&recipe, &out)?.iter().map(json_line).collect::<anyhow::Result<Vec<_>>>())?;
    lines.iter().map(|line| parsed(py, line)).collect()
}

/// A name is a preset's, whatever else a file's.
fn chosen(recipe: &Path) -> PyResult<Recipe> {
    let preset = Preset::ALL.into_iter().find(|preset| Path::new(preset.name()) == recipe);
    if preset.is_none() && !recipe.exists() {
        let (path, names) = (recipe.display(), Preset::ALL.map(Preset::name).join(", "));
        return Err(file(format!("{path}: no such file; expected a recipe, or one of the presets {names}")));
    }
    preset.map_or_else(|| Recipe::read(recipe), Preset::recipe).map_err(|error| {
        match error.chain().any(|cause| cause.is::<io::Error>()) {
            true => raise(&error),
            false => input(sentence(&error)),
        }
    })
}
