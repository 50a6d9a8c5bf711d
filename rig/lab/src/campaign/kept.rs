//! A run that was driven, read back from its files.

use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

use anyhow::bail;
use kernel::RoadNetwork;
use kernel::time::Tick;
use replay::{Case, Recording};

use super::places::Places;
use super::run_line::RunLine;
use crate::redrive::Counterfactual;

/// The recording of a whole run.
pub fn whole(path: &Path) -> anyhow::Result<Recording> {
    let recording = Recording::open(path)?;
    if !recording.finished() {
        bail!("{}: is cut off; expected a whole run, or none, which would be driven again", path.display());
    }
    Ok(recording)
}

/// Whether a file is the corner case that a window of a recording gives.
pub fn is_cut(path: &Path, recording: &Recording, window: &RangeInclusive<Tick>) -> bool {
    let is_its = |case: &Case| case.info().source == recording.digest() && case.info().to == *window.end();
    Case::open(path).is_ok_and(|case| is_its(&case))
}

/// The recording of a run through a checkpoint, and what is kept of it; `None` unless all of its files are there.
pub fn read(
    checkpoint: &str,
    places: &Places,
    network: impl FnOnce(&Recording) -> anyhow::Result<Arc<RoadNetwork>>,
) -> anyhow::Result<Option<(Recording, RunLine)>> {
    if !places.recording.exists() {
        return Ok(None);
    }
    let recording = whole(&places.recording)?;
    let window = Case::window(recording.log());
    if window.as_ref().is_some_and(|window| !is_cut(&places.case, &recording, window)) {
        return Ok(None);
    }
    let intervention = recording.log().intervention;
    let verdict = Counterfactual::read(&places.counterfactual, &recording)?.filter(|_| intervention.is_some());
    if intervention.is_some() && verdict.is_none() {
        return Ok(None);
    }
    let case = window.is_some().then_some(places.case.as_path());
    let mut line = RunLine::new(checkpoint, &places.recording, (&recording, &network(&recording)?), case);
    line.without_intervention = verdict;
    Ok(Some((recording, line)))
}
