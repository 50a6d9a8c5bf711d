//! What follows a run: its figures, and the corner case beside the recording.

use std::path::{Path, PathBuf};

use replay::{Case, Recording};

use super::disk::case_path;
use crate::commands::drive::RunFigures;
use crate::{output, study};

/// Cuts the corner case out of a recording, if there is one that counts, and prints what the recording
/// came to: also where nobody reads that any more, the case is cut.
pub fn of(path: &Path, json: bool) -> anyhow::Result<Option<PathBuf>> {
    let recording = Recording::open(path)?;
    let cut = cut(path, &recording);
    RunFigures::of(&recording).print(path, json)?;
    cut
}

fn cut(path: &Path, recording: &Recording) -> anyhow::Result<Option<PathBuf>> {
    if study::is_familiarisation(&recording.log().manifest.provenance) {
        return Ok(None);
    }
    let Some(window) = Case::window(recording.log()) else { return Ok(None) };
    let case = Case::cut(recording, &recording.network()?, window)?;
    let to = case_path(path);
    output::write_file(&to, &case.encode()?)?;
    Ok(Some(to))
}
