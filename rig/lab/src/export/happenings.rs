//! What happened in a log, as lines.

use std::ops::RangeInclusive;

use base::words;
use foxglove::messages::Log as Line;
use kernel::events::{Event, EventKind};
use kernel::time::Tick;
use replay::{Annotation, Log, Note, NoteKind, nanoseconds};
use viewers::messages::report;

/// Events of the car and notes of the rig within a range of ticks, by ascending tick.
pub fn lines(log: &Log, ticks: &RangeInclusive<Tick>) -> Vec<(Tick, Line)> {
    let annotation = log.annotation.as_ref();
    let events = log.events.iter().map(|(tick, event)| (*tick, of_event(*tick, event, annotation)));
    let notes = log.notes.iter().map(|note| (note.tick, of_note(note)));
    let mut lines: Vec<_> = events.chain(notes).filter(|(tick, _)| ticks.contains(tick)).collect();
    lines.sort_by_key(|(tick, _)| *tick);
    lines
}

fn of_event(tick: Tick, event: &Event, annotation: Option<&Annotation>) -> Line {
    let said = annotation.filter(|_| event.kind == EventKind::Intervention);
    let said = said.map_or(String::new(), |a| format!(": {}, {}", a.label, a.comment));
    report::event(event, &said, nanoseconds(tick))
}

fn of_note(note: &Note) -> Line {
    let message = words::note(note);
    report::note(message, note.kind == NoteKind::UnitLost, nanoseconds(note.tick))
}
