//! The natural dataset: frames with ground truth from simulated drives (paper, section 4).
//!
//! A scene is a drive of the [`Expert`] on one map, with weather, traffic and route of its own
//! seed, one frame a second. A collision or a jam ends the drive, and the scene goes on with the
//! next leg. Each scene depends on the recipe and its number alone, so scenes run in parallel and
//! an interrupted dataset is completed by the same command. `dataset.json` is written last.

use std::fs;
use std::path::Path;

use anyhow::{Context, bail};
use indicatif::ProgressBar;
use kernel::arbiter::Phase;
use kernel::events::EventKind;
use kernel::scene::Weather;
use kernel::time::{DATASET_STRIDE_TICKS, Tick, seconds};
use kernel::{Scenario, TickInput, World};
use perception::classes::TRAIN_CLASSES;
use render::{Camera, Frame, RenderOptions, Renderer};
use serde::{Deserialize, Serialize};

use super::cityscapes::{self, Kind, Place};
use super::expert::Expert;
use super::spread::{jobs, spread};
use crate::cli::NaturalArgs;
use crate::drivers::Driver;
use crate::exit::{Usage, Verdict};
use crate::maps::Map;
use crate::output;
use crate::progress::{self, Interrupt};

/// Frames in a row that may show the car standing; further ones are left out.
const STANDING_FRAMES: u32 = 4;
/// A car that stands so long is in a jam.
const JAM_TICKS: Tick = seconds(40);
/// Speed below which the car stands, m/s.
const STANDING_MPS: f32 = 0.2;

/// What a dataset is made from; the same recipe gives the same frames on the same adapter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Recipe {
    /// Seed of every scene's own.
    pub seed: u64,
    /// Scenes of the training split.
    pub scenes: u32,
    /// Scenes of the validation split.
    pub val_scenes: u32,
    /// Frames a scene.
    pub frames: u32,
    /// Width and height of the pictures, pixels.
    pub size: (u32, u32),
    /// People on foot, where not as many as in the map's default scenario.
    pub pedestrians: Option<u16>,
    /// The scenes' maps, in turn.
    pub maps: Vec<MapUsed>,
}

/// A map of a dataset.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MapUsed {
    /// Its name, as it stands in file names.
    pub name: String,
    /// Digest of the baked map.
    pub digest: String,
}

/// One frame's provenance, a line of `frames.jsonl`.
#[derive(Serialize)]
struct FrameLine<'a> {
    image: String,
    labels: String,
    split: &'a str,
    map: &'a str,
    scene: u32,
    frame: u32,
    leg: u32,
    seed: u64,
    tick: Tick,
    speed_mps: f32,
    weather: WeatherLine,
    /// BLAKE3 over colour, tags and instances, before they are compressed.
    pixels: String,
}

#[derive(Serialize)]
struct WeatherLine {
    cloudiness_pct: f32,
    wind_pct: f32,
    sun_altitude_deg: f32,
    sun_azimuth_deg: f32,
}

impl From<Weather> for WeatherLine {
    fn from(w: Weather) -> Self {
        let Weather { cloudiness_pct, wind_pct, sun_altitude_deg, sun_azimuth_deg } = w;
        Self { cloudiness_pct, wind_pct, sun_altitude_deg, sun_azimuth_deg }
    }
}

/// The content of `dataset.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Manifest {
    /// `natural`.
    pub kind: &'static str,
    /// What it is made from.
    pub recipe: Recipe,
    /// The graphics adapter that drew it; colours depend on it, labels do not.
    pub adapter: String,
    /// Frames to learn from.
    pub train_frames: u32,
    /// Frames to measure on.
    pub val_frames: u32,
    /// Names of the train ids, in order.
    pub classes: Vec<&'static str>,
    /// BLAKE3 over `frames.jsonl`.
    pub digest: String,
}

/// Runs `aeye dataset natural`.
pub fn run(args: &NaturalArgs, json: bool) -> anyhow::Result<Verdict> {
    let manifest = make(args, &Interrupt::listen()?)?;
    output::print(json, &manifest, || {
        let (train, val) = (manifest.train_frames, manifest.val_frames);
        format!("{}: {train} training and {val} validation frames, digest {}", args.out.display(), manifest.digest)
    })?;
    Ok(Verdict::Ok)
}

/// Makes a dataset, or completes one that was interrupted.
pub fn make(args: &NaturalArgs, interrupt: &Interrupt) -> anyhow::Result<Manifest> {
    let maps = Map::find_all(&args.maps)?;
    let recipe = Recipe::new(args, &maps)?;
    let options = RenderOptions::default();
    let adapter = options.adapter.find()?.name;
    let parts = prepare(&args.out, &recipe)?;
    let scenes = recipe.scenes();
    let bar = progress::bar("frames", u64::from(recipe.frames) * scenes.len() as u64);
    let fresh = || maps.iter().map(|_| None).collect::<Vec<Option<Renderer>>>();
    spread(jobs(args.jobs), scenes.len(), fresh, |renderers, index| {
        let scene = &scenes[index];
        let part = parts.join(scene.part());
        if part.is_file() {
            bar.inc(u64::from(recipe.frames));
            return Ok(());
        }
        let map = &maps[scene.map];
        let renderer = match &mut renderers[scene.map] {
            Some(renderer) => renderer,
            none => none.insert(Renderer::new(&map.network, &options)?),
        };
        let mut studio = Studio { recipe: &recipe, out: &args.out, renderer, interrupt, bar: &bar };
        let lines = studio.shoot(scene, map)?;
        output::write_file(&part, lines.as_bytes())
    })?;
    bar.finish_and_clear();
    finish(args, &recipe, &parts, adapter)
}

/// The folder of finished scenes, once it is certain that they belong to this recipe.
fn prepare(out: &Path, recipe: &Recipe) -> anyhow::Result<std::path::PathBuf> {
    let parts = out.join("parts");
    let recipe_file = parts.join("recipe.json");
    if out.join("dataset.json").exists() {
        bail!(
            "{}: holds a complete dataset already; expected a new folder, or one that was interrupted",
            out.display()
        );
    }
    output::create_folder(&parts)?;
    if recipe_file.exists() {
        let text = fs::read_to_string(&recipe_file).with_context(|| recipe_file.display().to_string())?;
        let begun: Recipe = serde_json::from_str(&text).with_context(|| recipe_file.display().to_string())?;
        if begun != *recipe {
            bail!("{}: was begun with other arguments; expected the same to complete it", out.display());
        }
    } else {
        output::write_file(&recipe_file, serde_json::to_string_pretty(recipe)?.as_bytes())?;
    }
    Ok(parts)
}

/// Joins the scenes' lines and writes the manifest, which makes the dataset complete.
fn finish(args: &NaturalArgs, recipe: &Recipe, parts: &Path, adapter: String) -> anyhow::Result<Manifest> {
    let mut lines = String::new();
    for scene in recipe.scenes() {
        let part = parts.join(scene.part());
        lines.push_str(&fs::read_to_string(&part).with_context(|| part.display().to_string())?);
    }
    output::write_file(&args.out.join("frames.jsonl"), lines.as_bytes())?;
    let manifest = Manifest {
        kind: "natural",
        recipe: recipe.clone(),
        adapter,
        train_frames: recipe.frames * recipe.scenes,
        val_frames: recipe.frames * recipe.val_scenes,
        classes: TRAIN_CLASSES.iter().map(|c| c.name).collect(),
        digest: blake3::hash(lines.as_bytes()).to_hex().to_string(),
    };
    output::write_file(&args.out.join("dataset.json"), output::json_file(&manifest)?.as_bytes())?;
    fs::remove_dir_all(parts).with_context(|| parts.display().to_string())?;
    Ok(manifest)
}

/// A scene of the recipe.
struct Scene {
    split: &'static str,
    number: u32,
    /// Index in the list of maps.
    map: usize,
}

impl Scene {
    fn part(&self) -> String {
        format!("{}_{:06}.jsonl", self.split, self.number)
    }

    /// Seed of a leg: the first 8 bytes of BLAKE3 over what names it, so that no two splits, scenes
    /// or datasets share a drive.
    fn seed(&self, recipe: &Recipe, leg: u32) -> u64 {
        let name = format!("natural {} {} {} {leg}", recipe.seed, self.split, self.number);
        let hash = blake3::hash(name.as_bytes());
        u64::from_le_bytes(*hash.as_bytes().first_chunk().unwrap_or(&[0; 8]))
    }
}

impl Recipe {
    fn new(args: &NaturalArgs, maps: &[Map]) -> anyhow::Result<Self> {
        if args.scenes + args.val_scenes == 0 || args.frames == 0 || maps.is_empty() {
            return Err(Usage("a dataset needs at least one map, one scene and one frame a scene".into()).into());
        }
        let used = |map: &Map| {
            let name = map.network.name.replace('_', "-");
            MapUsed { name, digest: format!("{:032x}", map.network.digest) }
        };
        Ok(Self {
            seed: args.seed,
            scenes: args.scenes,
            val_scenes: args.val_scenes,
            frames: args.frames,
            size: args.size,
            pedestrians: args.pedestrians,
            maps: maps.iter().map(used).collect(),
        })
    }

    fn scenes(&self) -> Vec<Scene> {
        let of = |split, count| {
            (0..count).map(move |number| Scene { split, number, map: number as usize % self.maps.len() })
        };
        of("train", self.scenes).chain(of("val", self.val_scenes)).collect()
    }
}

/// Where the frames of a scene are made.
struct Studio<'a> {
    recipe: &'a Recipe,
    out: &'a Path,
    renderer: &'a mut Renderer,
    interrupt: &'a Interrupt,
    bar: &'a ProgressBar,
}

impl Studio<'_> {
    /// Drives a scene and writes its frames; gives its lines of `frames.jsonl`.
    fn shoot(&mut self, scene: &Scene, map: &Map) -> anyhow::Result<String> {
        let mut lines = String::new();
        let (mut taken, mut leg) = (0, 0);
        while taken < self.recipe.frames {
            let before = taken;
            let seed = scene.seed(self.recipe, leg);
            let mut scenario = map.scenario(seed);
            scenario.traffic.pedestrians = self.recipe.pedestrians.unwrap_or(scenario.traffic.pedestrians);
            let mut drive = Drive::new(&scenario, map)?;
            while taken < self.recipe.frames && drive.next_frame() {
                let frame = self.draw(&drive.world)?;
                lines.push_str(&self.keep(scene, &drive.world, taken, leg, &frame)?);
                lines.push('\n');
                taken += 1;
            }
            leg += 1;
            if taken == before && leg > self.recipe.frames + 20 {
                bail!("map {}: no drive lasts a second from where it starts", map.network.name);
            }
        }
        Ok(lines)
    }

    fn draw(&mut self, world: &World) -> anyhow::Result<Frame> {
        if self.interrupt.is_raised() {
            bail!("{}: interrupted; the same command completes it", self.out.display());
        }
        let (width, height) = self.recipe.size;
        Ok(self.renderer.draw(&world.scene(), &Camera::driver(width, height))?)
    }

    fn keep(&self, scene: &Scene, world: &World, number: u32, leg: u32, frame: &Frame) -> anyhow::Result<String> {
        let map = &self.recipe.maps[scene.map].name;
        let place = Place { split: scene.split, city: map, scene: scene.number, frame: number };
        cityscapes::write(self.out, &place, frame)?;
        self.bar.inc(1);
        Ok(serde_json::to_string(&FrameLine {
            image: place.path(Kind::Image),
            labels: place.path(Kind::TrainIds),
            split: scene.split,
            map,
            scene: scene.number,
            frame: number,
            leg,
            seed: world.scenario().seed,
            tick: frame.tick,
            speed_mps: world.hud().speed_mps,
            weather: world.scenario().weather.into(),
            pixels: cityscapes::digest(frame),
        })?)
    }
}

/// A drive of the expert.
struct Drive {
    world: World,
    expert: Expert,
    standing_frames: u32,
    stood: Tick,
    collided: bool,
}

impl Drive {
    fn new(scenario: &Scenario, map: &Map) -> anyhow::Result<Self> {
        let world = World::new(scenario, &map.network)?;
        Ok(Self { world, expert: Expert, standing_frames: 0, stood: 0, collided: false })
    }

    /// Goes on to the next frame worth keeping; false when the drive is over.
    fn next_frame(&mut self) -> bool {
        while self.step() {
            if !self.world.tick().is_multiple_of(DATASET_STRIDE_TICKS) {
                continue;
            }
            self.standing_frames = if self.stood > 0 { self.standing_frames + 1 } else { 0 };
            if self.standing_frames <= STANDING_FRAMES {
                return true;
            }
        }
        false
    }

    /// Advances by a tick; false when the drive is over.
    fn step(&mut self) -> bool {
        if self.collided || self.stood >= JAM_TICKS || self.world.arbiter().phase == Phase::Done {
            return false;
        }
        let semantic = self.expert.controls(&self.world);
        let output = self.world.step(&TickInput { semantic, ..TickInput::default() });
        let hit = |kind| matches!(kind, EventKind::CollisionActor | EventKind::CollisionScenery);
        self.collided = output.events.iter().any(|event| hit(event.kind));
        self.stood = if self.world.hud().speed_mps.abs() < STANDING_MPS { self.stood + 1 } else { 0 };
        !self.collided
    }
}
