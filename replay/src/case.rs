//! Corner cases: self-contained cuts around an intervention.

use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

use kernel::time::{CLIP_FRAMES, CLIP_STRIDE_TICKS, CLIP_TICKS, Tick, seconds};
use kernel::{RoadNetwork, SceneSnapshot};

use crate::{CaseInfo, Error, Log, Mark, Recording, Replayer, RunSummary};

/// A self-contained cut of a recording: the keyframe before its window, the inputs from there to after
/// the outcome, and the scene of every clip frame of the window. It verifies as a recording does.
#[derive(Clone, Debug)]
pub struct Case {
    log: Log,
    info: CaseInfo,
}

impl Case {
    /// The window that a recording's intervention (or the collision nobody prevented) asks for: the
    /// ticks of the 30 clip frames up to it, first to last. `None` when nothing of the kind happened.
    pub fn window(log: &Log) -> Option<RangeInclusive<Tick>> {
        let to = log.decided_at()?;
        let from = to.checked_sub(Tick::from(CLIP_FRAMES - 1) * CLIP_STRIDE_TICKS)?;
        Some(from..=to)
    }

    /// Cuts a window out of a recording by replaying it; every tick of the case is compared. The
    /// scenes kept are those of the window's first tick and of every `CLIP_STRIDE_TICKS` after it. A case
    /// without the intervention has no annotation.
    pub fn cut(recording: &Recording, network: &Arc<RoadNetwork>, window: RangeInclusive<Tick>) -> Result<Self, Error> {
        let log = recording.log();
        let (from, to) = (*window.start(), *window.end());
        let mut replayer = Replayer::new(log, network.clone())?;
        replayer.seek(start_of(log, from, to))?;
        let end = log.last_tick().min(to + seconds(log.manifest.scenario.rules.takeover_s));
        let scenes = scenes(&mut replayer, window)?;
        replayer.run_to(end)?;
        let info = CaseInfo { source: recording.source(), from, to };
        Ok(Self { log: cut_log(&replayer, &info, scenes), info })
    }

    /// Reads a case's file; a recording that is no case is refused.
    pub fn open(path: &Path) -> Result<Self, Error> {
        Self::try_from(Recording::open(path)?).map_err(|e| e.within(path))
    }

    /// The bytes of its file.
    pub fn encode(&self) -> Result<Vec<u8>, Error> {
        self.log.encode()
    }

    /// The content, as that of a recording.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// Where it was cut from.
    pub fn info(&self) -> &CaseInfo {
        &self.info
    }

    /// The scenes of its clip, by ascending tick.
    pub fn scenes(&self) -> &[SceneSnapshot] {
        &self.log.scenes
    }
}

/// The ticks of a window whose scenes a case keeps.
pub(crate) fn scene_ticks(window: RangeInclusive<Tick>) -> impl Iterator<Item = Tick> {
    window.step_by(CLIP_STRIDE_TICKS as usize)
}

fn scenes(replayer: &mut Replayer<'_>, window: RangeInclusive<Tick>) -> Result<Vec<SceneSnapshot>, Error> {
    scene_ticks(window).map(|tick| replayer.run_to(tick).map(|()| replayer.world().scene())).collect()
}

/// The keyframe that a case begins with: from there forks of case and recording are the same.
fn start_of(log: &Log, from: Tick, to: Tick) -> Tick {
    let reach = from.min(to.saturating_sub(CLIP_TICKS));
    log.keyframes.iter().map(|k| k.tick).rfind(|t| *t <= reach).unwrap_or(log.first_tick())
}

/// The log from the keyframe before the window to where the replayer stands.
fn cut_log(replayer: &Replayer<'_>, info: &CaseInfo, scenes: Vec<SceneSnapshot>) -> Log {
    let (log, world) = (replayer.log(), replayer.world());
    let end = world.tick();
    let start = start_of(log, info.from, info.to);
    let inside = |tick: Tick| start < tick && tick <= end;
    let rows = (start - log.first_tick()) as usize..(end - log.first_tick()) as usize;
    let mark = Mark { tick: end, hash: world.hash(), parts: world.part_hashes(), odometer_mm: world.odometer_mm() };
    let (arbiter, mut manifest) = (world.arbiter(), log.manifest.clone());
    manifest.case = Some(info.clone());
    let holds_its_end = Case::window(log).is_none_or(|window| inside(*window.end()));
    Log {
        manifest,
        keyframes: log.keyframes.iter().filter(|k| k.tick == start || inside(k.tick)).cloned().collect(),
        inputs: log.inputs[rows.clone()].to_vec(),
        hashes: log.hashes[rows].to_vec(),
        marks: log.marks.iter().filter(|m| inside(m.tick) && m.tick < end).copied().chain([mark]).collect(),
        events: log.events.iter().filter(|(tick, _)| inside(*tick)).copied().collect(),
        intervention: log.intervention.filter(|i| inside(i.tick)),
        masks: log.masks.iter().filter(|m| inside(m.tick_shown)).copied().collect(),
        notes: log.notes.iter().filter(|n| inside(n.tick)).copied().collect(),
        annotation: log.annotation.clone().filter(|_| holds_its_end),
        summary: Some(RunSummary {
            ticks: end,
            odometer_mm: world.odometer_mm(),
            intervention: arbiter.intervention,
            outcome: arbiter.outcome,
        }),
        scenes,
    }
}

impl TryFrom<Recording> for Case {
    type Error = Error;

    fn try_from(recording: Recording) -> Result<Self, Error> {
        let log = recording.into_log();
        match log.manifest.case.clone() {
            Some(info) => Ok(Self { log, info }),
            None => Err(Error::Unsuited("a recording, not a corner case".into())),
        }
    }
}
