//! What a session says on stderr, from a thread of its own: a terminal that is stopped or gone delays
//! no tick and ends no run.

use std::sync::mpsc::{self, Sender};
use std::thread::JoinHandle;

/// The way to the terminal.
pub struct Terminal {
    lines: Option<Sender<String>>,
    writer: Option<JoinHandle<()>>,
}

impl Terminal {
    /// To stderr, or to nobody.
    pub fn new(is_heard: bool) -> Self {
        if !is_heard {
            return Self { lines: None, writer: None };
        }
        let (lines, inbox) = mpsc::channel::<String>();
        let writer = std::thread::spawn(move || {
            // Who does not listen any more misses nothing that is not in the recording.
            inbox.iter().for_each(base::say::say);
        });
        Self { lines: Some(lines), writer: Some(writer) }
    }

    /// Says a line; waits for nobody.
    pub fn say(&self, line: String) {
        if let Some(lines) = &self.lines {
            // The other end is there until this one goes.
            let _ = lines.send(line);
        }
    }
}

impl Drop for Terminal {
    /// Waits until everything is said.
    fn drop(&mut self) {
        self.lines = None;
        self.writer.take().into_iter().for_each(|writer| drop(writer.join()));
    }
}
