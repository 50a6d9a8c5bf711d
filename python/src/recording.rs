//! Recordings and corner cases.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use base::asked;
use base::failure::Failed;
use base::json::json_line;
use kernel::time::Tick;
use lab::shots::{Shots, Stage, Workshop};
use lab::{inspect, verify};
use measures::footage::Asked;
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use replay::Log;

use crate::errors::{diverged, input, raise};
use crate::forked::Owned;
use crate::frame::Frame;
use crate::frames::Frames;
use crate::given::{Argument, Given, Pair, Whole, named, within};
use crate::log;
use crate::values::{self, DEFAULT_PAIR, picture_size, viewpoint};
use crate::work::{parsed, work};

/// A recording or corner case. Nothing of it can be changed.
#[pyclass(frozen, module = "aeye")]
pub struct Recording {
    stage: Owned<Arc<Stage>>,
}

/// Opens a recording or corner case and checks every byte of it.
///
/// One whose writer was stopped is read as far as it goes (`finished` tells).
///
/// Raises FileError where it cannot be read, InputError where it is damaged or no recording.
#[pyfunction]
pub fn open(py: Python<'_>, path: PathBuf) -> PyResult<Recording> {
    static WORKSHOP: LazyLock<Arc<Workshop>> = LazyLock::new(Arc::default);
    let stage = py.detach(|| Stage::open(&path, &WORKSHOP)).map_err(|error| raise(&error))?;
    Ok(Recording { stage: Owned::new(Arc::new(stage)) })
}

impl Recording {
    fn log(&self) -> &Log {
        self.stage.recording().log()
    }

    fn path_buf(&self) -> &Path {
        self.stage.path()
    }
}

#[pymethods]
impl Recording {
    /// The file.
    #[getter]
    fn path(&self) -> PathBuf {
        self.path_buf().to_owned()
    }

    /// `recording` or `case`.
    #[getter]
    fn kind(&self) -> &'static str {
        if self.log().manifest.case.is_some() { "case" } else { "recording" }
    }

    /// Whether its writer came to its end; if not, up to a second is missing.
    #[getter]
    fn finished(&self) -> bool {
        self.stage.recording().finished()
    }

    /// Name of the map.
    #[getter]
    fn map(&self) -> &str {
        &self.log().manifest.scenario.map
    }

    /// Seed of the scenario.
    #[getter]
    fn seed(&self) -> u64 {
        self.log().manifest.scenario.seed
    }

    /// What the run started from, as TOML.
    #[getter]
    fn scenario(&self) -> String {
        self.log().manifest.scenario.to_toml()
    }

    /// The tick of the state that it starts from, 0 in recordings; it can be drawn, and has no controls.
    #[getter]
    fn first_tick(&self) -> Tick {
        self.log().first_tick()
    }

    /// Ticks, 60 a second, uint64 of shape (n,): of the rows of `controls` and `hashes`.
    #[getter]
    fn ticks<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u64>> {
        (self.log().first_tick() + 1..=self.log().last_tick()).collect::<Vec<_>>().into_pyarray(py)
    }

    /// What both drivers did at each tick: `semantic` and `safety`, each with `steering` (float32, [-1, 1], positive to
    /// the right), `throttle` and `brake` (float32, [0, 1]), and the switches `hand_brake`, `reverse`, `seen`,
    /// `indicate_left`, `indicate_right`, `horn`, `lights` and `wipers` (bool), all of shape (n,).
    #[getter]
    fn controls<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        log::controls(py, self.log())
    }

    /// The low 32 bits of the hash of the world's state at each tick, uint32 of shape (n,).
    #[getter]
    fn hashes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.log().hashes.clone().into_pyarray(py)
    }

    /// What happened, a row each: `tick` (uint64), `kind` (names, as in `aeye inspect --json`), `actor` (uint32, 0 for
    /// none), `speed_mps` (float32, of the ego car).
    #[getter]
    fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        log::events(py, self.log())
    }

    /// The masks that came onto the semantic driver's screen, a row each: `tick_shown`, `tick_of_frame`, `digest`
    /// (uint64).
    #[getter]
    fn masks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        log::masks(py, self.log())
    }

    /// What was said about the takeover: `label` (walker, vehicle, rules or boredom), `comment`, and
    /// `perception_caused` (bool, or None where nobody tried); None where nothing was said.
    #[getter]
    fn labels<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        log::labels(py, self.log())
    }

    /// What is in the file, as `aeye inspect --json` prints it: how it came about, what its run came to, what the
    /// drivers did, how critical it was. It is simulated for that, which takes a while.
    ///
    /// The checkpoint of blind drives is told with `reveal` only.
    #[pyo3(signature = (*, reveal = false))]
    fn inspect<'py>(&self, py: Python<'py>, reveal: bool) -> PyResult<Bound<'py, PyAny>> {
        let files = vec![self.path()];
        let options = inspect::Options { files, reveal, jobs: Some(1) };
        let line = work(py, move |_| {
            let mut line = String::new();
            let inspected = inspect::inspect(&options, |contents| {
                line = json_line(contents)?;
                Ok(())
            })?;
            Failed::check(&inspected.failed, inspected.read)?;
            Ok(line)
        })?;
        parsed(py, &line)
    }

    /// Simulates it again and compares every tick, as `aeye verify` does; with `rewind`, 1 to 600, also goes back so
    /// many ticks again and again. Gives what `aeye verify --json` prints.
    ///
    /// Raises DivergedError where a tick differs (which one and how it says), EngineError where another version of the
    /// simulation made the file.
    #[pyo3(signature = (*, rewind = None))]
    fn verify<'py>(&self, py: Python<'py>, rewind: Option<Given<Whole>>) -> PyResult<Bound<'py, PyAny>> {
        let (files, rewind) = (vec![self.path()], within(rewind, "rewind", 1..=600)?);
        let options = verify::Options { files, rewind, against: None, jobs: Some(1) };
        let (line, text, is_equal) = work(py, move |_| {
            let (mut line, mut text) = (String::new(), String::new());
            let verified = verify::verify(&options, |checked| {
                (line, text) = (json_line(checked)?, checked.to_string());
                Ok(())
            })?;
            Failed::check(&verified.failed, verified.checked)?;
            Ok((line, text, verified.diverged.is_empty()))
        })?;
        if is_equal { parsed(py, &line) } else { Err(diverged(text)) }
    }

    /// The frames of a window: the last seconds before the takeover (or the collision that nobody prevented, else the
    /// end), as `aeye rerender` draws them, or, with `from_` or `to` or with `last=None`, those between two times of the
    /// run (seconds; None: its start, its end), cut to what the file holds: a case begins at `first_tick`.
    ///
    /// `size` is (width, height) in pixels, `quality` one of `plain`, `standard` and `fine` (None: the usual), `sensor` what
    /// lens and chip do, as in `noise=4,k1=-0.1` (None: nothing), `fps` a divisor of 60, `camera` one of `driver`, `chase` and `top`.
    ///
    /// Raises InputError where there is nothing in the window, or a value cannot be.
    #[pyo3(
        signature = (
            *, last = Given::of(Last::Default), from_ = None, to = None, fps = Given::of(Whole(10)), size = DEFAULT_PAIR,
            quality = None, sensor = None, camera = driver()
        ),
        text_signature = "($self, *, last=3.0, from_=None, to=None, fps=10, size=(256, 128), quality=None, \
                          sensor=None, camera='driver')"
    )]
    #[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
    fn frames(
        &self,
        last: Given<Last>,
        from_: Option<Given<f64>>,
        to: Option<Given<f64>>,
        fps: Given<Whole>,
        size: Given<Pair>,
        quality: Option<Given<String>>,
        sensor: Option<Given<String>>,
        camera: Given<String>,
    ) -> PyResult<Frames> {
        let is_between = from_.is_some() || to.is_some();
        let last = match last.named("last")? {
            Last::Seconds(_) if is_between => {
                return Err(input("last with from_ or to; expected either".to_owned()));
            }
            Last::Seconds(seconds) => Some(ticks(seconds, "last")?),
            Last::Default if !is_between => Some(ticks(LAST_S, "last")?),
            Last::Default | Last::All => None,
        };
        let time = |given, name| named(given, name)?.map(|seconds| ticks(seconds, name)).transpose();
        let asked = Asked { last, from: time(from_, "from_")?, to: time(to, "to")?, fps: frame_rate(fps)? };
        let (viewpoint, size) = (viewpoint(camera)?, picture_size(size, "size")?);
        let imaging = values::imaging(quality, sensor)?;
        let shots = Shots::of_window(&self.stage, &asked, viewpoint.camera(size).at(imaging));
        Ok(shots.map_err(|error| raise(&error))?.into())
    }

    /// The picture of a tick.
    ///
    /// Raises InputError where the file has no such tick, EngineError where another version of the simulation made it
    /// (of its cases, the ticks with a stored scene can be drawn) or no graphics driver is there.
    #[pyo3(
        signature = (tick, *, size = DEFAULT_PAIR, quality = None, sensor = None, camera = driver()),
        text_signature = "($self, tick, *, size=(256, 128), quality=None, sensor=None, camera='driver')"
    )]
    fn frame(
        &self,
        py: Python<'_>,
        tick: Given<Whole>,
        size: Given<Pair>,
        quality: Option<Given<String>>,
        sensor: Option<Given<String>>,
        camera: Given<String>,
    ) -> PyResult<Frame> {
        let imaging = values::imaging(quality, sensor)?;
        let tick = tick.within("tick", self.first_tick()..=self.log().last_tick())?;
        let (viewpoint, size) = (viewpoint(camera)?, picture_size(size, "size")?);
        let shots = Shots::of_tick(&self.stage, tick, viewpoint.camera(size).at(imaging));
        Frames::from(shots.map_err(|error| raise(&error))?).draw(py, 0)
    }

    fn __repr__(&self) -> String {
        let (kind, path, log) = (self.kind(), self.path_buf().display(), self.log());
        format!("Recording({kind} {path}, ticks {} to {})", log.first_tick(), log.last_tick())
    }
}

/// How long a window is unless asked otherwise, seconds.
const LAST_S: f64 = 3.0;

/// How much of a run is asked for.
enum Last {
    /// What nobody asked otherwise for: the last seconds, or what lies between two times.
    Default,
    /// The last seconds.
    Seconds(f64),
    /// All of it.
    All,
}

impl<'py> Argument<'py> for Last {
    fn expected() -> String {
        "a number or None".to_owned()
    }

    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Bound<'py, PyAny>> {
        if value.is_none() { Ok(Self::All) } else { f64::of(value).map(Self::Seconds) }
    }
}

/// The camera that pictures are taken by unless asked otherwise.
fn driver() -> Given<String> {
    Given::of("driver".to_owned())
}

fn frame_rate(fps: Given<Whole>) -> PyResult<u32> {
    let Whole(fps) = fps.named("fps")?;
    let refused = || input(format!("fps={fps}; expected {}", asked::frame_rates()));
    u32::try_from(fps).ok().filter(|fps| asked::is_frame_rate(*fps)).ok_or_else(refused)
}

fn ticks(seconds: f64, name: &str) -> PyResult<Tick> {
    let refused = || input(format!("{name}={seconds}; expected a time of the run in seconds, 0 or more"));
    asked::ticks(seconds).ok_or_else(refused)
}
