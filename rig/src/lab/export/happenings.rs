//! What happened, as lines of a log.

use std::ops::RangeInclusive;

use foxglove::messages::Log as Line;
use foxglove::messages::log::Level;
use kernel::events::{Event, EventKind};
use kernel::time::Tick;
use replay::{Annotation, Log, Note, NoteKind};

use super::messages::stamp;
use crate::measures::seat_name;

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
    let at = format!("at {:.0} km/h", 3.6 * event.speed_mps);
    let said = annotation.map_or(String::new(), |a| format!(": {}, {}", a.label, a.comment));
    let (level, message) = match event.kind {
        EventKind::CollisionActor => (Level::Error, format!("Collision with actor {} {at}", event.actor)),
        EventKind::CollisionScenery => (Level::Error, format!("Collision with scenery {at}")),
        EventKind::Intervention => (Level::Error, format!("Intervention {at}{said}")),
        EventKind::RedLight => (Level::Warning, format!("Red light passed {at}")),
        EventKind::Speeding => (Level::Warning, format!("Limit exceeded {at}")),
        EventKind::OffRoad => (Level::Warning, format!("Off the road {at}")),
        EventKind::WrongWay => (Level::Warning, format!("Wrong way {at}")),
        EventKind::Armed => (Level::Info, format!("Armed {at}")),
        EventKind::Seen => (Level::Info, format!("\"I see it\" {at}")),
        EventKind::Ended => (Level::Info, format!("The run ended {at}")),
    };
    line(tick, level, "drive", message)
}

fn of_note(note: &Note) -> Line {
    let level = if note.kind == NoteKind::UnitLost { Level::Warning } else { Level::Info };
    line(note.tick, level, "rig", format!("{} ({} driver)", note.kind.name(), seat_name(note.seat)))
}

fn line(tick: Tick, level: Level, name: &str, message: String) -> Line {
    Line { timestamp: stamp(tick), level: level as i32, message, name: name.into(), file: String::new(), line: 0 }
}
