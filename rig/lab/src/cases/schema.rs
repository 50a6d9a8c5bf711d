//! The tables of an index, and how it is told from any other file.

use rusqlite::config::DbConfig;
use rusqlite::{Connection, OptionalExtension, Transaction};

/// What SQLite's header says of whose file it is: `AEYE`.
const APPLICATION: i32 = 0x4145_5945;
/// Raised with every change of the tables.
const VERSION: i32 = 2;

/// A case is a row of `cases` for each file that holds it, of which the first counts and the others are copies. What was
/// measured belongs to the bytes of a file (`digest`), what people said to the case (`identity`), wherever its file is.
const TABLES: [&str; 14] = [
    "CREATE TABLE cases (\
     id INTEGER PRIMARY KEY, place TEXT NOT NULL UNIQUE, path TEXT NOT NULL, stamp TEXT NOT NULL, \
     copy INTEGER NOT NULL, situation INTEGER NOT NULL, \
     label TEXT, perception_caused INTEGER, verdict TEXT, map TEXT NOT NULL, weather TEXT, conditions INTEGER NOT NULL, \
     hazards TEXT NOT NULL, checkpoint TEXT, blind INTEGER NOT NULL, tick INTEGER NOT NULL, speed_mps REAL NOT NULL, \
     fork_min_ttc_s REAL, x_m REAL, y_m REAL, ahead_x REAL, ahead_y REAL, nearest TEXT, nearest_m REAL, \
     map_digest BLOB NOT NULL, digest BLOB NOT NULL, identity TEXT NOT NULL, checkpoint_digest TEXT, \
     seed INTEGER NOT NULL, kernel TEXT NOT NULL, comment TEXT) STRICT",
    // What most queries read, in the order in which they give it, instead of the long rows of the table.
    "CREATE INDEX cases_in_order ON cases (\
     place, copy, situation, label, perception_caused, verdict, map, weather, conditions, hazards, checkpoint, blind, \
     speed_mps, fork_min_ttc_s)",
    // What likeness is told by.
    "CREATE INDEX cases_by_spot ON cases (\
     map_digest, x_m, y_m, ahead_x, ahead_y, speed_mps, label, nearest, place, copy, situation)",
    "CREATE INDEX cases_by_situation ON cases (situation)",
    "CREATE INDEX cases_by_digest ON cases (digest)",
    "CREATE INDEX cases_by_identity ON cases (identity)",
    "CREATE TABLE broken (place TEXT PRIMARY KEY, path TEXT NOT NULL, stamp TEXT NOT NULL, error TEXT NOT NULL) \
     STRICT, WITHOUT ROWID",
    "CREATE TABLE measured (\
     digest BLOB PRIMARY KEY, engine TEXT NOT NULL, min_ttc_s REAL, min_pret_s REAL, \
     max_required_deceleration_mps2 REAL, pet_s REAL, hazard TEXT, overlooked_px INTEGER NOT NULL) STRICT, WITHOUT ROWID",
    "CREATE INDEX measured_by_ttc ON measured (min_ttc_s)",
    "CREATE TABLE overlooked (\
     digest BLOB NOT NULL, actor TEXT NOT NULL, kind TEXT NOT NULL, frames INTEGER NOT NULL, pixels INTEGER NOT NULL, \
     PRIMARY KEY (digest, actor)) STRICT, WITHOUT ROWID",
    "CREATE INDEX overlooked_by_kind ON overlooked (kind, pixels)",
    "CREATE TABLE reviews (identity TEXT PRIMARY KEY, state TEXT NOT NULL) STRICT, WITHOUT ROWID",
    "CREATE TABLE tags (identity TEXT NOT NULL, tag TEXT NOT NULL, PRIMARY KEY (identity, tag)) STRICT, WITHOUT ROWID",
    "CREATE INDEX tags_by_name ON tags (tag)",
];

/// Bytes of a page of the file: a query reads most of a table of 100,000 cases, 36 MB, each page by a call of its own.
const PAGE_BYTES: u32 = 32_768;

/// What a database is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// Empty, as a new file is.
    Nothing,
    /// An index of this version.
    Index,
    /// An index of another version.
    OtherVersion(i32),
    /// Anything else.
    Foreign,
}

/// Makes a connection that believes nothing of what stands in a file: no code in its schema runs.
pub fn distrust(db: &Connection) -> rusqlite::Result<()> {
    db.set_db_config(DbConfig::SQLITE_DBCONFIG_DEFENSIVE, true)?;
    db.set_db_config(DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA, false)?;
    db.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false)?;
    db.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, false)?;
    db.execute_batch("PRAGMA cell_size_check = ON; PRAGMA temp_store = MEMORY")
}

/// Keeps many pages of a file that is being written. Who only reads sees most of them once, and fresh memory for each
/// costs more than the reading.
pub fn keep_pages(db: &Connection) -> rusqlite::Result<()> {
    db.pragma_update(None, "cache_size", -65_536)
}

/// What is in a database.
pub fn look(db: &Connection) -> rusqlite::Result<Found> {
    let number = |pragma: &str| db.query_row(&format!("PRAGMA {pragma}"), [], |row| row.get::<_, i32>(0));
    // What SQLite makes of its own accord has no text.
    let mut statement = db.prepare("SELECT sql FROM sqlite_schema WHERE sql IS NOT NULL ORDER BY rowid")?;
    let tables: Vec<String> = statement.query_map([], |row| row.get(0))?.collect::<rusqlite::Result<_>>()?;
    Ok(match (number("application_id")?, number("user_version")?) {
        (0, 0) if tables.is_empty() => Found::Nothing,
        (APPLICATION, VERSION) if tables == TABLES => Found::Index,
        (APPLICATION, version) if version != VERSION => Found::OtherVersion(version),
        _ => Found::Foreign,
    })
}

/// Says how the file of a new index is laid out.
pub fn lay_out(db: &Connection) -> rusqlite::Result<()> {
    db.pragma_update(None, "page_size", PAGE_BYTES)
}

/// Makes the tables of an index.
pub fn create(db: &Transaction<'_>) -> rusqlite::Result<()> {
    let mut text = format!("PRAGMA application_id = {APPLICATION}; PRAGMA user_version = {VERSION};");
    TABLES.iter().for_each(|table| text.extend([table, ";"]));
    db.execute_batch(&text)
}

/// Whether what follows from all cases together is older than they are.
pub fn is_stale(db: &Connection) -> rusqlite::Result<bool> {
    db.query_row("SELECT 1 FROM cases WHERE situation = 0 AND copy = 0 LIMIT 1", [], |_| Ok(()))
        .optional()
        .map(|row| row.is_some())
}
