//! Threads that cut the corner cases out of finished recordings while the next run waits.

use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::thread::JoinHandle;

use anyhow::anyhow;
use kernel::RoadNetwork;

use crate::drive::aftermath::{self, Tell};
use crate::drive::board::{Board, Message};
use crate::drive::strip::Strip;

/// The threads that cut, one for each recording.
pub struct Cutters {
    board: Arc<Board>,
    outbox: Sender<Message>,
    tell: Tell,
    helpers: Vec<JoinHandle<anyhow::Result<()>>>,
}

impl Cutters {
    /// None cuts yet. What they find goes onto the board and is said to the simulation.
    pub fn new(board: Arc<Board>, outbox: Sender<Message>, tell: Tell) -> Self {
        Self { board, outbox, tell, helpers: Vec::new() }
    }

    /// Cuts the case of a recording on a map, if there is one that counts.
    pub fn cut(&mut self, path: &Path, network: Arc<RoadNetwork>) {
        let (path, board) = (path.to_owned(), self.board.clone());
        let (outbox, tell) = (self.outbox.clone(), self.tell.clone());
        self.helpers.push(std::thread::spawn(move || {
            // When nobody listens any more the session is over, and says itself what failed.
            let note = |text: String| drop(outbox.send(Message::Note(text)));
            let cut = aftermath::of(&path, &network, &*tell);
            match &cut {
                Ok(Some(case)) => {
                    // A note draws the control centre anew, with the strip.
                    let shown = Strip::of(case).map(|strip| board.strip.put(strip));
                    note(format!("corner case {}", case.display()));
                    shown.unwrap_or_else(|error| note(format!("its pictures cannot be shown: {error:#}")));
                }
                Ok(None) => {}
                Err(error) => note(format!("the corner case was not cut: {error:#}")),
            }
            cut.map(drop)
        }));
    }

    /// Waits for all of them; the first that failed is the failure.
    pub fn join(&mut self) -> anyhow::Result<()> {
        let gone = |_| Err(anyhow!("a thread that cut a corner case panicked"));
        let helpers = std::mem::take(&mut self.helpers).into_iter();
        let cut: Vec<_> = helpers.map(|helper| helper.join().unwrap_or_else(gone)).collect();
        cut.into_iter().collect()
    }
}
