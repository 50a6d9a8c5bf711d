//! A log read back from its file.

use std::path::Path;
use std::sync::Arc;

use kernel::RoadNetwork;
use kernel::map::{bake, bundled};
use kernel::time::Tick;

use crate::block::Block;
use crate::layout::Channel;
use crate::scan::{Message, scan};
use crate::{Error, Log, Manifest, wire};

/// A recording or case whose bytes have all been checked.
#[derive(Clone, Debug)]
pub struct Recording {
    log: Log,
    finished: bool,
    digest: [u8; 32],
}

impl Recording {
    /// Reads a file. Any changed byte is an error that says where; a file whose writer was stopped is
    /// read up to its last whole block ([`Recording::finished`] tells).
    pub fn open(path: &Path) -> Result<Self, Error> {
        let read = std::fs::read(path).map_err(Error::from);
        read.and_then(|bytes| Self::from_bytes(&bytes)).map_err(|e| e.within(path))
    }

    /// As [`Recording::open`], from memory.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let scan = scan(bytes)?;
        let log = assemble(&scan.messages, scan.finished)?;
        Ok(Self { log, finished: scan.finished, digest: *blake3::hash(bytes).as_bytes() })
    }

    /// The content.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// The content, taken out.
    pub fn into_log(self) -> Log {
        self.log
    }

    /// Whether the writer came to its end; if not, up to a second is missing.
    pub fn finished(&self) -> bool {
        self.finished
    }

    /// blake3 of the file.
    pub fn digest(&self) -> [u8; 32] {
        self.digest
    }

    /// The map of the run: a bundled one, or the one embedded in the log; its digest is checked.
    pub fn network(&self) -> Result<Arc<RoadNetwork>, Error> {
        self.log.manifest.network()
    }
}

impl Manifest {
    /// The map of the run: a bundled one, or the embedded one; its digest is checked.
    pub fn network(&self) -> Result<Arc<RoadNetwork>, Error> {
        let name = &self.scenario.map;
        let network = match &self.foreign_map {
            Some(text) => Arc::new(bake(name, text)?),
            None => {
                bundled(name).ok_or_else(|| Error::Unsuited(format!("map {name} is neither bundled nor in the log")))?
            }
        };
        self.check_map(&network)?;
        Ok(network)
    }

    /// Refuses a map that is not the run's.
    pub(crate) fn check_map(&self, network: &RoadNetwork) -> Result<(), Error> {
        let (expected, got) = (self.map_digest, network.digest);
        let map = self.scenario.map.clone();
        if expected == got { Ok(()) } else { Err(Error::Map { map, expected, got }) }
    }
}

/// Puts the messages of a file together, in the only order in which a writer gives them.
fn assemble(messages: &[Message], finished: bool) -> Result<Log, Error> {
    let [first, start, rest @ ..] = messages else {
        return Err(Error::damaged("the end of the file", "it holds no manifest and start"));
    };
    let mut log = Log {
        manifest: first.parse(Channel::Manifest, wire::manifest)?,
        keyframes: vec![start.parse(Channel::Keyframe, wire::keyframe)?],
        inputs: Vec::new(),
        hashes: Vec::new(),
        marks: Vec::new(),
        events: Vec::new(),
        intervention: None,
        masks: Vec::new(),
        annotation: None,
        summary: None,
        scenes: Vec::new(),
    };
    let mut ended = false;
    for message in rest {
        if ended {
            return Err(message.damaged("expected nothing after the end"));
        }
        ended = message.channel == Channel::End;
        log.add(message)?;
    }
    if finished && !ended {
        return Err(Error::damaged("the end of the data", "expected the message that ends the log"));
    }
    Ok(log)
}

impl Message {
    fn parse<T>(&self, channel: Channel, read: impl Fn(&[u8]) -> Result<T, String>) -> Result<T, Error> {
        if self.channel != channel {
            return Err(self.damaged(format!("expected a message of {channel:?}")));
        }
        read(&self.payload).map_err(|reason| self.damaged(reason))
    }

    fn damaged(&self, reason: impl Into<String>) -> Error {
        Error::damaged(self.place.clone(), reason)
    }
}

impl Log {
    fn add(&mut self, message: &Message) -> Result<(), Error> {
        match message.channel {
            Channel::Manifest => return Err(message.damaged("expected one manifest only")),
            Channel::Block => self.add_block(message.parse(Channel::Block, wire::block)?, message)?,
            Channel::Keyframe => {
                let keyframe = message.parse(Channel::Keyframe, wire::keyframe)?;
                let before = self.keyframes.last().map_or(0, |k| k.tick);
                self.within_last_block(keyframe.tick, before + 1, message)?;
                self.keyframes.push(keyframe);
            }
            Channel::Events => {
                let happenings = message.parse(Channel::Events, wire::happenings)?;
                for (tick, event) in happenings.events {
                    let before = self.events.last().map_or(0, |e| e.0);
                    self.within_last_block(tick, before, message)?;
                    self.events.push((tick, event));
                }
                self.intervention = self.intervention.or(happenings.intervention);
            }
            Channel::Masks => self.masks.extend(message.parse(Channel::Masks, wire::masks)?),
            Channel::Scenes => self.scenes = message.parse(Channel::Scenes, wire::scenes)?,
            Channel::End => (self.annotation, self.summary) = message.parse(Channel::End, wire::end)?,
        }
        Ok(())
    }

    fn add_block(&mut self, block: Block, message: &Message) -> Result<(), Error> {
        let expected = self.last_tick() + 1;
        if block.first != expected {
            return Err(message.damaged(format!("its first tick is {}, expected {expected}", block.first)));
        }
        self.inputs.extend(block.inputs);
        self.hashes.extend(block.hashes);
        self.marks.push(block.mark);
        Ok(())
    }

    /// What belongs to a block follows it.
    fn within_last_block(&self, tick: Tick, least: Tick, message: &Message) -> Result<(), Error> {
        if (least..=self.last_tick()).contains(&tick) {
            return Ok(());
        }
        Err(message.damaged(format!("tick {tick}, expected {least} to {}", self.last_tick())))
    }
}
