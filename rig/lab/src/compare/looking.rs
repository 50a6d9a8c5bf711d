//! What each checkpoint makes of each case: found again from an earlier call, or made.

use base::library::Entry;
use base::progress::Bar;
use drivers::safety::LOOK_TICKS;
use drivers::vision::Eye;
use kernel::time::{CLIP_FPS, CLIP_FRAMES, CLIP_TICKS, TICK_HZ, Tick};
use measures::footage::Footage;
use render::Frame;

use super::super::pipeline::{OpenFile, Work};
use super::super::store::{Settings, Store};
use super::score::CaseScore;
use super::witness::{Facts, Witness};

const _: () = assert!((TICK_HZ / CLIP_FPS) as Tick == LOOK_TICKS, "a witness looks as the safety driver does");

/// The checkpoints look at the cases.
pub struct Looking<'a> {
    pub cases: &'a [Entry],
    pub eyes: &'a [Eye],
    pub store: &'a Store,
    pub settings: Settings,
    pub bar: &'a Bar,
}

/// A case and what each checkpoint made of it.
pub struct Looked {
    pub facts: Facts,
    pub scores: Vec<CaseScore>,
}

/// What is remembered of a case while its frames are on their way.
pub struct Notes {
    facts: Facts,
    /// Numbers of the checkpoints that look.
    eyes: Vec<usize>,
}

impl Work for Looking<'_> {
    type Notes = Notes;
    type Seen = Vec<CaseScore>;

    fn read(&self, index: usize) -> anyhow::Result<(Footage, Notes)> {
        let case = &self.cases[index];
        let mut witness = Witness::default();
        let see = |world: &_, scene: &_| witness.look(world, scene);
        let footage = Footage::watch(&case.path, CLIP_TICKS, CLIP_FPS, see)?;
        let ticks = footage.scenes.iter().map(|scene| scene.tick).collect();
        let facts = witness.facts(&footage.log, ticks);
        Ok((footage, Notes { facts, eyes: self.missing(case) }))
    }

    fn see(&self, file: &OpenFile<Self>, frame: &Frame, eyes: &mut [Eye]) -> anyhow::Result<Vec<CaseScore>> {
        let Notes { facts, eyes: missing } = &file.notes;
        let look = |eye: &usize| {
            let (mask, certainty) = eyes[*eye].see_with_certainty(frame)?;
            Ok(CaseScore::of_frame(frame, &mask, certainty.as_ref(), facts))
        };
        missing.iter().map(look).collect()
    }

    fn finish(&self, file: &OpenFile<Self>, seen: Vec<Vec<CaseScore>>) -> anyhow::Result<()> {
        let (case, Notes { facts, eyes }) = (&self.cases[file.index], &file.notes);
        for (i, eye) in eyes.iter().map(|eye| &self.eyes[*eye]).enumerate() {
            let mut score = CaseScore::default();
            seen.iter().for_each(|frame| score.add(&frame[i]));
            self.store.keep(&mark(case, eye), self.settings.key(case, Some(eye)), score)?;
        }
        self.store.keep(&facts_mark(case), self.settings.key(case, None), facts)?;
        self.bar.inc(CLIP_FRAMES.into());
        Ok(())
    }
}

impl Looking<'_> {
    /// Numbers of the cases of which something is missing.
    pub fn left(&self) -> Vec<usize> {
        (0..self.cases.len()).filter(|case| self.found(&self.cases[*case]).is_none()).collect()
    }

    /// Everything; `None` if anything is missing.
    pub fn all(&self) -> Option<Vec<Looked>> {
        self.cases.iter().map(|case| self.found(case)).collect()
    }

    fn found(&self, case: &Entry) -> Option<Looked> {
        let facts = self.store.find(&facts_mark(case), &self.settings.key(case, None))?;
        let scores = self.eyes.iter().map(|eye| self.score(case, eye)).collect::<Option<_>>()?;
        Some(Looked { facts, scores })
    }

    fn score(&self, case: &Entry, eye: &Eye) -> Option<CaseScore> {
        self.store.find(&mark(case, eye), &self.settings.key(case, Some(eye)))
    }

    fn missing(&self, case: &Entry) -> Vec<usize> {
        (0..self.eyes.len()).filter(|eye| self.score(case, &self.eyes[*eye]).is_none()).collect()
    }
}

fn facts_mark(case: &Entry) -> String {
    format!("{}/facts", case.name)
}

fn mark(case: &Entry, eye: &Eye) -> String {
    format!("{}/checkpoints/{}", case.name, eye.name())
}
