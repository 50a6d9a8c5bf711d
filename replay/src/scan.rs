//! Reads an MCAP file strictly: every byte is either checked against something or an error.
//!
//! A finished file is covered by two checksums that are never taken as absent: one over everything up
//! to the end of the data, one over index and footer. When one of them fails, the walk over the
//! records says which one is damaged. Checksums that fit vouch for nothing but the disk: the index must
//! be, byte for byte, the one that follows from the data, and the data must fit its seals. A file without
//! a footer is what a stopped writer leaves; since files only grow, it is whole records and at most one
//! that is cut off.

use std::collections::BTreeMap;

use mcap::MAGIC;
use mcap::records::{ChunkHeader, MessageHeader, MessageIndexEntry, Record, op};

use crate::index::Index;
use crate::layout::{CHANNELS, Channel, FORMAT_VERSION, MESSAGE_ENCODING, OLDEST_VERSION, SCHEMA_ENCODING, version_of};
use crate::records::{HEAD, MAX_RECORD, Raw, Walk, number};
use crate::seal::Seal;
use crate::{Error, export};

/// Most bytes that all chunks may unfold to: days of driving.
const MAX_UNFOLDED: u64 = 192 << 20;
/// The whole footer record: opcode, length, two offsets and a checksum.
const FOOTER: usize = HEAD + 20;
/// The whole record that ends the data: opcode, length and a checksum.
const DATA_END: usize = HEAD + 4;

/// A message of the file.
pub(crate) struct Message {
    pub channel: Channel,
    /// When it was complete, nanoseconds from tick 0.
    pub time_ns: u64,
    pub payload: Vec<u8>,
    /// Where it stands, for errors.
    pub place: String,
}

/// What a file holds.
pub(crate) struct Scan {
    /// Version of the layout.
    pub format: u16,
    pub messages: Vec<Message>,
    /// Whether it has its footer.
    pub finished: bool,
}

/// Reads a whole file.
pub(crate) fn scan(bytes: &[u8]) -> Result<Scan, Error> {
    starts_as_mcap(bytes)?;
    let finished = is_finished(bytes);
    let data = if finished {
        let end = end_of_data(bytes)?;
        let data = Data::read(&mut Walk::new(&bytes[..end], true))?;
        data.check_index(bytes, end + DATA_END)?;
        data
    } else {
        let mut walk = Walk::new(bytes, false);
        let data = Data::read(&mut walk)?;
        unfinished_tail(&mut walk)?;
        data
    };
    Ok(Scan { format: data.format.unwrap_or(FORMAT_VERSION), messages: data.messages, finished })
}

/// Refuses what does not begin as every file of MCAP.
pub(crate) fn starts_as_mcap(bytes: &[u8]) -> Result<(), Error> {
    if bytes.starts_with(MAGIC) {
        return Ok(());
    }
    let cut = bytes.len() < MAGIC.len() && MAGIC.starts_with(bytes);
    let reason = if cut { "the file ends here" } else { "this is no MCAP file" };
    Err(Error::damaged("byte 0", reason))
}

/// Whether a file has its footer.
pub(crate) fn is_finished(bytes: &[u8]) -> bool {
    bytes.len() >= MAGIC.len() + DATA_END + FOOTER + MAGIC.len() && bytes.ends_with(MAGIC)
}

fn damaged(at: usize, what: &str) -> Error {
    Error::damaged(format!("byte {at}"), what)
}

/// Checks both checksums of a finished file and gives the end of its data.
pub(crate) fn end_of_data(bytes: &[u8]) -> Result<usize, Error> {
    let footer_at = bytes.len() - MAGIC.len() - FOOTER;
    let footer = &bytes[footer_at..bytes.len() - MAGIC.len()];
    if !is_head(footer, op::FOOTER, FOOTER) {
        return Err(damaged(footer_at, "expected the footer"));
    }
    let index_at = usize::try_from(number::<8>(&footer[HEAD..])).unwrap_or(usize::MAX);
    if index_at < MAGIC.len() + DATA_END || index_at > footer_at {
        return Err(damaged(footer_at, "the footer does not say where the index begins"));
    }
    let (data, end) = bytes[..index_at].split_at(index_at - DATA_END);
    if !is_head(end, op::DATA_END, DATA_END) {
        return Err(damaged(data.len(), "expected the end of the data, before the index"));
    }
    if number::<4>(&end[HEAD..]) != u64::from(crc32fast::hash(data)) {
        Data::read(&mut Walk::new(data, true))?;
        return Err(damaged(MAGIC.len(), "the checksum of the data is wrong, in the header or itself"));
    }
    let sum_at = bytes.len() - MAGIC.len() - 4;
    if number::<4>(&bytes[sum_at..]) != u64::from(crc32fast::hash(&bytes[index_at..sum_at])) {
        return Err(Error::damaged(format!("bytes {index_at} to {sum_at}"), "the checksum of the index is wrong"));
    }
    Ok(data.len())
}

fn is_head(record: &[u8], op: u8, length: usize) -> bool {
    record[0] == op && number::<8>(&record[1..]) == (length - HEAD) as u64
}

/// What follows the data of a file without its end magic: an index that is cut off.
fn unfinished_tail(walk: &mut Walk<'_>) -> Result<(), Error> {
    while let Some(record) = walk.next()? {
        if record.op == op::FOOTER && walk.bytes.len() - walk.at >= MAGIC.len() {
            return Err(damaged(walk.at, "expected the magic bytes that end the file"));
        }
    }
    Ok(())
}

/// Message indexes that must follow a chunk.
type Expected = BTreeMap<u16, Vec<MessageIndexEntry>>;

/// The data section, as far as it has been read.
#[derive(Default)]
struct Data {
    /// Version of the layout, which the names of all schemas end with.
    format: Option<u16>,
    messages: Vec<Message>,
    seal: Seal,
    /// Whether the last message was a seal.
    sealed: bool,
    unfolded: u64,
    index: Index,
}

impl Data {
    /// Everything up to the end of the data. Of an unfinished file, what came last may be missing.
    fn read(walk: &mut Walk<'_>) -> Result<Self, Error> {
        let mut data = Self::default();
        match walk.next()? {
            Some(header) if header.op == op::HEADER => data.header(&header)?,
            Some(other) => return Err(other.damaged("expected the header")),
            None => return Ok(data),
        }
        let mut expected = Expected::new();
        while let Some(record) = walk.next()? {
            match record.op {
                op::CHUNK if expected.is_empty() => expected = data.chunk(&record)?,
                op::MESSAGE_INDEX => data.message_index(&record, &mut expected)?,
                op::DATA_END if !walk.whole && expected.is_empty() => {
                    check_data_end(&record, &walk.bytes[..record.at])?;
                    break;
                }
                op::METADATA if is_of_export(&record) => return Err(Error::Export),
                _ => return Err(record.damaged("expected a chunk and its message indexes")),
            }
        }
        if walk.whole && !expected.is_empty() {
            return Err(damaged(walk.at, "expected a message index"));
        }
        Ok(data)
    }

    fn header(&mut self, record: &Raw<'_>) -> Result<(), Error> {
        match mcap::parse_record(record.op, record.body) {
            Ok(Record::Header(h)) if h.profile.is_empty() && record.body.len() == 8 + h.library.len() => {
                self.seal.header(&h.library);
                Ok(())
            }
            Ok(_) => Err(record.damaged("expected an empty profile and the name of a library")),
            Err(e) => Err(record.damaged(e)),
        }
    }

    /// Takes the messages of a chunk, and gives the indexes that must follow it.
    fn chunk(&mut self, record: &Raw<'_>) -> Result<Expected, Error> {
        let (header, packed) = match mcap::parse_record(record.op, record.body) {
            Ok(Record::Chunk { header, data }) => (header, data),
            Ok(_) => return Err(record.damaged("expected a chunk")),
            Err(e) => return Err(record.damaged(e)),
        };
        if header.compression != "zstd" || record.body.len() != 40 + header.compression.len() + packed.len() {
            return Err(record.damaged("its header is wrong"));
        }
        self.unfolded = self.unfolded.saturating_add(header.uncompressed_size);
        if self.unfolded > MAX_UNFOLDED {
            return Err(record.damaged(format!("it unfolds to more than {MAX_UNFOLDED} bytes with those before")));
        }
        let records = unfold(&header, &packed).map_err(|reason| record.damaged(reason))?;
        let mut expected = Expected::new();
        let mut walk = Walk { bytes: &records, at: 0, whole: true };
        let inner = |e: Error| match e {
            Error::Damaged { place, reason } => record.damaged(format!("{reason} at unfolded {place}")),
            other => other,
        };
        while let Some(part) = walk.next().map_err(inner)? {
            if let Some((channel, log_time)) = self.part(&part, record.at).map_err(inner)? {
                let entry = MessageIndexEntry { log_time, offset: part.at as u64 };
                expected.entry(channel).or_default().push(entry);
            }
        }
        check_times(&header, &expected).map_err(|reason| record.damaged(reason))?;
        if self.format > Some(OLDEST_VERSION) && !self.sealed {
            return Err(record.damaged("expected a seal as its last message"));
        }
        self.index.chunk(record, header, packed.len());
        Ok(expected)
    }

    /// Takes a record of a chunk, which gives its channel and time if it is a message.
    fn part(&mut self, part: &Raw<'_>, chunk_at: usize) -> Result<Option<(u16, u64)>, Error> {
        let record = mcap::parse_record(part.op, part.body).map_err(|e| part.damaged(e))?;
        let message = match record {
            Record::Message { header, data } => {
                let at = (header.channel_id, header.log_time);
                self.message(part, header, data.into_owned(), chunk_at)?;
                Some(at)
            }
            Record::Schema { header, .. } => {
                self.schema(part, header.id, &header.name, &header.encoding)?;
                None
            }
            Record::Channel(channel) => {
                let ours = CHANNELS.iter().any(|l| {
                    (l.channel as u16, l.channel as u16, l.topic, MESSAGE_ENCODING)
                        == (channel.id, channel.schema_id, &*channel.topic, &*channel.message_encoding)
                });
                if !ours || !channel.metadata.is_empty() {
                    return Err(Error::Unsuited(format!("this is no log of A-Eye: channel {}", channel.topic)));
                }
                self.index.channel(part);
                None
            }
            _ => return Err(part.damaged("expected a message")),
        };
        self.seal.record(part.op, &[part.body]);
        Ok(message)
    }

    /// A schema's name says the version of the layout; its text is for readers.
    fn schema(&mut self, part: &Raw<'_>, id: u16, name: &str, encoding: &str) -> Result<(), Error> {
        let unknown = || Error::Unsuited(format!("layout {name:?} is not one that this program reads"));
        let layout = CHANNELS.iter().find(|l| l.channel as u16 == id && encoding == SCHEMA_ENCODING);
        let version = layout.and_then(|layout| version_of(name, layout)).ok_or_else(unknown)?;
        if !(OLDEST_VERSION..=FORMAT_VERSION).contains(&version) {
            return Err(Error::Layout { version });
        }
        if *self.format.get_or_insert(version) != version {
            return Err(part.damaged("its schemas are of different versions"));
        }
        self.index.schema(part);
        Ok(())
    }

    fn message(
        &mut self,
        part: &Raw<'_>,
        header: MessageHeader,
        payload: Vec<u8>,
        chunk_at: usize,
    ) -> Result<(), Error> {
        let MessageHeader { channel_id, sequence, log_time, publish_time } = header;
        let known = Channel::from_id(channel_id).filter(|channel| self.format >= Some(channel.layout().since));
        let channel = known.ok_or_else(|| part.damaged(format!("unknown channel {channel_id}")))?;
        let expected = self.index.messages();
        if u64::from(sequence) != expected {
            return Err(part.damaged(format!("its sequence number is {sequence}, expected {expected}")));
        }
        if publish_time != log_time {
            return Err(part.damaged(format!("published at {publish_time}, logged at {log_time}")));
        }
        self.sealed = channel == Channel::Seal;
        let before = self.messages.last().map(|message| message.time_ns);
        if self.sealed && before != Some(log_time) {
            return Err(part.damaged("its time is not that of the message that it seals"));
        }
        self.index.message(channel_id, log_time);
        if !self.sealed {
            let place = format!("byte {chunk_at} (chunk), message {sequence} of {}", channel.layout().topic);
            self.messages.push(Message { channel, time_ns: log_time, payload, place });
        } else if payload != self.seal.value() {
            return Err(part.damaged("what stands before it is not what was sealed"));
        }
        Ok(())
    }

    /// A message index must say what was read from its chunk.
    fn message_index(&mut self, record: &Raw<'_>, expected: &mut Expected) -> Result<(), Error> {
        let index = match mcap::parse_record(record.op, record.body) {
            Ok(Record::MessageIndex(index)) => index,
            Ok(_) => return Err(record.damaged("expected a message index")),
            Err(e) => return Err(record.damaged(e)),
        };
        let expected = expected.remove(&index.channel_id).unwrap_or_default();
        let same = |(a, b): (&MessageIndexEntry, &MessageIndexEntry)| (a.log_time, a.offset) == (b.log_time, b.offset);
        let entries = &index.records;
        let complete = record.body.len() == 6 + 16 * expected.len() && entries.len() == expected.len();
        if !complete || entries.is_empty() || !entries.iter().zip(&expected).all(same) {
            return Err(record.damaged("it does not say what its chunk holds"));
        }
        self.index.message_index(record, index.channel_id);
        Ok(())
    }

    /// The index of a finished file must be the one that follows from its data.
    fn check_index(&self, bytes: &[u8], index_at: usize) -> Result<(), Error> {
        let footer_at = bytes.len() - MAGIC.len() - FOOTER;
        let (expected, offsets_at) = self.index.bytes(index_at);
        let found = &bytes[index_at..footer_at];
        if found != expected {
            let same = found.iter().zip(&expected).take_while(|(a, b)| a == b).count();
            return Err(damaged(index_at + same, "the index does not say what the file holds"));
        }
        if number::<8>(&bytes[footer_at + HEAD + 8..]) != offsets_at {
            return Err(damaged(footer_at, "the footer does not say where the offsets begin"));
        }
        Ok(())
    }
}

pub(crate) fn is_of_export(record: &Raw<'_>) -> bool {
    mcap::parse_record(record.op, record.body).is_ok_and(|record| export::about(&record).is_some())
}

fn check_data_end(record: &Raw<'_>, data: &[u8]) -> Result<(), Error> {
    let expected = u64::from(crc32fast::hash(data));
    if record.body.len() == 4 && number::<4>(record.body) == expected {
        Ok(())
    } else {
        Err(record.damaged("the checksum of the data is wrong"))
    }
}

pub(crate) fn unfold(header: &ChunkHeader, packed: &[u8]) -> Result<Vec<u8>, String> {
    if header.uncompressed_size > MAX_RECORD {
        return Err(format!("it claims {} bytes, more than {MAX_RECORD}", header.uncompressed_size));
    }
    let size = header.uncompressed_size as usize;
    let records = zstd::bulk::decompress(packed, size).map_err(|e| format!("it does not unfold: {e}"))?;
    if records.len() != size || crc32fast::hash(&records) != header.uncompressed_crc {
        return Err("its checksum is wrong".to_owned());
    }
    Ok(records)
}

fn check_times(header: &ChunkHeader, expected: &Expected) -> Result<(), String> {
    let times = || expected.values().flatten().map(|e| e.log_time);
    let span = (times().min().unwrap_or(0), times().max().unwrap_or(0));
    let claimed = (header.message_start_time, header.message_end_time);
    if claimed == span { Ok(()) } else { Err(format!("it claims times {claimed:?}, its messages have {span:?}")) }
}
