//! The scenes of a window of a recording or case, from a replay that compared every tick of it.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, bail};
use kernel::time::{TICK_HZ, Tick};
use kernel::{RoadNetwork, SceneSnapshot, World};
use replay::{Case, Divergence, Error, Log, Recording, Replayer};

/// A window of a run, ready to be drawn.
pub struct Footage {
    /// The file's name without `.mcap`.
    pub name: String,
    /// What the file holds.
    pub log: Log,
    /// The map.
    pub network: Arc<RoadNetwork>,
    /// Scenes by ascending tick.
    pub scenes: Vec<SceneSnapshot>,
}

impl Footage {
    /// The last `last` ticks up to the intervention (the collision of a missed one, else the end)
    /// at `fps` frames a second, a divisor of the tick rate.
    pub fn read(path: &Path, last: Tick, fps: u32) -> anyhow::Result<Self> {
        Self::watch(path, last, fps, |_, _| ())
    }

    /// As [`Footage::read`]; `see` is shown the world at each frame, unless another kernel made the file.
    pub fn watch(path: &Path, last: Tick, fps: u32, see: impl FnMut(&World, &SceneSnapshot)) -> anyhow::Result<Self> {
        let file = || path.display().to_string();
        let recording = Recording::open(path)?;
        let network = recording.network().with_context(file)?;
        let log = recording.into_log();
        let ticks = window(&log, last, fps);
        if ticks.is_empty() {
            bail!("{}: holds no tick of that window", file());
        }
        let scenes = scenes(&log, &network, &ticks, see).with_context(file)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = name.strip_suffix(".mcap").unwrap_or(&name).to_owned();
        Ok(Self { name, log, network, scenes })
    }
}

/// Where the window of a log ends: at the intervention, the collision of a missed one, or the last tick.
pub fn decisive_tick(log: &Log) -> Tick {
    match &log.manifest.case {
        Some(case) => case.to,
        None => Case::window(log).map_or(log.last_tick(), |window| *window.end()),
    }
}

/// The ticks of the window's frames, ascending; those before the log's first are left out.
fn window(log: &Log, last: Tick, fps: u32) -> Vec<Tick> {
    let end = decisive_tick(log);
    let stride = Tick::from(TICK_HZ / fps);
    let count = last.div_ceil(stride);
    let tick = |before: Tick| end.checked_sub(before * stride).filter(|tick| *tick >= log.first_tick());
    (0..count).rev().filter_map(tick).collect()
}

/// The scenes at these ticks. A case made by another kernel cannot be replayed; its stored scenes
/// can still be drawn.
fn scenes(
    log: &Log,
    network: &Arc<RoadNetwork>,
    ticks: &[Tick],
    mut see: impl FnMut(&World, &SceneSnapshot),
) -> anyhow::Result<Vec<SceneSnapshot>> {
    let stored = |tick: Tick| log.scenes.iter().find(|scene| scene.tick == tick);
    if log.manifest.kernel != kernel::identity() {
        let all: Option<Vec<_>> = ticks.iter().map(|tick| stored(*tick).cloned()).collect();
        let (made_by, this) = (&log.manifest.kernel, kernel::identity());
        return all.with_context(|| {
            format!("made by kernel {made_by}; this one, {this}, can draw no more than the stored scenes of a case")
        });
    }
    let mut replayer = Replayer::new(log, network.clone())?;
    replayer.seek(ticks.first().copied().unwrap_or(log.first_tick()))?;
    let mut scenes = Vec::with_capacity(ticks.len());
    for &tick in ticks {
        replayer.run_to(tick)?;
        let scene = replayer.world().scene();
        if stored(tick).is_some_and(|stored| *stored != scene) {
            return Err(Error::from(Box::new(other_scene(tick))).into());
        }
        see(replayer.world(), &scene);
        scenes.push(scene);
    }
    Ok(scenes)
}

fn other_scene(tick: Tick) -> Divergence {
    Divergence {
        tick,
        part: "output".into(),
        actor: None,
        field: "scene".into(),
        expected: "the stored scene".into(),
        got: "another one".into(),
        seen_at: tick,
    }
}
