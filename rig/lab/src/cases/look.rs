//! Who was overlooked in a case, and how critical it was: by simulating it, drawing it, and looking at it through the
//! checkpoint of its drive.

use std::collections::BTreeMap;
use std::path::PathBuf;

use anyhow::Context;
use base::progress::Bar;
use base::words;
use drivers::vision::Eye;
use kernel::SceneSnapshot;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use measures::criticality::Extremes;
use measures::footage::Footage;
use measures::{Criticality, footage};
use perception::Mask;
use render::{EGO_INSTANCE, FIRST_PARKED_INSTANCE, Frame, instance_of_actor};

use super::line::OverlookedLine;
use super::query::PARKED_CAR;
use crate::compare::{Hits, Witness};
use crate::pipeline::{OpenFile, Work};

/// What was found out about a case.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// How close it came; nothing of a case of another kernel.
    pub extremes: Option<Extremes>,
    /// Whom the takeover is about.
    pub hazard: Option<String>,
    /// Who was overlooked.
    pub overlooked: Vec<OverlookedLine>,
}

/// Looks at cases through one checkpoint.
pub struct Looking<'a, K: Fn(usize, Measured) -> anyhow::Result<()> + Sync> {
    /// The files.
    pub files: &'a [PathBuf],
    /// Keeps what was found out about a file.
    pub keep: K,
    /// A step a file.
    pub bar: &'a Bar,
}

/// What is remembered of a case while its frames are on their way.
pub struct Notes {
    extremes: Option<Extremes>,
    hazard: Option<String>,
    /// By instance in frames.
    kinds: BTreeMap<u16, Name>,
}

/// What somebody is called.
struct Name {
    actor: String,
    kind: &'static str,
}

/// Pixels of everybody in a frame, by instance.
type Seen = BTreeMap<u16, Hits>;

impl<K: Fn(usize, Measured) -> anyhow::Result<()> + Sync> Work for Looking<'_, K> {
    type Notes = Notes;
    type Seen = Seen;

    fn read(&self, index: usize) -> anyhow::Result<(Footage, Notes)> {
        let path = &self.files[index];
        let mut witness = Witness::default();
        let footage = Footage::watch(path, CLIP_TICKS, CLIP_FPS, |world, scene| witness.look(world, scene))?;
        let facts = witness.facts(&footage.log, footage.scenes.iter().map(|scene| scene.tick).collect());
        let extremes = match facts.other_kernel {
            Some(_) => None,
            None => criticality(&footage).with_context(|| path.display().to_string())?,
        };
        let notes = Notes { extremes, hazard: facts.hazard.map(|hazard| hazard.what), kinds: kinds(&footage.scenes) };
        Ok((footage, notes))
    }

    fn see(&self, _: &OpenFile<Self>, frame: &Frame, eyes: &mut [Eye]) -> anyhow::Result<Seen> {
        let eye = eyes.first_mut().context("an eye")?;
        Ok(pixels(frame, &eye.see(frame.clone())?))
    }

    fn finish(&self, file: &OpenFile<Self>, seen: Vec<Seen>) -> anyhow::Result<()> {
        let Notes { extremes, hazard, kinds } = &file.notes;
        let overlooked = overlooked(&seen, |instance| name(kinds, instance));
        (self.keep)(file.index, Measured { extremes: extremes.clone(), hazard: hazard.clone(), overlooked })?;
        self.bar.inc(1);
        Ok(())
    }
}

fn criticality(footage: &footage::Footage) -> Result<Option<Extremes>, replay::Error> {
    Ok(Criticality::of_case(&footage.log, &footage.network)?.map(|criticality| criticality.extremes))
}

/// What the road users of a window are called, by instance.
fn kinds(scenes: &[SceneSnapshot]) -> BTreeMap<u16, Name> {
    let actors = scenes.iter().flat_map(|scene| &scene.actors).map(|actor| {
        let name = Name { actor: words::actor(actor), kind: words::road_user(actor.kind) };
        (instance_of_actor(actor.id), name)
    });
    // A parked car that was pushed is one still.
    actors.filter(|(instance, _)| *instance < FIRST_PARKED_INSTANCE).collect()
}

fn name(kinds: &BTreeMap<u16, Name>, instance: u16) -> (String, String) {
    match kinds.get(&instance) {
        Some(name) => (name.actor.clone(), name.kind.to_owned()),
        None => (format!("{PARKED_CAR} {}", instance.saturating_sub(FIRST_PARKED_INSTANCE)), PARKED_CAR.to_owned()),
    }
}

/// Pixels of each road user and how many of them have the right class.
fn pixels(frame: &Frame, mask: &Mask) -> Seen {
    let mut seen = Seen::new();
    for ((truth, predicted), instance) in frame.class_ids.iter().zip(&mask.ids).zip(&frame.instance_ids) {
        if *instance != 0 && *instance != EGO_INSTANCE {
            seen.entry(*instance).or_default().count(truth == predicted);
        }
    }
    seen
}

/// Who was visible and not seen in any frame, most pixels first.
fn overlooked(frames: &[Seen], name: impl Fn(u16) -> (String, String)) -> Vec<OverlookedLine> {
    let mut sums: BTreeMap<u16, (u32, u64)> = BTreeMap::new();
    let missed = frames.iter().flatten().filter(|(_, hits)| hits.is_visible() && !hits.is_seen());
    for (instance, hits) in missed {
        let (frames, pixels) = sums.entry(*instance).or_default();
        *frames += 1;
        *pixels += hits.of - hits.right;
    }
    let line = |(instance, (frames, pixels)): (u16, (u32, u64))| {
        let (actor, kind) = name(instance);
        OverlookedLine { actor, kind, frames, pixels: u32::try_from(pixels).unwrap_or(u32::MAX) }
    };
    let mut lines: Vec<OverlookedLine> = sums.into_iter().map(line).collect();
    lines.sort_by(|a, b| b.pixels.cmp(&a.pixels).then_with(|| a.actor.cmp(&b.actor)));
    lines
}

#[cfg(test)]
mod tests {
    use perception::classes::PEDESTRIAN_TAG;
    use render::SemanticTag;

    use super::*;

    #[test]
    fn who_is_visible_and_seen_by_less_than_half_is_overlooked() {
        let (road, car) = (SemanticTag::Road as u8, SemanticTag::Vehicles as u8);
        let class_ids = [vec![PEDESTRIAN_TAG; 20], vec![car; 7], vec![car; 9], vec![road; 4]].concat();
        let instance_ids = [vec![5; 20], vec![6; 7], vec![FIRST_PARKED_INSTANCE + 3; 9], vec![0; 4]].concat();
        let frame = Frame { width: 40, height: 1, class_ids, instance_ids, ..Frame::default() };
        let look = |right: usize| {
            let mut ids = vec![road; 40];
            ids[..right].fill(PEDESTRIAN_TAG);
            pixels(&frame, &Mask::new(40, 1, ids).expect("40 pixels"))
        };
        let kinds = [(5, Name { actor: "pedestrian 5".into(), kind: "pedestrian" })].into();
        let found = overlooked(&[look(9), look(10), look(0)], |instance| name(&kinds, instance));
        let told: Vec<_> = found.iter().map(|it| (it.actor.as_str(), it.kind.as_str(), it.frames, it.pixels)).collect();
        // Of 20 pixels 10 are enough; 7 are too few to tell.
        assert_eq!(told, [("pedestrian 5", "pedestrian", 2, 31), ("parked car 3", "parked car", 3, 27)]);
    }
}
