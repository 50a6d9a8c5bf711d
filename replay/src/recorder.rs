//! Writes a log while the run goes on.

use std::io::Write;

use kernel::arbiter::{Intervention, Outcome};
use kernel::time::Tick;
use kernel::world::PARTS;
use kernel::{Keyframe, TickInput, TickOutput};

use crate::block::{BLOCK_TICKS, Block};
use crate::encode::LogFile;
use crate::{Annotation, Error, Manifest, Mark, MaskShown, Note, RunSummary};

/// Writes a recording. What was written is only ever appended to, a block each second and at every
/// intervention, so that a killed process loses at most a second.
///
/// [`Recorder::finish`] must be called: without it the file reads as that of a killed process, and
/// the ticks since the last block are lost.
#[must_use = "a recording is complete only after `finish`"]
pub struct Recorder<W: Write> {
    file: LogFile<W>,
    block: Block,
    masks: Vec<MaskShown>,
    notes: Vec<Note>,
    /// Camera and digest of the last mask.
    on_screen: Option<(u8, u64)>,
    intervention: Option<Intervention>,
    annotation: Option<Annotation>,
}

impl<W: Write> Recorder<W> {
    /// Starts a recording: writes the manifest and the state of tick 0
    /// ([`kernel::World::initial_keyframe`]).
    pub fn new(out: W, manifest: &Manifest, start: &Keyframe) -> Result<Self, Error> {
        Ok(Self {
            file: LogFile::new(out, manifest, start)?,
            block: Block::starting_at(start.tick + 1),
            masks: Vec::new(),
            notes: Vec::new(),
            on_screen: None,
            intervention: None,
            annotation: None,
        })
    }

    /// Logs a tick: its input, what [`kernel::World::step`] gave, and
    /// [`kernel::World::part_hashes`] after it.
    pub fn tick(&mut self, input: &TickInput, output: &TickOutput, parts: &[u64; PARTS.len()]) -> Result<(), Error> {
        let (tick, expected) = (output.tick, self.block.first + self.block.inputs.len() as Tick);
        if tick != expected {
            return Err(Error::Unsuited(format!("cannot log tick {tick}: expected tick {expected}")));
        }
        self.block.push(input, output, parts);
        self.intervention = self.intervention.or(output.intervention);
        if tick.is_multiple_of(BLOCK_TICKS) || output.intervention.is_some() {
            self.end_block()?;
        }
        Ok(())
    }

    /// Logs the mask on the semantic driver's screen; call it as often as you like, only changes of
    /// the mask are written.
    pub fn mask_shown(&mut self, mask: MaskShown) {
        let shown = Some((mask.camera, mask.digest));
        if self.on_screen != shown {
            self.on_screen = shown;
            self.masks.push(mask);
        }
    }

    /// Logs what happened to the rig, by ascending tick.
    pub fn note(&mut self, note: Note) {
        self.notes.push(note);
    }

    /// Says what the intervention was; the last call counts.
    pub fn annotate(&mut self, annotation: Annotation) {
        self.annotation = Some(annotation);
    }

    /// Ends the recording and hands the stream back, flushed.
    pub fn finish(mut self, outcome: Option<Outcome>) -> Result<W, Error> {
        let Mark { tick, odometer_mm, .. } = self.block.mark;
        if !self.block.inputs.is_empty() {
            self.end_block()?;
        }
        let summary = RunSummary { ticks: tick, odometer_mm, intervention: self.intervention, outcome };
        self.file.finish(&self.masks, &self.notes, tick, self.annotation.as_ref(), Some(&summary))
    }

    fn end_block(&mut self) -> Result<(), Error> {
        let last = self.block.mark.tick;
        let later = self.masks.iter().position(|m| m.tick_shown > last).unwrap_or(self.masks.len());
        let masks = self.masks.drain(..later);
        let later = self.notes.iter().position(|n| n.tick > last).unwrap_or(self.notes.len());
        let notes = self.notes.drain(..later);
        let next = Block { mark: self.block.mark, ..Block::starting_at(last + 1) };
        let block = std::mem::replace(&mut self.block, next);
        self.file.block(&block, masks.as_slice(), notes.as_slice())
    }
}
