//! The layout of a file: which channels there are, and what a message of each holds.
//!
//! An MCAP file with profile `""`, in chunks compressed by zstd, one chunk a block. Payloads are
//! bincode 2 (standard configuration: little-endian, variable-length integers, zigzag for signed
//! ones), as `wire.rs` declares them; "state bytes" are the canonical bytes of `kernel::state`.
//! docs/recording.md says all of it for readers in other languages.
//! Message times are simulated time: the tick at which the message was complete, in nanoseconds.

use kernel::time::{TICK_HZ, Tick};

/// Version of the layout that is written; the names of all schemas end with it.
pub const FORMAT_VERSION: u16 = 3;
/// The oldest version that is read: it has no seals, holds a foreign map in its manifest, and names its kernel by a
/// number.
pub(crate) const OLDEST_VERSION: u16 = 1;

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
    Map = 9,
    Seal = 10,
}

/// What stands in the file about a channel.
pub(crate) struct Layout {
    pub channel: Channel,
    /// The first version of the layout that has it.
    pub since: u16,
    pub topic: &'static str,
    /// Name of the schema, without the version of the layout.
    name: &'static str,
    /// Text of the schema: what a message holds.
    pub text: &'static str,
}

/// Encoding of messages and of schema texts, as MCAP names them.
pub(crate) const MESSAGE_ENCODING: &str = "bincode2";
pub(crate) const SCHEMA_ENCODING: &str = "text";

const fn layout(channel: Channel, since: u16, topic: &'static str, name: &'static str, text: &'static str) -> Layout {
    Layout { channel, since, topic, name, text }
}

/// Every channel, in the order of their ids.
pub(crate) const CHANNELS: [Layout; 10] = [
    layout(
        Channel::Manifest,
        1,
        "/manifest",
        "aeye.Manifest",
        "The first message. version of the layout u16; kernel string: its version and a digest of its golden timeline; \
         engines string: the libraries it was built on, with versions; scenario string: TOML; map digest 16 bytes, of \
         the baked map; of a foreign map (option): blake3 of its OpenDRIVE text; provenance (map string to string); of \
         a corner case (option): blake3 of its source, first and last tick of its window.",
    ),
    layout(
        Channel::Keyframe,
        1,
        "/keyframes",
        "aeye.Keyframe",
        "tick u64, length, state bytes of the whole world as a zstd frame whose dictionary is the state before, xxh3-128 \
         of the state bytes: the hash of the tick. The first one is where the log starts and has no dictionary.",
    ),
    layout(
        Channel::Block,
        1,
        "/blocks",
        "aeye.Block",
        "Up to 60 ticks. First tick u64; of both seats, semantic first: columns of steer i16, throttle u16, brake u16 \
         and flags u8, each as the zigzag difference to the tick before (the first to 0) in 16 bits, first all low \
         bytes, then all high ones; the low 4 bytes of each tick's hash; at the last tick: hash 16 bytes, 8 bytes for \
         each part of the state, odometer in millimetres u64.",
    ),
    layout(
        Channel::Events,
        1,
        "/events",
        "aeye.Events",
        "Events of the block before, if any: column of ticks (differences), state bytes of the list of events, state \
         bytes of the intervention (option).",
    ),
    layout(
        Channel::Masks,
        1,
        "/masks",
        "aeye.Masks",
        "Masks that came onto the semantic driver's screen, if any, as columns: tick shown (differences), age in ticks, \
         camera, 8 bytes of digest each, and live times in microseconds (option: capture, as difference to that of the \
         mask before; inference after that; present after that).",
    ),
    layout(
        Channel::End,
        1,
        "/end",
        "aeye.End",
        "The last message but its seal. Annotation (option): label u8, comment, perception-caused (option bool). Summary \
         (option): ticks, odometer in millimetres, state bytes of intervention and outcome (options).",
    ),
    layout(
        Channel::Scenes,
        1,
        "/scenes",
        "aeye.Scenes",
        "Of a corner case: state bytes of the snapshots of its window, every sixth tick from the first to the last, \
         stacked. Lengths of the snapshots; then, if all are equal, their bytes transposed, each the difference to the \
         snapshot before; else one after the other.",
    ),
    layout(
        Channel::Notes,
        1,
        "/notes",
        "aeye.Notes",
        "What happened to the rig, if anything, as columns: tick (differences), code of the kind, seat (0 semantic, 1 \
         safety, 2 the whole rig).",
    ),
    layout(
        Channel::Map,
        2,
        "/map",
        "aeye.Map",
        "The second message, if the map is foreign and stands in the file: its OpenDRIVE text, as bytes, not as bincode.",
    ),
    layout(
        Channel::Seal,
        2,
        "/seal",
        "aeye.Seal",
        "The last message of every chunk, as 16 bytes, not as bincode: the first of blake3 over the header record and \
         all records of all chunks, unfolded, up to the record of this message.",
    ),
];

impl Layout {
    /// Name of the schema, ending in the version of the layout.
    pub fn schema(&self) -> String {
        format!("{}.{FORMAT_VERSION}", self.name)
    }
}

/// The version at the end of a schema's name, if it is the name of the channel's schema.
pub(crate) fn version_of(name: &str, layout: &Layout) -> Option<u16> {
    let version = name.strip_prefix(layout.name)?.strip_prefix('.')?;
    version.parse().ok().filter(|n: &u16| n.to_string() == version)
}

impl Channel {
    /// The channel with an id.
    pub fn from_id(id: u16) -> Option<Self> {
        CHANNELS.iter().map(|l| l.channel).find(|c| *c as u16 == id)
    }

    /// What stands in the file about it.
    pub fn layout(self) -> &'static Layout {
        &CHANNELS[self as usize - 1]
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
            assert!(!layout.text.is_empty() && version_of(&layout.schema(), layout) == Some(FORMAT_VERSION));
            assert!(CHANNELS[..i].iter().all(|l| l.topic != layout.topic && l.name != layout.name));
        }
        assert_eq!(Channel::from_id(0), None);
    }

    #[test]
    fn a_version_is_a_number_after_the_name() {
        let manifest = Channel::Manifest.layout();
        assert_eq!(version_of("aeye.Manifest.1", manifest), Some(1));
        assert_eq!(version_of("aeye.Manifest.70", manifest), Some(70));
        for other in ["aeye.Manifest", "aeye.Manifest.", "aeye.Manifest.01", "aeye.Manifest.+1", "aeye.Keyframe.1"] {
            assert_eq!(version_of(other, manifest), None, "{other}");
        }
    }

    #[test]
    fn a_second_is_a_billion_nanoseconds() {
        assert_eq!(nanoseconds(60), 1_000_000_000);
        assert_eq!(nanoseconds(1), 16_666_666);
    }
}
