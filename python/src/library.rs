//! The library of cases.

use std::ffi::CString;
use std::fmt::Display;
use std::path::PathBuf;
use std::str::FromStr;

use base::json::json_line;
use lab::cases::query::{Query, dashed};
use lab::cases::review::Change;
use lab::cases::{Options, cases as find};
use lab::redrive::Need;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;

use crate::errors::input;
use crate::external::{Checkpoint, Raised, choices};
use crate::given::{Argument, Given, OneOrMore, Whole, named, within};
use crate::values::{check_there, jobs_at_once, level_named};
use crate::work::{parsed, work};

/// Some words, or none.
pub type Words = Option<Given<OneOrMore<String>>>;

/// `yes`, `no` or `unknown`, the first two also as a bool.
pub struct Whether(String);

impl<'py> Argument<'py> for Whether {
    fn expected() -> String {
        "a string or a bool".to_owned()
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        match value.extract() {
            Ok(is) => Ok(Self(if is { "yes" } else { "no" }.to_owned())),
            Err(_) => String::of(value).map(Self),
        }
    }
}

/// Finds corner cases by what is known of them, as `aeye cases` does, and gives a `Table` with a dictionary for each, as that prints
/// with `--json`; `file` of it is the path. The index of the `folders`, in the file `index` (None: `cases.sqlite` in the one
/// folder), is brought up to date first, unless `scan` is False; files in folders that cannot be read are left out with a warning. With
/// files among `folders` only these cases are meant. Ctrl-C ends it; what was read or measured stays.
///
/// Everything holds that is given, and of a list one is enough. `label`: walker, vehicle, rules, boredom. `verdict`: necessary,
/// near-miss, early, needless, in-vain. `map`, `checkpoint`: names (or 8 or more digits that a checkpoint's digest begins with). `weather`: rain,
/// wet, dry, fog, night, day, or the name of a weather. `hazards`: none, natural, raised, own. `perception_caused`: yes, no, unknown, True, False.
/// `overlooked`: any, walker, vehicle or a kind of road user, as in `child:200` with so many pixels of them. `ttc_below` and
/// `fork_ttc_below`: seconds to collision, measured, and without the takeover. `reviewed`: yes, no, accepted, rejected,
/// unclear. `tag`: tags. `near`: cases whose situation is nearly that of this file; `unique`: one of each group that
/// are nearly the same. `sort`: file, ttc, fork-ttc, speed, overlooked, distance; `descending` and `limit` of it.
///
/// `measure` simulates and draws those cases that were not measured, through the checkpoints of their drives, which are found
/// among `recorded` if they do not come with the package. `set_review`, `add_tag` and `remove_tag` say what came of looking at
/// the cases. `reveal` tells the checkpoints of blind drives.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there, EngineError where the index
/// cannot be read or nothing can be drawn.
#[pyfunction]
#[pyo3(signature = (
    folders, *, index = None, scan = true, label = None, verdict = None, map = None, weather = None, hazards = None,
    checkpoint = None, perception_caused = None, overlooked = None, ttc_below = None, fork_ttc_below = None,
    reviewed = None, tag = None, near = None, unique = false, sort = "file", descending = false, limit = None,
    measure = false, recorded = None, set_review = None, add_tag = None, remove_tag = None, reveal = false, jobs = None
))]
#[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
pub fn cases<'py>(
    py: Python<'py>,
    folders: Given<OneOrMore<PathBuf>>,
    index: Option<PathBuf>,
    scan: bool,
    label: Words,
    verdict: Words,
    map: Words,
    weather: Words,
    hazards: Words,
    checkpoint: Words,
    perception_caused: Option<Given<OneOrMore<Whether>>>,
    overlooked: Words,
    ttc_below: Option<Given<f64>>,
    fork_ttc_below: Option<Given<f64>>,
    reviewed: Words,
    tag: Words,
    near: Option<PathBuf>,
    unique: bool,
    sort: &str,
    descending: bool,
    limit: Option<Given<Whole>>,
    measure: bool,
    recorded: Option<Given<OneOrMore<Checkpoint<'py>>>>,
    set_review: Option<Given<String>>,
    add_tag: Words,
    remove_tag: Words,
    reveal: bool,
    jobs: Option<Given<Whole>>,
) -> PyResult<Bound<'py, PyAny>> {
    let query = Query {
        label: read("label", label)?,
        verdict: verdicts(verdict)?,
        map: listed("map", map)?,
        weather: read("weather", weather)?,
        hazards: listed("hazards", hazards)?.into_iter().map(hazard_level).collect::<PyResult<_>>()?,
        checkpoint: listed("checkpoint", checkpoint)?,
        perception_caused: listed("perception_caused", perception_caused)?
            .iter()
            .map(|Whether(word)| one("perception_caused", word))
            .collect::<PyResult<_>>()?,
        overlooked: read("overlooked", overlooked)?,
        ttc_below_s: seconds("ttc_below", ttc_below)?,
        fork_ttc_below_s: seconds("fork_ttc_below", fork_ttc_below)?,
        reviewed: read("reviewed", reviewed)?,
        tag: read("tag", tag)?,
        unique,
        sort: one("sort", sort)?,
        descending,
        limit: within(limit, "limit", 1..=u32::MAX)?,
    };
    let change = Change {
        review: named(set_review, "set_review")?.map(|state| one("set_review", &state)).transpose()?,
        add: read("add_tag", add_tag)?,
        remove: read("remove_tag", remove_tag)?,
    };
    let raised = Raised::default();
    let recorded = choices(named(recorded, "recorded")?, &raised)?;
    let jobs = jobs_at_once(jobs)?;
    let places = folders.named("folders")?.list();
    check_there(&places)?;
    let options =
        Options { places, index, no_scan: !scan, query, near, count: false, reveal, measure, recorded, change, jobs };
    let answer = raised.or(work(py, |interrupt| find(&options, interrupt)))?;
    for failure in &answer.overall.failed {
        let sentence = CString::new(failure.error.replace('\0', "\\0"))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &sentence, 1)?;
    }
    let row = |case| parsed(py, &json_line(case).map_err(|error| crate::errors::raise(&error))?);
    let rows = answer.cases.iter().map(row).collect::<PyResult<Vec<_>>>()?;
    py.import("aeye._tables")?.call_method1("Table", (rows,))
}

fn listed<T>(name: &str, words: Option<Given<OneOrMore<T>>>) -> PyResult<Vec<T>> {
    Ok(named(words, name)?.map_or_else(Vec::new, OneOrMore::list))
}

fn one<T: FromStr<Err: Display>>(name: &str, word: &str) -> PyResult<T> {
    word.parse().map_err(|error: T::Err| input(format!("{name}={word:?}: {error}")))
}

fn read<T: FromStr<Err: Display>>(name: &str, words: Words) -> PyResult<Vec<T>> {
    listed(name, words)?.iter().map(|word| one(name, word)).collect()
}

/// Verdicts on takeovers, by their names.
pub fn verdicts(names: Words) -> PyResult<Vec<Need>> {
    listed("verdict", names)?.iter().map(|name| need(name)).collect()
}

fn need(name: &str) -> PyResult<Need> {
    let found = Need::WITHOUT_INTERVENTION.into_iter().find(|need| dashed(need.name()) == name);
    let names = || Need::WITHOUT_INTERVENTION.map(|need| dashed(need.name())).join(", ");
    found.ok_or_else(|| input(format!("verdict={name:?}; expected one of {}", names())))
}

fn hazard_level(name: String) -> PyResult<String> {
    if name != "own" {
        level_named(&name)?;
    }
    Ok(name)
}

fn seconds(name: &str, seconds: Option<Given<f64>>) -> PyResult<Option<f64>> {
    match named(seconds, name)? {
        Some(seconds) if seconds <= 0.0 || !seconds.is_finite() => {
            Err(input(format!("{name}={seconds}; expected seconds, more than 0")))
        }
        fine => Ok(fine),
    }
}
