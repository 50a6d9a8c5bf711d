//! A block as the file holds it: its messages, one after the other, in one chunk.

use std::io::Write;

use kernel::time::Tick;

use crate::block::{Block, Happenings};
use crate::container::Container;
use crate::layout::Channel;
use crate::{Error, MaskShown, Note, wire};

/// Writes a block, the masks shown in it and the notes of it as one chunk. `state` is the last
/// keyframe before it, and becomes the last one in it.
pub(crate) fn write<W: Write>(
    block: &Block,
    masks: &[MaskShown],
    notes: &[Note],
    state: &mut Vec<u8>,
    out: &mut Container<W>,
) -> Result<(), Error> {
    let last = block.mark.tick;
    out.put(Channel::Block, last, &wire::block_bytes(block))?;
    for keyframe in &block.keyframes {
        out.put(Channel::Keyframe, keyframe.tick, &wire::keyframe_bytes(keyframe, state))?;
        state.clone_from(&keyframe.bytes);
    }
    if block.happenings != Happenings::default() {
        out.put(Channel::Events, last, &wire::happenings_bytes(&block.happenings))?;
    }
    put_rows(masks, notes, last, out)?;
    out.flush()
}

/// Writes masks and notes, if there are any, in messages of a length that the reader takes.
pub(crate) fn put_rows<W: Write>(
    masks: &[MaskShown],
    notes: &[Note],
    tick: Tick,
    out: &mut Container<W>,
) -> Result<(), Error> {
    for some in masks.chunks(wire::MOST_ROWS) {
        out.put(Channel::Masks, tick, &wire::masks_bytes(some))?;
    }
    for some in notes.chunks(wire::MOST_ROWS) {
        out.put(Channel::Notes, tick, &wire::notes_bytes(some))?;
    }
    Ok(())
}
