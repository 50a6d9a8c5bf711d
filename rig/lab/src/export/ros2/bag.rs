//! A bag of ROS 2: a folder with an MCAP file of CDR messages, and `metadata.yaml`, which tells of it.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use anyhow::Context;
use kernel::time::Tick;
use replay::{ExportChannel, Exporter, Schema, nanoseconds};

use super::definitions;
use super::messages::Message;

/// The file of messages.
pub const MESSAGES: &str = "bag_0.mcap";
const METADATA: &str = "metadata.yaml";
/// The oldest version with a list of files; every later ROS reads it.
const VERSION: u32 = 5;

/// Whether whoever comes late gets the last message of a topic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Durability {
    /// It does.
    TransientLocal = 1,
    /// It does not.
    Volatile = 2,
}

/// A topic whose messages are of one type.
pub struct Topic<M> {
    number: usize,
    messages: PhantomData<M>,
}

struct Told {
    name: String,
    r#type: &'static str,
    durability: Durability,
    channel: ExportChannel,
    messages: usize,
}

/// A bag that grows.
pub struct Bag {
    folder: PathBuf,
    exporter: Exporter<BufWriter<File>>,
    topics: Vec<Told>,
    ticks: Option<(Tick, Tick)>,
}

impl Bag {
    /// Starts a bag that was made from `about`, names and values, in a folder that is there.
    pub fn new(folder: &Path, about: BTreeMap<String, String>) -> anyhow::Result<Self> {
        let path = folder.join(MESSAGES);
        let file = BufWriter::new(File::create(&path).with_context(|| path.display().to_string())?);
        let exporter = Exporter::with_profile(file, "ros2", about)?;
        Ok(Self { folder: folder.to_owned(), exporter, topics: Vec::new(), ticks: None })
    }

    /// Adds a topic.
    pub fn topic<M: Message>(&mut self, name: &str, durability: Durability) -> anyhow::Result<Topic<M>> {
        let definition = definitions::whole(M::TYPE);
        let schema = Schema { name: M::TYPE, encoding: "ros2msg", data: definition.as_bytes() };
        let qos = [("offered_qos_profiles".to_owned(), qos(durability))].into();
        let channel = self.exporter.channel_with(name, &schema, &qos)?;
        self.topics.push(Told { name: name.to_owned(), r#type: M::TYPE, durability, channel, messages: 0 });
        Ok(Topic { number: self.topics.len() - 1, messages: PhantomData })
    }

    /// Appends a message about a tick; ticks come in ascending order.
    pub fn put<M: Message>(&mut self, topic: &Topic<M>, tick: Tick, message: &M) -> anyhow::Result<()> {
        let told = &mut self.topics[topic.number];
        let bytes = message.encode().with_context(|| format!("a message of tick {tick} on {}", told.name))?;
        told.messages += 1;
        self.ticks = Some((self.ticks.map_or(tick, |(first, _)| first), tick));
        Ok(self.exporter.put(told.channel, tick, &bytes)?)
    }

    /// Writes what tells of the bag.
    pub fn finish(self) -> anyhow::Result<()> {
        let metadata = metadata(&self.topics, self.ticks.unwrap_or_default());
        self.exporter.finish()?.flush().with_context(|| self.folder.join(MESSAGES).display().to_string())?;
        let path = self.folder.join(METADATA);
        fs::write(&path, metadata).with_context(|| path.display().to_string())
    }
}

/// How a topic is offered, as this version has it: reliably, the last ten messages, with no deadline.
fn qos(durability: Durability) -> String {
    let never = "\n    sec: 9223372036\n    nsec: 854775807";
    format!(
        "- history: 1\n  depth: 10\n  reliability: 1\n  durability: {}\n  deadline:{never}\n  lifespan:{never}\n  liveliness: 1\n  \
         liveliness_lease_duration:{never}\n  avoid_ros_namespace_conventions: false",
        durability as u8
    )
}

/// The text of `metadata.yaml`.
fn metadata(topics: &[Told], (first, last): (Tick, Tick)) -> String {
    let (from_ns, to_ns) = (nanoseconds(first), nanoseconds(last));
    let (duration_ns, messages) = (to_ns - from_ns, topics.iter().map(|told| told.messages).sum::<usize>());
    let mut text = format!(
        "rosbag2_bagfile_information:\n  version: {VERSION}\n  storage_identifier: mcap\n  duration:\n    nanoseconds: \
         {duration_ns}\n  starting_time:\n    nanoseconds_since_epoch: {from_ns}\n  message_count: {messages}\n  \
         topics_with_message_count:\n"
    );
    for Told { name, r#type, durability, messages, .. } in topics {
        let qos = qos(*durability).replace('\n', "\\n");
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "    - topic_metadata:\n        name: {name}\n        type: {type}\n        serialization_format: cdr\n        \
             offered_qos_profiles: \"{qos}\"\n      message_count: {messages}\n"
        );
    }
    let _ = write!(
        text,
        "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - {MESSAGES}\n  files:\n    - path: \
         {MESSAGES}\n      starting_time:\n        nanoseconds_since_epoch: {from_ns}\n      duration:\n        nanoseconds: \
         {duration_ns}\n      message_count: {messages}\n"
    );
    text
}
