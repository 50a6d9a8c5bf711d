//! Writes MCAP files for viewers: channels, schemas and messages are the caller's, container and
//! times are ours.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

use kernel::time::Tick;
use mcap::records::{MessageHeader, Metadata, Record};
use mcap::write::NoSeek;
use mcap::{MAGIC, WriteOptions, Writer};

use crate::Error;
use crate::container::{io_error, options};
use crate::layout::nanoseconds;

/// Bytes of messages in a chunk: a second or two of small pictures.
const CHUNK_BYTES: u64 = 1 << 20;
/// Name of the metadata record that says what the file was made from; it follows the header.
const METADATA: &str = "aeye.export";
/// Header and metadata are shorter than this.
const HEAD_BYTES: u64 = 1 << 16;

/// What the messages of a channel look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schema<'a> {
    /// Name, as in `foxglove.Log`.
    pub name: &'a str,
    /// Encoding of the schema, as MCAP's registry names it, as in `protobuf`; that of its messages follows from it.
    pub encoding: &'a str,
    /// The schema itself.
    pub data: &'a [u8],
}

impl Schema<'_> {
    /// How messages are encoded, as MCAP's registry names it.
    fn message_encoding(&self) -> &str {
        match self.encoding {
            "ros2msg" => "cdr",
            same => same,
        }
    }
}

/// A channel of an [`Exporter`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExportChannel(u16);

/// Writes an MCAP file, in chunks compressed by zstd. Message times are simulated time, nanoseconds from tick 0: the same
/// messages give the same bytes.
///
/// [`Exporter::finish`] must be called: without it the file has no index and no end.
#[must_use = "a file is complete only after `finish`"]
pub struct Exporter<W: Write> {
    writer: Writer<NoSeek<W>>,
    /// The number of messages of each channel so far.
    counts: BTreeMap<u16, u32>,
}

impl<W: Write> Exporter<W> {
    /// Starts a file that was made from `about`, names and values.
    pub fn new(out: W, about: BTreeMap<String, String>) -> Result<Self, Error> {
        Self::with_profile(out, "", about)
    }

    /// As [`Exporter::new`], of a profile of MCAP's registry, as in `ros2`.
    pub fn with_profile(out: W, profile: &str, about: BTreeMap<String, String>) -> Result<Self, Error> {
        let options: WriteOptions = options().profile(profile).chunk_size(Some(CHUNK_BYTES));
        let mut writer = Writer::with_options(NoSeek::new(out), options).map_err(io_error)?;
        writer.write_metadata(&Metadata { name: METADATA.into(), metadata: about }).map_err(io_error)?;
        Ok(Self { writer, counts: BTreeMap::new() })
    }

    /// Adds a record of names and values that a standard asks for, beside the one of [`Exporter::new`].
    pub fn metadata(&mut self, name: &str, entries: BTreeMap<String, String>) -> Result<(), Error> {
        self.writer.write_metadata(&Metadata { name: name.into(), metadata: entries }).map_err(io_error)
    }

    /// Adds a channel.
    pub fn channel(&mut self, topic: &str, schema: &Schema<'_>) -> Result<ExportChannel, Error> {
        self.channel_with(topic, schema, &BTreeMap::new())
    }

    /// Adds a channel of which more is told, names and values.
    pub fn channel_with(
        &mut self,
        topic: &str,
        schema: &Schema<'_>,
        entries: &BTreeMap<String, String>,
    ) -> Result<ExportChannel, Error> {
        let id = self.writer.add_schema(schema.name, schema.encoding, schema.data).map_err(io_error)?;
        let channel = self.writer.add_channel(id, topic, schema.message_encoding(), entries).map_err(io_error)?;
        match self.counts.insert(channel, 0) {
            None => Ok(ExportChannel(channel)),
            Some(_) => Err(Error::Unsuited(format!("topic {topic}: has a channel already"))),
        }
    }

    /// Appends a message about a tick; ticks should come in ascending order.
    pub fn put(&mut self, channel: ExportChannel, tick: Tick, message: &[u8]) -> Result<(), Error> {
        let (channel_id, time) = (channel.0, nanoseconds(tick));
        let sequence = self.counts.get(&channel_id).copied().unwrap_or_default();
        self.counts.insert(channel_id, sequence.wrapping_add(1));
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.writer.write_to_known_channel(&header, message).map_err(io_error)
    }

    /// Writes index and footer, and hands the stream back.
    pub fn finish(mut self) -> Result<W, Error> {
        self.writer.finish().map_err(io_error)?;
        Ok(self.writer.into_inner().into_inner())
    }
}

/// What is known of an export from its head and its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// What it was made from, as given to [`Exporter::new`].
    pub about: BTreeMap<String, String>,
    /// Whether its end is there.
    pub is_whole: bool,
}

/// Reads head and end of a file; `None` for one of another kind.
pub fn exported(path: &Path) -> Option<Exported> {
    let mut head = Vec::new();
    let mut file = File::open(path).ok()?;
    (&file).take(HEAD_BYTES).read_to_end(&mut head).ok()?;
    let records = mcap::read::LinearReader::sans_magic(head.strip_prefix(MAGIC)?);
    let about = records.take(2).find_map(|record| about(&record.ok()?))?;
    Some(Exported { about, is_whole: ends_as_mcap(&mut file) })
}

/// What an export was made from, if this is the record that says so.
pub(crate) fn about(record: &Record<'_>) -> Option<BTreeMap<String, String>> {
    match record {
        Record::Metadata(Metadata { name, metadata }) if name == METADATA => Some(metadata.clone()),
        _ => None,
    }
}

fn ends_as_mcap(file: &mut File) -> bool {
    let mut end = [0; MAGIC.len()];
    let back = -(MAGIC.len() as i64);
    file.seek(SeekFrom::End(back)).and_then(|_| file.read_exact(&mut end)).is_ok_and(|()| end == *MAGIC)
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;

    const LOG: Schema<'_> = Schema { name: "foxglove.Log", encoding: "protobuf", data: b"of any kind" };

    /// A disk with room for so many bytes.
    struct Disk(usize);

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0 = self.0.checked_sub(bytes.len()).ok_or(io::ErrorKind::StorageFull)?;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn write(out: impl Write) -> Result<(), Error> {
        let mut exporter = Exporter::new(out, BTreeMap::new())?;
        let channel = exporter.channel("/events", &LOG)?;
        for tick in 0..40_u32 {
            // Nothing of this can be compressed.
            let hash = |i: u32| *blake3::hash(&(tick << 16 | i).to_le_bytes()).as_bytes();
            let noise: Vec<u8> = (0..1 << 12).flat_map(hash).collect();
            exporter.put(channel, tick.into(), &noise)?;
        }
        exporter.finish().map(drop)
    }

    #[test]
    fn a_full_disk_is_an_error_wherever_it_happens() {
        write(Disk(usize::MAX)).expect("there is room");
        for room in [0, 100, 1 << 20, 4 << 20] {
            let error = write(Disk(room)).expect_err("there is no room");
            assert!(matches!(&error, Error::Io(e) if e.kind() == io::ErrorKind::StorageFull), "{room}: {error}");
        }
    }

    #[test]
    fn a_topic_has_one_channel() {
        let mut exporter = Exporter::new(Vec::new(), BTreeMap::new()).expect("starts");
        exporter.channel("/events", &LOG).expect("the first");
        assert!(exporter.channel("/events", &LOG).is_err());
        exporter.channel("/other", &LOG).expect("another topic");
        exporter.finish().expect("ends");
    }

    #[test]
    fn an_export_is_told_from_a_recording_whole_or_cut() {
        let mut bytes = Vec::new();
        write(&mut bytes).expect("there is room");
        for part in [&bytes[..], &bytes[..bytes.len() / 2]] {
            assert!(matches!(crate::Recording::from_bytes(part), Err(Error::Export)));
        }
    }
}
