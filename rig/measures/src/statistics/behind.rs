//! Which rides stand behind corner cases.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use base::failure::Failure;
use base::library::{self, Entry, Found, Kind};

use super::groups::{Group, group};

/// Corner cases, and all rides of which they came.
pub struct Library {
    /// The cases.
    pub cases: Vec<Entry>,
    /// The rides, with a case or without, by checkpoint.
    pub rides: Vec<Group>,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

impl Library {
    /// The cases among files and folders. Behind those of a folder stand all recordings of drives anywhere below it,
    /// behind a file those in the folder that it lies in, and a recording that is given stands for itself: how often
    /// cases happen is seen from rides without one, too.
    pub fn of(places: &[PathBuf]) -> Self {
        let (mut places, mut failed) = library::expand(places);
        for folder in folders_of_files(&places) {
            match library::drives_in(&folder) {
                Ok(drives) => places.extend(drives),
                Err(error) => failed.push(Failure::new(&folder, &error)),
            }
        }
        let Found { files, failed: unread } = library::find(&places, Kind::DrivesAndCases);
        failed.extend(unread);
        let (cases, recordings): (Vec<_>, Vec<_>) = files.into_iter().partition(|entry| entry.is_case);
        let (rides, unread) = group(&recordings, false, None, |_, _| true);
        failed.extend(unread);
        Self { cases, rides, failed }
    }
}

/// The folders of the cases that are given as files.
fn folders_of_files(places: &[PathBuf]) -> BTreeSet<PathBuf> {
    let files = places.iter().filter(|place| place.is_file() && library::is_case_name(place));
    let parent = |file: &PathBuf| file.parent().filter(|p| !p.as_os_str().is_empty()).map(Path::to_owned);
    files.map(|file| parent(file).unwrap_or_else(|| PathBuf::from("."))).collect()
}
