//! A case as it is printed, from its rows.

use std::collections::HashSet;

use base::json::Typed;
use kernel::time::TICK_HZ;
use rusqlite::{Connection, Row, Statement};
use serde::Serialize;

use super::conditions;
use super::query::{Query, Sql};

/// A case of the library.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CaseLine {
    /// The file.
    pub file: String,
    /// What stays the same when the file is moved, cut or labelled again: digits of the recording's digest, and the tick.
    pub id: String,
    /// BLAKE3 of the file.
    pub digest: String,
    /// What it was labelled as.
    pub label: Option<String>,
    /// What was said about it.
    pub comment: Option<String>,
    /// Whether true masks avoid it; unknown where nobody tried.
    pub perception_caused: Option<bool>,
    /// Whether the takeover was `necessary`, `early`, `needless` or `in vain`, as a campaign has found out.
    pub verdict: Option<String>,
    /// Name of the checkpoint that was driven with; that of a blind drive is told only when asked for.
    pub checkpoint: Option<String>,
    /// Its digest, or `truth`.
    pub checkpoint_digest: Option<String>,
    /// Whether the drivers did not know the checkpoint.
    pub blind: bool,
    /// Name of the map.
    pub map: String,
    /// Digest of the map.
    pub map_digest: String,
    /// Seed of the run.
    pub seed: u64,
    /// Version of the kernel that made it.
    pub kernel: String,
    /// The name of the weather at the takeover, if it has one.
    pub weather: Option<String>,
    /// Of it: `rain`, `wet`, `fog`, `night`.
    pub conditions: Vec<&'static str>,
    /// Level of the hazards, or `own`.
    pub hazards: String,
    /// Tick of the takeover.
    pub tick: u64,
    /// The same as time of the run, seconds.
    pub time_s: f64,
    /// Speed of the ego car at the takeover, m/s.
    pub speed_mps: f64,
    /// Where it was: metres east and north on the map.
    pub position_m: Option<[f64; 2]>,
    /// Its direction, degrees counter-clockwise from east, -180 to 180.
    pub heading_deg: Option<f64>,
    /// Who was next ahead, up to 40 m.
    pub nearest: Option<String>,
    /// How far from the rear axle, metres.
    pub nearest_m: Option<f64>,
    /// Least time to collision within 10 s without the takeover, as a campaign has found out, seconds.
    pub fork_min_ttc_s: Option<f64>,
    /// What was measured of it by `--measure`.
    pub measured: Option<MeasuredLine>,
    /// What came of looking at it: `accepted`, `rejected` or `unclear`.
    pub review: Option<String>,
    /// Tags.
    pub tags: Vec<String>,
    /// Number of the group of cases that are near each other; it may differ after the next change of the library.
    pub situation: i64,
    /// From the case that is asked for with `--near`, metres.
    pub distance_m: Option<f64>,
    /// Where it is, as the index has it.
    #[serde(skip)]
    pub way: String,
}

/// A line of `aeye cases`, of a case.
impl Typed for CaseLine {
    const TYPE: &'static str = "aeye.cases.case";
}

/// What was measured of a case, by simulating and drawing it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasuredLine {
    /// Least time to collision, seconds.
    pub min_ttc_s: Option<f64>,
    /// Least predicted post-encroachment time, seconds.
    pub min_pret_s: Option<f64>,
    /// Greatest required deceleration, m/s^2.
    pub max_required_deceleration_mps2: Option<f64>,
    /// Post-encroachment time, seconds.
    pub pet_s: Option<f64>,
    /// Whom the takeover is about.
    pub hazard: Option<String>,
    /// Who was overlooked by the checkpoint of the drive, most pixels first.
    pub overlooked: Vec<OverlookedLine>,
}

/// Somebody who was overlooked: in a frame of the window, at least 8 pixels of them were visible and less than half of those
/// were predicted as what they are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct OverlookedLine {
    /// Kind and number, as in `pedestrian 12`.
    pub actor: String,
    /// Kind of road user.
    pub kind: String,
    /// In how many of the window's frames.
    pub frames: u32,
    /// Pixels of them that were predicted as something else in these frames.
    pub pixels: u32,
}

const COLUMNS: &str = "c.path, c.identity, c.digest, c.label, c.comment, c.perception_caused, c.verdict, c.checkpoint, \
     c.checkpoint_digest, c.blind, c.map, c.map_digest, c.seed, c.kernel, c.weather, c.conditions, c.hazards, c.tick, \
     c.speed_mps, c.x_m, c.y_m, c.ahead_x, c.ahead_y, c.nearest, c.nearest_m, c.fork_min_ttc_s, c.situation, m.engine, \
     m.min_ttc_s, m.min_pret_s, m.max_required_deceleration_mps2, m.pet_s, m.hazard, \
     (SELECT state FROM reviews r WHERE r.identity = c.identity) AS review";

/// The cases that a query asks for, in its order.
pub fn lines(db: &Connection, query: &Query, sql: &Sql, reveal: bool) -> rusqlite::Result<Vec<CaseLine>> {
    let mut case = db.prepare(&format!(
        "SELECT {COLUMNS} FROM cases c LEFT JOIN measured m ON m.digest = c.digest WHERE c.id = ?"
    ))?;
    let mut more = More {
        tags: db.prepare("SELECT tag FROM tags WHERE identity = ? ORDER BY tag")?,
        overlooked: db.prepare(
            "SELECT actor, kind, frames, pixels FROM overlooked WHERE digest = ? ORDER BY pixels DESC, actor",
        )?,
    };
    let line = |wanted: Wanted| {
        let line = case.query_row([wanted.id], |row| more.line(row, reveal))?;
        Ok(CaseLine { distance_m: wanted.distance2.map(f64::sqrt), ..line })
    };
    wanted(db, query, sql)?.into_iter().map(line).collect()
}

/// Of so many rows for each group that is asked for, one is mostly of another group.
const ROWS_A_GROUP: u32 = 8;

/// A case that is asked for.
struct Wanted {
    id: i64,
    /// Square of the distance, m^2.
    distance2: Option<f64>,
}

/// The cases that are asked for, in order. Rows are long: only their numbers are sorted, and of those that are not wanted
/// nothing else is read.
fn wanted(db: &Connection, query: &Query, sql: &Sql) -> rusqlite::Result<Vec<Wanted>> {
    if !query.unique {
        return Ok(first(db, query, sql, query.limit)?.0);
    }
    if let Some(limit) = query.limit {
        let few = limit.saturating_mul(ROWS_A_GROUP);
        let (found, rows) = first(db, query, sql, Some(few))?;
        if found.len() == limit as usize || rows < few {
            return Ok(found);
        }
    }
    Ok(first(db, query, sql, None)?.0)
}

/// Those among the first so many rows, of each group one where groups count once; and how many rows were seen.
fn first(db: &Connection, query: &Query, sql: &Sql, rows_asked: Option<u32>) -> rusqlite::Result<(Vec<Wanted>, u32)> {
    let mut order = db.prepare(&sql.select("c.id, c.situation", rows_asked))?;
    let mut rows = order.query(rusqlite::params_from_iter(sql.values()))?;
    let most = query.limit.map_or(usize::MAX, |limit| limit as usize);
    let (mut found, mut groups, mut seen) = (Vec::new(), Groups::default(), 0);
    while found.len() < most {
        let Some(row) = rows.next()? else { break };
        seen += 1;
        if !query.unique || groups.is_new(row.get("situation")?) {
            found.push(Wanted { id: row.get("id")?, distance2: row.get("distance2")? });
        }
    }
    Ok((found, seen))
}

/// How many cases a query asks for.
pub fn count(db: &Connection, query: &Query, sql: &Sql) -> rusqlite::Result<u64> {
    let values = rusqlite::params_from_iter(sql.values());
    let count = if query.unique {
        let (mut statement, mut groups) = (db.prepare(&sql.groups())?, Groups::default());
        let mut rows = statement.query(values)?;
        let mut count = 0;
        while let Some(row) = rows.next()? {
            count += u64::from(groups.is_new(row.get(0)?));
        }
        count
    } else {
        db.query_row(&sql.count(), values, |row| row.get::<_, i64>(0))? as u64
    };
    Ok(query.limit.map_or(count, |limit| count.min(limit.into())))
}

/// Groups of cases that have been seen.
#[derive(Default)]
struct Groups(HashSet<i64>);

impl Groups {
    /// Whether a case is the first of its group. Where a scan was interrupted, new cases have no group yet: it is 0.
    fn is_new(&mut self, group: i64) -> bool {
        group == 0 || self.0.insert(group)
    }
}

/// Lays down the places of the only cases that are meant, instead of the last; gives those that are not there.
pub fn want<'a>(db: &Connection, places: impl Iterator<Item = &'a str>) -> rusqlite::Result<HashSet<String>> {
    db.execute_batch(
        "CREATE TEMP TABLE IF NOT EXISTS wanted (place TEXT PRIMARY KEY) WITHOUT ROWID; DELETE FROM temp.wanted",
    )?;
    let mut insert = db.prepare("INSERT OR IGNORE INTO temp.wanted VALUES (?)")?;
    for place in places {
        insert.execute([place])?;
    }
    let mut missing = db.prepare("SELECT place FROM temp.wanted WHERE place NOT IN (SELECT place FROM cases)")?;
    missing.query_map([], |row| row.get(0))?.collect()
}

/// What stands in other tables.
struct More<'a> {
    tags: Statement<'a>,
    overlooked: Statement<'a>,
}

impl More<'_> {
    fn line(&mut self, row: &Row<'_>, reveal: bool) -> rusqlite::Result<CaseLine> {
        let (identity, digest, tick): (String, Vec<u8>, i64) =
            (row.get("identity")?, row.get("digest")?, row.get("tick")?);
        let blind: bool = row.get("blind")?;
        let is_told = reveal || !blind;
        let position: (Option<f64>, Option<f64>) = (row.get("x_m")?, row.get("y_m")?);
        let ahead: (Option<f64>, Option<f64>) = (row.get("ahead_x")?, row.get("ahead_y")?);
        let tags = self.tags.query_map([&identity], |row| row.get(0))?.collect::<rusqlite::Result<_>>()?;
        Ok(CaseLine {
            file: String::new(),
            way: row.get("path")?,
            id: identity,
            measured: self.measured(row, &digest)?,
            digest: hex(&digest),
            label: row.get("label")?,
            comment: row.get("comment")?,
            perception_caused: row.get("perception_caused")?,
            verdict: row.get("verdict")?,
            checkpoint: row.get::<_, Option<String>>("checkpoint")?.filter(|_| is_told),
            checkpoint_digest: row.get::<_, Option<String>>("checkpoint_digest")?.filter(|_| is_told),
            blind,
            map: row.get("map")?,
            // As every other place has it: as a number, the highest byte first.
            map_digest: hex(&row.get::<_, Vec<u8>>("map_digest")?.into_iter().rev().collect::<Vec<_>>()),
            seed: row.get::<_, i64>("seed")? as u64,
            kernel: row.get("kernel")?,
            weather: row.get("weather")?,
            conditions: conditions::names(row.get("conditions")?),
            hazards: row.get("hazards")?,
            tick: tick as u64,
            time_s: tick as f64 / f64::from(TICK_HZ),
            speed_mps: row.get("speed_mps")?,
            position_m: position.0.zip(position.1).map(|(x, y)| [x, y]),
            heading_deg: ahead.0.zip(ahead.1).map(|(x, y)| y.atan2(x).to_degrees()),
            nearest: row.get("nearest")?,
            nearest_m: row.get("nearest_m")?,
            fork_min_ttc_s: row.get("fork_min_ttc_s")?,
            review: row.get("review")?,
            tags,
            situation: row.get("situation")?,
            distance_m: None,
        })
    }

    fn measured(&mut self, row: &Row<'_>, digest: &[u8]) -> rusqlite::Result<Option<MeasuredLine>> {
        if row.get::<_, Option<String>>("engine")?.is_none() {
            return Ok(None);
        }
        let overlooked = self.overlooked.query_map([digest], |row| {
            Ok(OverlookedLine { actor: row.get(0)?, kind: row.get(1)?, frames: row.get(2)?, pixels: row.get(3)? })
        })?;
        Ok(Some(MeasuredLine {
            min_ttc_s: row.get("min_ttc_s")?,
            min_pret_s: row.get("min_pret_s")?,
            max_required_deceleration_mps2: row.get("max_required_deceleration_mps2")?,
            pet_s: row.get("pet_s")?,
            hazard: row.get("hazard")?,
            overlooked: overlooked.collect::<rusqlite::Result<_>>()?,
        }))
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
