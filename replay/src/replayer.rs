//! Simulates a log again.

use std::sync::Arc;

use kernel::state::first_difference;
use kernel::time::Tick;
use kernel::{Keyframe, RoadNetwork, TickOutput, World};

use crate::{Divergence, Error, Log, Mark};

/// Steps through a log, comparing every tick with what was recorded.
pub struct Replayer<'a> {
    log: &'a Log,
    network: Arc<RoadNetwork>,
    world: World,
}

impl<'a> Replayer<'a> {
    /// Stands at the first tick of the log.
    pub fn new(log: &'a Log, network: Arc<RoadNetwork>) -> Result<Self, Error> {
        log.manifest.check(&network)?;
        let start = log.keyframes.first();
        let start = start.ok_or_else(|| Error::Unsuited("the log has no keyframe to start from".into()))?;
        let world = World::resume(&log.manifest.scenario, &network, start)?;
        Ok(Self { log, network, world })
    }

    /// Goes to a tick: resumes from the nearest keyframe before it unless the world stands between
    /// the two, and steps from there. What it jumps over is not compared.
    pub fn seek(&mut self, tick: Tick) -> Result<(), Error> {
        let (first, last) = (self.log.first_tick(), self.log.last_tick());
        let before = self.log.keyframes.iter().rev().find(|k| k.tick <= tick);
        let Some(keyframe) = before.filter(|_| tick <= last) else {
            return Err(Error::Unsuited(format!("the log has ticks {first} to {last}, not {tick}")));
        };
        if !(keyframe.tick..=tick).contains(&self.world.tick()) {
            self.resume(keyframe)?;
        }
        self.run_to(tick)
    }

    /// Goes on to a tick that is not behind, simulating every tick on the way.
    pub fn run_to(&mut self, tick: Tick) -> Result<(), Error> {
        while self.world.tick() < tick {
            if self.step()?.is_none() {
                return Err(Error::Unsuited(format!("the log ends at tick {}, before {tick}", self.world.tick())));
            }
        }
        Ok(())
    }

    /// Stands at a keyframe of the log.
    pub(crate) fn resume(&mut self, keyframe: &Keyframe) -> Result<(), Error> {
        self.world = World::resume(&self.log.manifest.scenario, &self.network, keyframe)?;
        Ok(())
    }

    /// Advances by one tick; `None` at the end of the log. A tick that differs from the log is an
    /// error ([`Error::Diverged`]), after which the world is no longer that of the log.
    pub fn step(&mut self) -> Result<Option<TickOutput>, Error> {
        let Some(output) = self.advance() else { return Ok(None) };
        match self.compare(&output)? {
            Some(divergence) => Err(Error::Diverged(Box::new(divergence))),
            None => Ok(Some(output)),
        }
    }

    /// Advances by one tick without comparing.
    pub(crate) fn advance(&mut self) -> Option<TickOutput> {
        let input = self.log.input(self.world.tick() + 1)?;
        Some(self.world.step(input))
    }

    /// The world at the current tick.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The log.
    pub fn log(&self) -> &'a Log {
        self.log
    }

    /// What differs between the tick just simulated and the log.
    pub(crate) fn compare(&self, output: &TickOutput) -> Result<Option<Divergence>, Error> {
        let keyframe = self.compare_keyframe(output)?;
        if keyframe.is_some() {
            return Ok(keyframe);
        }
        let (tick, got) = (output.tick, output.hash.0 as u32);
        if let Some(expected) = self.log.hash(tick).filter(|h| *h != got) {
            return Ok(Some(Divergence::of_hash(tick, format!("{expected:08x}"), format!("{got:08x}"))));
        }
        Ok(self.compare_mark(output).or_else(|| self.compare_happenings(output)))
    }

    /// Differences in the keyframe of a tick, which name actor, field and both values.
    pub(crate) fn compare_keyframe(&self, output: &TickOutput) -> Result<Option<Divergence>, Error> {
        let tick = output.tick;
        match (self.log.keyframe(tick), &output.keyframe) {
            (Some(recorded), Some(computed)) if recorded != computed => {
                let found = recorded.difference(computed)?;
                Ok(Some(found.map_or_else(
                    || Divergence::of_hash(tick, "other bytes in the keyframe".into(), "the computed ones".into()),
                    |field| Divergence::of_field(tick, field, tick),
                )))
            }
            (Some(_), None) => Ok(Some(Divergence::at(tick, "state", "keyframe", "present", "absent"))),
            (None, Some(_)) => Ok(Some(Divergence::at(tick, "state", "keyframe", "absent", "present"))),
            _ => Ok(None),
        }
    }

    /// Differences at a mark: the full hash, and the parts of the state.
    pub(crate) fn compare_mark(&self, output: &TickOutput) -> Option<Divergence> {
        let mark = self.log.mark(output.tick)?;
        let parts = self.world.part_hashes();
        let computed = Mark { tick: output.tick, hash: output.hash, parts, odometer_mm: output.odometer_mm };
        mark.difference(&computed)
    }

    /// Differences in what follows from the state: events and intervention.
    fn compare_happenings(&self, output: &TickOutput) -> Option<Divergence> {
        let (tick, log) = (output.tick, self.log);
        let start = log.events.partition_point(|(t, _)| *t < tick);
        let recorded: Vec<_> = log.events[start..].iter().take_while(|(t, _)| *t == tick).map(|(_, e)| *e).collect();
        if let Some((field, expected, got)) = first_difference(&recorded, &output.events) {
            return Some(Divergence::at(tick, "output", &format!("events{field}"), &expected, &got));
        }
        let recorded = log.intervention.filter(|i| i.tick == tick);
        if recorded == output.intervention {
            return None;
        }
        let (field, expected, got) = first_difference(&recorded, &output.intervention)?;
        Some(Divergence::at(tick, "output", &format!("intervention{field}"), &expected, &got))
    }
}
