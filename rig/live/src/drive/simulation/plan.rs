//! What a session is about, and the threads around it.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender};

use base::clock::SessionClock;
use base::maps::Map;
use base::progress::Interrupt;
use kernel::Scenario;
use kernel::time::Tick;
use replay::Provenance;
use study::Cast;
use viewers::server::Endpoint;

use crate::drive::aftermath::Tell;
use crate::drive::board::{About, Board, Message, Wake};

/// What a session is about.
pub struct Plan {
    /// Where to drive.
    pub map: Map,
    /// The scenario of the first run; the others follow from its seed.
    pub scenario: Scenario,
    /// Greatest force of wheels, [0, 1].
    pub force: f32,
    /// Where remote control centres are served.
    pub foxglove: Option<Endpoint>,
    /// Where the recordings go.
    pub record: PathBuf,
    /// What the recordings say about themselves, the checkpoint aside.
    pub provenance: Provenance,
    /// Which seed and which checkpoint a run has.
    pub cast: Cast,
    /// What may be shown of all that.
    pub about: Arc<About>,
    /// Told what each run came to.
    pub tell: Tell,
    /// Runs start by themselves until so much has been driven, ticks; then the session ends.
    pub unattended: Option<Tick>,
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
    /// Ctrl-C and SIGTERM.
    pub interrupt: Interrupt,
}
