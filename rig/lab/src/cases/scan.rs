//! Brings an index up to date with the folders that it is about: only files that changed are read.

use std::collections::HashMap;
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use anyhow::{Context, bail};
use base::failure::{Failure, sentence};
use base::library::{self, Kind};
use base::progress::{self, Interrupt};
use base::say::say;
use base::spread::{in_order, jobs};

use super::facts::Facts;
use super::given::Given;
use super::index::Index;
use super::rows::{self, Known, Within, Writer};
use super::schema;
use crate::redrive::Counterfactual;

/// Files that are written in one step; an interruption loses no more than these.
const BATCH: usize = 1000;

/// What a scan came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scanned {
    /// Files that were read.
    pub read: usize,
    /// Files that are as they were.
    pub kept: usize,
    /// Files that were there and are not.
    pub gone: usize,
    /// Files that are no cases, or cannot be read, and why.
    pub failed: Vec<Failure>,
}

/// A file that was found.
struct Found {
    path: PathBuf,
    /// What it is called.
    shown: String,
    place: String,
    /// As the index has it.
    way: String,
    stamp: String,
}

impl Found {
    /// Why it is left out, as the index has it.
    fn failure(&self, error: &str) -> Failure {
        let file = self.shown.clone();
        Failure { error: format!("{file}: {error}"), file, is_divergence: false }
    }
}

/// What was made of a file.
enum Seen {
    Case(Box<Facts>),
    Broken(String),
    /// An export for viewers, which is passed over.
    Export,
}

/// Takes in what a folder holds now.
pub fn scan(index: &mut Index, folder: &Given, asked: Option<u16>, interrupt: &Interrupt) -> anyhow::Result<Scanned> {
    let within = Within::of(library::order_below(index.way_to(folder.whole())));
    let mut known = index.read(|db| rows::known(db, &within))?;
    let mut scanned = Scanned::default();
    let mut changed = Vec::new();
    for path in library::walk(folder.whole(), Kind::Cases)? {
        match found(index, folder, path) {
            Ok(found) => match known.remove(&found.place) {
                Some(Known { stamp, error }) if stamp == found.stamp => match error {
                    None => scanned.kept += 1,
                    Some(error) => scanned.failed.push(found.failure(&error)),
                },
                _ => changed.push(found),
            },
            Err(failure) => scanned.failed.push(failure),
        }
    }
    changed.sort_unstable_by(|a, b| a.place.cmp(&b.place));
    read(index, &changed, &mut scanned, (jobs(asked), interrupt))?;
    scanned.gone = known.len();
    if !(known.is_empty() && changed.is_empty()) || index.read(schema::is_stale)? {
        tidy_up(index, &known)?;
    }
    Ok(scanned)
}

/// What the system tells of a file.
fn found(index: &Index, folder: &Given, path: PathBuf) -> Result<Found, Failure> {
    let shown = folder.shown(&path);
    let of = |path: &Path| {
        let metadata = path.metadata()?;
        if !metadata.is_file() {
            bail!("is no regular file; expected a corner case");
        }
        let way = index.way_to(path);
        let text = way.to_str().context("its name is not UTF-8; expected one that is")?;
        let beside = Counterfactual::place(path).metadata().ok();
        let stamp = format!("{} {}", stamp(&metadata), beside.as_ref().map(stamp).unwrap_or_default());
        Ok((library::order(way), text.to_owned(), stamp))
    };
    match of(&path) {
        Ok((place, way, stamp)) => Ok(Found { shown: shown.display().to_string(), path, place, way, stamp }),
        Err(error) => Err(Failure::new(&shown, &error)),
    }
}

/// Length, and time of the last change in nanoseconds.
fn stamp(metadata: &Metadata) -> String {
    let changed = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    format!("{} {}", metadata.len(), changed.unwrap_or_default().as_nanos())
}

/// Reads files on several threads, and writes what they say in steps.
fn read(
    index: &mut Index,
    files: &[Found],
    scanned: &mut Scanned,
    (jobs, interrupt): (usize, &Interrupt),
) -> anyhow::Result<()> {
    let bar = progress::bar("cases", files.len() as u64);
    let mut batch = Vec::with_capacity(BATCH);
    let look = |number: usize| (!interrupt.is_raised()).then(|| seen(&files[number].path));
    in_order(jobs, files.len(), look, |number, seen| {
        if let Some(seen) = seen {
            batch.push((&files[number], seen));
        }
        let is_over = interrupt.is_raised() || number + 1 == files.len();
        if batch.len() == BATCH || is_over {
            let count = batch.len();
            write(index, std::mem::take(&mut batch), scanned)?;
            bar.inc(count as u64);
        }
        if interrupt.is_raised() {
            bail!("{}: interrupted; the same command goes on from there", index.path().display());
        }
        Ok(())
    })?;
    bar.finish_and_clear();
    Ok(())
}

fn seen(path: &Path) -> Seen {
    match Facts::read(path) {
        Ok(facts) => Seen::Case(Box::new(facts)),
        Err(_) if library::is_export(path) => Seen::Export,
        // Without the file's name, which may come to be another.
        Err(error) => {
            let said = sentence(&error);
            Seen::Broken(said.strip_prefix(&format!("{}: ", path.display())).unwrap_or(&said).to_owned())
        }
    }
}

fn write(index: &mut Index, batch: Vec<(&Found, Seen)>, scanned: &mut Scanned) -> anyhow::Result<()> {
    index.write(|db| {
        let mut writer = Writer::new(db)?;
        for (file, seen) in &batch {
            let at = (file.place.as_str(), file.way.as_str(), file.stamp.as_str());
            match seen {
                Seen::Case(facts) => writer.case(at, facts)?,
                Seen::Broken(error) => writer.broken(at, error)?,
                Seen::Export => writer.gone(&file.place)?,
            }
        }
        Ok(())
    })?;
    for (file, seen) in batch {
        match seen {
            Seen::Case(_) => scanned.read += 1,
            Seen::Broken(error) => scanned.failed.push(file.failure(&error)),
            Seen::Export => say(format_args!("{}: left out, an export of aeye for viewers", file.shown)),
        }
    }
    Ok(())
}

/// Drops what is gone, and brings up to date what follows from all cases together.
fn tidy_up(index: &mut Index, gone: &HashMap<String, Known>) -> anyhow::Result<()> {
    index.write(|db| {
        let mut writer = Writer::new(db)?;
        gone.keys().try_for_each(|place| writer.gone(place))?;
        rows::regroup(db)
    })
}
