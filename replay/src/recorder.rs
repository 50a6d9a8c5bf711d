//! Writes a log while the run goes on.

use std::io::Write;

use kernel::arbiter::{Intervention, Outcome};
use kernel::time::Tick;
use kernel::world::PARTS;
use kernel::{Keyframe, TickInput, TickOutput};

use crate::block::{BLOCK_TICKS, Block};
use crate::encode::LogFile;
use crate::wire::MOST_A_TICK;
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
    taken: [Taken; 2],
    /// Camera and digest of the last mask.
    on_screen: Option<(u8, u64)>,
    intervention: Option<Intervention>,
    annotation: Option<Annotation>,
}

/// What was logged of masks, or of notes.
#[derive(Default)]
struct Taken {
    what: &'static str,
    count: u64,
    last: Tick,
}

impl Taken {
    /// Takes one more of a tick after so many ticks.
    fn take(&mut self, tick: Tick, ticks: Tick) -> Result<(), Error> {
        let (what, last, most) = (self.what, self.last, MOST_A_TICK as u64 * (ticks + 1));
        if tick < last {
            return Err(Error::Unsuited(format!(
                "cannot log a {what} of tick {tick}: the one before is of tick {last}"
            )));
        }
        if self.count >= most {
            return Err(Error::Unsuited(format!("cannot log more than {most} {what}s in {ticks} ticks")));
        }
        (self.count, self.last) = (self.count + 1, tick);
        Ok(())
    }
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
            taken: [Taken { what: "mask", ..Taken::default() }, Taken { what: "note", ..Taken::default() }],
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

    /// Logs the mask on the semantic driver's screen, by ascending tick; call it as often as you like, only
    /// changes of the mask are written. Refused are masks that no reader would take.
    pub fn mask_shown(&mut self, mask: MaskShown) -> Result<(), Error> {
        let shown = Some((mask.camera, mask.digest));
        if self.on_screen != shown {
            self.taken[0].take(mask.tick_shown, self.block.mark.tick)?;
            self.on_screen = shown;
            self.masks.push(mask);
        }
        Ok(())
    }

    /// Logs what happened to the rig, by ascending tick. Refused are notes that no reader would take.
    pub fn note(&mut self, note: Note) -> Result<(), Error> {
        self.taken[1].take(note.tick, self.block.mark.tick)?;
        self.notes.push(note);
        Ok(())
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

#[cfg(test)]
mod tests {
    use kernel::Seat;

    use super::*;
    use crate::{NoteKind, testing};

    #[test]
    fn what_no_reader_would_take_is_not_written() {
        let log = testing::sample(1);
        let mut recorder = Recorder::new(Vec::new(), &log.manifest, &log.keyframes[0]).expect("a new log");
        let note = |tick| Note { tick, kind: NoteKind::UnitLost, seat: Some(Seat::Safety) };
        assert!((0..16).all(|_| recorder.note(note(3)).is_ok()));
        let said = |refused: Result<(), Error>| refused.expect_err("refused").to_string();
        assert!(said(recorder.note(note(2))).ends_with("cannot log a note of tick 2: the one before is of tick 3"));
        assert!(said(recorder.note(note(3))).ends_with("cannot log more than 16 notes in 0 ticks"));
        let mask = |tick_shown, digest| MaskShown { tick_shown, digest, ..log.masks[0] };
        recorder.mask_shown(mask(9, 1)).expect("the first");
        recorder.mask_shown(mask(8, 1)).expect("the same mask is not written again");
        assert!(said(recorder.mask_shown(mask(8, 2))).contains("a mask of tick 8"));
    }
}
