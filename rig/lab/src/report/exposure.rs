//! How much was driven for the cases of a page.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use base::failure::Failure;
use base::library::{self, Kind, Listed};
use replay::{Log, Recording};

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

/// Sums over the recordings in and below the folders of the cases.
pub fn exposure(cases: &[Listed], failed: &mut Vec<Failure>) -> Exposure {
    let here = Path::new(".");
    let folder = |case: &Listed| case.path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(here).to_owned();
    let folders: BTreeSet<PathBuf> = cases.iter().map(folder).collect();
    // A folder may hold cases alone.
    let recordings = library::list(&Vec::from_iter(folders), Kind::Drives).files;
    let mut sum = Exposure::default();
    for Listed { path, .. } in recordings {
        match Recording::open(&path) {
            Ok(recording) => sum.add(recording.log()),
            Err(error) => failed.push(Failure::new(&path, &error.into())),
        }
    }
    sum
}

impl Exposure {
    fn add(&mut self, log: &Log) {
        if study::is_familiarisation(&log.manifest.provenance) {
            return;
        }
        self.recordings += 1;
        self.km += log.odometer_mm() as f64 / 1e6;
        self.minutes += log.inputs.len() as f64 / f64::from(60 * kernel::time::TICK_HZ);
    }
}
