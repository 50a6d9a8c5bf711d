//! Rows of cases: written when a file has been read, grouped when all of them have.

use std::collections::{HashMap, HashSet};

use replay::Label;
use rusqlite::{Connection, OptionalExtension, Row, Statement, Transaction, params};

use super::facts::Facts;
use super::situation::{Situation, Spot, groups};

/// A file of a case, as the index knows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// What changes whenever the file does.
    pub stamp: String,
    /// Its sentence, of a file that cannot be read.
    pub error: Option<String>,
}

/// What the index knows of the files below a folder, by their places in the order of all.
pub fn known(db: &Connection, within: &Within) -> rusqlite::Result<HashMap<String, Known>> {
    let mut all = HashMap::new();
    for (table, error) in [("cases", "NULL"), ("broken", "error")] {
        let (condition, bounds) = within.condition();
        let mut statement = db.prepare(&format!("SELECT place, stamp, {error} FROM {table} WHERE {condition}"))?;
        let mut rows = statement.query(rusqlite::params_from_iter(&bounds))?;
        while let Some(row) = rows.next()? {
            all.insert(row.get(0)?, Known { stamp: row.get(1)?, error: row.get(2)? });
        }
    }
    Ok(all)
}

/// A folder whose files are meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Within {
    /// Everything that lies below the index's own folder: ways to others begin with a slash.
    Home,
    /// What lies below another: what places there begin with.
    Folder(String),
}

impl Within {
    /// The folder to which the keys of all files below begin with this.
    pub fn of(order: String) -> Self {
        if order.is_empty() { Self::Home } else { Self::Folder(order) }
    }

    /// A condition on `place`, and its values.
    pub fn condition(&self) -> (&'static str, Vec<String>) {
        match self {
            // A slash is followed by a zero among characters. Said so that no search by index is made of what most rows are.
            Self::Home => ("NOT (place >= '/' AND place < '0')", Vec::new()),
            // No character of a name stands between both.
            Self::Folder(begin) => {
                let end = begin.trim_end_matches('\u{1}').to_owned() + "\u{2}";
                ("(place >= ? AND place < ?)", vec![begin.clone(), end])
            }
        }
    }
}

/// Writes rows of files.
pub struct Writer<'a> {
    case: Statement<'a>,
    broken: Statement<'a>,
    no_case: Statement<'a>,
    stale: Statement<'a>,
    whole: Statement<'a>,
}

impl<'a> Writer<'a> {
    /// Into an index that is being changed.
    pub fn new(db: &'a Transaction<'_>) -> rusqlite::Result<Self> {
        Ok(Self {
            case: db.prepare(
                "INSERT OR REPLACE INTO cases (place, path, stamp, copy, situation, label, perception_caused, verdict, \
                 map, weather, conditions, hazards, checkpoint, blind, tick, speed_mps, fork_min_ttc_s, x_m, y_m, \
                 ahead_x, ahead_y, nearest, nearest_m, map_digest, digest, identity, checkpoint_digest, seed, kernel, \
                 comment) SELECT ?1, ?2, ?3, 0, 0, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ? \
                 WHERE NOT EXISTS (SELECT 1 FROM cases WHERE place = ?1 AND stamp = ?3)",
            )?,
            broken: db.prepare("INSERT OR REPLACE INTO broken (place, path, stamp, error) VALUES (?, ?, ?, ?)")?,
            no_case: db.prepare("DELETE FROM cases WHERE place = ?")?,
            stale: db.prepare(
                "UPDATE cases SET situation = 0 WHERE id = (SELECT id FROM cases WHERE copy = 0 LIMIT 1)",
            )?,
            whole: db.prepare("DELETE FROM broken WHERE place = ?")?,
        })
    }

    /// A file and what is known of it. Where another process wrote that meanwhile, its group is known, too, and stays.
    pub fn case(&mut self, (place, path, stamp): (&str, &str, &str), facts: &Facts) -> rusqlite::Result<()> {
        let spot = facts.spot.as_ref();
        self.whole.execute([place])?;
        self.case.execute(params![
            place,
            path,
            stamp,
            facts.label.map(Label::name),
            facts.perception_caused,
            facts.verdict.map(|verdict| verdict.name()),
            facts.map,
            facts.weather,
            facts.conditions,
            facts.hazards,
            facts.checkpoint,
            facts.blind,
            facts.tick as i64,
            facts.speed_mps,
            facts.fork_min_ttc_s,
            spot.map(|spot| spot.x_m),
            spot.map(|spot| spot.y_m),
            spot.map(|spot| spot.ahead_x),
            spot.map(|spot| spot.ahead_y),
            facts.nearest.map(|(kind, _)| kind),
            facts.nearest.map(|(_, m)| m),
            facts.map_digest,
            facts.digest,
            facts.identity,
            facts.checkpoint_digest,
            // All 64 bits: numbers of the database have a sign.
            facts.seed as i64,
            facts.kernel,
            facts.comment,
        ])?;
        Ok(())
    }

    /// A file that cannot be read.
    pub fn broken(&mut self, (place, path, stamp): (&str, &str, &str), error: &str) -> rusqlite::Result<()> {
        self.no_case(place)?;
        self.broken.execute(params![place, path, stamp, error])?;
        Ok(())
    }

    /// A file that is no longer there.
    pub fn gone(&mut self, place: &str) -> rusqlite::Result<()> {
        self.no_case(place)?;
        self.whole.execute([place])?;
        Ok(())
    }

    /// Others may have been copies of it, or in its group: [`regroup`] is due.
    fn no_case(&mut self, place: &str) -> rusqlite::Result<()> {
        if self.no_case.execute([place])? > 0 {
            self.stale.execute([])?;
        }
        Ok(())
    }
}

/// What a row says of its situation; nothing where nobody knows the place.
pub fn situation(row: &Row<'_>) -> rusqlite::Result<Option<Situation>> {
    let (x_m, y_m, ahead_x, ahead_y): (Option<f64>, Option<f64>, Option<f64>, Option<f64>) =
        (row.get("x_m")?, row.get("y_m")?, row.get("ahead_x")?, row.get("ahead_y")?);
    let (Some(x_m), Some(y_m), Some(ahead_x), Some(ahead_y)) = (x_m, y_m, ahead_x, ahead_y) else { return Ok(None) };
    Ok(Some(Situation {
        map_digest: row.get("map_digest")?,
        label: row.get("label")?,
        nearest: row.get("nearest")?,
        spot: Spot { x_m, y_m, ahead_x, ahead_y },
        speed_mps: row.get("speed_mps")?,
    }))
}

/// The situation of the case at a place, as the index knows it, and which case it is.
pub fn situation_at(db: &Connection, place: &str) -> rusqlite::Result<Option<(Situation, String)>> {
    let read = |row: &Row<'_>| Ok((situation(row)?, row.get("identity")?));
    let found = db.query_row("SELECT * FROM cases WHERE place = ?", [place], read).optional()?;
    Ok(found.and_then(|(situation, identity)| Some((situation?, identity))))
}

/// A row, as far as it is compared with all others.
struct Compared {
    id: i64,
    group: i64,
    is_copy: bool,
    identity: String,
    situation: Option<Situation>,
}

/// Says of every case whether it is a copy of one before it, and which cases are near each other. That follows from all
/// cases, in the order of their places.
pub fn regroup(db: &Transaction<'_>) -> rusqlite::Result<()> {
    let mut statement = db.prepare(
        "SELECT id, situation, copy, identity, map_digest, label, nearest, x_m, y_m, ahead_x, ahead_y, speed_mps \
         FROM cases ORDER BY place",
    )?;
    let read = |row: &Row<'_>| {
        let (id, group, is_copy, identity) = (row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?);
        Ok(Compared { id, group, is_copy, identity, situation: situation(row)? })
    };
    let all: Vec<Compared> = statement.query_map([], read)?.collect::<rusqlite::Result<_>>()?;
    let mut seen = HashSet::new();
    let (firsts, copies): (Vec<&Compared>, Vec<&Compared>) = all.iter().partition(|row| seen.insert(&row.identity));
    let groups = groups(firsts.iter().map(|row| row.situation.as_ref()));
    let group_of: HashMap<&str, i64> =
        firsts.iter().zip(groups).map(|(row, first)| (row.identity.as_str(), firsts[first].id)).collect();
    let mut update = db.prepare("UPDATE cases SET situation = ?, copy = ? WHERE id = ?")?;
    let all = firsts.iter().map(|row| (row, false)).chain(copies.iter().map(|row| (row, true)));
    for (row, is_copy) in all {
        let group = group_of[row.identity.as_str()];
        if (row.group, row.is_copy) != (group, is_copy) {
            update.execute(params![group, is_copy, row.id])?;
        }
    }
    Ok(())
}
