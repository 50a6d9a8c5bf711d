//! The chain of digests that vouches for what no replay can tell: notes, masks, labels, comments, names.
//!
//! The last message of every chunk is a seal: the first 16 bytes of blake3 over the header record and all
//! records of all chunks, unfolded, up to the record of the seal itself. So each vouches for those before.

use mcap::records::op;

/// A seal as its message holds it.
pub(crate) type SealBytes = [u8; 16];

/// A digest over the records of a file so far.
#[derive(Clone, Default)]
pub(crate) struct Seal(blake3::Hasher);

impl Seal {
    /// Goes on with a record, whose body is given in parts.
    pub fn record(&mut self, op: u8, body: &[&[u8]]) {
        let length: usize = body.iter().map(|part| part.len()).sum();
        self.0.update(&[op]);
        self.0.update(&(length as u64).to_le_bytes());
        for part in body {
            self.0.update(part);
        }
    }

    /// Goes on with the header record, whose profile is empty.
    pub fn header(&mut self, library: &str) {
        self.record(op::HEADER, &[&length(b""), &length(library.as_bytes()), library.as_bytes()]);
    }

    /// Goes on with a schema.
    pub fn schema(&mut self, id: u16, name: &str, encoding: &str, text: &str) {
        let [name, encoding, text] = [name, encoding, text].map(str::as_bytes);
        let body = [&id.to_le_bytes()[..], &length(name), name, &length(encoding), encoding, &length(text), text];
        self.record(op::SCHEMA, &body);
    }

    /// Goes on with a channel without metadata, whose schema has the same id.
    pub fn channel(&mut self, id: u16, topic: &str, encoding: &str) {
        let ([topic, encoding], id) = ([topic, encoding].map(str::as_bytes), id.to_le_bytes());
        let body = [&id[..], &id, &length(topic), topic, &length(encoding), encoding, &length(b"")];
        self.record(op::CHANNEL, &body);
    }

    /// Goes on with a message, published when it was logged.
    pub fn message(&mut self, channel: u16, sequence: u32, time_ns: u64, payload: &[u8]) {
        let time = time_ns.to_le_bytes();
        self.record(op::MESSAGE, &[&channel.to_le_bytes(), &sequence.to_le_bytes(), &time, &time, payload]);
    }

    /// What a seal says at this point.
    pub fn value(&self) -> SealBytes {
        let digest = self.0.finalize();
        std::array::from_fn(|at| digest.as_bytes()[at])
    }
}

/// The length that stands before a text, as MCAP writes it.
fn length(text: &[u8]) -> [u8; 4] {
    (text.len() as u32).to_le_bytes()
}
