//! Checks of whole logs.

use std::sync::Arc;

use kernel::RoadNetwork;
use kernel::time::Tick;

use crate::{Divergence, Error, Log};

/// What a check found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// Ticks simulated and compared.
    pub ticks: Tick,
    /// Keyframes compared or resumed from.
    pub keyframes: usize,
    /// The first difference, if there is one.
    pub divergence: Option<Divergence>,
}

/// Simulates every tick from the start and compares all that is derived: the hash each tick, the
/// parts each second, the bytes of each keyframe, events, intervention and summary.
pub fn verify(_log: &Log, _network: &Arc<RoadNetwork>) -> Result<Report, Error> {
    todo!()
}

/// Resumes from every keyframe and compares every tick up to the next one.
pub fn resumes(_log: &Log, _network: &Arc<RoadNetwork>) -> Result<Report, Error> {
    todo!()
}

/// Every `n` ticks: saves the world, advances `n` ticks, goes back, advances again and compares
/// (rollback self-check, as GGRS has it).
pub fn rewind(_log: &Log, _network: &Arc<RoadNetwork>, _n: Tick) -> Result<Report, Error> {
    todo!()
}

/// Simulates two logs side by side and names the first tick and field in which they differ;
/// `expected` is the value in `other`.
pub fn against(
    _log: &Log,
    _network: &Arc<RoadNetwork>,
    _other: &Log,
    _other_network: &Arc<RoadNetwork>,
) -> Result<Report, Error> {
    todo!()
}
