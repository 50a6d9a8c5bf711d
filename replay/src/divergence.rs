//! Where a replay first differs from what was recorded.

use std::fmt;

use kernel::time::Tick;
use kernel::world::{FieldDifference, PARTS};

use crate::Mark;

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

impl Divergence {
    pub(crate) fn at(tick: Tick, part: &str, field: &str, expected: &str, got: &str) -> Self {
        let [part, field, expected, got] = [part, field, expected, got].map(str::to_owned);
        Self { tick, part, actor: None, field, expected, got, seen_at: tick }
    }

    pub(crate) fn of_hash(tick: Tick, expected: String, got: String) -> Self {
        Self { tick, part: "state".into(), actor: None, field: "hash".into(), expected, got, seen_at: tick }
    }

    /// A run that differs from `tick` on, with a field that was found to differ at `seen_at`.
    pub(crate) fn of_field(tick: Tick, found: FieldDifference, seen_at: Tick) -> Self {
        let FieldDifference { part, actor, field, expected, got } = found;
        Self { tick, part, actor, field, expected, got, seen_at }
    }
}

impl Mark {
    /// The first difference to a computed mark.
    pub(crate) fn difference(&self, computed: &Mark) -> Option<Divergence> {
        let tick = self.tick;
        let parts = PARTS.iter().zip(self.parts.iter().zip(&computed.parts));
        if let Some((part, (expected, got))) = parts.into_iter().find(|(_, (a, b))| a != b) {
            return Some(Divergence::at(tick, part, "hash", &format!("{expected:016x}"), &format!("{got:016x}")));
        }
        if self.hash != computed.hash {
            return Some(Divergence::of_hash(tick, format!("{:?}", self.hash), format!("{:?}", computed.hash)));
        }
        let (expected, got) = (self.odometer_mm, computed.odometer_mm);
        (expected != got)
            .then(|| Divergence::at(tick, "output", "odometer_mm", &expected.to_string(), &got.to_string()))
    }
}
