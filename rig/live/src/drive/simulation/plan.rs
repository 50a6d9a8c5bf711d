//! What a session is about, and the threads around it.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender};

use base::clock::SessionClock;
use base::progress::Interrupt;
use kernel::time::Tick;
use replay::Provenance;
use study::Cast;
use viewers::server::Endpoint;

use super::agenda::{Agenda, Bill};
use crate::drive::aftermath::Tell;
use crate::drive::board::{About, Board, Message, Wake};
use crate::speakers::Sound;

/// What a session is about.
pub struct Plan {
    /// What its runs are to be.
    pub agenda: Agenda,
    /// Greatest force of wheels, [0, 1].
    pub force: f32,
    /// Where remote control centres are served.
    pub foxglove: Option<Endpoint>,
    /// Where the recordings go.
    pub record: PathBuf,
    /// What the recordings say about themselves, the checkpoint aside.
    pub provenance: Provenance,
    /// What is known of its checkpoints.
    pub cast: Cast,
    /// Pseudonyms of the operators, first of whoever begins as the semantic driver.
    pub operators: [Option<String>; 2],
    /// Whether the drives are to get used to the rig and do not count.
    pub is_familiarisation: bool,
    /// Told what each run came to.
    pub tell: Tell,
    /// Runs start by themselves until so much has been driven, ticks; then the session ends.
    pub unattended: Option<Tick>,
}

impl Plan {
    /// What may be shown of a run.
    pub fn about(&self, bill: &Bill) -> Arc<About> {
        Arc::new(About {
            checkpoint: self.cast.public_name(bill.eye).to_owned(),
            map: bill.scenario.map.clone(),
            rules: bill.scenario.rules,
            operators: self.operators.clone(),
            is_familiarisation: self.is_familiarisation,
            trial: self.agenda.protocol().map(|protocol| protocol.words(bill.trial)),
        })
    }
}

/// The threads around the simulation.
pub struct Links {
    /// What everybody looks at.
    pub board: Arc<Board>,
    /// What the simulation hears.
    pub inbox: Receiver<Message>,
    /// For its own helpers to speak to it.
    pub outbox: Sender<Message>,
    /// Draws windows anew.
    pub wake: Box<dyn Fn(Wake) + Send>,
    /// Time since the session began.
    pub clock: SessionClock,
    /// Who plays what is heard.
    pub sound: Sound,
    /// Ctrl-C and SIGTERM.
    pub interrupt: Interrupt,
}
