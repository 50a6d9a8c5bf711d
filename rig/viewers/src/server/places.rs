//! Who has a place: a few who look on and, for a moment, those who still shake hands.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// More handshakes at a time are turned away; each is over soon.
const MAX_ARRIVING: usize = 64;
/// More clients are refused.
const MAX_GUESTS: usize = 8;

/// The places of a server. Each is held by whoever has its `Arc`.
#[derive(Debug, Default)]
pub struct Places {
    arriving: Arc<()>,
    guests: Mutex<Vec<Weak<Guest>>>,
}

/// The place of one who shakes hands.
#[derive(Debug)]
pub struct Arrival(#[expect(dead_code, reason = "held, never read")] Arc<()>);

/// The place of one who looks on, or has not said yet at what.
#[derive(Debug, Default)]
pub struct Guest {
    looks_on: AtomicBool,
    is_sent_away: AtomicBool,
}

impl Guest {
    /// Whether it has subscribed to anything.
    pub fn set_looks_on(&self, looks_on: bool) {
        self.looks_on.store(looks_on, Ordering::Relaxed);
    }

    /// Whether its place was given to another.
    pub fn is_sent_away(&self) -> bool {
        self.is_sent_away.load(Ordering::Relaxed)
    }
}

impl Places {
    /// A place to shake hands; `None` when there is none. Only the thread that accepts may ask.
    pub fn arrive(&self) -> Option<Arrival> {
        let taken = Arc::strong_count(&self.arriving) - 1;
        (taken < MAX_ARRIVING).then(|| Arrival(self.arriving.clone()))
    }

    /// A place to look on. When all are taken, who has subscribed to nothing makes room, the oldest first;
    /// `None` when all look on.
    pub fn seat(&self) -> Option<Arc<Guest>> {
        let mut guests = self.guests.lock().unwrap_or_else(PoisonError::into_inner);
        guests.retain(|guest| guest.strong_count() > 0);
        if guests.len() >= MAX_GUESTS {
            let idle = |guest: &Weak<Guest>| guest.upgrade().is_none_or(|g| !g.looks_on.load(Ordering::Relaxed));
            let idle = guests.iter().position(idle)?;
            if let Some(guest) = guests.remove(idle).upgrade() {
                guest.is_sent_away.store(true, Ordering::Relaxed);
            }
        }
        let guest = Arc::new(Guest::default());
        guests.push(Arc::downgrade(&guest));
        Some(guest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_looks_on_keeps_the_place_and_who_does_not_makes_room() {
        let places = Places::default();
        let guests: Vec<_> = (0..MAX_GUESTS).map(|_| places.seat().unwrap()).collect();
        guests.iter().enumerate().filter(|(i, _)| *i != 3).for_each(|(_, guest)| guest.set_looks_on(true));
        let ninth = places.seat().unwrap();
        ninth.set_looks_on(true);
        let sent_away = |guests: &[Arc<Guest>]| guests.iter().map(|g| g.is_sent_away()).collect::<Vec<_>>();
        assert_eq!(sent_away(&guests), [false, false, false, true, false, false, false, false]);
        assert!(places.seat().is_none(), "all look on");
        drop(ninth);
        assert!(places.seat().is_some());
    }

    #[test]
    fn a_handshake_gives_its_place_back() {
        let places = Places::default();
        let mut arrivals: Vec<_> = std::iter::from_fn(|| places.arrive()).collect();
        assert_eq!(arrivals.len(), MAX_ARRIVING);
        arrivals.pop();
        assert!(places.arrive().is_some());
    }
}
