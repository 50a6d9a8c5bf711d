//! What happened, as lines of a log.

use std::ops::RangeInclusive;

use base::words;
use foxglove::messages::Log as Line;
use foxglove::messages::log::Level;
use kernel::events::{Event, EventKind};
use kernel::time::Tick;
use replay::{Annotation, Log, Note, NoteKind};

use super::messages::stamp;

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
    let level = match event.kind {
        EventKind::CollisionActor | EventKind::CollisionScenery | EventKind::Intervention => Level::Error,
        EventKind::RedLight | EventKind::Speeding | EventKind::OffRoad | EventKind::WrongWay => Level::Warning,
        EventKind::Armed | EventKind::Seen | EventKind::Ended => Level::Info,
    };
    let said = annotation.filter(|_| event.kind == EventKind::Intervention);
    let said = said.map_or(String::new(), |a| format!(": {}, {}", a.label, a.comment));
    let message = words::event(event) + &said;
    line(tick, level, "drive", message)
}

fn of_note(note: &Note) -> Line {
    let level = if note.kind == NoteKind::UnitLost { Level::Warning } else { Level::Info };
    line(note.tick, level, "rig", format!("{} ({} driver)", note.kind.name(), words::seat(note.seat)))
}

fn line(tick: Tick, level: Level, name: &str, message: String) -> Line {
    Line { timestamp: stamp(tick), level: level as i32, message, name: name.into(), file: String::new(), line: 0 }
}
