//! One picture of one moment: of a recording, or of a scenario that simulated drivers drive so far.

mod layer;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, bail};
use base::failure::Usage;
use base::json::Typed;
use base::maps::Map;
use base::output;
use base::output::PendingFolder;
use base::progress::{self, Interrupt};
use drivers::crew::Crew;
use drivers::film::Viewpoint;
use drivers::session::SessionState;
use drivers::simulate::lasting;
use drivers::vision::{Eye, Vision};
use kernel::time::{TICK_HZ, Tick, seconds};
use kernel::{Scenario, SceneSnapshot, World};
use measures::footage::decisive_tick;
use render::{AdapterChoice, Camera, Frame, Imaging, Renderer};
use serde::Serialize;

pub use self::layer::{LAYERS, Layer};
use super::cameras::{self, Named};
use super::looks::Size;
use super::shots::{Shots, Stage};

/// The moment of a run that none is asked for of: traffic has spread by then.
const USUAL_TICK: Tick = seconds(20);

/// What a picture is of.
#[derive(Clone, Debug)]
pub enum Subject {
    /// A recording or case.
    File(PathBuf),
    /// A run that starts so, with simulated drivers who see the truth.
    Run {
        /// Where it takes place.
        map: Box<Map>,
        /// What it starts from.
        scenario: Box<Scenario>,
    },
}

/// A picture that is asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// What it is of.
    pub subject: Subject,
    /// Its moment; none: where a file has its corner case or its end, 20 s after the beginning of a run.
    pub tick: Option<Tick>,
    /// From where it is taken.
    pub camera: Viewpoint,
    /// Instead of that, through each of the cameras of this file ([`cameras`]).
    pub cameras: Option<PathBuf>,
    /// What of the picture.
    pub layer: Layer,
    /// Its width and height, pixels.
    pub size: Size,
    /// How good the pictures are.
    pub imaging: Imaging,
    /// Where it goes; with cameras of a file the folder of their pictures, each named after its camera.
    pub out: PathBuf,
}

/// A picture that was made.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Still {
    /// Where it is.
    pub out: String,
    /// Its moment.
    pub tick: Tick,
    /// What of the picture: `rgb`, `classes`, `instances` or `depth`.
    pub layer: &'static str,
    /// Its width and height, pixels.
    pub size_px: [u32; 2],
}

/// What `aeye render` prints, a line for each picture.
impl Typed for Still {
    const TYPE: &'static str = "aeye.still";
}

impl fmt::Display for Still {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { out, tick, layer, size_px: [width, height] } = self;
        write!(f, "{out}: {layer} at {:.2} s (tick {tick}), {width}x{height} pixels", seconds_of(*tick))
    }
}

/// Makes a picture, in a file that there is not yet, or one of each camera of a file, in a folder that there is not yet.
pub fn render(options: &Options, interrupt: &Interrupt) -> anyhow::Result<Vec<Still>> {
    let Options { camera, size, imaging, out, .. } = options;
    if let Some(path) = &options.cameras {
        return render_all(options, &cameras::read(path, *size, *imaging)?, interrupt);
    }
    if out.extension().is_none_or(|ending| ending != "png") {
        return Err(Usage(format!("{}: expected the name of a PNG file, as in still.png", out.display())).into());
    }
    if out.exists() {
        bail!("{}: exists already; expected a new file", out.display());
    }
    output::check_file(out)?;
    let camera = camera.camera(*size).at(*imaging);
    cameras::check(&camera)?;
    let (bytes, still) = Moment::of(options, interrupt)?.still(&camera, options, out)?;
    output::write_file(out, &bytes)?;
    Ok(vec![still])
}

fn render_all(options: &Options, cameras: &[Named], interrupt: &Interrupt) -> anyhow::Result<Vec<Still>> {
    let folder = PendingFolder::new(&options.out)?;
    let mut moment = Moment::of(options, interrupt)?;
    let mut stills = Vec::new();
    for Named { name, camera } in cameras {
        let file = format!("{name}.png");
        let (bytes, still) = moment.still(camera, options, &options.out.join(&file)).with_context(|| name.clone())?;
        output::write_file(&folder.path().join(file), &bytes)?;
        stills.push(still);
    }
    folder.finish()?;
    Ok(stills)
}

/// A moment that can be drawn.
enum Moment {
    OfFile(Arc<Stage>, Tick),
    OfRun(Box<SceneSnapshot>, Box<Renderer>),
}

impl Moment {
    fn of(options: &Options, interrupt: &Interrupt) -> anyhow::Result<Self> {
        match &options.subject {
            Subject::File(path) => {
                let stage = Arc::new(Stage::open(path, &Arc::default())?);
                let tick = options.tick.unwrap_or_else(|| decisive_tick(stage.recording().log()));
                Ok(Self::OfFile(stage, tick))
            }
            Subject::Run { map, scenario } => {
                let (scene, renderer) = of_run(map, scenario, options.tick.unwrap_or(USUAL_TICK), interrupt)?;
                Ok(Self::OfRun(Box::new(scene), Box::new(renderer)))
            }
        }
    }

    fn draw(&mut self, camera: &Camera) -> anyhow::Result<Frame> {
        match self {
            Self::OfFile(stage, tick) => Ok(Shots::of_tick(stage, *tick, *camera)?.draw(0)?.frame),
            Self::OfRun(scene, renderer) => Ok(renderer.draw(scene, camera)?),
        }
    }

    /// The bytes of a picture's file, and what is to be said of it.
    fn still(&mut self, camera: &Camera, options: &Options, out: &Path) -> anyhow::Result<(Vec<u8>, Still)> {
        let (layer, frame) = (options.layer, self.draw(camera)?);
        let size_px = [camera.width, camera.height];
        let still = Still { out: out.display().to_string(), tick: frame.tick, layer: layer.name(), size_px };
        Ok((layer.png(&frame)?, still))
    }
}

/// The scene at a tick of a run, and what drew the truth for its semantic driver.
pub(crate) fn of_run(
    map: &Map,
    scenario: &Scenario,
    tick: Tick,
    interrupt: &Interrupt,
) -> anyhow::Result<(SceneSnapshot, Renderer)> {
    let network = &map.network;
    let scenario = lasting(scenario.clone(), tick);
    let mut world = World::new(&scenario, network)?;
    let mut crew =
        Crew::drawn(Vision::new(Renderer::new(network, &AdapterChoice::default())?, Eye::Truth), scenario.seed);
    let bar = progress::bar("ticks", tick);
    while world.tick() < tick {
        if interrupt.is_raised() {
            bail!("interrupted at {:.2} s of the run", seconds_of(world.tick()));
        }
        if SessionState::of(&world) != SessionState::Driving {
            let (ended, asked) = (seconds_of(world.tick()), seconds_of(tick));
            return Err(
                Usage(format!("the run ended after {ended:.2} s; expected no later time than {asked:.2} s")).into()
            );
        }
        let (input, _) = crew.act(&world).context("the simulated drivers")?;
        world.step(&input);
        bar.set_position(world.tick());
    }
    bar.finish_and_clear();
    Ok((world.scene(), crew.into_vision().into_renderer()))
}

fn seconds_of(tick: Tick) -> f64 {
    tick as f64 / f64::from(TICK_HZ)
}
