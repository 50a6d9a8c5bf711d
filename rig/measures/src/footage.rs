//! The scenes of a window of a recording or case, from a replay that compared every tick of it.

use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

use anyhow::Context;
use base::failure::Usage;
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
        let asked = Asked { last: Some(last), from: None, to: None, fps };
        let ticks: Vec<Tick> = Window::of(&log, &asked).with_context(file)?.pictures().collect();
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

/// The window of a log that is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// Its length, where it ends at the [`decisive_tick`]; the other two count only without it.
    pub last: Option<Tick>,
    /// Its first tick; none: that of the log.
    pub from: Option<Tick>,
    /// Its last tick; none: that of the log.
    pub to: Option<Tick>,
    /// Pictures a second, a divisor of the tick rate.
    pub fps: u32,
}

/// A window of a log, and which of its ticks have a picture.
#[derive(Clone, Debug)]
pub struct Window {
    /// The ticks, of which there is at least one.
    pub ticks: RangeInclusive<Tick>,
    /// Ticks from one picture to the next.
    pub stride: Tick,
    /// A tick that has a picture, if it is within.
    pub anchor: Tick,
}

impl Window {
    /// The ticks that are asked for, as far as the log holds them.
    pub fn of(log: &Log, asked: &Asked) -> anyhow::Result<Self> {
        let (first, last) = (log.first_tick(), log.last_tick());
        let anchor = decisive_tick(log);
        let (from, to) = match asked.last {
            Some(length) => ((anchor + 1).saturating_sub(length), anchor),
            None => (asked.from.unwrap_or(first), asked.to.unwrap_or(last)),
        };
        let ticks = from.max(first)..=to.min(last);
        if ticks.is_empty() {
            let seconds = |tick: Tick| tick as f64 / f64::from(TICK_HZ);
            let (first, last) = (seconds(first), seconds(last));
            return Err(
                Usage(format!("holds {first:.2} s to {last:.2} s of its run, and nothing of that window")).into()
            );
        }
        Ok(Self { ticks, stride: Tick::from(TICK_HZ / asked.fps), anchor })
    }

    /// Whether a tick has a picture.
    pub fn has_picture(&self, tick: Tick) -> bool {
        tick.abs_diff(self.anchor).is_multiple_of(self.stride)
    }

    /// The ticks that have a picture, ascending.
    pub fn pictures(&self) -> impl Iterator<Item = Tick> {
        self.ticks.clone().filter(|tick| self.has_picture(*tick))
    }
}

/// The scenes at these ticks. A case made by another kernel cannot be replayed; its stored scenes
/// can still be drawn. `see` is shown the world at each tick, unless another kernel made the log.
pub fn scenes(
    log: &Log,
    network: &Arc<RoadNetwork>,
    ticks: &[Tick],
    mut see: impl FnMut(&World, &SceneSnapshot),
) -> anyhow::Result<Vec<SceneSnapshot>> {
    let mut scenes = Vec::with_capacity(ticks.len());
    each_scene(log, network, ticks, |world, scene| {
        if let Some(world) = world {
            see(world, &scene);
        }
        scenes.push(scene);
        Ok(())
    })?;
    Ok(scenes)
}

/// As [`scenes`], one after the other, so that a long window need not fit into memory. The world is there unless
/// another kernel made the log; an error of `take` ends it.
pub fn each_scene(
    log: &Log,
    network: &Arc<RoadNetwork>,
    ticks: &[Tick],
    mut take: impl FnMut(Option<&World>, SceneSnapshot) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let stored = |tick: Tick| log.scenes.iter().find(|scene| scene.tick == tick);
    if log.manifest.kernel != kernel::identity() {
        let all: Option<Vec<_>> = ticks.iter().map(|tick| stored(*tick).cloned()).collect();
        let (made_by, this) = (&log.manifest.kernel, kernel::identity());
        let all = all.with_context(|| {
            format!("made by kernel {made_by}; this one, {this}, can draw no more than the stored scenes of a case")
        })?;
        return all.into_iter().try_for_each(|scene| take(None, scene));
    }
    let mut replayer = Replayer::new(log, network.clone())?;
    replayer.seek(ticks.first().copied().unwrap_or(log.first_tick()))?;
    for &tick in ticks {
        replayer.run_to(tick)?;
        let scene = replayer.world().scene();
        if stored(tick).is_some_and(|stored| *stored != scene) {
            return Err(Error::from(Box::new(other_scene(tick))).into());
        }
        take(Some(replayer.world()), scene)?;
    }
    Ok(())
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
