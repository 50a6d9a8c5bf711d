//! The layout of a file: which channels there are, and what a message of each holds.
//!
//! An MCAP file with profile `""`, in chunks compressed by zstd, one chunk a block. Payloads are
//! bincode 2 (standard configuration: little-endian, variable-length integers, zigzag for signed
//! ones), as `wire.rs` declares them; "state bytes" are the canonical bytes of `kernel::state`.
//! Message times are simulated time: the tick at which the message was complete, in nanoseconds.

use kernel::time::{TICK_HZ, Tick};

/// A channel of the file; the discriminant is its MCAP channel and schema id.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u16)]
pub(crate) enum Channel {
    Manifest = 1,
    Keyframe = 2,
    Block = 3,
    Events = 4,
    Masks = 5,
    End = 6,
    Scenes = 7,
    Notes = 8,
}

/// What stands in the file about a channel.
pub(crate) struct Layout {
    pub channel: Channel,
    pub topic: &'static str,
    /// Name of the schema, ending in the version of the layout.
    pub schema: &'static str,
    /// Text of the schema: what a message holds.
    pub text: &'static str,
}

/// Encoding of messages and of schema texts, as MCAP names them.
pub(crate) const MESSAGE_ENCODING: &str = "bincode2";
pub(crate) const SCHEMA_ENCODING: &str = "text";

/// Every channel, in the order of their ids.
pub(crate) const CHANNELS: [Layout; 8] = [
    Layout {
        channel: Channel::Manifest,
        topic: "/manifest",
        schema: "aeye.Manifest.1",
        text: "The first message. format u16, kernel version string, map name string, seed u64, then state bytes of \
               traffic counts, weather, ego start and rules; map digest 16 bytes; OpenDRIVE text of a foreign map \
               (option); provenance (map string to string); of a corner case (option): blake3 of its source, first \
               and last tick of its window.",
    },
    Layout {
        channel: Channel::Keyframe,
        topic: "/keyframes",
        schema: "aeye.Keyframe.1",
        text: "tick u64, length, state bytes of the whole world as a zstd frame whose dictionary is the state before. \
               The first one is where the log starts and has no dictionary.",
    },
    Layout {
        channel: Channel::Block,
        topic: "/blocks",
        schema: "aeye.Block.1",
        text: "Up to 60 ticks. First tick u64; of both seats, semantic first: columns of steer, throttle, brake and \
               flags, each the difference to the tick before (the first to 0); the low 4 bytes of each tick's hash; \
               at the last tick: hash 16 bytes, 8 bytes for each part of the state, odometer in millimetres.",
    },
    Layout {
        channel: Channel::Events,
        topic: "/events",
        schema: "aeye.Events.1",
        text: "Events of a block, if any: column of ticks (differences), state bytes of the list of events, state \
               bytes of the intervention (option).",
    },
    Layout {
        channel: Channel::Masks,
        topic: "/masks",
        schema: "aeye.Masks.1",
        text: "Masks that came onto the semantic driver's screen, if any, as columns: tick shown (differences), age \
               in ticks, camera, 8 bytes of digest each, and live times in microseconds (option: capture, inference \
               after that, present after that).",
    },
    Layout {
        channel: Channel::End,
        topic: "/end",
        schema: "aeye.End.1",
        text: "The last message. Annotation (option): label u8, comment, perception-caused (option bool). Summary \
               (option): ticks, odometer in millimetres, state bytes of intervention and outcome (options).",
    },
    Layout {
        channel: Channel::Scenes,
        topic: "/scenes",
        schema: "aeye.Scenes.1",
        text: "Of a corner case: state bytes of the snapshots of its window, stacked. Lengths of the snapshots; \
               then, if all are equal, their bytes transposed, each the difference to the snapshot before; else one \
               after the other.",
    },
    Layout {
        channel: Channel::Notes,
        topic: "/notes",
        schema: "aeye.Notes.1",
        text: "What happened to the rig, if anything, as columns: tick (differences), code of the kind, seat \
               (0 semantic, 1 safety).",
    },
];

impl Channel {
    /// The channel with an id.
    pub fn from_id(id: u16) -> Option<Self> {
        CHANNELS.iter().map(|l| l.channel).find(|c| *c as u16 == id)
    }
}

/// Time of a tick in a file, nanoseconds from tick 0.
pub fn nanoseconds(tick: Tick) -> u64 {
    u64::try_from(u128::from(tick) * 1_000_000_000 / u128::from(TICK_HZ)).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_topics_and_schemas_are_distinct_and_in_order() {
        for (i, layout) in CHANNELS.iter().enumerate() {
            assert_eq!(layout.channel as usize, i + 1);
            assert_eq!(Channel::from_id(i as u16 + 1), Some(layout.channel));
            assert!(!layout.text.is_empty());
            assert!(CHANNELS[..i].iter().all(|l| l.topic != layout.topic && l.schema != layout.schema));
        }
        assert_eq!(Channel::from_id(0), None);
    }

    #[test]
    fn a_second_is_a_billion_nanoseconds() {
        assert_eq!(nanoseconds(60), 1_000_000_000);
        assert_eq!(nanoseconds(1), 16_666_666);
    }
}
