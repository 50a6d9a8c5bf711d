//! Simulates a log again.

use std::fmt;
use std::sync::Arc;

use kernel::time::Tick;
use kernel::{RoadNetwork, TickOutput, World};

use crate::{Error, Log};

/// Where a replay first differs from what was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Divergence {
    /// The first tick that differs.
    pub tick: Tick,
    /// One of [`kernel::world::PARTS`], or `"state"` when it cannot be told apart.
    pub part: String,
    /// Id of the actor, if the field belongs to one.
    pub actor: Option<u32>,
    /// Name of the field; `"hash"` when only hashes are known.
    pub field: String,
    /// What the log says.
    pub expected: String,
    /// What the simulation gives.
    pub got: String,
    /// The tick at which field and values were read: `tick` itself, or the next keyframe's.
    pub seen_at: Tick,
}

impl fmt::Display for Divergence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "diverges at tick {}: {}", self.tick, self.part)?;
        if let Some(actor) = self.actor {
            write!(f, ", actor {actor}")?;
        }
        write!(f, ", {}: expected {}, got {}", self.field, self.expected, self.got)?;
        if self.seen_at != self.tick {
            write!(f, " (at tick {})", self.seen_at)?;
        }
        Ok(())
    }
}

impl std::error::Error for Divergence {}

/// Steps through a log, comparing every tick with what was recorded.
pub struct Replayer<'a> {
    log: &'a Log,
    network: Arc<RoadNetwork>,
    world: World,
}

impl<'a> Replayer<'a> {
    /// Stands at the first tick of the log.
    pub fn new(_log: &'a Log, _network: Arc<RoadNetwork>) -> Result<Self, Error> {
        todo!()
    }

    /// Goes to a tick: resumes from the nearest keyframe before it, and steps from there.
    pub fn seek(&mut self, _tick: Tick) -> Result<(), Error> {
        todo!()
    }

    /// Advances by one tick; `None` at the end of the log. A tick that differs from the log is an
    /// error ([`Error::Diverged`]).
    pub fn step(&mut self) -> Result<Option<TickOutput>, Error> {
        todo!()
    }

    /// The world at the current tick.
    pub fn world(&self) -> &World {
        &self.world
    }
}
