//! A library of corner cases: an index of folders, which finds cases by what is known of them.
//!
//! The index is a database in one file. What is in it of files follows from the files, and is brought up to date by every
//! call; what people say about cases (reviews, tags) is in it alone.

pub mod conditions;
mod facts;
mod given;
mod index;
pub mod line;
mod look;
mod measure;
pub mod query;
pub mod review;
mod rows;
mod scan;
mod schema;
mod situation;
#[cfg(test)]
mod tests;
mod text;

use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::Context;
use base::failure::{Failure, Usage};
use base::json::Typed;
use base::library;
use base::progress::Interrupt;
use base::words::count;
use drivers::checkpoint::CheckpointChoice;
use serde::Serialize;

use self::facts::Facts;
use self::given::Given;
use self::index::{Access, Index};
use self::line::{CaseLine, lines};
use self::query::{Query, Scope, Sort, Sql};
use self::review::Change;
use self::rows::Within;

/// What the index of a folder is called in it.
pub const FILE: &str = "cases.sqlite";

/// What is asked of a library.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Folders with cases anywhere below, of which the index is kept; with files among them, only these cases are meant.
    pub places: Vec<PathBuf>,
    /// The file of the index; none: `cases.sqlite` in the folder, if it is a single one.
    pub index: Option<PathBuf>,
    /// Answer from the index as it is, without a look at the folders.
    pub no_scan: bool,
    /// Which cases.
    pub query: Query,
    /// Only cases whose situation is nearly that of this one, which need not be in the library.
    pub near: Option<PathBuf>,
    /// Say how many there are, and not which.
    pub count: bool,
    /// Tell, and find by, the checkpoints of blind drives.
    pub reveal: bool,
    /// Simulate and draw the cases first that were not measured.
    pub measure: bool,
    /// Where the checkpoints of the drives may be found, if they do not come with the program.
    pub recorded: Vec<CheckpointChoice>,
    /// What is to be said of these cases.
    pub change: Change,
    /// Files read at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
}

/// The cases that were asked for.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The cases; none where they are only counted.
    pub cases: Vec<CaseLine>,
    /// All of them together.
    pub overall: Overall,
}

/// What a call came to.
#[derive(Clone, Debug, Serialize)]
pub struct Overall {
    /// File of the index.
    pub index: String,
    /// Cases that were asked for.
    pub cases: u64,
    /// Files that were read, as they are new or were changed.
    pub read: usize,
    /// Files that are as they were.
    pub kept: usize,
    /// Files that are no longer there.
    pub gone: usize,
    /// Cases that were measured now.
    pub measured: usize,
    /// Cases of which something was said now.
    pub changed: usize,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// The last line of `aeye cases`.
impl Typed for Overall {
    const TYPE: &'static str = "aeye.cases";
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Overall { cases, changed, measured, .. } = self.overall;
        if !self.cases.is_empty() {
            writeln!(f, "{}\n", text::table(&self.cases))?;
        }
        f.write_str(&count(cases, "case"))?;
        if measured > 0 {
            write!(f, ", {measured} measured now")?;
        }
        if changed > 0 {
            write!(f, ", {changed} changed")?;
        }
        Ok(())
    }
}

/// Brings the index up to date, measures and says what is asked for, and gives the cases.
pub fn cases(options: &Options, interrupt: &Interrupt) -> anyhow::Result<Answer> {
    let (places, mut failed) = library::expand(&options.places);
    let (folders, files): (Vec<PathBuf>, Vec<PathBuf>) = places.into_iter().partition(|place| place.is_dir());
    check(options, &folders, &files)?;
    let given = folders.iter().map(|folder| Given::open(folder)).collect::<anyhow::Result<Vec<_>>>()?;
    let path = options.index.clone().unwrap_or_else(|| folders[0].join(FILE));
    let access = if options.no_scan && !writes(options) { Access::Read } else { Access::Write };
    let mut index = Index::open(&path, access)?;
    let mut overall = Overall {
        index: path.display().to_string(),
        cases: 0,
        read: 0,
        kept: 0,
        gone: 0,
        measured: 0,
        changed: 0,
        failed: Vec::new(),
    };
    for folder in given.iter().filter(|_| !options.no_scan) {
        let scanned = scan::scan(&mut index, folder, options.jobs, interrupt)?;
        overall.read += scanned.read;
        overall.kept += scanned.kept;
        overall.gone += scanned.gone;
        failed.extend(scanned.failed);
    }
    let (scope, missing) = scope(&index, &given, &files, options)?;
    failed.extend(missing);
    let sql = Sql::of(&options.query, &scope);
    if options.measure {
        let (measured, unmeasured) = measure_due(&mut index, &sql, &given, options, interrupt)?;
        overall.measured = measured;
        failed.extend(unmeasured);
    }
    let mut cases = Vec::new();
    if options.count && options.change.is_empty() {
        overall.cases = index.read(|db| line::count(db, &options.query, &sql))?;
    } else {
        cases = index.read(|db| lines(db, &options.query, &sql, options.reveal))?;
        overall.cases = cases.len() as u64;
    }
    if !options.change.is_empty() {
        overall.changed = cases.len();
        index.write(|db| cases.iter().try_for_each(|case| options.change.make(db, &case.id)))?;
        // As they are now; what was asked for may no longer hold.
        cases = again(&index, &cases, options)?;
    }
    cases.iter_mut().for_each(|case| case.file = shown(&index, &given, &case.way).display().to_string());
    if options.count {
        cases.clear();
    }
    overall.failed = failed;
    Ok(Answer { cases, overall })
}

fn writes(options: &Options) -> bool {
    options.measure || !options.change.is_empty()
}

/// Refuses what does not go together.
fn check(options: &Options, folders: &[PathBuf], files: &[PathBuf]) -> Result<(), Usage> {
    let refuse = |sentence: String| Err(Usage(sentence));
    if options.index.is_none() && folders.len() != 1 {
        let folders = count(folders.len(), "folder");
        return refuse(format!("{folders}; expected one, or --index FILE, which says where the index is"));
    }
    if options.query.sort == Sort::Distance && options.near.is_none() {
        return refuse("--sort distance; expected --near FILE, to which it is".into());
    }
    if !options.change.is_empty() && files.is_empty() && options.near.is_none() && options.query.asks_for_all() {
        return refuse("a review or tag for every case; expected files, or a query such as --label walker".into());
    }
    Ok(())
}

/// What else decides which cases are given; and files that are asked for and are not in the index.
fn scope(
    index: &Index,
    given: &[Given],
    files: &[PathBuf],
    options: &Options,
) -> anyhow::Result<(Scope, Vec<Failure>)> {
    let within = given.iter().map(|folder| Within::of(library::order_below(index.way_to(folder.whole())))).collect();
    let near = options.near.as_deref().map(|path| situation_of(path, index)).transpose()?;
    let scope = Scope { within, only_wanted: !files.is_empty(), near, reveal: options.reveal };
    let mut failed = Vec::new();
    let mut wanted = Vec::new();
    for file in files {
        match file.canonicalize() {
            Ok(whole) => wanted.push((file, library::order(index.way_to(&whole)))),
            Err(error) => failed.push(Failure::new(file, &error.into())),
        }
    }
    let missing = index.read(|db| line::want(db, wanted.iter().map(|(_, place)| place.as_str())))?;
    let absent = || anyhow::anyhow!("is not in {}; expected a case below the folders", index.path().display());
    let is_missing = wanted.iter().filter(|(_, place)| missing.contains(place));
    failed.extend(is_missing.map(|(file, _)| Failure::new(file, &absent())));
    Ok((scope, failed))
}

/// The situation of a case, and which case it is.
fn situation_of(path: &Path, index: &Index) -> anyhow::Result<(situation::Situation, String)> {
    // A case of the index is not read again: to see its scene its map has to be built.
    if let Ok(whole) = path.canonicalize()
        && let Some(known) = index.read(|db| rows::situation_at(db, &library::order(index.way_to(&whole))))?
    {
        return Ok(known);
    }
    let facts = Facts::read(path)?;
    let situation = facts.situation().with_context(|| format!("{}: holds no scene of its takeover", path.display()))?;
    Ok((situation, facts.identity))
}

fn measure_due(
    index: &mut Index,
    sql: &Sql,
    given: &[Given],
    options: &Options,
    interrupt: &Interrupt,
) -> anyhow::Result<(usize, Vec<Failure>)> {
    let engine = measure::engine()?;
    let due = index.read(|db| measure::due(db, sql, &engine))?;
    let due: Vec<measure::Due> = due
        .into_iter()
        .map(|(way, digest)| {
            let (path, shown) = (index.place_of(&way), shown(index, given, &way));
            measure::Due { path, shown, digest }
        })
        .collect();
    measure::measure(index, &due, &engine, &options.recorded, (options.jobs, interrupt))
}

/// What the file of a way is called: as its folder was given.
fn shown(index: &Index, given: &[Given], way: &str) -> PathBuf {
    let place = index.place_of(way);
    let folder = given.iter().find(|folder| place.starts_with(folder.whole()));
    folder.map_or_else(|| place.clone(), |folder| folder.shown(&place))
}

/// Cases that were changed, as they are now.
fn again(index: &Index, cases: &[CaseLine], options: &Options) -> anyhow::Result<Vec<CaseLine>> {
    let places: Vec<String> = cases.iter().map(|case| library::order(Path::new(&case.way))).collect();
    index.read(|db| line::want(db, places.iter().map(String::as_str)))?;
    let Query { sort, descending, .. } = options.query;
    // Their distance is told no longer.
    let sort = if sort == Sort::Distance { Sort::File } else { sort };
    let all = Query { sort, descending, ..Query::default() };
    let sql = Sql::of(&all, &Scope { only_wanted: true, reveal: options.reveal, ..Scope::default() });
    index.read(|db| lines(db, &all, &sql, options.reveal))
}
