//! The natural dataset: frames with ground truth from simulated drives (paper, section 4).
//!
//! A scene is a drive of the expert on one map, with weather, traffic and route of its own seed, one
//! frame a second. A collision or a jam ends the drive, and the scene goes on with the next leg. The
//! recordings of the drives lie below `drives`. Each scene depends on the recipe and its number alone,
//! so scenes run in parallel and an interrupted dataset is completed by the same command.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{Context, bail};
use base::failure::Usage;
use base::maps::{self, Map};
use base::output::{self, OutputFolder};
use base::progress::{self, Bar, Interrupt};
use base::room::NoRoom;
use base::say::say;
use base::spread::{jobs, on_threads};
use drivers::vision;
use kernel::World;
use kernel::weather::WeatherPreset;
use perception::cityscapes::Place;
use render::{AdapterChoice, Imaging, Renderer};

use super::drive::ExpertDrive;
use super::manifest::{Manifest, PARTS};
use super::parts::Parts;
use super::provenance::{Drive, FrameLine};
use super::recipe::{MapUsed, NaturalRecipe, Recipe};
use super::views::{View, say_sizes, views};
use crate::share::{Share, ShareDone};
use crate::store::remove_folder;
use crate::{cameras, cityscapes};

/// What natural frames are asked for.
#[derive(Clone, Debug)]
pub struct Options {
    /// Scenes (drives) of the training split (paper: 85).
    pub scenes: u32,
    /// Scenes of the validation split, with seeds of their own (paper: 20).
    pub val_scenes: u32,
    /// Scenes of the test split, with seeds of their own (paper: 21).
    pub test_scenes: u32,
    /// Frames a scene of training and validation, one a second (paper: 60).
    pub frames: u32,
    /// Frames a scene of the test split (paper: 30).
    pub test_frames: u32,
    /// Size of the pictures.
    pub size: (u32, u32),
    /// How good the pictures are.
    pub imaging: Imaging,
    /// A file with cameras that take the frames, each all of them, instead of the drivers' ([`crate::cameras`]).
    pub cameras: Option<PathBuf>,
    /// Bundled maps or OpenDRIVE files, in turn; `all` are the bundled ones.
    pub maps: Vec<String>,
    /// People on foot in each scene, instead of as many as the map's default scenario has.
    pub pedestrians: Option<u16>,
    /// The scenes' weathers, in turn after each round of maps, instead of those that their seeds draw.
    pub weather: Vec<WeatherPreset>,
    /// Seed of the dataset.
    pub seed: u64,
    /// Scenes simulated at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the dataset; one that was interrupted is completed.
    pub out: PathBuf,
}

/// Makes a dataset, or completes one that was interrupted; one that is complete stays as it is.
pub fn make(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Manifest> {
    let maps = Map::find_all(&args.maps)?;
    build(&NaturalRecipe::new(args, &maps)?, &maps, &args.out, args.jobs, interrupt)
}

/// Makes a share of a dataset's scenes: a later call of [`make`] finds them in the folder.
pub fn make_shard(args: &Options, share: Share, interrupt: &Interrupt) -> anyhow::Result<ShareDone> {
    let maps = Map::find_all(&args.maps)?;
    let recipe = NaturalRecipe::new(args, &maps)?;
    if Manifest::of_finished(&args.out, &Recipe::Natural(recipe.clone()))?.is_none() {
        shoot(&recipe, &maps, &args.out, (share, args.jobs), interrupt)?;
    }
    let done = share.count(recipe.scenes().len() as u32) as usize;
    Ok(ShareDone { share, out: args.out.display().to_string(), done, failed: Vec::new() })
}

/// As [`make`], from a recipe and its maps.
pub(super) fn build(
    recipe: &NaturalRecipe,
    maps: &[Map],
    out: &Path,
    threads: Option<u16>,
    interrupt: &Interrupt,
) -> anyhow::Result<Manifest> {
    let whole = Recipe::Natural(recipe.clone());
    if let Some(finished) = Manifest::of_finished(out, &whole)? {
        // A process that was killed just after it wrote the manifest leaves them.
        remove_folder(&out.join(PARTS))?;
        return Ok(finished);
    }
    let shot = shoot(recipe, maps, out, (Share::WHOLE, threads), interrupt)?;
    finish(out, whole, &recipe.scenes(), shot.parts, shot.adapter)
}

/// An unfinished dataset.
struct Shot {
    parts: Parts,
    adapter: String,
    _folder: OutputFolder,
}

/// Makes the scenes of a share that are not there.
fn shoot(
    recipe: &NaturalRecipe,
    maps: &[Map],
    out: &Path,
    (share, threads): (Share, Option<u16>),
    interrupt: &Interrupt,
) -> anyhow::Result<Shot> {
    let views = views(&recipe.cameras, recipe.size, recipe.imaging())?;
    let adapter = vision::find_adapter()?;
    let folder = OutputFolder::open(out)?;
    let parts = Parts::open(out, recipe, &adapter)?;
    let mut scenes = recipe.scenes();
    share.keep(&mut scenes);
    let bar = progress::bar("frames", scenes.iter().map(|scene| u64::from(scene.frames)).sum());
    let no_room = Mutex::default();
    say_sizes(&views);
    let fresh = || maps.iter().map(|_| None).collect::<Vec<Option<Renderer>>>();
    on_threads(jobs(threads), scenes.len(), fresh, |renderers, index| {
        let scene = &scenes[index];
        if parts.find(out, scene.split, scene.number)?.is_some() {
            bar.inc(u64::from(scene.frames));
            return Ok(());
        }
        let map = &maps[scene.map];
        let renderer = match &mut renderers[scene.map] {
            Some(renderer) => renderer,
            none => none.insert(Renderer::new(&map.network, &AdapterChoice::default())?),
        };
        let mut studio =
            Studio { recipe, views: &views, out, adapter: &adapter, renderer, interrupt, bar: &bar, no_room: &no_room };
        parts.keep(scene.split, scene.number, &studio.shoot(scene, map)?)
    })?;
    bar.finish_and_clear();
    Ok(Shot { parts, adapter, _folder: folder })
}

/// Joins the scenes' lines and writes the manifest, which makes the dataset complete.
fn finish(out: &Path, recipe: Recipe, scenes: &[Scene], parts: Parts, adapter: String) -> anyhow::Result<Manifest> {
    let mut frames = Vec::new();
    for scene in scenes {
        let lines = parts.find(out, scene.split, scene.number)?;
        frames.extend(lines.with_context(|| format!("{}: was changed meanwhile", out.display()))?);
    }
    let manifest = Manifest::complete(out, recipe, adapter, &frames)?;
    parts.remove()?;
    Ok(manifest)
}

/// A scene of the recipe.
struct Scene {
    split: &'static str,
    number: u32,
    frames: u32,
    /// Index in the list of maps.
    map: usize,
    weather: Option<&'static WeatherPreset>,
}

impl Scene {
    /// Seed of a leg: the first 8 bytes of BLAKE3 over what names it, so that no two splits, scenes
    /// or datasets share a drive.
    fn seed(&self, recipe: &NaturalRecipe, leg: u32) -> u64 {
        let name = format!("natural {} {} {} {leg}", recipe.seed, self.split, self.number);
        let hash = blake3::hash(name.as_bytes());
        u64::from_le_bytes(*hash.as_bytes().first_chunk().unwrap_or(&[0; 8]))
    }
}

impl NaturalRecipe {
    fn new(args: &Options, maps: &[Map]) -> anyhow::Result<Self> {
        let recipe = Self {
            seed: args.seed,
            scenes: args.scenes,
            val_scenes: args.val_scenes,
            test_scenes: args.test_scenes,
            frames: args.frames,
            test_frames: args.test_frames,
            size: args.size,
            quality: args.imaging.quality,
            sensor: args.imaging.sensor,
            cameras: cameras::of_file(args.cameras.as_deref(), (args.size, args.imaging))?,
            models: args.imaging.models,
            pedestrians: args.pedestrians,
            weather: args.weather.iter().map(|preset| preset.name.to_owned()).collect(),
            maps: maps.iter().map(MapUsed::new).collect(),
        };
        recipe.check().map_err(Usage)?;
        Ok(recipe)
    }

    fn scenes(&self) -> Vec<Scene> {
        let splits = [
            ("train", self.scenes, self.frames),
            ("val", self.val_scenes, self.frames),
            ("test", self.test_scenes, self.test_frames),
        ];
        let maps = self.maps.len().max(1);
        let of = |(split, count, frames)| {
            (0..count).map(move |number| Scene {
                split,
                number,
                frames,
                map: number as usize % maps,
                weather: self.weather_of(number as usize / maps),
            })
        };
        splits.into_iter().flat_map(of).collect()
    }

    /// The weather of a round of maps, where it is not drawn.
    fn weather_of(&self, round: usize) -> Option<&'static WeatherPreset> {
        self.weather.get(round % self.weather.len().max(1)).and_then(|name| WeatherPreset::find(name))
    }
}

/// Where the frames of a scene are made.
struct Studio<'a> {
    recipe: &'a NaturalRecipe,
    views: &'a [View],
    out: &'a Path,
    adapter: &'a str,
    renderer: &'a mut Renderer,
    interrupt: &'a Interrupt,
    bar: &'a Bar,
    no_room: &'a Mutex<NoRoom>,
}

impl Studio<'_> {
    /// Drives a scene and writes its frames and recordings.
    fn shoot(&mut self, scene: &Scene, map: &Map) -> anyhow::Result<Vec<FrameLine>> {
        let mut lines: Vec<FrameLine> = Vec::new();
        let (mut leg, mut frames) = (0, 0);
        while frames < scene.frames {
            let before = lines.len();
            let mut scenario = map.scenario(scene.seed(self.recipe, leg));
            scenario.traffic.pedestrians = self.recipe.pedestrians.unwrap_or(scenario.traffic.pedestrians);
            if let Some(preset) = scene.weather {
                scenario.take_weather(preset);
            }
            let mut drive = ExpertDrive::new(&scenario, map)?;
            self.say_who_is_missing(drive.world());
            while frames < scene.frames && drive.next_frame()? {
                self.keep(scene, drive.world(), frames, &mut lines)?;
                frames += 1;
            }
            if lines.len() > before {
                let recording = self.record(scene, leg, map, &drive.into_recording()?)?;
                lines[before..].iter_mut().for_each(|line| line.recording.clone_from(&recording));
            } else if leg > scene.frames + 20 {
                bail!("map {}: no drive lasts a second from where it starts", map.network.name);
            }
            leg += 1;
        }
        Ok(lines)
    }

    fn say_who_is_missing(&self, world: &World) {
        let mut no_room = self.no_room.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let told = no_room.of_world(world);
        self.bar.suspend(|| told.into_iter().for_each(say));
    }

    /// Draws and writes a frame through each camera; the digest of its drive's recording is not known yet.
    fn keep(&mut self, scene: &Scene, world: &World, frame: u32, lines: &mut Vec<FrameLine>) -> anyhow::Result<()> {
        let (snapshot, state_hash) = (world.scene(), Some(world.hash().0 as u32));
        let drive = Drive { recording: String::new(), seed: world.scenario().seed, label: None };
        let city = &self.recipe.maps[scene.map].name;
        for view in self.views {
            if self.interrupt.is_raised() {
                bail!("{}: interrupted; the same command completes it", self.out.display());
            }
            let drawn = self.renderer.draw(&snapshot, &view.camera)?;
            let camera = view.name.as_deref();
            let place = Place { split: scene.split, city, scene: scene.number, frame, camera };
            cityscapes::write(self.out, &place, &drawn)?;
            lines.push(FrameLine::new(&place, (&drawn, view), (&snapshot, state_hash), &drive, self.adapter));
        }
        self.bar.inc(1);
        Ok(())
    }

    /// Writes the recording of a drive; gives its digest.
    fn record(&self, scene: &Scene, leg: u32, map: &Map, recording: &[u8]) -> anyhow::Result<String> {
        let city = &self.recipe.maps[scene.map].name;
        let folder = self.out.join("drives").join(scene.split);
        fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        let path = folder.join(format!("{city}_{:06}_{leg}.mcap", scene.number));
        maps::put_beside(map.foreign.as_ref(), &path)?;
        output::write_file(&path, recording)?;
        Ok(blake3::hash(recording).to_hex().to_string())
    }
}
