//! The latest events of a session, numbered, so that a reader knows which are new to it.

use std::collections::VecDeque;

/// Events that are kept.
const KEPT: usize = 12;

/// The latest events in words, newest last.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Events {
    lines: VecDeque<String>,
    /// Number of the first line that is kept; the first of the session is 0.
    first: u64,
}

impl Events {
    /// Adds one, and forgets the oldest.
    pub fn push(&mut self, line: String) {
        self.lines.push_back(line);
        if self.lines.len() > KEPT {
            self.lines.pop_front();
            self.first += 1;
        }
    }

    /// Forgets all; numbers go on.
    pub fn clear(&mut self) {
        self.first = self.end();
        self.lines.clear();
    }

    /// Those that are kept, newest last.
    pub fn lines(&self) -> impl Iterator<Item = &str> {
        self.lines.iter().map(String::as_str)
    }

    /// Those with this number or a later one.
    pub fn since(&self, number: u64) -> impl Iterator<Item = &str> {
        self.lines().skip(number.saturating_sub(self.first) as usize)
    }

    /// Number of the next one.
    pub fn end(&self) -> u64 {
        self.first + self.lines.len() as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_gets_each_event_once_and_never_waits_for_lost_ones() {
        let mut events = Events::default();
        (0..20).for_each(|i| events.push(i.to_string()));
        assert_eq!((events.lines().count(), events.lines().last()), (KEPT, Some("19")));
        assert_eq!(events.since(0).next(), Some("8"), "the first ones are lost");
        assert_eq!(events.since(18).collect::<Vec<_>>(), ["18", "19"]);
        let seen = events.end();
        assert_eq!(events.since(seen).count(), 0);
        events.clear();
        events.push("next run".into());
        assert_eq!(events.since(seen).collect::<Vec<_>>(), ["next run"]);
    }
}
