//! A log read back from its file.

use std::path::Path;
use std::sync::Arc;

use kernel::map::{bake, bundled};
use kernel::time::Tick;
use kernel::{Keyframe, RoadNetwork};

use crate::block::Block;
use crate::layout::{Channel, nanoseconds};
use crate::scan::{Message, Scan, scan};
use crate::{Error, ForeignMap, Log, Manifest, WRITTEN_BY, wire};

/// A recording or case whose bytes have all been checked.
#[derive(Clone, Debug)]
pub struct Recording {
    log: Log,
    finished: bool,
    digest: [u8; 32],
}

impl Recording {
    /// Reads a file, and the file of a foreign map beside it. Any changed byte is an error that says where; a
    /// recording whose writer was stopped is read up to its last whole block ([`Recording::finished`] tells).
    pub fn open(path: &Path) -> Result<Self, Error> {
        let read = || {
            let mut recording = Self::from_bytes(&intake::read(path, intake::most::RECORDING)?)?;
            if let Some(map) = recording.log.manifest.foreign_map.as_mut().filter(|map| !map.embedded) {
                map.look_beside(path)?;
            }
            Ok(recording)
        };
        read().map_err(|e: Error| e.within(path))
    }

    /// As [`Recording::open`], from memory; of a foreign map that is not in it, the text is missing.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let scan = scan(bytes)?;
        let log = assemble(&scan)?;
        if log.manifest.case.is_some() && !scan.finished {
            return Err(Error::damaged("the end of the file", "it was cut off; a corner case is written as a whole"));
        }
        Ok(Self { log, finished: scan.finished, digest: *blake3::hash(bytes).as_bytes() })
    }

    /// The content.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// The content, taken out.
    pub fn into_log(self) -> Log {
        self.log
    }

    /// Whether the writer came to its end; if not, up to a second is missing.
    pub fn finished(&self) -> bool {
        self.finished
    }

    /// blake3 of the file.
    pub fn digest(&self) -> [u8; 32] {
        self.digest
    }

    /// Digest of the recording that it is, or was cut from.
    pub fn source(&self) -> [u8; 32] {
        self.log.manifest.case.as_ref().map_or(self.digest, |case| case.source)
    }

    /// The map of the run: a bundled one, or the foreign one that is in the file or beside it; its digest is checked.
    pub fn network(&self) -> Result<Arc<RoadNetwork>, Error> {
        self.log.manifest.network()
    }
}

impl ForeignMap {
    /// Reads the map's file in the folder of a recording, if it is there.
    fn look_beside(&mut self, recording: &Path) -> Result<(), Error> {
        let path = recording.with_file_name(self.file_name());
        if !path.is_file() {
            return Ok(());
        }
        let text = intake::read(&path, intake::most::MAP).map_err(|e| Error::from(e).within(&path))?;
        let digest = *blake3::hash(&text).as_bytes();
        let text = String::from_utf8(text).ok().filter(|_| digest == self.digest);
        let changed = || Error::Unsuited("not the map of the recording: it was changed".into()).within(&path);
        self.text = Some(text.ok_or_else(changed)?.into());
        Ok(())
    }
}

impl Manifest {
    /// The map of the run: a bundled one, or the foreign one; its digest is checked.
    pub fn network(&self) -> Result<Arc<RoadNetwork>, Error> {
        let name = &self.scenario.map;
        let network = match &self.foreign_map {
            Some(map) => Arc::new(bake(name, map.text.as_ref().ok_or_else(|| self.no_map())?)?),
            None => {
                bundled(name).ok_or_else(|| Error::Unsuited(format!("map {name} is neither bundled nor in the log")))?
            }
        };
        self.check_map(&network)?;
        Ok(network)
    }

    /// Refuses a kernel that is not the run's.
    pub fn check_kernel(&self) -> Result<(), Error> {
        let (made, this) = (self.kernel.clone(), kernel::identity());
        let program = || self.provenance.get(WRITTEN_BY).cloned();
        if made == this { Ok(()) } else { Err(Error::Kernel { made, this, program: program() }) }
    }

    /// Refuses a kernel or map that is not the run's.
    pub(crate) fn check(&self, network: &RoadNetwork) -> Result<(), Error> {
        self.check_kernel()?;
        self.check_map(network)
    }

    /// Refuses a map that is not the run's.
    fn check_map(&self, network: &RoadNetwork) -> Result<(), Error> {
        let (expected, got) = (self.map_digest, network.digest);
        let map = self.scenario.map.clone();
        if expected == got { Ok(()) } else { Err(Error::Map { map, expected, got }) }
    }

    pub(crate) fn no_map(&self) -> Error {
        let file = self.foreign_map.as_ref().map(ForeignMap::file_name).unwrap_or_default();
        Error::NoMap { map: self.scenario.map.clone(), file }
    }
}

/// Ticks beyond this are damage: it is six hundred years.
const MAX_TICK: Tick = 1 << 40;

/// Most bytes of all keyframes.
const MAX_KEYFRAMES: usize = 256 << 20;

/// Puts the messages of a file together, in the only order in which a writer gives them.
fn assemble(scan: &Scan) -> Result<Log, Error> {
    let missing = || Error::damaged("the end of the file", "it holds no manifest and start");
    let (first, mut rest) = scan.messages.split_first().ok_or_else(missing)?;
    let mut manifest = first.parse(Channel::Manifest, |payload| wire::manifest(payload, scan.format))?;
    let map = rest.split_first().filter(|(message, _)| message.channel == Channel::Map);
    if let Some((message, after)) = map {
        message.map_of(&mut manifest)?;
        rest = after;
    }
    let (start, rest) = rest.split_first().ok_or_else(missing)?;
    let start_at = start.parse(Channel::Keyframe, |payload| wire::keyframe(payload, &[], scan.format))?;
    if start_at.tick > MAX_TICK {
        return Err(start.damaged(format!("tick {}, expected at most {MAX_TICK}", start_at.tick)));
    }
    let before = map.into_iter().map(|(message, _)| message).chain([first, start]);
    before.into_iter().try_for_each(|message| message.at(start_at.tick))?;
    let mut log = Log {
        manifest,
        keyframes: vec![start_at],
        inputs: Vec::new(),
        hashes: Vec::new(),
        marks: Vec::new(),
        events: Vec::new(),
        intervention: None,
        masks: Vec::new(),
        notes: Vec::new(),
        annotation: None,
        summary: None,
        scenes: Vec::new(),
    };
    let (mut ended, mut room) = (false, MAX_KEYFRAMES);
    for message in rest {
        if ended {
            return Err(message.damaged("expected nothing after the end"));
        }
        ended = message.channel == Channel::End;
        log.add(message, &mut room)?;
    }
    if scan.finished && !ended {
        return Err(Error::damaged("the end of the data", "expected the message that ends the log"));
    }
    Ok(log)
}

impl Message {
    fn parse<T>(&self, channel: Channel, read: impl Fn(&[u8]) -> Result<T, String>) -> Result<T, Error> {
        if self.channel != channel {
            return Err(self.damaged(format!("expected a message of {channel:?}")));
        }
        read(&self.payload).map_err(|reason| self.damaged(reason))
    }

    /// Refuses a time that is not that of the tick at which the message was complete.
    fn at(&self, tick: Tick) -> Result<(), Error> {
        let (expected, got) = (nanoseconds(tick), self.time_ns);
        if got == expected { Ok(()) } else { Err(self.damaged(format!("its time is {got} ns, expected {expected}"))) }
    }

    /// Takes the text of a foreign map.
    fn map_of(&self, manifest: &mut Manifest) -> Result<(), Error> {
        let named = manifest.foreign_map.as_ref().map(|map| map.digest);
        let text = String::from_utf8(self.payload.clone()).map_err(|_| self.damaged("expected text in UTF-8"))?;
        let map = ForeignMap::new(text, true);
        if named != Some(map.digest) {
            return Err(self.damaged("it is not the map that the manifest names"));
        }
        manifest.foreign_map = Some(map);
        Ok(())
    }

    fn damaged(&self, reason: impl Into<String>) -> Error {
        Error::damaged(self.place.clone(), reason)
    }
}

impl Log {
    /// Takes the next message; `room` is how many bytes further keyframes may have.
    fn add(&mut self, message: &Message, room: &mut usize) -> Result<(), Error> {
        match message.channel {
            Channel::Manifest | Channel::Map => return Err(message.damaged("expected it at the beginning only")),
            Channel::Seal => return Err(message.damaged("expected it at the end of a chunk only")),
            Channel::Block => self.add_block(message.parse(Channel::Block, wire::block)?, message)?,
            Channel::Keyframe => return self.add_keyframe(message, room),
            Channel::Events => {
                let happenings = message.parse(Channel::Events, wire::happenings)?;
                for (tick, event) in happenings.events {
                    let before = self.events.last().map_or(0, |e| e.0);
                    self.within_last_block(tick, before, message)?;
                    self.events.push((tick, event));
                }
                self.intervention = self.intervention.or(happenings.intervention);
            }
            Channel::Masks => {
                let before = self.masks.len();
                self.masks.extend(message.parse(Channel::Masks, wire::masks)?);
                self.in_order(self.masks.iter().map(|mask| mask.tick_shown), before, message)?;
            }
            Channel::Notes => {
                let before = self.notes.len();
                self.notes.extend(message.parse(Channel::Notes, wire::notes)?);
                self.in_order(self.notes.iter().map(|note| note.tick), before, message)?;
            }
            Channel::Scenes => {
                let format = self.manifest.format;
                self.scenes = message.parse(Channel::Scenes, |payload| wire::scenes(payload, format))?;
            }
            Channel::End => {
                (self.annotation, self.summary) = message.parse(Channel::End, wire::end)?;
                if self.summary.is_none() {
                    return Err(message.damaged("expected how the run went"));
                }
            }
        }
        message.at(self.last_tick())
    }

    fn add_keyframe(&mut self, message: &Message, room: &mut usize) -> Result<(), Error> {
        let Keyframe { tick, bytes } = &self.keyframes[self.keyframes.len() - 1];
        let format = self.manifest.format;
        let keyframe = message.parse(Channel::Keyframe, |payload| wire::keyframe(payload, bytes, format))?;
        self.within_last_block(keyframe.tick, tick + 1, message)?;
        let left = room.checked_sub(keyframe.bytes.len());
        *room = left.ok_or_else(|| message.damaged(format!("the keyframes have more than {MAX_KEYFRAMES} bytes")))?;
        message.at(keyframe.tick)?;
        self.keyframes.push(keyframe);
        Ok(())
    }

    /// Masks and notes ascend, those after the first `before` too, and are not more than can happen in so many ticks.
    fn in_order(
        &self,
        ticks: impl ExactSizeIterator<Item = Tick>,
        before: usize,
        message: &Message,
    ) -> Result<(), Error> {
        let (rows, most) = (ticks.len(), wire::MOST_A_TICK * (self.inputs.len() + 1));
        if rows > most {
            return Err(message.damaged(format!("{rows} so far, expected at most {most}")));
        }
        let ascend = ticks.skip(before.saturating_sub(1)).is_sorted();
        if ascend { Ok(()) } else { Err(message.damaged("its ticks do not ascend")) }
    }

    fn add_block(&mut self, block: Block, message: &Message) -> Result<(), Error> {
        let expected = self.last_tick() + 1;
        if block.first != expected {
            return Err(message.damaged(format!("its first tick is {}, expected {expected}", block.first)));
        }
        self.inputs.extend(block.inputs);
        self.hashes.extend(block.hashes);
        self.marks.push(block.mark);
        Ok(())
    }

    /// What belongs to a block follows it.
    fn within_last_block(&self, tick: Tick, least: Tick, message: &Message) -> Result<(), Error> {
        if (least..=self.last_tick()).contains(&tick) {
            return Ok(());
        }
        Err(message.damaged(format!("tick {tick}, expected {least} to {}", self.last_tick())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PROGRAM;
    use crate::testing::sample;
    use proptest::prelude::*;

    fn read(bytes: &[u8]) -> Result<Recording, Error> {
        Recording::from_bytes(bytes)
    }

    #[test]
    fn what_was_written_is_read() {
        for ticks in [1, 59, 60, 61, 200] {
            let log = sample(ticks);
            let bytes = log.encode().unwrap();
            let recording = read(&bytes).unwrap();
            assert!(recording.finished());
            assert_eq!(recording.log(), &log);
            assert_eq!(recording.log().encode().unwrap(), bytes, "the same content gives the same bytes");
        }
    }

    #[test]
    fn a_recording_of_the_first_layout_opens() {
        let old = read(include_bytes!("../tests/without_notes.mcap")).unwrap();
        assert!(old.finished() && old.log().notes.is_empty());
        let now = sample(61);
        let manifest = Manifest { format: 1, kernel: "0.1.0".into(), engines: String::new(), ..now.manifest.clone() };
        assert_eq!(old.log(), &Log { manifest, notes: Vec::new(), ..now });
    }

    #[test]
    fn a_log_of_another_kernel_says_which_program_has_it() {
        let said = |program: Option<&str>| {
            let provenance = program.map(|program| (WRITTEN_BY.to_owned(), program.to_owned())).into_iter().collect();
            let manifest = Manifest { kernel: "0.0.9-0123".into(), provenance, ..sample(1).manifest };
            manifest.check_kernel().expect_err("another kernel").to_string()
        };
        let this = kernel::identity();
        let sentence =
            format!("made by kernel 0.0.9-0123, this is {this}; only the kernel that made a log can drive it again");
        assert_eq!(said(None), sentence);
        assert_eq!(said(Some("aeye 0.0.9")), format!("{sentence}, which is that of aeye 0.0.9"));
        assert_eq!(said(Some(PROGRAM)), format!("{sentence}, which is that of another build of {PROGRAM}"));
    }

    #[test]
    fn standard_readers_find_every_message() {
        let bytes = sample(200).encode().unwrap();
        let summary = mcap::Summary::read(&bytes).unwrap().expect("an index");
        let counted: u64 = summary.stats.expect("statistics").channel_message_counts.values().sum();
        let messages: Vec<_> = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
        assert_eq!(messages.len() as u64, counted);
        assert!(messages.iter().all(|m| m.channel.schema.as_ref().is_some_and(|s| !s.data.is_empty())));
        assert_eq!(summary.chunk_indexes.len(), 1 + 5 + 1, "the start, a chunk a block, the end");
        assert_eq!(messages.last().map(|m| m.log_time), Some(200 * 1_000_000_000 / 60));
    }

    #[test]
    fn a_start_beyond_time_is_refused() {
        let mut log = sample(1);
        (log.keyframes[0].tick, log.marks[0].tick) = (1 << 50, (1 << 50) + 1);
        assert!(matches!(read(&log.encode().unwrap()), Err(Error::Damaged { .. })));
    }

    #[test]
    fn any_changed_byte_is_an_error_with_a_place() {
        let mut bytes = sample(200).encode().unwrap();
        for at in 0..bytes.len() {
            for flip in [0x01, 0x80, 0xff, bytes[at]] {
                bytes[at] ^= flip;
                match read(&bytes) {
                    Err(Error::Damaged { place, .. }) => assert!(place.contains("byte"), "{place}"),
                    Err(other) => panic!("byte {at} ^ {flip:02x}: {other}"),
                    Ok(_) => assert_eq!(flip, 0, "byte {at} ^ {flip:02x} went unnoticed"),
                }
                bytes[at] ^= flip;
            }
        }
    }

    #[test]
    fn the_place_of_damage_in_the_data_is_its_record() {
        let bytes = sample(200).encode().unwrap();
        let mut places = std::collections::BTreeSet::new();
        for at in 60..bytes.len() * 3 / 4 {
            let mut bytes = bytes.clone();
            bytes[at] ^= 0x10;
            let place = read(&bytes).unwrap_err().to_string();
            let start: usize = first_number(&place);
            assert!(start <= at || place.contains("footer"), "byte {at}: {place}");
            places.insert(start);
        }
        assert!(places.len() > 10, "{places:?}");
    }

    #[test]
    fn a_file_that_was_cut_off_reads_up_to_its_last_whole_block() {
        let log = sample(200);
        let bytes = log.encode().unwrap();
        let mut read_ticks = Vec::new();
        for length in 0..bytes.len() {
            match read(&bytes[..length]) {
                Ok(recording) => {
                    assert!(!recording.finished(), "{length} bytes");
                    let (got, ticks) = (recording.log(), recording.log().inputs.len());
                    assert_eq!(got.inputs, log.inputs[..ticks]);
                    assert!(got.mark(got.last_tick()).is_some() || ticks == 0);
                    read_ticks.push(ticks);
                }
                Err(e) => assert!(read_ticks.is_empty(), "{length} bytes: {e}"),
            }
        }
        assert!(read_ticks.is_sorted());
        assert_eq!(read_ticks.last(), Some(&200));
        read_ticks.dedup();
        assert_eq!(read_ticks, [0, 60, 101, 120, 180, 200]);
    }

    #[test]
    fn damage_in_the_middle_of_an_unfinished_file_is_not_taken_for_its_end() {
        let bytes = sample(400).encode().unwrap();
        let end = bytes.len() / 2;
        let whole = read(&bytes[..end]).unwrap().log().last_tick();
        for at in 0..end {
            let mut bytes = bytes[..end].to_vec();
            bytes[at] ^= 0x40;
            if let Ok(recording) = read(&bytes) {
                // What is cut off at the end is not covered, and not read.
                assert_eq!(recording.log().last_tick(), whole, "byte {at}");
            }
        }
    }

    proptest! {
        #[test]
        fn foreign_bytes_are_errors(bytes in prop::collection::vec(any::<u8>(), 0..400), magic in any::<bool>()) {
            let mut file = if magic { mcap_magic() } else { Vec::new() };
            file.extend(bytes);
            prop_assert!(read(&file).is_err());
        }

        #[test]
        fn any_change_of_a_finished_file_is_noticed(
            changes in prop::collection::vec((any::<prop::sample::Index>(), 1u8..), 1..6),
        ) {
            let whole = sample(130).encode().unwrap();
            let mut bytes = whole.clone();
            for (at, flip) in changes {
                let at = at.index(bytes.len());
                bytes[at] ^= flip;
            }
            prop_assume!(bytes != whole);
            // Damage to the end magic and to what stands before it may look like a cut-off file.
            prop_assert!(!read(&bytes).is_ok_and(|r| r.finished()));
        }
    }

    proptest! {
        #[test]
        fn messages_in_another_order_are_no_panic(order in prop::collection::vec(any::<prop::sample::Index>(), 0..30)) {
            let Scan { messages, format, .. } = scan(&sample(200).encode().unwrap()).unwrap();
            let copy = |m: &Message| Message { payload: m.payload.clone(), place: m.place.clone(), ..*m };
            let messages: Vec<Message> =
                messages[..3].iter().chain(order.iter().map(|i| i.get(&messages))).map(copy).collect();
            if let Ok(log) = assemble(&Scan { messages, format, finished: false }) {
                prop_assert_eq!(log.inputs.len(), log.hashes.len());
                prop_assert!(log.keyframes.is_sorted_by_key(|k| k.tick));
            }
        }
    }

    fn first_number(text: &str) -> usize {
        let digits = text.split(|c: char| !c.is_ascii_digit()).find(|s| !s.is_empty());
        digits.and_then(|d| d.parse().ok()).expect("a place has a number")
    }

    fn mcap_magic() -> Vec<u8> {
        sample(1).encode().unwrap()[..8].to_vec()
    }
}
