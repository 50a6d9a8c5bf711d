//! What a session says: line by line on stderr, and as the events that the control centre lists.

use std::fmt;

use viewers::events::Events;

use crate::drive::terminal::Terminal;

/// What a session says.
pub struct Voice {
    terminal: Terminal,
    events: Events,
}

impl Voice {
    /// Of a session that somebody attends, or that nobody hears.
    pub fn new(is_heard: bool) -> Self {
        Self { terminal: Terminal::new(is_heard), events: Events::default() }
    }

    /// Says a line on stderr; waits for nobody.
    pub fn say(&self, words: fmt::Arguments<'_>) {
        self.terminal.say(words.to_string());
    }

    /// Adds to the events.
    pub fn note(&mut self, text: String) {
        self.events.push(text);
    }

    /// A new run has had no events yet.
    pub fn forget(&mut self) {
        self.events.clear();
    }

    /// The latest events, newest last.
    pub fn events(&self) -> &Events {
        &self.events
    }
}
