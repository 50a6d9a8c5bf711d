//! The ticks of a log in a row, with what happened at them.

use base::words;
use kernel::events::{Event, EventKind};
use kernel::time::{TICK_HZ, Tick};
use replay::{Log, Note};

/// What a mark on the timeline stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkKind {
    /// The intervention, or the collision that nobody prevented.
    CornerCase,
    /// Something that the ego car did or that a driver pressed.
    Event,
    /// Something that happened to the rig.
    Note,
}

/// Something that happened at a tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mark {
    /// When.
    pub tick: Tick,
    /// What kind.
    pub kind: MarkKind,
    /// What, in words.
    pub text: String,
}

/// The ticks that can be looked at, and the marks at them by ascending tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Timeline {
    /// First tick.
    pub first: Tick,
    /// Last tick.
    pub last: Tick,
    /// What happened.
    pub marks: Vec<Mark>,
}

impl Timeline {
    /// That of a log.
    pub fn of(log: &Log) -> Self {
        let events = log.events.iter().map(|(tick, event)| event_mark(*tick, event));
        let mut marks: Vec<Mark> = events.chain(log.notes.iter().map(note_mark)).collect();
        marks.sort_by_key(|mark| mark.tick);
        Self { first: log.first_tick(), last: log.last_tick(), marks }
    }

    /// The nearest tick that there is.
    pub fn clamp(&self, tick: Tick) -> Tick {
        tick.clamp(self.first, self.last)
    }

    /// The tick at a fraction of the length, [0, 1]; beyond, the nearest.
    pub fn tick_at(&self, fraction: f32) -> Tick {
        let ticks = (self.last - self.first) as f32;
        self.clamp(self.first + (fraction * ticks).round().max(0.0) as Tick)
    }

    /// Where a tick lies, as a fraction of the length, [0, 1].
    pub fn fraction_of(&self, tick: Tick) -> f32 {
        let ticks = (self.last - self.first).max(1);
        (self.clamp(tick) - self.first) as f32 / ticks as f32
    }

    /// The tick of the first mark after a tick.
    pub fn next_mark(&self, tick: Tick) -> Option<Tick> {
        let after = self.marks.partition_point(|mark| mark.tick <= tick);
        self.marks.get(after).map(|mark| mark.tick)
    }

    /// The tick of the last mark before a tick.
    pub fn previous_mark(&self, tick: Tick) -> Option<Tick> {
        let before = self.marks.partition_point(|mark| mark.tick < tick);
        self.marks[..before].last().map(|mark| mark.tick)
    }
}

/// A tick as seconds.
pub fn seconds(tick: Tick) -> f64 {
    tick as f64 / f64::from(TICK_HZ)
}

fn event_mark(tick: Tick, event: &Event) -> Mark {
    let kind = match event.kind {
        EventKind::Intervention | EventKind::CollisionActor | EventKind::CollisionScenery => MarkKind::CornerCase,
        _ => MarkKind::Event,
    };
    Mark { tick, kind, text: words::event(event) }
}

fn note_mark(note: &Note) -> Mark {
    Mark { tick: note.tick, kind: MarkKind::Note, text: words::note(note) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn timeline(first: Tick, ticks: Tick, marks: &[Tick]) -> Timeline {
        let mark = |tick: &Tick| Mark { tick: *tick, kind: MarkKind::Event, text: String::new() };
        Timeline { first, last: first + ticks, marks: marks.iter().map(mark).collect() }
    }

    #[test]
    fn marks_are_visited_in_order_and_ends_are_ends() {
        let line = timeline(100, 100, &[100, 120, 120, 150]);
        let mut visited = vec![100];
        while let Some(tick) = line.next_mark(visited[visited.len() - 1]) {
            visited.push(tick);
        }
        assert_eq!(visited, [100, 120, 150]);
        let mut back = vec![200];
        while let Some(tick) = line.previous_mark(back[back.len() - 1]) {
            back.push(tick);
        }
        assert_eq!(back, [200, 150, 120, 100]);
    }

    #[test]
    fn a_log_of_one_tick_has_a_timeline() {
        let line = timeline(7, 0, &[]);
        assert_eq!((line.tick_at(0.5), line.fraction_of(7), line.next_mark(7)), (7, 0.0, None));
    }

    proptest! {
        #[test]
        fn every_tick_is_found_where_it_is_drawn(first in 0u64..1_000_000, ticks in 1u64..36_000, at in 0.0f64..=1.0) {
            let line = timeline(first, ticks, &[]);
            let tick = first + (at * ticks as f64) as Tick;
            prop_assert_eq!(line.tick_at(line.fraction_of(tick)), tick);
        }

        #[test]
        fn every_place_is_a_tick(first in 0u64..1_000_000, ticks in 0u64..36_000, at in any::<f32>()) {
            let line = timeline(first, ticks, &[]);
            prop_assert!((line.first..=line.last).contains(&line.tick_at(at)));
            prop_assert!((0.0..=1.0).contains(&line.fraction_of(at.abs() as Tick)));
        }
    }
}
