//! What the car did wrong, or what happened to it, for a moment on those screens whose drivers are to know.

use base::words;
use kernel::Seat;
use kernel::events::{Event, EventKind};
use kernel::time::{TICK_HZ, Tick};

/// So long it is shown, seconds.
const SHOWN_S: Tick = 3;

/// Something that people are told of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alert {
    tick: Tick,
    words: String,
    /// Whoever sits in the car feels it, whatever he sees.
    is_felt: bool,
}

impl Alert {
    /// That of the events of a tick, the one that is felt first.
    pub fn of(tick: Tick, events: &[Event]) -> Option<Self> {
        let alerts = events.iter().filter_map(|event| {
            let is_felt = match event.kind {
                EventKind::CollisionActor | EventKind::CollisionScenery | EventKind::OffRoad => true,
                EventKind::RedLight | EventKind::Speeding | EventKind::WrongWay => false,
                _ => return None,
            };
            Some(Self { tick, words: words::event(event), is_felt })
        });
        alerts.max_by_key(|alert| alert.is_felt)
    }

    /// Whether it is still shown at a tick.
    pub fn is_shown(&self, tick: Tick) -> bool {
        tick < self.tick + SHOWN_S * Tick::from(TICK_HZ)
    }

    /// What a driver is told: the semantic one no more than what is felt in the car, since the mask alone tells him of the
    /// world.
    pub fn words(&self, seat: Seat) -> Option<&str> {
        match seat {
            Seat::Safety => Some(&self.words),
            Seat::Semantic => self.is_felt.then_some("a jolt goes through the car"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(kind: EventKind) -> Event {
        Event { kind, actor: 0, speed_mps: 9.0 }
    }

    #[test]
    fn the_semantic_driver_is_told_what_is_felt_and_no_more() {
        let of = |kinds: &[EventKind]| {
            let events: Vec<Event> = kinds.iter().map(|kind| event(*kind)).collect();
            Alert::of(100, &events)
        };
        let light = of(&[EventKind::RedLight]).unwrap();
        assert_eq!((light.words(Seat::Semantic), light.words(Seat::Safety).is_some()), (None, true));
        let both = of(&[EventKind::CollisionActor, EventKind::RedLight]).unwrap();
        let [semantic, safety] = [Seat::Semantic, Seat::Safety].map(|seat| both.words(seat).unwrap().to_owned());
        assert!(semantic != safety && !semantic.contains("collision"), "{semantic} {safety}");
        assert_eq!(of(&[EventKind::Seen, EventKind::HazardDoor]), None);
        assert_eq!([279, 280].map(|tick| both.is_shown(tick)), [true, false]);
    }
}
