//! How much was driven for the cases of a page.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::Context;
use replay::Recording;

/// What was driven.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    /// Recordings that count.
    pub recordings: usize,
    /// Kilometres.
    pub km: f64,
    /// Minutes of the simulated world.
    pub minutes: f64,
}

/// Sums over the recordings in the folders of the cases.
pub fn exposure(cases: &[PathBuf]) -> anyhow::Result<Exposure> {
    let here = Path::new(".");
    let folder = |path: &PathBuf| path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(here).to_owned();
    let mut sum = Exposure::default();
    for folder in cases.iter().map(folder).collect::<BTreeSet<_>>() {
        let entries = std::fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
        let mut paths = entries.map(|e| e.map(|e| e.path())).collect::<Result<Vec<_>, _>>()?;
        paths.sort();
        for path in paths.iter().filter(|path| is_recording(path)) {
            let recording = Recording::open(path)?;
            let log = recording.log();
            if study::is_familiarisation(&log.manifest.provenance) {
                continue;
            }
            sum.recordings += 1;
            sum.km += log.odometer_mm() as f64 / 1e6;
            sum.minutes += log.inputs.len() as f64 / f64::from(60 * kernel::time::TICK_HZ);
        }
    }
    Ok(sum)
}

fn is_recording(path: &Path) -> bool {
    let name = path.to_string_lossy();
    name.ends_with(".mcap") && !name.ends_with(".case.mcap")
}
