//! The index that a file must end with, byte for byte, gathered while its data is read.

use std::collections::BTreeMap;

use mcap::records::{ChunkHeader, op};

use crate::records::{HEAD, Raw};

/// Where the messages of each channel are listed: channel, and offset of the record.
pub(crate) type Places = BTreeMap<u16, u64>;

/// What the data of a file holds, as its index has to say it.
#[derive(Default)]
pub(crate) struct Index {
    schemas: Records,
    channels: Records,
    chunks: Vec<Chunk>,
    /// Messages of each channel.
    counts: BTreeMap<u16, u64>,
    times: Option<(u64, u64)>,
}

/// Whole records, one after the other.
#[derive(Default)]
struct Records {
    bytes: Vec<u8>,
    count: u32,
}

struct Chunk {
    header: ChunkHeader,
    at: u64,
    length: u64,
    /// Its message indexes.
    places: Places,
    places_length: u64,
    packed: u64,
}

impl Index {
    pub fn schema(&mut self, record: &Raw<'_>) {
        self.schemas.push(record.op, record.body);
    }

    pub fn channel(&mut self, record: &Raw<'_>) {
        self.channels.push(record.op, record.body);
    }

    pub fn message(&mut self, channel: u16, time_ns: u64) {
        *self.counts.entry(channel).or_default() += 1;
        let (from, to) = self.times.unwrap_or((time_ns, time_ns));
        self.times = Some((from.min(time_ns), to.max(time_ns)));
    }

    /// Messages so far.
    pub fn messages(&self) -> u64 {
        self.counts.values().sum()
    }

    pub fn chunk(&mut self, record: &Raw<'_>, header: ChunkHeader, packed: usize) {
        let (at, length) = (record.at as u64, (HEAD + record.body.len()) as u64);
        let (places, places_length, packed) = (Places::new(), 0, packed as u64);
        self.chunks.push(Chunk { header, at, length, places, places_length, packed });
    }

    /// A message index of the last chunk.
    pub fn message_index(&mut self, record: &Raw<'_>, channel: u16) {
        if let Some(chunk) = self.chunks.last_mut() {
            chunk.places.insert(channel, record.at as u64);
            chunk.places_length += (HEAD + record.body.len()) as u64;
        }
    }

    /// The bytes of the index when it begins at `start`, and where in the file its offsets begin.
    pub fn bytes(&self, start: usize) -> (Vec<u8>, u64) {
        let mut statistics = Records::default();
        statistics.push(op::STATISTICS, &self.statistics());
        let mut chunks = Records::default();
        self.chunks.iter().for_each(|chunk| chunks.push(op::CHUNK_INDEX, &chunk.index()));

        let groups = [(op::SCHEMA, &self.schemas), (op::CHANNEL, &self.channels)];
        let groups = groups.into_iter().chain([(op::STATISTICS, &statistics), (op::CHUNK_INDEX, &chunks)]);
        let (mut bytes, mut offsets) = (Vec::new(), Records::default());
        for (op, group) in groups.filter(|(_, group)| group.count > 0) {
            let at = (start + bytes.len()) as u64;
            let length = group.bytes.len() as u64;
            offsets.push(op::SUMMARY_OFFSET, &[&[op][..], &at.to_le_bytes(), &length.to_le_bytes()].concat());
            bytes.extend_from_slice(&group.bytes);
        }
        let offsets_at = (start + bytes.len()) as u64;
        bytes.extend(offsets.bytes);
        (bytes, offsets_at)
    }

    fn statistics(&self) -> Vec<u8> {
        let messages: u64 = self.counts.values().sum();
        let (from, to) = self.times.unwrap_or_default();
        let none = 0u32.to_le_bytes();
        let counts: Vec<u8> = pairs(&self.counts);
        [
            &messages.to_le_bytes()[..],
            &(self.schemas.count as u16).to_le_bytes(),
            &self.channels.count.to_le_bytes(),
            // Attachments and metadata.
            &none,
            &none,
            &(self.chunks.len() as u32).to_le_bytes(),
            &from.to_le_bytes(),
            &to.to_le_bytes(),
            &counts,
        ]
        .concat()
    }
}

impl Records {
    fn push(&mut self, op: u8, body: &[u8]) {
        self.bytes.push(op);
        self.bytes.extend((body.len() as u64).to_le_bytes());
        self.bytes.extend_from_slice(body);
        self.count += 1;
    }
}

impl Chunk {
    fn index(&self) -> Vec<u8> {
        let header = &self.header;
        [
            &header.message_start_time.to_le_bytes()[..],
            &header.message_end_time.to_le_bytes(),
            &self.at.to_le_bytes(),
            &self.length.to_le_bytes(),
            &pairs(&self.places),
            &self.places_length.to_le_bytes(),
            &(header.compression.len() as u32).to_le_bytes(),
            header.compression.as_bytes(),
            &self.packed.to_le_bytes(),
            &header.uncompressed_size.to_le_bytes(),
        ]
        .concat()
    }
}

/// A map from channels as MCAP writes it: its length in bytes, then its entries.
fn pairs(map: &BTreeMap<u16, u64>) -> Vec<u8> {
    let entries = map.iter().flat_map(|(channel, n)| channel.to_le_bytes().into_iter().chain(n.to_le_bytes()));
    let length = (map.len() * 10) as u32;
    length.to_le_bytes().into_iter().chain(entries).collect()
}
