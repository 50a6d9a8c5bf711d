//! Reads an MCAP file strictly: every byte is either checked against something or an error.
//!
//! A finished file is covered by two checksums that are never taken as absent: one over everything up
//! to the end of the data, one over index and footer. When one of them fails, the walk over the
//! records says which one is damaged. A file without a footer is what a stopped writer leaves; since
//! files only grow, it is whole records and at most one that is cut off.

use std::collections::BTreeMap;

use mcap::MAGIC;
use mcap::records::{ChunkHeader, MessageIndexEntry, Record, op};

use crate::layout::{CHANNELS, Channel, MESSAGE_ENCODING, SCHEMA_ENCODING};
use crate::{Error, export};

/// Most bytes that a chunk may unfold to.
const MAX_CHUNK: u64 = 256 << 20;
/// Opcode and length of a record.
const HEAD: usize = 9;
/// The whole footer record: opcode, length, two offsets and a checksum.
const FOOTER: usize = HEAD + 20;
/// The whole record that ends the data: opcode, length and a checksum.
const DATA_END: usize = HEAD + 4;

/// A message of the file.
pub(crate) struct Message {
    pub channel: Channel,
    pub payload: Vec<u8>,
    /// Where it stands, for errors.
    pub place: String,
}

/// What a file holds.
pub(crate) struct Scan {
    pub messages: Vec<Message>,
    /// Whether it has its footer.
    pub finished: bool,
}

/// Reads a whole file.
pub(crate) fn scan(bytes: &[u8]) -> Result<Scan, Error> {
    if !bytes.starts_with(MAGIC) {
        let cut = bytes.len() < MAGIC.len() && MAGIC.starts_with(bytes);
        let reason = if cut { "the file ends here" } else { "this is no MCAP file" };
        return Err(Error::damaged("byte 0", reason));
    }
    if bytes.len() >= MAGIC.len() + DATA_END + FOOTER + MAGIC.len() && bytes.ends_with(MAGIC) {
        let data = checked_data(bytes)?;
        return Ok(Scan { messages: Walk::new(data, true).data_section()?, finished: true });
    }
    let mut walk = Walk::new(bytes, false);
    let messages = walk.data_section()?;
    walk.unfinished_tail()?;
    Ok(Scan { messages, finished: false })
}

/// Checks both checksums of a finished file and gives its data section.
fn checked_data(bytes: &[u8]) -> Result<&[u8], Error> {
    let footer_at = bytes.len() - MAGIC.len() - FOOTER;
    let footer = &bytes[footer_at..bytes.len() - MAGIC.len()];
    let damaged = |at: usize, what: &str| Error::damaged(format!("byte {at}"), what);
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
        Walk::new(data, true).data_section()?;
        return Err(damaged(MAGIC.len(), "the checksum of the data is wrong, in the header or itself"));
    }
    let sum_at = bytes.len() - MAGIC.len() - 4;
    if number::<4>(&bytes[sum_at..]) != u64::from(crc32fast::hash(&bytes[index_at..sum_at])) {
        return Err(Error::damaged(format!("bytes {index_at} to {sum_at}"), "the checksum of the index is wrong"));
    }
    Ok(data)
}

fn is_head(record: &[u8], op: u8, length: usize) -> bool {
    record[0] == op && number::<8>(&record[1..]) == (length - HEAD) as u64
}

/// A little-endian number of `N` bytes; missing bytes count as 0.
fn number<const N: usize>(bytes: &[u8]) -> u64 {
    bytes.iter().take(N).rev().fold(0, |n, b| n << 8 | u64::from(*b))
}

/// A record as it stands in the file.
struct Raw<'a> {
    at: usize,
    op: u8,
    body: &'a [u8],
}

impl Raw<'_> {
    fn damaged(&self, reason: impl std::fmt::Display) -> Error {
        Error::damaged(format!("byte {} ({})", self.at, name(self.op)), reason.to_string())
    }
}

fn name(op: u8) -> &'static str {
    match op {
        op::HEADER => "header",
        op::FOOTER => "footer",
        op::SCHEMA => "schema",
        op::CHANNEL => "channel",
        op::MESSAGE => "message",
        op::CHUNK => "chunk",
        op::MESSAGE_INDEX => "message index",
        op::DATA_END => "end of data",
        _ => "record",
    }
}

type Indexes = BTreeMap<u16, Vec<MessageIndexEntry>>;

/// Steps from record to record.
struct Walk<'a> {
    bytes: &'a [u8],
    at: usize,
    /// The bytes are known to be complete, so that nothing may be cut off.
    whole: bool,
}

impl<'a> Walk<'a> {
    fn new(bytes: &'a [u8], whole: bool) -> Self {
        Self { bytes, at: MAGIC.len(), whole }
    }

    /// The next record; `None` at the end, or where a stopped writer left one cut off.
    fn next(&mut self) -> Result<Option<Raw<'a>>, Error> {
        let (at, rest) = (self.at, &self.bytes[self.at..]);
        let Some(&op) = rest.first() else { return Ok(None) };
        let length = (rest.len() >= HEAD).then(|| number::<8>(&rest[1..]));
        let body = length.and_then(|n| rest[HEAD..].get(..usize::try_from(n).ok()?));
        if let Some(body) = body {
            self.at += HEAD + body.len();
            return Ok(Some(Raw { at, op, body }));
        }
        let cut = Raw { at, op, body: rest.get(HEAD..).unwrap_or_default() };
        if self.whole || !may_be_cut(&cut, length) {
            return Err(cut.damaged("its length leads beyond the end of the file"));
        }
        Ok(None)
    }

    /// Everything up to the end of the data. Of an unfinished file, what came last may be missing.
    fn data_section(&mut self) -> Result<Vec<Message>, Error> {
        match self.next()? {
            Some(header) if header.op == op::HEADER => check_header(&header)?,
            Some(other) => return Err(other.damaged("expected the header")),
            None => return Ok(Vec::new()),
        }
        let (mut messages, mut indexes) = (Vec::new(), Indexes::new());
        while let Some(record) = self.next()? {
            match record.op {
                op::CHUNK if indexes.is_empty() => indexes = read_chunk(&record, &mut messages)?,
                op::MESSAGE_INDEX => check_index(&record, &mut indexes)?,
                op::DATA_END if !self.whole && indexes.is_empty() => {
                    check_data_end(&record, &self.bytes[..record.at])?;
                    break;
                }
                op::METADATA if is_of_export(&record) => return Err(Error::Export),
                _ => return Err(record.damaged("expected a chunk and its message indexes")),
            }
        }
        if self.whole && !indexes.is_empty() {
            return Err(Error::damaged(format!("byte {}", self.at), "expected a message index"));
        }
        Ok(messages)
    }

    /// What follows the data of a file without its end magic: an index that is cut off.
    fn unfinished_tail(&mut self) -> Result<(), Error> {
        while let Some(record) = self.next()? {
            if record.op == op::FOOTER && self.bytes.len() - self.at >= MAGIC.len() {
                return Err(Error::damaged(format!("byte {}", self.at), "expected the magic bytes that end the file"));
            }
        }
        Ok(())
    }
}

/// Whether a record that leads beyond the end can be one that a stopped writer left: then the lengths
/// inside it agree with its own. A changed length in the middle of a file does not look like that.
fn may_be_cut(record: &Raw<'_>, length: Option<u64>) -> bool {
    let (Some(length), body) = (length, record.body) else { return true };
    let long_at =
        |at: usize| body.get(at..at + 8).is_none_or(|b| (at as u64 + 8).checked_add(number::<8>(b)) == Some(length));
    let short_at = |at: usize| body.get(at..at + 4).is_none_or(|b| at as u64 + 4 + number::<4>(b) == length);
    match record.op {
        op::HEADER => body.len() < 4 || short_at(4 + number::<4>(body) as usize),
        // Three longs, a checksum, the name of the compression, then the data.
        op::CHUNK => body.len() < 32 || long_at(32 + number::<4>(&body[28..]) as usize),
        op::MESSAGE_INDEX => short_at(2),
        op::DATA_END => length == 4,
        op::FOOTER => length == 20,
        _ => length < MAX_CHUNK,
    }
}

fn check_header(record: &Raw<'_>) -> Result<(), Error> {
    match mcap::parse_record(record.op, record.body) {
        Ok(Record::Header(h)) if h.profile.is_empty() && record.body.len() == 8 + h.library.len() => Ok(()),
        Ok(_) => Err(record.damaged("expected an empty profile and the name of a library")),
        Err(e) => Err(record.damaged(e)),
    }
}

fn is_of_export(record: &Raw<'_>) -> bool {
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

/// Appends the messages of a chunk, and gives the indexes that must follow it.
fn read_chunk(record: &Raw<'_>, messages: &mut Vec<Message>) -> Result<Indexes, Error> {
    let (header, data) = match mcap::parse_record(record.op, record.body) {
        Ok(Record::Chunk { header, data }) => (header, data),
        Ok(_) => return Err(record.damaged("expected a chunk")),
        Err(e) => return Err(record.damaged(e)),
    };
    if header.compression != "zstd" || record.body.len() != 40 + header.compression.len() + data.len() {
        return Err(record.damaged("its header is wrong"));
    }
    let records = unfold(&header, &data).map_err(|reason| record.damaged(reason))?;
    let mut indexes = Indexes::new();
    let mut walk = Walk { bytes: &records, at: 0, whole: true };
    let inner = |e: Error| match e {
        Error::Damaged { place, reason } => record.damaged(format!("{reason} at unfolded {place}")),
        other => other,
    };
    while let Some(part) = walk.next().map_err(inner)? {
        if let Some((time, message)) = read_part(&part, record.at).map_err(inner)? {
            let entry = MessageIndexEntry { log_time: time, offset: part.at as u64 };
            indexes.entry(message.channel as u16).or_default().push(entry);
            messages.push(message);
        }
    }
    check_times(&header, &indexes).map_err(|reason| record.damaged(reason))?;
    Ok(indexes)
}

fn unfold(header: &ChunkHeader, data: &[u8]) -> Result<Vec<u8>, String> {
    if header.uncompressed_size > MAX_CHUNK {
        return Err(format!("it claims {} bytes, more than {MAX_CHUNK}", header.uncompressed_size));
    }
    let size = header.uncompressed_size as usize;
    let records = zstd::bulk::decompress(data, size).map_err(|e| format!("it does not unfold: {e}"))?;
    if records.len() != size || crc32fast::hash(&records) != header.uncompressed_crc {
        return Err("its checksum is wrong".to_owned());
    }
    Ok(records)
}

fn check_times(header: &ChunkHeader, indexes: &Indexes) -> Result<(), String> {
    let times = || indexes.values().flatten().map(|e| e.log_time);
    let span = (times().min().unwrap_or(0), times().max().unwrap_or(0));
    let claimed = (header.message_start_time, header.message_end_time);
    if claimed == span { Ok(()) } else { Err(format!("it claims times {claimed:?}, its messages have {span:?}")) }
}

/// A record of a chunk: a message with its time, or a declaration that must be ours.
fn read_part(part: &Raw<'_>, chunk_at: usize) -> Result<Option<(u64, Message)>, Error> {
    match mcap::parse_record(part.op, part.body).map_err(|e| part.damaged(e))? {
        Record::Message { header, data } => {
            let known = Channel::from_id(header.channel_id);
            let channel = known.ok_or_else(|| part.damaged(format!("unknown channel {}", header.channel_id)))?;
            let topic = CHANNELS[channel as usize - 1].topic;
            let place = format!("byte {chunk_at} (chunk), message {} of {topic}", header.sequence);
            Ok(Some((header.log_time, Message { channel, payload: data.into_owned(), place })))
        }
        Record::Schema { header, data } => {
            let ours = CHANNELS.iter().find(|l| l.channel as u16 == header.id);
            match ours.filter(|l| l.schema == header.name && header.encoding == SCHEMA_ENCODING) {
                Some(layout) if layout.text.as_bytes() == &*data => Ok(None),
                _ => Err(Error::Unsuited(format!("layout {} is not one that this program reads", header.name))),
            }
        }
        Record::Channel(c) => {
            let ours = CHANNELS.iter().any(|l| {
                (l.channel as u16, l.channel as u16, l.topic, MESSAGE_ENCODING)
                    == (c.id, c.schema_id, &*c.topic, &*c.message_encoding)
            });
            if ours { Ok(None) } else { Err(Error::Unsuited(format!("this is no log of A-Eye: channel {}", c.topic))) }
        }
        _ => Err(part.damaged("expected a message")),
    }
}

/// A message index must say what was read from its chunk.
fn check_index(record: &Raw<'_>, indexes: &mut Indexes) -> Result<(), Error> {
    let index = match mcap::parse_record(record.op, record.body) {
        Ok(Record::MessageIndex(index)) => index,
        Ok(_) => return Err(record.damaged("expected a message index")),
        Err(e) => return Err(record.damaged(e)),
    };
    let expected = indexes.remove(&index.channel_id).unwrap_or_default();
    let same = |(a, b): (&MessageIndexEntry, &MessageIndexEntry)| (a.log_time, a.offset) == (b.log_time, b.offset);
    let entries = &index.records;
    let complete = record.body.len() == 6 + 16 * expected.len() && entries.len() == expected.len();
    if complete && !entries.is_empty() && entries.iter().zip(&expected).all(same) {
        Ok(())
    } else {
        Err(record.damaged("it does not say what its chunk holds"))
    }
}
