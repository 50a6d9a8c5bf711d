//! What follows a run: its figures, and the corner case beside the recording.

use std::path::{Path, PathBuf};

use replay::{Case, Recording};

use super::disk::case_path;
use crate::commands::drive::RunFigures;
use crate::{output, study};

/// Prints what a recording came to.
pub fn figures_of(path: &Path, json: bool) -> anyhow::Result<()> {
    RunFigures::of(&Recording::open(path)?).print(path, json)
}

/// Cuts the corner case out of a recording, if there is one that counts.
pub fn cut(path: &Path) -> anyhow::Result<Option<PathBuf>> {
    let recording = Recording::open(path)?;
    if study::is_familiarisation(&recording.log().manifest.provenance) {
        return Ok(None);
    }
    let Some(window) = Case::window(recording.log()) else { return Ok(None) };
    let case = Case::cut(&recording, &recording.network()?, window)?;
    let to = case_path(path);
    output::write_file(&to, &case.encode()?)?;
    Ok(Some(to))
}
