//! Writes messages into an MCAP file that only ever grows.

use std::collections::BTreeMap;
use std::io::{self, Write};

use kernel::time::Tick;
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{Compression, McapError, WriteOptions, Writer};

use crate::Error;
use crate::layout::{CHANNELS, Channel, MESSAGE_ENCODING, SCHEMA_ENCODING, nanoseconds};
use crate::seal::Seal;

/// What writes: the name that stands in a file's header.
const LIBRARY: &str = concat!("aeye ", env!("CARGO_PKG_VERSION"));

/// Every option is set here, so that neither the machine nor a new default can change a file.
pub(crate) fn options() -> WriteOptions {
    WriteOptions::new()
        .profile("")
        .library(LIBRARY)
        .compression(Some(Compression::Zstd))
        .compression_level(9)
        .compression_threads(0)
        .use_chunks(true)
        // A chunk ends when it is flushed, and is written at once: the file is append-only.
        .chunk_size(None)
        .disable_seeking(true)
        .emit_summary_records(true)
        .emit_summary_offsets(true)
        .emit_message_indexes(true)
        .calculate_chunk_crcs(true)
        .calculate_data_section_crc(true)
        .calculate_summary_section_crc(true)
        .calculate_attachment_crcs(true)
}

/// An MCAP file being written, each of whose chunks ends with a seal.
pub(crate) struct Container<W: Write> {
    writer: Option<Writer<NoSeek<W>>>,
    messages: u32,
    seal: Seal,
    /// Of the last message.
    tick: Tick,
}

impl<W: Write> Container<W> {
    /// Starts the file and declares all channels.
    pub fn new(out: W) -> Result<Self, Error> {
        let mut writer = Writer::with_options(NoSeek::new(out), options()).map_err(io_error)?;
        let mut seal = Seal::default();
        seal.header(LIBRARY);
        for layout in &CHANNELS {
            let (id, schema) = (layout.channel as u16, layout.schema());
            writer
                .add_schema_with_id(id, &schema, SCHEMA_ENCODING, layout.text.as_bytes())
                .and_then(|s| writer.add_channel_with_id(id, s, layout.topic, MESSAGE_ENCODING, &BTreeMap::new()))
                .map_err(io_error)?;
            seal.schema(id, &schema, SCHEMA_ENCODING, layout.text);
            seal.channel(id, layout.topic, MESSAGE_ENCODING);
        }
        Ok(Self { writer: Some(writer), messages: 0, seal, tick: 0 })
    }

    /// Appends a message that was complete at `tick`; it is in the file after the next flush.
    pub fn put(&mut self, channel: Channel, tick: Tick, payload: &[u8]) -> Result<(), Error> {
        let (channel_id, sequence, time) = (channel as u16, self.messages, nanoseconds(tick));
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.messages = self.messages.wrapping_add(1);
        self.tick = tick;
        self.seal.message(channel_id, sequence, time, payload);
        self.writer()?.write_to_known_channel(&header, payload).map_err(io_error)
    }

    /// Seals and ends the chunk, and hands everything to the operating system.
    pub fn flush(&mut self) -> Result<(), Error> {
        let seal = self.seal.value();
        self.put(Channel::Seal, self.tick, &seal)?;
        self.writer()?.flush().map_err(io_error)
    }

    /// Ends the last chunk, and writes index and footer.
    pub fn finish(mut self) -> Result<W, Error> {
        self.flush()?;
        self.writer()?.finish().map_err(io_error)?;
        let writer = self.writer.take().ok_or_else(closed)?;
        Ok(writer.into_inner().into_inner())
    }

    fn writer(&mut self) -> Result<&mut Writer<NoSeek<W>>, Error> {
        self.writer.as_mut().ok_or_else(closed)
    }
}

impl<W: Write> Drop for Container<W> {
    /// Leaves the file as a killed process would: without a footer, which the reader reports. The
    /// MCAP writer on its own would add one and hide that the end is missing.
    fn drop(&mut self) {
        if let Some(writer) = self.writer.take() {
            drop(writer.into_inner());
        }
    }
}

fn closed() -> Error {
    Error::Io(io::Error::other("the file is closed"))
}

pub(crate) fn io_error(error: McapError) -> Error {
    match error {
        McapError::Io(e) => Error::Io(e),
        other => Error::Io(io::Error::other(other)),
    }
}
