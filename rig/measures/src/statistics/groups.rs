//! Rides by checkpoint.

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use base::failure::{Failed, Failure, Usage};
use base::json::Typed;
use base::library::{self, Entry, Found, Kind};
use base::spread::{collect_in_order, jobs};
use drivers::{external, recorded_eye};
use replay::Recording;
use serde::Serialize;

use super::{Comparison, Ride, Sampling, SetAside, Statistics};

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
    /// Runs that operators set aside, by why.
    pub set_aside: Vec<SetAside>,
}

/// The rides through one checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Its name; with the beginning of its digest where several have that name.
    pub checkpoint: String,
    digest: Option<String>,
    /// Those that count, in the order in which they were driven.
    pub rides: Vec<Ride>,
    /// Runs that operators set aside, by why; those that count are rides as well.
    pub set_aside: Vec<SetAside>,
}

impl Group {
    fn new(checkpoint: String, digest: Option<String>) -> Self {
        Self { checkpoint, digest, rides: Vec::new(), set_aside: Vec::new() }
    }

    fn add(&mut self, ride: Ride) {
        SetAside::add(&mut self.set_aside, &ride);
        if ride.counts() {
            self.rides.push(ride);
        }
    }
}

/// How the statistics are made.
#[derive(Clone, Copy, Debug, Default)]
pub struct Choice<'a> {
    /// The checkpoint that others are compared with; that of the first ride if none is named.
    pub reference: Option<&'a str>,
    /// Blind drives are all one, unless their checkpoints are to be revealed.
    pub reveal: bool,
    /// Recordings read at the same time.
    pub jobs: Option<u16>,
    /// What decided how much was driven; recordings do not say.
    pub sampling: Sampling,
}

/// Statistics, and what they leave out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatisticsOfAll {
    /// Those of each checkpoint.
    pub checkpoints: Vec<CheckpointStatistics>,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// What `aeye statistics` prints.
impl Typed for StatisticsOfAll {
    const TYPE: &'static str = "aeye.statistics";
}

/// Statistics of recordings and of those anywhere below folders (where corner cases and forks are left out),
/// checkpoint by checkpoint in the order of their first rides.
///
/// Which takeovers count `counts` says; others end their drive without a corner case.
pub fn of_recordings(
    paths: &[PathBuf],
    choice: Choice<'_>,
    counts: impl Fn(&Path, &Recording) -> bool + Sync,
) -> anyhow::Result<StatisticsOfAll> {
    let Found { files, mut failed } = library::find(paths, Kind::Drives);
    let (groups, unread) = group(&files, choice.reveal, choice.jobs, counts);
    failed.extend(unread);
    let Some(first) = groups.first() else {
        let why = Failed::check(&failed, 0).err();
        return Err(why.unwrap_or_else(|| anyhow!("no recording counts: all are drives to get used to the rig")));
    };
    let reference = choice.reference;
    let name = reference.unwrap_or(&first.checkpoint);
    let names: Vec<_> = groups.iter().map(|g| g.checkpoint.as_str()).collect();
    let Some(at) = names.iter().position(|n| *n == name) else {
        return Err(Usage(format!("no recording is of {name:?}; expected one of {}", names.join(", "))).into());
    };
    let reference = Statistics::of(&groups[at].rides, choice.sampling);
    let of = |(i, group): (usize, Group)| {
        let statistics = Statistics::of(&group.rides, choice.sampling);
        let against_reference = (i != at).then(|| Comparison::of(&reference, &statistics));
        let Group { checkpoint, digest, set_aside, .. } = group;
        CheckpointStatistics { checkpoint, digest, statistics, against_reference, set_aside }
    };
    Ok(StatisticsOfAll { checkpoints: groups.into_iter().enumerate().map(of).collect(), failed })
}

/// What is known of a ride.
struct Known {
    checkpoint: String,
    checkpoint_digest: Option<String>,
    /// None for a drive to get used to the rig.
    ride: Option<Ride>,
}

/// Rides by checkpoint, in the order of their first recordings, and the files that are none.
pub fn group(
    files: &[Entry],
    reveal: bool,
    threads: Option<u16>,
    counts: impl Fn(&Path, &Recording) -> bool + Sync,
) -> (Vec<Group>, Vec<Failure>) {
    let (mut groups, mut failed): (Vec<Group>, _) = (Vec::new(), Vec::new());
    let known = collect_in_order(jobs(threads), files.len(), |index| read(&files[index].path, reveal, &counts));
    for (Entry { path, .. }, known) in files.iter().zip(known) {
        match known {
            Ok(Known { ride: Some(ride), checkpoint, checkpoint_digest: digest }) => {
                let is_it = |group: &Group| group.digest == digest && group.checkpoint == checkpoint;
                let at = groups.iter().position(is_it).unwrap_or_else(|| {
                    groups.push(Group::new(checkpoint, digest));
                    groups.len() - 1
                });
                groups[at].add(ride);
            }
            Ok(_) => {}
            Err(error) => failed.push(Failure::new(path, &error)),
        }
    }
    tell_apart(&mut groups);
    (groups, failed)
}

fn read(path: &Path, reveal: bool, counts: impl Fn(&Path, &Recording) -> bool) -> anyhow::Result<Known> {
    let recording = Recording::open(path)?;
    let manifest = &recording.log().manifest;
    if manifest.case.is_some() {
        bail!("{}: a corner case; expected the recording that it was cut from", path.display());
    }
    if manifest.provenance.contains_key("fork") {
        bail!("{}: a fork of aeye redrive, which nobody drove; expected recordings of drives", path.display());
    }
    let told = study::tellable(&manifest.provenance, reveal);
    let untold = if study::is_blind(&manifest.provenance) { BLIND } else { UNKNOWN };
    let ride = Ride::of(&recording);
    let is_takeover = recording.log().intervention.is_some();
    let is_doubted = |ride: &Ride| ride.is_case && is_takeover && !counts(path, &recording);
    let counted = |ride: Ride| if is_doubted(&ride) { ride.uncounted() } else { ride };
    Ok(Known {
        checkpoint: told.get("checkpoint").cloned().unwrap_or_else(|| untold.into()),
        checkpoint_digest: recorded_eye::digest_of(&told),
        ride: ride.map(counted),
    })
}

/// Checkpoints of one name get the beginning of their digests, or their versions where no file holds them.
fn tell_apart(groups: &mut [Group]) {
    let names: Vec<String> = groups.iter().map(|g| g.checkpoint.clone()).collect();
    for group in groups {
        let twins = names.iter().filter(|name| **name == group.checkpoint).count();
        if let Some(digest) = group.digest.as_ref().filter(|_| twins > 1) {
            let short = digest.get(..8).unwrap_or(digest);
            let versioned = external::name_and_version(digest).map(str::to_owned);
            group.checkpoint = versioned.unwrap_or_else(|| format!("{}@{short}", group.checkpoint));
        }
    }
}
