//! The order of messages in a file, whether a run or a whole log is written.

use std::io::Write;

use kernel::Keyframe;
use kernel::time::Tick;

use crate::block::{BLOCK_TICKS, Block, Happenings};
use crate::container::Container;
use crate::layout::Channel;
use crate::{Annotation, Error, Log, Manifest, Mark, MaskShown, Note, RunSummary, chunk, wire};

/// A log's file being written.
pub(crate) struct LogFile<W: Write> {
    file: Container<W>,
    /// Bytes of the last keyframe written.
    state: Vec<u8>,
}

impl<W: Write> LogFile<W> {
    pub fn new(out: W, manifest: &Manifest, start: &Keyframe) -> Result<Self, Error> {
        let mut file = Container::new(out)?;
        file.put(Channel::Manifest, start.tick, &wire::manifest_bytes(manifest))?;
        if let Some(map) = manifest.foreign_map.as_ref().filter(|map| map.embedded) {
            let text = map.text.as_ref().ok_or_else(|| manifest.no_map())?;
            file.put(Channel::Map, start.tick, text.as_bytes())?;
        }
        file.put(Channel::Keyframe, start.tick, &wire::keyframe_bytes(start, &[]))?;
        file.flush()?;
        Ok(Self { file, state: start.bytes.clone() })
    }

    pub fn block(&mut self, block: &Block, masks: &[MaskShown], notes: &[Note]) -> Result<(), Error> {
        chunk::write(block, masks, notes, &mut self.state, &mut self.file)
    }

    pub fn finish(
        mut self,
        masks: &[MaskShown],
        notes: &[Note],
        tick: Tick,
        annotation: Option<&Annotation>,
        summary: Option<&RunSummary>,
    ) -> Result<W, Error> {
        chunk::put_rows(masks, notes, tick, &mut self.file)?;
        self.file.put(Channel::End, tick, &wire::end_bytes(annotation, summary))?;
        self.file.finish()
    }
}

impl Log {
    /// The file with this content, byte for byte what a [`Recorder`](crate::Recorder) writes. Nothing of the content
    /// is checked against a simulation: that is what verifying is for.
    pub fn encode(&self) -> Result<Vec<u8>, Error> {
        let start =
            self.keyframes.first().ok_or_else(|| Error::Unsuited("a log needs a keyframe to start from".into()))?;
        let mut file = LogFile::new(Vec::new(), &self.manifest, start)?;
        let (mut masks, mut notes) = (&self.masks[..], &self.notes[..]);
        let mut first = start.tick + 1;
        for mark in &self.marks {
            let shown = masks.iter().position(|m| m.tick_shown > mark.tick).unwrap_or(masks.len());
            let noted = notes.iter().position(|n| n.tick > mark.tick).unwrap_or(notes.len());
            file.block(&self.block(first, mark)?, &masks[..shown], &notes[..noted])?;
            (first, masks, notes) = (mark.tick + 1, &masks[shown..], &notes[noted..]);
        }
        if first != self.last_tick() + 1 {
            return Err(Error::Unsuited(format!("a log needs a mark at its last tick {}", self.last_tick())));
        }
        if !self.scenes.is_empty() {
            file.file.put(Channel::Scenes, self.last_tick(), &wire::scenes_bytes(&self.scenes))?;
        }
        file.finish(masks, notes, self.last_tick(), self.annotation.as_ref(), self.summary.as_ref())
    }

    /// The block from tick `first` to a mark.
    fn block(&self, first: Tick, mark: &Mark) -> Result<Block, Error> {
        let start = self.first_tick() + 1;
        let within = |tick: Tick| (first..=mark.tick).contains(&tick);
        let rows = (first - start) as usize..(mark.tick + 1).saturating_sub(start) as usize;
        let rows = || rows.clone();
        match (self.inputs.get(rows()), self.hashes.get(rows())) {
            (Some(inputs), Some(hashes)) if !inputs.is_empty() && inputs.len() as Tick <= BLOCK_TICKS => Ok(Block {
                inputs: inputs.to_vec(),
                hashes: hashes.to_vec(),
                mark: *mark,
                keyframes: self.keyframes.iter().filter(|k| within(k.tick)).cloned().collect(),
                happenings: Happenings {
                    events: self.events.iter().filter(|(tick, _)| within(*tick)).copied().collect(),
                    intervention: self.intervention.filter(|i| within(i.tick)),
                },
                ..Block::starting_at(first)
            }),
            _ => Err(Error::Unsuited(format!("a log needs 1 to {BLOCK_TICKS} ticks before the mark at {}", mark.tick))),
        }
    }
}
