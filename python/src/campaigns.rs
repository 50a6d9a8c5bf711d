//! Drives by bots: campaigns, their shards, and what shards come to.

use std::path::{Path, PathBuf};

use base::json::json_line;
use lab::campaign::{Collection, Goal, Options, drive, drive_shard};
use pyo3::prelude::*;

use crate::errors::input;
use crate::external::{Checkpoint, Raised, choices};
use crate::given::{Given, OneOrMore, Pair, Whole, named, within};
use crate::values::{self, jobs_at_once, level, people, preset, share, whole_seconds};
use crate::work::{parsed, tabled, work};

const GOAL: &str = "expected runs, or one of km, cases and pedestrian_cases, more than 0";

/// Lets bots drive through checkpoints until there are so many `runs`, `km`, `cases` or `pedestrian_cases` of each, as
/// `aeye campaign` does, and gives what that prints with `--json`; `runs` of it is a table. Recordings, corner cases and
/// `campaign.json` go to the folder `out`. Ctrl-C ends it; what was driven stays, and the same call goes on there.
///
/// `checkpoint` are `early`, `full`, `truth`, ONNX files or `External`, `maps` names of bundled maps or OpenDRIVE files (None: the
/// scenario's, or all bundled ones), `hazards` is `none`, `natural` or `raised`, `weather` one with a name. Networks look at
/// pictures of the `quality` `plain`, `standard` or `fine` (None: the usual), to which lens and chip do what `sensor` says, as in
/// `noise=4,k1=-0.1` (None: nothing). A run takes at most `max_time` simulated seconds. `jobs` worlds are simulated at the same time (None: one a core); the
/// results do not depend on it.
///
/// With `shard`, (i, n), it drives every n-th run alone, up to `runs` or `vary`, into a folder for `collect`, and gives what `aeye
/// campaign --shard --json` prints.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there or cannot be written,
/// MissingRunsError where `runs` do not come to the goal.
#[pyfunction]
#[pyo3(
    signature = (
        checkpoint, out, *, runs = None, vary = None, km = None, cases = None, pedestrian_cases = None, maps = None, scenario = None,
        pedestrians = None, hazards = None, weather = None, quality = None, sensor = None, max_time = Given::of(240.0),
        seed = Given::of(Whole(1)), jobs = None, shard = None
    ),
    text_signature = "(checkpoint, out, *, runs=None, vary=None, km=None, cases=None, pedestrian_cases=None, maps=None, \
                      scenario=None, pedestrians=None, hazards=None, weather=None, quality=None, sensor=None, \
                      max_time=240.0, seed=1, \
                      jobs=None, shard=None)"
)]
#[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
pub fn campaign<'py>(
    py: Python<'py>,
    checkpoint: Given<OneOrMore<Checkpoint<'py>>>,
    out: PathBuf,
    runs: Option<Given<Whole>>,
    vary: Option<Given<Whole>>,
    km: Option<Given<f64>>,
    cases: Option<Given<Whole>>,
    pedestrian_cases: Option<Given<Whole>>,
    maps: Option<Given<OneOrMore<PathBuf>>>,
    scenario: Option<PathBuf>,
    pedestrians: Option<Given<Whole>>,
    hazards: Option<Given<String>>,
    weather: Option<Given<String>>,
    quality: Option<Given<String>>,
    sensor: Option<Given<String>>,
    max_time: Given<f64>,
    seed: Given<Whole>,
    jobs: Option<Given<Whole>>,
    shard: Option<Given<Pair>>,
) -> PyResult<Bound<'py, PyAny>> {
    let count = |given, name| within(given, name, 1..=u32::MAX);
    let (runs, km, pedestrians) = (count(runs, "runs")?, named(km, "km")?, people(pedestrians)?);
    let vary = count(vary, "vary")?;
    if vary.is_some() && runs.is_some() {
        return Err(input("both runs and vary; expected one of them".to_owned()));
    }
    let (cases, pedestrian_cases) = (count(cases, "cases")?, count(pedestrian_cases, "pedestrian_cases")?);
    if pedestrian_cases.is_some() && pedestrians == Some(0) {
        return Err(input("pedestrian_cases with pedestrians=0; expected more than 0".to_owned()));
    }
    let raised = Raised::default();
    let options = Options {
        checkpoint: choices(Some(checkpoint.named("checkpoint")?), &raised)?,
        maps: named(maps, "maps")?.map_or_else(Vec::new, OneOrMore::list).iter().map(|path| text(path)).collect(),
        embed_map: false,
        scenario,
        vary: vary.is_some(),
        goal: Goal::of(runs.or(vary), km, [cases, pedestrian_cases]).ok_or_else(|| input(GOAL.to_owned()))?,
        pedestrians,
        hazards: level(hazards)?,
        weather: preset(weather)?,
        imaging: values::imaging(quality, sensor)?,
        run_seconds: whole_seconds(max_time, "max_time", 10..=86_400)?,
        seed: seed.within("seed", 0..=u64::MAX)?,
        jobs: jobs_at_once(jobs)?,
        out,
    };
    if shard.is_some() && runs.or(vary).is_none() {
        return Err(input("a shard without runs or vary; expected the number up to which all shards drive".to_owned()));
    }
    match share(shard)? {
        Some(share) => {
            let line = work(py, |interrupt| json_line(&drive_shard(&options, share, interrupt)?));
            parsed(py, &raised.or(line)?)
        }
        None => {
            let line = work(py, |interrupt| json_line(&drive(&options, interrupt)?));
            tabled(py, &raised.or(line)?, "runs")
        }
    }
}

/// Puts together what the shards of a campaign drove, as `aeye campaign --collect` does: the files of one process in the folder
/// `out`, and what that prints with `--json`; `runs` of it is a table. It drives nothing and needs no graphics driver.
///
/// `folders` are those of shards, or hold such folders. `jobs` runs are read at the same time (None: one a core).
///
/// Raises MissingRunsError where runs are not there yet, EngineError where the folders are not of one campaign and
/// program.
#[pyfunction]
#[pyo3(signature = (folders, out, *, jobs = None))]
pub fn collect(
    py: Python<'_>,
    folders: Given<OneOrMore<PathBuf>>,
    out: PathBuf,
    jobs: Option<Given<Whole>>,
) -> PyResult<Bound<'_, PyAny>> {
    let options = Collection { folders: folders.named("folders")?.list(), jobs: jobs_at_once(jobs)?, out };
    tabled(py, &work(py, |_| json_line(&lab::campaign::collect(&options)?))?, "runs")
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
