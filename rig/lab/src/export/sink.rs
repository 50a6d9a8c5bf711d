//! Typed topics of an MCAP file.

use std::collections::BTreeMap;
use std::io::Write;
use std::marker::PhantomData;

use anyhow::Context;
use foxglove::Encode;
use kernel::time::Tick;
use replay::{ExportChannel, Exporter, Schema};

/// A topic whose messages are of one type.
pub struct Topic<M> {
    channel: ExportChannel,
    messages: PhantomData<M>,
}

/// The file, and how much is in it.
pub struct Sink<W: Write> {
    exporter: Exporter<W>,
    bytes: Vec<u8>,
}

impl<W: Write> Sink<W> {
    /// Starts a file that was made from `about`, names and values.
    pub fn new(out: W, about: BTreeMap<String, String>) -> anyhow::Result<Self> {
        Ok(Self { exporter: Exporter::new(out, about)?, bytes: Vec::new() })
    }

    /// Adds a topic.
    pub fn topic<M: Encode>(&mut self, name: &str) -> anyhow::Result<Topic<M>> {
        let schema = M::get_schema().with_context(|| format!("topic {name}: its messages have no schema"))?;
        let schema = Schema { name: &schema.name, encoding: &schema.encoding, data: &schema.data };
        Ok(Topic { channel: self.exporter.channel(name, &schema)?, messages: PhantomData })
    }

    /// Appends a message about a tick.
    pub fn put<M: Encode>(&mut self, topic: &Topic<M>, tick: Tick, message: &M) -> anyhow::Result<()> {
        self.bytes.clear();
        message.encode(&mut self.bytes).map_err(|error| anyhow::anyhow!("a message of tick {tick}: {error}"))?;
        Ok(self.exporter.put(topic.channel, tick, &self.bytes)?)
    }

    /// Writes index and footer, and hands the stream back.
    pub fn finish(self) -> anyhow::Result<W> {
        Ok(self.exporter.finish()?)
    }
}
