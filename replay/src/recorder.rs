//! Writes a log while the run goes on.

use std::io::Write;

use kernel::arbiter::Outcome;
use kernel::world::PARTS;
use kernel::{Keyframe, TickInput, TickOutput};

use crate::{Annotation, Error, Manifest, MaskShown};

/// Writes a recording. What was written is only ever appended to, a block each second and at every
/// intervention, so that a killed process loses at most a second.
///
/// [`Recorder::finish`] must be called: without it the file reads as that of a killed process, and
/// the ticks since the last block are lost.
#[must_use = "a recording is complete only after `finish`"]
pub struct Recorder<W: Write> {
    out: W,
}

impl<W: Write> Recorder<W> {
    /// Starts a recording: writes the manifest and the state of tick 0
    /// ([`kernel::World::initial_keyframe`]).
    pub fn new(_out: W, _manifest: &Manifest, _start: &Keyframe) -> Result<Self, Error> {
        todo!()
    }

    /// Logs a tick: its input, what [`kernel::World::step`] gave, and
    /// [`kernel::World::part_hashes`] after it.
    pub fn tick(&mut self, _input: &TickInput, _output: &TickOutput, _parts: &[u64; PARTS.len()]) -> Result<(), Error> {
        todo!()
    }

    /// Logs the mask on the semantic driver's screen; call it as often as you like, only changes of
    /// the mask are written.
    pub fn mask_shown(&mut self, _mask: MaskShown) {
        todo!()
    }

    /// Says what the intervention was; the last call counts.
    pub fn annotate(&mut self, _annotation: Annotation) {
        todo!()
    }

    /// Ends the recording and hands the stream back, flushed.
    pub fn finish(self, _outcome: Option<Outcome>) -> Result<W, Error> {
        todo!()
    }
}
