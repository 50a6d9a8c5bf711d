//! Drives by bots: campaigns, and corner cases driven on.

use std::path::{Path, PathBuf};

use base::failure::Failed;
use base::json::json_line;
use lab::campaign::{Goal, Options, Until, drive};
use lab::redrive as forks;
use pyo3::prelude::*;

use crate::errors::input;
use crate::values::{choice, jobs_at_once, level, people, preset, whole_seconds};
use crate::work::{tabled, work};

/// One of something, or several.
#[derive(FromPyObject)]
pub enum OneOrMore<T> {
    /// Tried first: a path is no list.
    One(T),
    More(Vec<T>),
}

impl<T> OneOrMore<T> {
    fn list(self) -> Vec<T> {
        match self {
            Self::One(one) => vec![one],
            Self::More(more) => more,
        }
    }
}

/// Lets bots drive through checkpoints until there are so many `runs`, `km`, `cases` or `pedestrian_cases` of each, as
/// `aeye campaign` does, and gives what that prints with `--json`; `runs` of it is a table. Recordings, corner cases and
/// `campaign.json` go to the folder `out`. Ctrl-C ends it; what was driven stays, and the same call goes on there.
///
/// `checkpoint` are `early`, `full`, `truth` or ONNX files, `maps` names of bundled maps or OpenDRIVE files (None: the
/// scenario's, or all bundled ones), `hazards` is `none`, `natural` or `raised`, `weather` one of CARLA's names. A run
/// takes at most `max_time` simulated seconds. `jobs` worlds are simulated at the same time (None: one a core); the
/// results do not depend on it.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there or cannot be written.
#[pyfunction]
#[pyo3(signature = (
    checkpoint, out, *, runs = None, km = None, cases = None, pedestrian_cases = None, maps = None, scenario = None,
    pedestrians = None, hazards = None, weather = None, max_time = 240.0, seed = 1, jobs = None
))]
#[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
pub fn campaign<'py>(
    py: Python<'py>,
    checkpoint: OneOrMore<PathBuf>,
    out: PathBuf,
    runs: Option<u32>,
    km: Option<f64>,
    cases: Option<u32>,
    pedestrian_cases: Option<u32>,
    maps: Option<OneOrMore<PathBuf>>,
    scenario: Option<PathBuf>,
    pedestrians: Option<u16>,
    hazards: Option<&str>,
    weather: Option<&str>,
    max_time: f64,
    seed: u64,
    jobs: Option<u16>,
) -> PyResult<Bound<'py, PyAny>> {
    if pedestrian_cases.is_some() && pedestrians == Some(0) {
        return Err(input("pedestrian_cases with pedestrians=0; expected more than 0".to_owned()));
    }
    let options = Options {
        checkpoint: checkpoint.list().iter().map(|path| choice(path)).collect::<PyResult<_>>()?,
        maps: maps.map(|maps| maps.list().iter().map(|path| text(path)).collect()).unwrap_or_default(),
        embed_map: false,
        scenario,
        goal: goal(runs, km, [cases, pedestrian_cases])?,
        pedestrians: pedestrians.map(people).transpose()?,
        hazards: hazards.map(level).transpose()?,
        weather: weather.map(preset).transpose()?,
        run_seconds: whole_seconds(max_time, "max_time", 10..=86_400)?,
        seed,
        jobs: jobs.map(jobs_at_once).transpose()?,
        out,
    };
    let line = work(py, |interrupt| json_line(&drive(&options, interrupt)?))?;
    tabled(py, &line, "runs")
}

/// Drives recordings or cases on from before their intervention, as `aeye redrive` does, and gives what that prints with
/// `--json`; `forks` of it is a table. Their recordings go to the folder `out`. Ctrl-C ends it; what was driven stays.
///
/// Either `without_intervention`: what would have happened if the safety driver had done nothing? Or through a
/// `checkpoint` (`early`, `full`, `truth` or an ONNX file): is there an intervention again? `recorded` are files in which
/// checkpoints of the recordings may be found. Each file has `vary` further forks, 0 to 30, and a fork goes on for `after`
/// seconds, 1 to 60.
///
/// Raises InputError for a value that cannot be, FileError where a file is not there, EngineError where none of them can be
/// driven on.
#[pyfunction]
#[pyo3(signature = (
    files, out, *, without_intervention = false, checkpoint = None, recorded = None, vary = 0, after = 10.0, jobs = None
))]
#[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
pub fn redrive<'py>(
    py: Python<'py>,
    files: OneOrMore<PathBuf>,
    out: PathBuf,
    without_intervention: bool,
    checkpoint: Option<PathBuf>,
    recorded: Option<OneOrMore<PathBuf>>,
    vary: u16,
    after: f64,
    jobs: Option<u16>,
) -> PyResult<Bound<'py, PyAny>> {
    if without_intervention == checkpoint.is_some() {
        return Err(input("expected either without_intervention=True or a checkpoint".to_owned()));
    }
    if vary > 30 {
        return Err(input(format!("vary={vary}; expected 0 to 30")));
    }
    let recorded = recorded.map(|recorded| recorded.list().iter().map(|path| choice(path)).collect()).transpose()?;
    let options = forks::Options {
        files: files.list(),
        without_intervention,
        checkpoint: checkpoint.as_deref().map(choice).transpose()?,
        recorded: recorded.unwrap_or_default(),
        reveal: false,
        vary,
        seconds: whole_seconds(after, "after", 1..=60)?,
        jobs: jobs.map(jobs_at_once).transpose()?,
        out,
    };
    let line = work(py, |interrupt| {
        let done = forks::redrive(&options, interrupt)?;
        Failed::check(&done.failed, done.files)?;
        json_line(&done)
    })?;
    tabled(py, &line, "forks")
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn goal(runs: Option<u32>, km: Option<f64>, [cases, pedestrian_cases]: [Option<u32>; 2]) -> PyResult<Goal> {
    let goal = match (km, cases, pedestrian_cases) {
        (Some(km), None, None) if km > 0.0 && km.is_finite() => Goal { until: Until::Km(km), most: runs },
        (None, Some(cases), None) => Goal { until: Until::Cases(cases), most: runs },
        (None, None, Some(cases)) => Goal { until: Until::PedestrianCases(cases), most: runs },
        (None, None, None) if runs.is_some() => Until::Runs(runs.unwrap_or_default()).into(),
        _ => return Err(input("expected runs, or one of km (more than 0), cases and pedestrian_cases".to_owned())),
    };
    match [runs, cases, pedestrian_cases].contains(&Some(0)) {
        true => Err(input("0 runs or cases; expected 1 or more".to_owned())),
        false => Ok(goal),
    }
}
