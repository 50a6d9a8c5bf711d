//! What was driven beside the cases of a page.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use base::failure::Failure;
use base::library::{self, Kind, Listed};
use measures::statistics::Ride;
use replay::Recording;

/// The rides of all recordings in and below the folders of the cases, each once, whichever of their cases are shown.
pub fn driven(cases: &[Listed], failed: &mut Vec<Failure>) -> Vec<Ride> {
    let here = Path::new(".");
    let folder = |case: &Listed| case.path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(here).to_owned();
    let folders: BTreeSet<PathBuf> = cases.iter().map(folder).collect();
    let (mut rides, mut known) = (Vec::new(), BTreeSet::new());
    // A folder may hold cases alone.
    for Listed { path, .. } in library::list(&Vec::from_iter(folders), Kind::Drives).files {
        match Recording::open(&path) {
            Ok(recording) if known.insert(recording.digest()) => rides.extend(Ride::of(&recording)),
            Ok(_) => {}
            Err(error) => failed.push(Failure::new(&path, &error.into())),
        }
    }
    rides
}
