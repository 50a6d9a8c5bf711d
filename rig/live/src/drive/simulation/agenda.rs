//! What the runs of a session are to be, one after the other.

use std::sync::Arc;

use base::maps::Map;
use kernel::Scenario;
use replay::Provenance;
use study::protocol::Progress;
use study::{Draw, Protocol};

/// What the runs of a session are to be.
#[derive(Clone)]
pub enum Agenda {
    /// All of them start from one scenario; their seeds and checkpoints are drawn.
    Drawn { map: Map, scenario: Box<Scenario>, draw: Draw },
    /// Trials of a protocol.
    Planned(Arc<Protocol>),
}

/// What a run is to be.
pub struct Bill {
    /// Where it drives.
    pub map: Map,
    /// What it starts from.
    pub scenario: Scenario,
    /// Which of the session's checkpoints the semantic driver sees through.
    pub eye: usize,
    /// Which trial of the protocol it is; 0 without one.
    pub trial: usize,
}

impl Agenda {
    /// The run of a number, from 1, after these; none once all is driven.
    pub fn bill(&self, number: u32, progress: &Progress) -> Option<Bill> {
        match self {
            Self::Drawn { map, scenario, draw } => {
                let scenario = Scenario { seed: draw.seed_of_run(number), ..Scenario::clone(scenario) };
                Some(Bill { map: map.clone(), scenario, eye: draw.eye_of_run(number), trial: 0 })
            }
            Self::Planned(protocol) => progress.next(protocol).map(|trial| planned(protocol, trial, progress)),
        }
    }

    /// What is shown when all is driven.
    pub fn last(&self, number: u32, progress: &Progress) -> Bill {
        match self {
            Self::Drawn { map, scenario, draw } => {
                Bill { map: map.clone(), scenario: Scenario::clone(scenario), eye: draw.eye_of_run(number), trial: 0 }
            }
            Self::Planned(protocol) => planned(protocol, protocol.trials.len() - 1, progress),
        }
    }

    /// The protocol, if there is one.
    pub fn protocol(&self) -> Option<&Protocol> {
        match self {
            Self::Drawn { .. } => None,
            Self::Planned(protocol) => Some(protocol),
        }
    }

    /// Which trial a recording is of; one that is of none of the protocol's is refused.
    pub fn trial_of(&self, provenance: &Provenance) -> Result<usize, String> {
        self.protocol().map_or(Ok(0), |protocol| protocol.trial_of(provenance))
    }
}

fn planned(protocol: &Protocol, trial: usize, progress: &Progress) -> Bill {
    let earlier = progress.of_trial(trial).count();
    let map = protocol.trials[trial].setting.map.clone();
    Bill { map, scenario: protocol.scenario(trial, earlier), eye: protocol.trials[trial].checkpoint, trial }
}
