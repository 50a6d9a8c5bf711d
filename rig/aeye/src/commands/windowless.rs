//! Stands in for `windows` in a build without the feature `live`: every function says that it cannot be done.

use std::fmt;
use std::path::Path;

use anyhow::bail;
use base::failure::Usage;
use base::maps::Map;
use drivers::checkpoint::CheckpointChoice;
use drivers::film::Film;
use kernel::Scenario;
use measures::RunFigures;
use serde::Serialize;
use study::Protocol;

use crate::cli::{DoctorArgs, DriveArgs, WheelCommand};
use crate::exit::Verdict;

/// What is missing, and how to get it.
const LACKS: &str =
    "this aeye has no windows and reads no wheels: it was built without the feature live, which is on by default";

fn refusal(instead: &str) -> anyhow::Error {
    Usage(format!("{LACKS}; {instead}")).into()
}

/// Live runs; there are none.
pub fn drive(
    _: &DriveArgs,
    _: Scenario,
    _: Map,
    _: impl Fn(&Path, &RunFigures) -> anyhow::Result<()> + Send + Sync + 'static,
) -> anyhow::Result<()> {
    Err(refusal("expected --headless"))
}

/// Live runs of a protocol; there are none.
pub fn drive_planned(
    _: &DriveArgs,
    _: Protocol,
    _: impl Fn(&Path, &RunFigures) -> anyhow::Result<()> + Send + Sync + 'static,
) -> anyhow::Result<()> {
    Err(refusal("plans are driven in windows"))
}

/// A recording or case in a window; there is none.
pub fn watch(_: &Film, _: &[CheckpointChoice]) -> anyhow::Result<()> {
    Err(refusal("expected --digests"))
}

/// `aeye wheel`.
pub fn wheels(_: &WheelCommand, _: bool) -> anyhow::Result<Verdict> {
    Err(refusal("aeye drive --headless and aeye campaign need none"))
}

/// Names of wheels and gamepads.
pub fn devices() -> anyhow::Result<Vec<String>> {
    Ok(Vec::new())
}

/// What there is to say about devices.
pub fn none_found() -> String {
    "not looked for".into()
}

/// In the place of what a drive in windows came to; there never is one.
#[derive(Debug, Serialize)]
pub enum Never {}

pub use Never as LiveFigures;

impl fmt::Display for Never {
    fn fmt(&self, _: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {}
    }
}

/// Real time is measured in windows.
pub fn trial(_: &DoctorArgs) -> anyhow::Result<(LiveFigures, Vec<String>)> {
    bail!(LACKS)
}
