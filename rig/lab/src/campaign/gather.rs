//! The runs of shards, as one process would have counted them.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use anyhow::bail;
use base::files::{self, most};
use base::maps::Map;
use base::spread::collect_in_order;
use drivers::recorded_eye;
use replay::{ForeignMap, Recording};

use super::kept;
use super::places::Places;
use super::plan::seed_of;
use super::run_line::RunLine;
use super::shard::{Named, Shard};
use super::shards::Placed;
use super::sum::Driven;
use super::until::Goal;

/// The runs that count.
#[derive(Default)]
pub struct Gathered {
    /// What is kept of them, checkpoint by checkpoint.
    pub driven: Vec<Driven>,
    /// Their files, in the same order.
    pub files: Vec<RunFiles>,
    /// Numbers of those that are not there, by checkpoint.
    pub missing: Vec<(String, Vec<u32>)>,
}

/// The files of a run.
pub struct RunFiles {
    /// Where they are.
    pub places: Places,
    /// Of the foreign map that it was driven on, which may have to be beside them.
    pub map: Option<ForeignMap>,
}

/// A run that is there.
struct Found {
    line: RunLine,
    files: RunFiles,
}

/// Maps that recordings name, by their digests: foreign ones take long to read.
#[derive(Default)]
struct Maps(Mutex<BTreeMap<u128, Map>>);

/// Reads runs until the goal is met: so many at the same time, and none with a number from `end` on.
pub fn gather(shards: &[Placed], goal: Goal, end: u32, jobs: usize) -> anyhow::Result<Gathered> {
    let (mut gathered, maps) = (Gathered::default(), Maps::default());
    for checkpoint in shards.first().iter().flat_map(|first| &first.shard.plan.checkpoints) {
        let read = |run| read(shards, checkpoint, run, &maps);
        let each = collect_in_order(jobs, end as usize, |run| read(run as u32));
        let (mut runs, mut missing) = (Vec::new(), Vec::new());
        for (run, found) in (0..end).zip(each) {
            if goal.until.is_met(&runs) {
                break;
            }
            match found? {
                Some(Found { line, files }) => {
                    runs.push(line);
                    gathered.files.push(files);
                }
                None => missing.push(run),
            }
        }
        let name = &checkpoint.name;
        gathered.driven.push(Driven { checkpoint: name.clone(), runs });
        if !missing.is_empty() {
            gathered.missing.push((name.clone(), missing));
        }
    }
    Ok(gathered)
}

/// A run through a checkpoint, of the first of its shards that has it; another one must have the same.
fn read(shards: &[Placed], checkpoint: &Named, run: u32, maps: &Maps) -> anyhow::Result<Option<Found>> {
    let mut found: Option<Found> = None;
    for placed in shards.iter().filter(|placed| placed.shard.share.has(run)) {
        let places = Places::new(&placed.folder, &checkpoint.name, run);
        let Some((recording, line)) = kept::read(&checkpoint.name, &places, |of| Ok(maps.of(of)?.network))? else {
            continue;
        };
        check_run(&placed.shard, checkpoint, run, (&recording, &places))?;
        match &found {
            Some(found) => check_same((&found.files.places, &found.line), (&places, &line))?,
            None => found = Some(Found { line, files: RunFiles { places, map: maps.of(&recording)?.foreign } }),
        }
    }
    Ok(found)
}

impl Maps {
    fn of(&self, recording: &Recording) -> anyhow::Result<Map> {
        let manifest = &recording.log().manifest;
        let known = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(map) = known().get(&manifest.map_digest) {
            return Ok(map.clone());
        }
        let map = Map { network: recording.network()?, foreign: manifest.foreign_map.clone(), path: None };
        known().insert(manifest.map_digest, map.clone());
        Ok(map)
    }
}

/// Refuses a recording that its shard did not drive.
fn check_run(
    shard: &Shard,
    checkpoint: &Named,
    run: u32,
    (recording, places): (&Recording, &Places),
) -> anyhow::Result<()> {
    let manifest = &recording.log().manifest;
    let says = |name: &str| manifest.provenance.get(name);
    let is_its = manifest.scenario.seed == seed_of(shard.plan.seed, run)
        && recorded_eye::digest_of(&manifest.provenance).as_ref() == Some(&checkpoint.digest)
        && shard.machines.iter().any(|machine| says("adapter") == Some(&machine.adapter));
    if !is_its {
        bail!("{}: belongs to another campaign; expected run {run} of the shard's", places.recording.display());
    }
    Ok(())
}

/// Refuses a run that two shards drove differently.
fn check_same(one: (&Places, &RunLine), another: (&Places, &RunLine)) -> anyhow::Result<()> {
    for (one, another) in one.0.of(one.1).zip(another.0.of(another.1)) {
        if files::read(one, most::RECORDING)? != files::read(another, most::RECORDING)? {
            bail!("{}: differs from {}; expected the same run of both", another.display(), one.display());
        }
    }
    Ok(())
}
