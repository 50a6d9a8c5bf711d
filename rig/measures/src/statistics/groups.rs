//! Rides by checkpoint.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::failure::Usage;
use replay::Recording;
use serde::Serialize;

use super::{Comparison, Ride, Sampling, Statistics};

/// What blind drives go by.
const BLIND: &str = "blind";
/// What drives go by whose recordings name no checkpoint.
const UNKNOWN: &str = "unknown";

/// The statistics of one checkpoint.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckpointStatistics {
    /// Its name; with the beginning of its digest where several have that name.
    pub checkpoint: String,
    /// Its digest; absent where nothing is told.
    pub digest: Option<String>,
    /// What its rides came to.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// Against the reference; absent for the reference itself.
    pub against_reference: Option<Comparison>,
}

/// The rides through one checkpoint.
struct Group {
    checkpoint: String,
    digest: Option<String>,
    rides: Vec<Ride>,
}

/// Statistics of recordings and of folders of them (where corner cases are left out), checkpoint by
/// checkpoint in the order of their first rides. The reference is the first unless it is named. Blind
/// drives are all one, unless their checkpoints are to be revealed. Recordings do not say what decided how
/// much was driven.
pub fn of_recordings(
    paths: &[PathBuf],
    reference: Option<&str>,
    reveal: bool,
) -> anyhow::Result<Vec<CheckpointStatistics>> {
    of_sampled(paths, reference, reveal, Sampling::Unknown)
}

/// The same of all recordings of a campaign, of which that is known; the first checkpoint is the reference.
pub fn of_campaign(paths: &[PathBuf], sampling: Sampling) -> anyhow::Result<Vec<CheckpointStatistics>> {
    of_sampled(paths, None, false, sampling)
}

fn of_sampled(
    paths: &[PathBuf],
    reference: Option<&str>,
    reveal: bool,
    sampling: Sampling,
) -> anyhow::Result<Vec<CheckpointStatistics>> {
    let mut groups = group(&recordings(paths)?, reveal)?;
    tell_apart(&mut groups);
    let Some(first) = groups.first() else { bail!("no recording counts: all are drives to get used to the rig") };
    let name = reference.unwrap_or(&first.checkpoint);
    let names: Vec<_> = groups.iter().map(|g| g.checkpoint.as_str()).collect();
    let Some(at) = names.iter().position(|n| *n == name) else {
        return Err(Usage(format!("no recording is of {name:?}; expected one of {}", names.join(", "))).into());
    };
    let reference = Statistics::of(&groups[at].rides, sampling);
    let of = |(i, group): (usize, Group)| {
        let statistics = Statistics::of(&group.rides, sampling);
        let against_reference = (i != at).then(|| Comparison::of(&reference, &statistics));
        CheckpointStatistics { checkpoint: group.checkpoint, digest: group.digest, statistics, against_reference }
    };
    Ok(groups.into_iter().enumerate().map(of).collect())
}

/// The recordings among files and folders.
fn recordings(paths: &[PathBuf]) -> anyhow::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for path in paths {
        if !path.is_dir() {
            found.push(path.clone());
            continue;
        }
        let context = || path.display().to_string();
        let entries = std::fs::read_dir(path).with_context(context)?;
        let mut inside = entries.map(|e| e.map(|e| e.path())).collect::<Result<Vec<_>, _>>().with_context(context)?;
        inside.retain(|path| is_recording(path));
        if inside.is_empty() {
            bail!("{}: holds no recording; expected NAME.mcap", path.display());
        }
        inside.sort_by_cached_key(|path| turn(path));
        found.append(&mut inside);
    }
    Ok(found)
}

/// What recordings are sorted by: `drive.mcap`, `drive-2.mcap` ... `drive-10.mcap` were driven in this order.
fn turn(path: &Path) -> (String, u64) {
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let numbered = name.rsplit_once('-').and_then(|(stem, number)| Some((stem.to_owned(), number.parse().ok()?)));
    numbered.unwrap_or((name, 1))
}

fn is_recording(path: &Path) -> bool {
    let name = path.to_string_lossy();
    name.ends_with(".mcap") && !name.ends_with(".case.mcap")
}

/// Rides by checkpoint, in the order of their first recordings.
fn group(files: &[PathBuf], reveal: bool) -> anyhow::Result<Vec<Group>> {
    let mut groups: Vec<Group> = Vec::new();
    let mut known = BTreeSet::new();
    for path in files {
        let recording = Recording::open(path)?;
        let log = recording.log();
        if log.manifest.case.is_some() {
            bail!("{}: a corner case; expected the recording that it was cut from", path.display());
        }
        if log.manifest.provenance.contains_key("fork") {
            bail!("{}: a fork of aeye redrive, which nobody drove; expected recordings of drives", path.display());
        }
        if !known.insert(recording.digest()) {
            bail!("{}: the same recording was given before; expected each once", path.display());
        }
        let Some(ride) = Ride::of(&recording) else { continue };
        let told = study::tellable(&log.manifest.provenance, reveal);
        let digest = told.get("checkpoint_digest").cloned();
        let untold = if study::is_blind(&log.manifest.provenance) { BLIND } else { UNKNOWN };
        let checkpoint = told.get("checkpoint").cloned().unwrap_or_else(|| untold.into());
        match groups.iter_mut().find(|g| g.digest == digest && g.checkpoint == checkpoint) {
            Some(group) => group.rides.push(ride),
            None => groups.push(Group { checkpoint, digest, rides: vec![ride] }),
        }
    }
    Ok(groups)
}

/// Checkpoints of one name get the beginning of their digests.
fn tell_apart(groups: &mut [Group]) {
    let names: Vec<String> = groups.iter().map(|g| g.checkpoint.clone()).collect();
    for group in groups {
        let twins = names.iter().filter(|name| **name == group.checkpoint).count();
        if let Some(digest) = group.digest.as_ref().filter(|_| twins > 1) {
            group.checkpoint = format!("{}@{}", group.checkpoint, digest.get(..8).unwrap_or(digest));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_a_session_come_in_their_order() {
        let order = ["drive.mcap", "drive-2.mcap", "drive-10.mcap", "early-0002.mcap", "early-0010.mcap", "p-07.mcap"];
        let mut paths: Vec<PathBuf> = order.iter().rev().map(PathBuf::from).collect();
        paths.sort_by_cached_key(|path| turn(path));
        assert_eq!(paths, order.map(PathBuf::from));
    }
}
