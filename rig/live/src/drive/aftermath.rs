//! What follows a run: its figures, and the corner case beside the recording.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use base::library::case_path;
use base::output;
use kernel::RoadNetwork;
use measures::run_figures::RunFigures;
use replay::{Case, Recording};

/// Hears where the recording of a run is and what the run came to.
pub type Tell = Arc<dyn Fn(&Path, &RunFigures) -> anyhow::Result<()> + Send + Sync>;

/// Cuts the corner case out of a recording on a map, if there is one that counts, and tells what the recording
/// came to: also where nobody hears that any more, the case is cut.
pub fn of(
    path: &Path,
    network: &Arc<RoadNetwork>,
    tell: &(dyn Fn(&Path, &RunFigures) -> anyhow::Result<()> + Send + Sync),
) -> anyhow::Result<Option<PathBuf>> {
    let recording = Recording::open(path)?;
    let cut = cut(path, &recording, network);
    tell(path, &RunFigures::of(&recording, Some(network)))?;
    cut
}

fn cut(path: &Path, recording: &Recording, network: &Arc<RoadNetwork>) -> anyhow::Result<Option<PathBuf>> {
    if study::is_familiarisation(&recording.log().manifest.provenance) {
        return Ok(None);
    }
    let Some(window) = Case::window(recording.log()) else { return Ok(None) };
    let case = Case::cut(recording, network, window)?;
    let to = case_path(path);
    output::write_file(&to, &case.encode()?)?;
    Ok(Some(to))
}
