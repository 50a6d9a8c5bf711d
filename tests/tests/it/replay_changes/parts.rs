//! A recording's file taken apart, and put together again with everything repaired that follows from
//! the rest: checksums, message indexes, the index at the end, and, when asked, the seals.

use std::collections::BTreeMap;

use mcap::records::{MessageHeader, Record};
use mcap::write::NoSeek;
use mcap::{Compression, WriteOptions, Writer};

/// Channel of the seals.
pub const SEAL: u16 = 10;

/// What a file holds.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    pub library: String,
    pub schemas: Vec<Schema>,
    pub channels: Vec<mcap::records::Channel>,
    /// The messages of each chunk.
    pub chunks: Vec<Vec<Message>>,
}

#[derive(Clone, Debug)]
pub struct Schema {
    pub id: u16,
    pub name: String,
    pub encoding: String,
    pub text: Vec<u8>,
}

#[derive(Clone, Debug)]
pub struct Message {
    pub header: MessageHeader,
    pub payload: Vec<u8>,
}

impl Parts {
    /// Takes a whole file apart.
    pub fn of(file: &[u8]) -> Self {
        let mut parts = Self::default();
        for record in mcap::read::LinearReader::new(file).expect("an MCAP file") {
            match record.expect("a record") {
                Record::Header(header) => parts.library = header.library,
                Record::Chunk { header, data } => {
                    let mut messages = Vec::new();
                    for record in mcap::read::ChunkReader::new(header, &data).expect("a chunk") {
                        parts.add(record.expect("a record"), &mut messages);
                    }
                    parts.chunks.push(messages);
                }
                Record::DataEnd(_) => break,
                _ => {}
            }
        }
        parts
    }

    fn add(&mut self, record: Record<'_>, messages: &mut Vec<Message>) {
        match record {
            Record::Schema { header, data } => {
                let (name, encoding) = (header.name, header.encoding);
                self.schemas.push(Schema { id: header.id, name, encoding, text: data.into_owned() });
            }
            Record::Channel(channel) => self.channels.push(channel),
            Record::Message { header, data } => messages.push(Message { header, payload: data.into_owned() }),
            _ => {}
        }
    }

    /// All messages.
    pub fn messages(&mut self) -> impl Iterator<Item = &mut Message> {
        self.chunks.iter_mut().flatten()
    }

    /// The file with this content, as MCAP's own writer makes it.
    pub fn file(&self) -> Vec<u8> {
        let options = WriteOptions::new()
            .profile("")
            .library(&self.library)
            .compression(Some(Compression::Zstd))
            .compression_level(1)
            .compression_threads(0)
            .chunk_size(None)
            .disable_seeking(true);
        let mut writer = Writer::with_options(NoSeek::new(Vec::new()), options).expect("a writer");
        for (schema, channel) in self.schemas.iter().zip(&self.channels) {
            writer.add_schema_with_id(schema.id, &schema.name, &schema.encoding, &schema.text).expect("a schema");
            let (topic, encoding) = (&channel.topic, &channel.message_encoding);
            writer
                .add_channel_with_id(channel.id, channel.schema_id, topic, encoding, &channel.metadata)
                .expect("a channel");
        }
        for chunk in &self.chunks {
            for message in chunk {
                writer.write_to_known_channel(&message.header, &message.payload).expect("a message");
            }
            writer.flush().expect("a chunk");
        }
        writer.finish().expect("a file");
        writer.into_inner().into_inner()
    }

    /// Makes every seal anew, as docs/recording.md says.
    pub fn seal(&mut self) {
        let mut digest = blake3::Hasher::new();
        add(&mut digest, 0x01, &[text(b""), text(self.library.as_bytes())]);
        for (schema, channel) in self.schemas.iter().zip(&self.channels) {
            let texts = [schema.name.as_bytes(), schema.encoding.as_bytes(), &schema.text].map(text);
            add(&mut digest, 0x03, &[schema.id.to_le_bytes().to_vec(), texts.concat()]);
            let ids = [channel.id.to_le_bytes(), channel.schema_id.to_le_bytes()].concat();
            let texts = [channel.topic.as_bytes(), channel.message_encoding.as_bytes()].map(text);
            add(&mut digest, 0x04, &[ids, texts.concat(), metadata(&channel.metadata)]);
        }
        for Message { header, payload } in self.chunks.iter_mut().flatten() {
            if header.channel_id == SEAL {
                *payload = digest.finalize().as_bytes()[..16].to_vec();
            }
            let numbers = [&header.channel_id.to_le_bytes()[..], &header.sequence.to_le_bytes()].concat();
            let times = [header.log_time.to_le_bytes(), header.publish_time.to_le_bytes()].concat();
            add(&mut digest, 0x05, &[numbers, times, payload.clone()]);
        }
    }
}

/// Goes on with a record.
fn add(digest: &mut blake3::Hasher, op: u8, body: &[Vec<u8>]) {
    let body = body.concat();
    digest.update(&[op]).update(&(body.len() as u64).to_le_bytes()).update(&body);
}

fn text(bytes: &[u8]) -> Vec<u8> {
    [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat()
}

fn metadata(map: &BTreeMap<String, String>) -> Vec<u8> {
    text(
        &map.iter()
            .flat_map(|(key, value)| [text(key.as_bytes()), text(value.as_bytes())].concat())
            .collect::<Vec<_>>(),
    )
}
