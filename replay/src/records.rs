//! Steps through the records of an MCAP file, or of a chunk that was unfolded.

use mcap::MAGIC;
use mcap::records::op;

use crate::Error;

/// Opcode and length of a record.
pub(crate) const HEAD: usize = 9;
/// Most bytes that a record may claim, or a chunk unfold to.
pub(crate) const MAX_RECORD: u64 = 64 << 20;

/// A little-endian number of `N` bytes; missing bytes count as 0.
pub(crate) fn number<const N: usize>(bytes: &[u8]) -> u64 {
    bytes.iter().take(N).rev().fold(0, |n, b| n << 8 | u64::from(*b))
}

/// A record as it stands in the file.
pub(crate) struct Raw<'a> {
    pub at: usize,
    pub op: u8,
    pub body: &'a [u8],
}

impl Raw<'_> {
    pub fn damaged(&self, reason: impl std::fmt::Display) -> Error {
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

/// Steps from record to record.
pub(crate) struct Walk<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    /// The bytes are known to be complete, so that nothing may be cut off.
    pub whole: bool,
}

impl<'a> Walk<'a> {
    pub fn new(bytes: &'a [u8], whole: bool) -> Self {
        Self { bytes, at: MAGIC.len(), whole }
    }

    /// The next record; `None` at the end, or where a stopped writer left one cut off.
    pub fn next(&mut self) -> Result<Option<Raw<'a>>, Error> {
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
        _ => length < MAX_RECORD,
    }
}
