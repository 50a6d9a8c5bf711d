//! What happened, as lines of a log.

use base::words;
use foxglove::messages::Log as Line;
use foxglove::messages::log::Level;
use kernel::events::{Event, EventKind};

use super::parts::stamp;

/// Who tells of the car.
const DRIVE: &str = "drive";
/// Who tells of the control units.
const RIG: &str = "rig";

/// Something that happened to the car, and what was said of it.
pub fn event(event: &Event, said: &str, time_ns: u64) -> Line {
    let level = match event.kind {
        EventKind::CollisionActor | EventKind::CollisionScenery | EventKind::Intervention => Level::Error,
        EventKind::RedLight | EventKind::Speeding | EventKind::OffRoad | EventKind::WrongWay => Level::Warning,
        EventKind::Stuck | EventKind::Dissolved | EventKind::HazardCollision => Level::Warning,
        EventKind::Armed | EventKind::Seen | EventKind::Ended => Level::Info,
        EventKind::HazardRedLight
        | EventKind::HazardRollingStop
        | EventKind::HazardBraking
        | EventKind::HazardCutIn
        | EventKind::HazardDoor
        | EventKind::HazardPullOut => Level::Info,
    };
    line(level, DRIVE, words::event(event) + said, time_ns)
}

/// Something that happened to a control unit; `is_loss` says that the driver is without it now.
pub fn note(message: String, is_loss: bool, time_ns: u64) -> Line {
    line(if is_loss { Level::Warning } else { Level::Info }, RIG, message, time_ns)
}

/// Whatever a drive tells as it goes, in its words.
pub fn told(message: &str, time_ns: u64) -> Line {
    line(Level::Info, DRIVE, message.into(), time_ns)
}

fn line(level: Level, name: &str, message: String, time_ns: u64) -> Line {
    Line { timestamp: stamp(time_ns), level: level as i32, message, name: name.into(), file: String::new(), line: 0 }
}
