//! Drives that are stepped together.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use drivers::checkpoint::CheckpointChoice;
use drivers::episode::{Archive, COLUMNS, Fleet, MOST_STEP_TICKS, Plan, STEP_TICKS, Start, hud};
use drivers::vision::Eye;
use kernel::{Controls, Seat};
use numpy::{IntoPyArray, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use render::Camera;

use super::arrays::{Arrays, Sizes};
use super::setting::Setting;
use crate::errors::{input, raise};
use crate::external::{Checkpoint, Raised};
use crate::forked::{self, Owned};
use crate::given::{Given, Pair, Whole, named};
use crate::values::{self, jobs_at_once, picture_size, viewpoint};

/// Most drives that are stepped together.
const MOST_PLACES: u16 = 1024;

/// So many places for drives that are stepped together, `jobs` at the same time (None: one a core). An agent has the
/// `seat` (`semantic` or `safety`) and holds its controls for `ticks` of a step, a bot has the other. `masks` and `images`
/// say what is observed; images have a `size`, (width, height) (None: that of masks). What is seen
/// has the `quality` (None: the usual), and lens and chip do to it what `sensor` says (None: nothing); `record` is a folder for recordings.
/// `draw` takes pictures of `render_size` from a `camera` (`driver`, `chase` or `top`).
///
/// Raises FileError where a file is not there, InputError for a value that cannot be.
#[pyclass(frozen, module = "aeye._aeye")]
pub struct Episodes {
    fleet: Owned<Mutex<Fleet>>,
    sizes: Sizes,
    mask_size: (u32, u32),
    image_size: (u32, u32),
    camera: Camera,
    raised: Raised,
}

#[pymethods]
impl Episodes {
    /// Names of the columns of a HUD.
    #[classattr]
    const HUD: [&'static str; hud::NAMES.len()] = hud::NAMES;
    /// Least and greatest value of each.
    #[classattr]
    const HUD_RANGES: [[f32; 2]; hud::NAMES.len()] = hud::RANGES;
    /// Names of the columns of figures.
    #[classattr]
    const FIGURES: [&'static str; COLUMNS.len()] = COLUMNS;

    #[new]
    #[pyo3(
        signature = (
            places, *, seat = Given::of("semantic".to_owned()), checkpoint = None,
            ticks = Given::of(Whole(STEP_TICKS as i128)), masks = true, images = false, size = None,
            quality = None, sensor = None, record = None,
            camera = Given::of("chase".to_owned()), render_size = Given::of(Pair(512, 256)), jobs = None
        ),
        text_signature = "(places, *, seat='semantic', checkpoint=None, ticks=6, masks=True, images=False, size=None, \
                          quality=None, sensor=None, record=None, camera='chase', render_size=(512, 256), jobs=None)"
    )]
    #[expect(clippy::too_many_arguments, reason = "they are named where it is called")]
    fn new(
        py: Python<'_>,
        places: Given<Whole>,
        seat: Given<String>,
        checkpoint: Option<Given<Checkpoint<'_>>>,
        ticks: Given<Whole>,
        masks: bool,
        images: bool,
        size: Option<Given<Pair>>,
        quality: Option<Given<String>>,
        sensor: Option<Given<String>>,
        record: Option<PathBuf>,
        camera: Given<String>,
        render_size: Given<Pair>,
        jobs: Option<Given<Whole>>,
    ) -> PyResult<Self> {
        let places = usize::from(places.within("num_envs", 1..=MOST_PLACES)?);
        let ticks = ticks.within("ticks", 1..=MOST_STEP_TICKS)?;
        let size = size.map(|size| picture_size(size, "size")).transpose()?;
        let camera = viewpoint(camera)?.camera(picture_size(render_size, "render_size")?);
        let imaging = values::imaging(quality, sensor)?;
        let seat = seat_of(&seat.named("seat")?)?;
        let raised = Raised::default();
        let checkpoint = named(checkpoint, "checkpoint")?;
        let choice = checkpoint.map_or(Ok(CheckpointChoice::Truth), |checkpoint| checkpoint.choice(&raised))?;
        let jobs = base::spread::jobs(jobs_at_once(jobs)?).min(places);
        let (fleet, images) = py
            .detach(|| {
                let eye = Eye::open(&choice)?.at(imaging);
                let size = size.unwrap_or(eye.size());
                let images = images.then(|| Camera::driver(size.0, size.1).at(imaging));
                let archive = record.as_deref().map(Archive::open).transpose()?;
                let plan = Plan { seat, ticks, masks, images, archive, jobs };
                anyhow::Ok((Fleet::new(plan, eye, places), images))
            })
            .map_err(|error| raise(&error))?;
        let mask_size = fleet.eye().size();
        let sizes = Sizes {
            places,
            mask: masks.then(|| bytes(mask_size)),
            image: images.map(|camera| 3 * bytes(size_of(&camera))),
        };
        let image_size = images.map_or(mask_size, |camera| size_of(&camera));
        Ok(Self { fleet: Owned::new(Mutex::new(fleet)), sizes, mask_size, image_size, camera, raised })
    }

    /// Width and height of masks, pixels: those that the checkpoint takes.
    #[getter]
    fn mask_size(&self) -> (u32, u32) {
        self.mask_size
    }

    /// Width and height of images, pixels.
    #[getter]
    fn image_size(&self) -> (u32, u32) {
        self.image_size
    }

    /// Starts drives at places, from a setting with a seed each, and writes what is to be seen into the rows of `arrays`.
    /// Those that still go on there end.
    ///
    /// Raises EngineError where there is no graphics driver, FileError where a recording cannot be written.
    fn reset(
        &self,
        py: Python<'_>,
        places: Vec<usize>,
        seeds: Vec<u64>,
        setting: &Setting,
        mut arrays: Arrays<'_>,
    ) -> PyResult<()> {
        forked::check()?;
        if seeds.len() != places.len() {
            return Err(input(format!("{} seeds for {} drives", seeds.len(), places.len())));
        }
        let rows = arrays.rows(&places, self.sizes)?;
        let starts = || {
            let start = |(place, seed): (&usize, u64)| {
                let (scenario, map) = setting.of_seed(seed);
                Start { place: *place, scenario, map }
            };
            places.iter().zip(seeds).map(start).collect()
        };
        self.raised.or(py.detach(|| self.fleet().start(starts(), rows)).map_err(|error| raise(&error)))
    }

    /// Steps the drives at places by `actions`, float32 of shape (n, 3): steering, throttle and brake of each.
    ///
    /// Raises InputError where no drive goes on, EngineError where it cannot be drawn or seen.
    fn step(
        &self,
        py: Python<'_>,
        places: Vec<usize>,
        actions: PyReadonlyArray2<'_, f32>,
        mut arrays: Arrays<'_>,
    ) -> PyResult<()> {
        forked::check()?;
        let actions = actions.as_array();
        let controls: Vec<Controls> = match actions.dim() {
            (rows, 3) if rows == places.len() => {
                actions.rows().into_iter().map(|row| Controls::from_fractions(row[0], row[1], row[2])).collect()
            }
            (rows, width) => {
                let places = places.len();
                return Err(input(format!("actions of shape ({rows}, {width}); expected ({places}, 3)")));
            }
        };
        let rows = arrays.rows(&places, self.sizes)?;
        self.raised.or(py.detach(|| self.fleet().step(&controls, rows)).map_err(|error| raise(&error)))
    }

    /// Ends the drives at places and tells where their recordings are: None of those that are not recorded, have not begun
    /// or are over.
    ///
    /// Raises FileError where a recording cannot be written.
    fn finish(&self, py: Python<'_>, places: Vec<usize>) -> PyResult<Vec<Option<PathBuf>>> {
        self.raised.or(py.detach(|| self.fleet().finish(&places)).map_err(|error| raise(&error)))
    }

    /// A picture of the drive at a place from the camera, uint8 of shape (height, width, 3).
    ///
    /// Raises InputError where no drive goes on, EngineError where it cannot be drawn.
    fn draw<'py>(&self, py: Python<'py>, place: usize) -> PyResult<Bound<'py, PyArray3<u8>>> {
        forked::check()?;
        let frame = py.detach(|| self.fleet().draw(place, &self.camera)).map_err(|error| raise(&error))?;
        frame.rgb.into_pyarray(py).reshape([frame.height as usize, frame.width as usize, 3])
    }

    fn __repr__(&self) -> String {
        format!("Episodes({})", self.sizes.places)
    }
}

impl Episodes {
    fn fleet(&self) -> MutexGuard<'_, Fleet> {
        self.fleet.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn size_of(camera: &Camera) -> (u32, u32) {
    (camera.width, camera.height)
}

fn bytes((width, height): (u32, u32)) -> usize {
    width as usize * height as usize
}

fn seat_of(name: &str) -> PyResult<Seat> {
    match name {
        "semantic" => Ok(Seat::Semantic),
        "safety" => Ok(Seat::Safety),
        _ => Err(input(format!("seat=\"{name}\"; expected semantic or safety"))),
    }
}
