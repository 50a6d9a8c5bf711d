//! A recording or case, opened so that any of its ticks can be drawn, and series of its pictures, each made when it is
//! asked for.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use anyhow::{Context, bail};
use base::asked;
use base::failure::Usage;
use kernel::time::Tick;
use kernel::{RoadNetwork, SceneSnapshot};
use measures::footage::{Asked, Window, scenes};
use render::{AdapterChoice, Camera, Frame, Renderer};
use replay::{Log, Manifest, Recording};

use super::cameras;

/// Pictures whose scenes are simulated at once: a replay begins at a keyframe, up to 12 s before the first of them.
const AT_ONCE: usize = 32;

/// Maps and renderers that are kept while nobody draws with them, at most.
const KEPT: usize = 4;

/// Maps and renderers for all files that a process draws: one takes as long to make as dozens of pictures. Those that were
/// used last are kept; who draws at the same time as others has a renderer alone.
#[derive(Default)]
pub struct Workshop {
    /// Beside their texts.
    foreign_maps: Mutex<Vec<(Arc<str>, Arc<RoadNetwork>)>>,
    /// Beside the digests of their maps.
    renderers: Mutex<Vec<(u128, Renderer)>>,
}

impl Workshop {
    fn network(&self, manifest: &Manifest) -> anyhow::Result<Arc<RoadNetwork>> {
        // Bundled maps are kept by themselves.
        let Some(text) = manifest.foreign_map.as_ref().and_then(|map| map.text.as_ref()) else {
            return Ok(manifest.network()?);
        };
        let is_it = |map: &RoadNetwork| map.name == manifest.scenario.map && map.digest == manifest.map_digest;
        let network = match take(&self.foreign_maps, |(known, map)| known == text && is_it(map)) {
            Some((_, network)) => network,
            None => manifest.network()?,
        };
        keep(&self.foreign_maps, (text.clone(), network.clone()));
        Ok(network)
    }

    fn draw(&self, network: &RoadNetwork, scene: &SceneSnapshot, camera: &Camera) -> anyhow::Result<Frame> {
        let mut renderer = match take(&self.renderers, |(map, _)| *map == network.digest) {
            Some((_, renderer)) => renderer,
            None => Renderer::new(network, &AdapterChoice::default())?,
        };
        let frame = renderer.draw(scene, camera)?;
        keep(&self.renderers, (network.digest, renderer));
        Ok(frame)
    }
}

fn take<T>(kept: &Mutex<Vec<T>>, is_it: impl Fn(&T) -> bool) -> Option<T> {
    let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
    kept.iter().position(is_it).map(|at| kept.remove(at))
}

fn keep<T>(kept: &Mutex<Vec<T>>, used: T) {
    let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
    kept.push(used);
    let old = (kept.len() > KEPT).then(|| kept.remove(0));
    drop(kept);
    drop(old);
}

/// A file and what it is drawn with.
pub struct Stage {
    path: PathBuf,
    recording: Recording,
    network: OnceLock<Arc<RoadNetwork>>,
    workshop: Arc<Workshop>,
}

impl Stage {
    /// Reads a file; one whose writer was stopped is read as far as it goes.
    pub fn open(path: &Path, workshop: &Arc<Workshop>) -> anyhow::Result<Self> {
        let recording = Recording::open(path)?;
        Ok(Self { path: path.to_owned(), recording, network: OnceLock::new(), workshop: workshop.clone() })
    }

    /// Where it was read.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it holds.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    fn log(&self) -> &Log {
        self.recording.log()
    }

    fn network(&self) -> anyhow::Result<&Arc<RoadNetwork>> {
        match self.network.get() {
            Some(network) => Ok(network),
            None => {
                let network = self.workshop.network(&self.log().manifest)?;
                Ok(self.network.get_or_init(|| network))
            }
        }
    }

    fn draw(&self, scene: &SceneSnapshot, camera: &Camera) -> anyhow::Result<Frame> {
        self.workshop.draw(self.network()?, scene, camera)
    }
}

/// Pictures of a window of a file, by ascending tick.
pub struct Shots {
    stage: Arc<Stage>,
    camera: Camera,
    ticks: Vec<Tick>,
    /// Those of the pictures that were asked for last, from the first of them on.
    scenes: Mutex<(usize, Vec<SceneSnapshot>)>,
}

/// A picture, and what it is of.
pub struct Shot {
    /// All its planes.
    pub frame: Frame,
    /// The scene.
    pub scene: SceneSnapshot,
    /// The camera.
    pub camera: Camera,
}

impl Shots {
    /// The pictures of a window; those of `last` are the ones that `aeye rerender` makes.
    pub fn of_window(stage: &Arc<Stage>, asked: &Asked, camera: Camera) -> anyhow::Result<Self> {
        if !asked::is_frame_rate(asked.fps) {
            return Err(Usage(format!("{} frames a second; expected {}", asked.fps, asked::frame_rates())).into());
        }
        let window = Window::of(stage.log(), asked).with_context(|| stage.path.display().to_string())?;
        Self::of(stage, window.pictures().collect(), camera)
    }

    /// The picture of a tick.
    pub fn of_tick(stage: &Arc<Stage>, tick: Tick, camera: Camera) -> anyhow::Result<Self> {
        let (first, last) = held(stage.log()).into_inner();
        if !(first..=last).contains(&tick) {
            let path = stage.path.display();
            return Err(Usage(format!("{path}: holds ticks {first} to {last}, and no tick {tick}")).into());
        }
        Self::of(stage, vec![tick], camera)
    }

    fn of(stage: &Arc<Stage>, ticks: Vec<Tick>, camera: Camera) -> anyhow::Result<Self> {
        cameras::check(&camera)?;
        let scenes = Mutex::new((0, Vec::new()));
        Ok(Self { stage: stage.clone(), camera, ticks, scenes })
    }

    /// Their ticks.
    pub fn ticks(&self) -> &[Tick] {
        &self.ticks
    }

    /// Draws one of them.
    pub fn draw(&self, index: usize) -> anyhow::Result<Shot> {
        self.draw_through(index, &self.camera)
    }

    /// What another camera sees at that tick, of the same simulation.
    pub fn draw_through(&self, index: usize, camera: &Camera) -> anyhow::Result<Shot> {
        let file = || self.stage.path.display().to_string();
        let scene = self.scene(index).with_context(file)?;
        let frame = self.stage.draw(&scene, camera).with_context(file)?;
        Ok(Shot { frame, scene, camera: *camera })
    }

    fn scene(&self, index: usize) -> anyhow::Result<SceneSnapshot> {
        let mut known = self.scenes.lock().unwrap_or_else(PoisonError::into_inner);
        let from = index - index % AT_ONCE;
        if known.0 != from || known.1.is_empty() {
            let Some(ticks) = self.ticks.get(from..self.ticks.len().min(from + AT_ONCE)) else {
                bail!("has {} pictures, and none at {index}", self.ticks.len());
            };
            *known = (from, scenes(self.stage.log(), self.stage.network()?, ticks, |_, _| ())?);
        }
        known.1.get(index - from).cloned().context("a scene for each tick")
    }
}

/// The ticks that can be drawn.
fn held(log: &Log) -> RangeInclusive<Tick> {
    log.first_tick()..=log.last_tick()
}
