//! Seats, road users and events in the words that people read.

use std::fmt::Display;

use kernel::Seat;
use kernel::events::{Event, EventKind};
use kernel::scene::{ActorKind, ActorScene, FIRST_DOOR_ID, FIRST_PARKED_ID, FIRST_STORY_DOOR_ID, FIRST_STORY_ID};
use replay::Note;

/// What people and files call the seats.
pub const SEATS: [&str; 2] = ["semantic", "safety"];

/// What people and files call a seat.
pub fn seat(seat: Seat) -> &'static str {
    SEATS[seat as usize]
}

/// What happened to the rig, and to whose unit.
pub fn note(note: &Note) -> String {
    let whose = note.seat.map_or(String::new(), |whose| format!(" ({} driver)", seat(whose)));
    format!("{}{whose}", note.kind.name())
}

/// A number of things, as in `1 frame` and `2 frames`.
pub fn count<N: Display + PartialEq + From<u8>>(number: N, thing: &str) -> String {
    let ending = if number == N::from(1) { "" } else { "s" };
    format!("{number} {thing}{ending}")
}

/// A speed along a car's direction, m/s, in whole km/h: negative backwards, and never `-0`, which a standing car comes to.
pub fn kmh(speed_mps: f64) -> String {
    format!("{:.0}", (3.6 * speed_mps).round() + 0.0)
}

/// What kind of road user it is.
pub fn road_user(kind: ActorKind) -> &'static str {
    match kind {
        ActorKind::Car => "car",
        ActorKind::Truck => "truck",
        ActorKind::Bus => "bus",
        ActorKind::Motorcycle => "motorcycle",
        ActorKind::Bicycle => "bicycle",
        ActorKind::Pedestrian => "pedestrian",
        ActorKind::Van => "van",
        ActorKind::Suv => "SUV",
        ActorKind::Scooter => "scooter",
        ActorKind::CargoBike => "cargo bike",
        ActorKind::Emergency => "emergency vehicle",
        ActorKind::Door => "car door",
        ActorKind::Child => "child",
        ActorKind::Pram => "person with a pram",
        ActorKind::Wheelchair => "person in a wheelchair",
        ActorKind::Tram => "tram",
        ActorKind::Obstacle => "obstacle",
    }
}

/// What an actor is called within its run: kind and number, as in `pedestrian 12`.
pub fn actor(actor: &ActorScene) -> String {
    format!("{} {}", road_user(actor.kind), actor.id)
}

/// Whom or what an actor's number names.
fn collided(actor: u32) -> String {
    match actor {
        FIRST_STORY_DOOR_ID.. => format!("a door of actor {}", actor - FIRST_STORY_DOOR_ID + FIRST_STORY_ID),
        FIRST_DOOR_ID.. => format!("a door of parked car {}", actor - FIRST_DOOR_ID),
        FIRST_PARKED_ID.. => format!("parked car {}", actor - FIRST_PARKED_ID),
        _ => format!("actor {actor}"),
    }
}

/// What happened to the ego car, as in `red light passed at 43 km/h`, or to traffic.
pub fn event(event: &Event) -> String {
    let what = match event.kind {
        EventKind::CollisionActor => format!("collision with {}", collided(event.actor)),
        EventKind::CollisionScenery => "collision with scenery".into(),
        EventKind::RedLight => "red light passed".into(),
        EventKind::Speeding => "limit exceeded".into(),
        EventKind::OffRoad => "off the road".into(),
        EventKind::WrongWay => "wrong way".into(),
        EventKind::Armed => "run armed".into(),
        EventKind::Intervention => "intervention".into(),
        EventKind::Seen => "\"I see it\"".into(),
        EventKind::Ended => "run ended".into(),
        EventKind::Stuck => return format!("vehicle {} has stood for a minute without a reason", event.actor),
        EventKind::Dissolved => {
            return format!("vehicle {} stood for too long and was taken off the road", event.actor);
        }
        EventKind::HazardRedLight => return format!("vehicle {} runs a red light", event.actor),
        EventKind::HazardRollingStop => return format!("vehicle {} rolls over the line of a stop sign", event.actor),
        EventKind::HazardBraking => return format!("vehicle {} brakes hard for no reason", event.actor),
        EventKind::HazardCutIn => return format!("vehicle {} cuts in", event.actor),
        EventKind::HazardPullOut => return format!("vehicle {} pulls out from the kerb without a look", event.actor),
        EventKind::HazardDoor => {
            return format!("{} opens into the lane", collided(event.actor));
        }
        EventKind::HazardCollision => return format!("vehicle {} is in a collision with another", event.actor),
    };
    // The tick of a collision ends with what the impact has left of the speed.
    let at = match event.kind {
        EventKind::CollisionActor | EventKind::CollisionScenery => ", after it at",
        _ => " at",
    };
    // Adding 0 makes a negative zero positive.
    format!("{what}{at} {} km/h", kmh(event.speed_mps.into()))
}

/// An event in words, with its time.
pub fn event_at(tick: u64, event: &Event) -> String {
    let seconds = tick as f64 / f64::from(kernel::time::TICK_HZ);
    format!("{seconds:7.2} s  {}", self::event(event))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_hit_has_a_name() {
        let said = |actor| event(&Event { kind: EventKind::CollisionActor, actor, speed_mps: 5.0 });
        assert_eq!(said(7), "collision with actor 7, after it at 18 km/h");
        assert_eq!(said(FIRST_PARKED_ID + 3), "collision with parked car 3, after it at 18 km/h");
        assert_eq!(said(FIRST_DOOR_ID + 3), "collision with a door of parked car 3, after it at 18 km/h");
    }

    #[test]
    fn a_car_that_stands_goes_at_nothing() {
        assert_eq!([-0.01, 0.1, 10.0, -2.0].map(kmh), ["0", "0", "36", "-7"]);
    }

    #[test]
    fn one_is_not_many() {
        assert_eq!(
            [count(0usize, "frame"), count(1u32, "frame"), count(2u64, "frame")],
            ["0 frames", "1 frame", "2 frames"]
        );
    }
}
