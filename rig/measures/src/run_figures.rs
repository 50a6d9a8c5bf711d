//! What a run came to.

use std::collections::BTreeMap;
use std::sync::Arc;

use base::room::RoadUsers;
use kernel::{RoadNetwork, World};
use replay::{Label, Manifest, Recording};
use serde::Serialize;

use crate::run_outcome::RunOutcome;

/// What a drive came to, or what a recording holds of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunFigures {
    /// Name of the map.
    pub map: String,
    /// Seed of the run.
    pub seed: u64,
    /// Values of those parameters of its story that have ranges, by name.
    pub drawn: BTreeMap<String, f64>,
    /// Kilometres driven.
    pub km: f64,
    /// Simulated minutes.
    pub minutes: f64,
    /// Road users that the scenario asks for.
    pub asked: RoadUsers,
    /// Of these, those for whom the map has no room; unknown without the map, and of a run of another kernel.
    pub missing: Option<RoadUsers>,
    /// `intervened`, `missed`, `censored`, or `stopped` when it was ended from outside; `driver-error`, `technical-fault` or
    /// `discarded` where operators set it aside.
    pub outcome: RunOutcome,
    /// Whether it was a drive to get used to the rig, which does not count.
    pub familiarisation: bool,
    /// What kind of corner case, if it is one.
    pub label: Option<&'static str>,
    /// What is to be seen in the corner case.
    pub comment: Option<String>,
    /// Whether true masks avoid the intervention; unknown without one.
    pub perception_caused: Option<bool>,
}

impl RunFigures {
    /// Those of a recording, and of its map where that is there.
    pub fn of(recording: &Recording, network: Option<&Arc<RoadNetwork>>) -> Self {
        let log = recording.log();
        let annotation = log.annotation.as_ref();
        Self {
            map: log.manifest.scenario.map.clone(),
            seed: log.manifest.scenario.seed,
            drawn: log.manifest.scenario.story.iter().flat_map(|story| story.drawn()).collect(),
            km: log.odometer_mm() as f64 / 1e6,
            minutes: log.last_tick() as f64 / f64::from(60 * kernel::time::TICK_HZ),
            asked: RoadUsers::asked(&log.manifest.scenario.traffic),
            missing: network.and_then(|network| missing(&log.manifest, network)),
            outcome: RunOutcome::of(log),
            familiarisation: study::is_familiarisation(&log.manifest.provenance),
            label: annotation.map(|a| a.label).filter(|label| label.is_case()).map(Label::name),
            comment: annotation.map(|a| a.comment.clone()),
            perception_caused: annotation.and_then(|a| a.perception_caused),
        }
    }
}

impl std::fmt::Display for RunFigures {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let label = self.label.map(|l| format!(" ({l})")).unwrap_or_default();
        let practice = if self.familiarisation { ", familiarisation: does not count" } else { "" };
        let Self { km, minutes, outcome, .. } = self;
        write!(f, "{km:.3} km in {minutes:.1} min, {outcome}{label}{practice}")
    }
}

/// Who of a run found no room: that follows from what it started from.
fn missing(manifest: &Manifest, network: &Arc<RoadNetwork>) -> Option<RoadUsers> {
    manifest.check_kernel().ok()?;
    let world = World::new(&manifest.scenario, network).ok()?;
    Some(RoadUsers::missing(&world.missing()))
}
