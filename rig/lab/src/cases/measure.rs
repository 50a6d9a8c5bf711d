//! Measures cases that were not measured before, and keeps what it finds as it goes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use anyhow::bail;
use base::failure::Failure;
use base::progress::{self, Interrupt};
use base::spread::{collect_in_order, jobs};
use drivers::checkpoint::CheckpointChoice;
use drivers::recorded_eye::RecordedEye;
use drivers::vision;
use measures::criticality::{Extreme, Extremes};
use replay::CaseHeader;
use rusqlite::{Connection, params};

use super::index::Index;
use super::line::OverlookedLine;
use super::look::{Looking, Measured};
use super::query::Sql;
use crate::pipeline::{Pipeline, Studios};

/// A case that is to be measured.
#[derive(Clone, Debug)]
pub struct Due {
    /// Its file.
    pub path: PathBuf,
    /// What it is called.
    pub shown: PathBuf,
    /// BLAKE3 of it.
    pub digest: [u8; 32],
}

/// Of the cases that are asked for, way and digest of those that these programs have not measured.
pub fn due(db: &Connection, sql: &Sql, engine: &str) -> rusqlite::Result<Vec<(String, [u8; 32])>> {
    let mut statement = db.prepare(&sql.select("c.path, c.digest, m.engine", None))?;
    let mut rows = statement.query(rusqlite::params_from_iter(sql.values()))?;
    let mut due = Vec::new();
    while let Some(row) = rows.next()? {
        if row.get::<_, Option<String>>(2)?.as_deref() != Some(engine) {
            due.push((row.get(0)?, row.get(1)?));
        }
    }
    Ok(due)
}

/// Everything that what is measured follows from, beside the case and the checkpoint that it names.
pub fn engine() -> anyhow::Result<String> {
    let (kernel, renderer, adapter) = (kernel::identity(), render::identity(), vision::find_adapter()?);
    Ok(format!("{} {kernel} {renderer} {adapter}", env!("CARGO_PKG_VERSION")))
}

/// Measures cases; gives how many, and those that could not be.
pub fn measure(
    index: &mut Index,
    due: &[Due],
    engine: &str,
    recorded: &[CheckpointChoice],
    (asked, interrupt): (Option<u16>, &Interrupt),
) -> anyhow::Result<(usize, Vec<Failure>)> {
    let jobs = jobs(asked);
    let (groups, mut failed) = by_eye(due, jobs);
    let bar = progress::bar("cases", due.len() as u64);
    let (index, mut measured) = (Mutex::new(index), 0);
    for (eye, numbers) in groups.into_values() {
        let camera = eye.camera;
        let Some(eye) = eye.find(recorded)? else {
            let sentence = || anyhow::anyhow!(eye.not_found("--recorded-checkpoint"));
            failed.extend(numbers.iter().map(|number| Failure::new(&due[*number].shown, &sentence())));
            continue;
        };
        let files: Vec<PathBuf> = numbers.iter().map(|number| due[*number].path.clone()).collect();
        let keep = |number: usize, found: Measured| {
            let digest = &due[numbers[number]].digest;
            index.lock().unwrap_or_else(PoisonError::into_inner).write(|db| put(db, digest, engine, &found))
        };
        let (work, all): (_, Vec<usize>) = (Looking { files: &files, keep, bar: &bar }, (0..files.len()).collect());
        let eyes = [eye];
        let (size, studios) = ((camera.width, camera.height), Studios::new(camera.imaging()));
        let pipeline = Pipeline { work: &work, files: &all, size, eyes: &eyes, jobs, interrupt, studios };
        let (_, unread) = pipeline.run()?;
        if interrupt.is_raised() {
            bail!("interrupted; the same command goes on from there");
        }
        measured += files.len() - unread.len();
        failed.extend(unread.iter().map(|(number, error)| Failure::new(&due[numbers[*number]].shown, error)));
    }
    bar.finish_and_clear();
    Ok((measured, failed))
}

/// Which cases were driven through which eye, by its digest and its camera in words.
type Groups = BTreeMap<(String, String), (RecordedEye, Vec<usize>)>;

/// Numbers of the cases by the eye that they were driven through, and those that do not say.
fn by_eye(due: &[Due], jobs: usize) -> (Groups, Vec<Failure>) {
    let read = |number: usize| -> anyhow::Result<RecordedEye> {
        RecordedEye::of(&CaseHeader::open(&due[number].path)?.manifest.provenance)
    };
    let (mut groups, mut failed) = (Groups::new(), Vec::new());
    for (number, eye) in collect_in_order(jobs, due.len(), read).into_iter().enumerate() {
        match eye {
            Ok(eye) => {
                let key = (eye.digest.clone(), vision::camera_text(&eye.camera));
                groups.entry(key).or_insert((eye, Vec::new())).1.push(number);
            }
            Err(error) => failed.push(Failure::new(&due[number].shown, &error)),
        }
    }
    (groups, failed)
}

/// Keeps what was found out about a file, in the place of what was known.
pub(super) fn put(db: &Connection, digest: &[u8; 32], engine: &str, found: &Measured) -> rusqlite::Result<()> {
    let Measured { extremes, hazard, overlooked } = found;
    let worst = |of: fn(&Extremes) -> &Option<Extreme>| Some(of(extremes.as_ref()?).as_ref()?.value);
    let most = overlooked.iter().map(|line| line.pixels).max().unwrap_or_default();
    db.execute("DELETE FROM overlooked WHERE digest = ?", params![digest])?;
    db.execute(
        "INSERT OR REPLACE INTO measured VALUES (?, ?, ?, ?, ?, ?, ?, ?)",
        params![
            digest,
            engine,
            worst(|extremes| &extremes.min_ttc_s),
            worst(|extremes| &extremes.min_pret_s),
            worst(|extremes| &extremes.max_required_deceleration_mps2),
            worst(|extremes| &extremes.pet_s),
            hazard,
            most,
        ],
    )?;
    for OverlookedLine { actor, kind, frames, pixels } in overlooked {
        let values = params![digest, actor, kind, frames, pixels];
        db.execute("INSERT OR REPLACE INTO overlooked VALUES (?, ?, ?, ?, ?)", values)?;
    }
    Ok(())
}
