//! What the runs of a session are to be, one after the other.

use base::maps::Map;
use kernel::Scenario;
use replay::Provenance;
use study::protocol::Progress;
use study::{Draw, Protocol};

/// What the runs of a session are to be.
pub enum Agenda {
    /// All of them start from one scenario; their seeds and checkpoints are drawn.
    Drawn { map: Map, scenario: Box<Scenario>, draw: Draw },
    /// Trials of a protocol.
    Planned(Box<Protocol>),
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
    /// All trials are driven: it is shown, and does not start.
    pub is_over: bool,
}

impl Agenda {
    /// The run of a number, from 1, after these.
    pub fn bill(&self, number: u32, progress: &Progress) -> Bill {
        match self {
            Self::Drawn { map, scenario, draw } => Bill {
                map: map.clone(),
                scenario: Scenario { seed: draw.seed_of_run(number), ..Scenario::clone(scenario) },
                eye: draw.eye_of_run(number),
                trial: 0,
                is_over: false,
            },
            Self::Planned(protocol) => {
                let next = progress.next(protocol);
                let trial = next.unwrap_or(protocol.trials.len() - 1);
                let planned = &protocol.trials[trial];
                Bill {
                    map: planned.setting.map.clone(),
                    scenario: protocol.scenario(trial, progress.of_trial(trial).count()),
                    eye: planned.checkpoint,
                    trial,
                    is_over: next.is_none(),
                }
            }
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
