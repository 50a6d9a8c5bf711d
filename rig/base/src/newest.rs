//! Hands the newest value from one thread to others; older ones are lost on purpose.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// A slot in which the latest value wins.
#[derive(Debug)]
pub struct Newest<T> {
    slot: Mutex<Slot<T>>,
    changed: Condvar,
}

#[derive(Debug)]
struct Slot<T> {
    value: Option<Arc<T>>,
    /// Number of values so far.
    count: u64,
    is_closed: bool,
}

impl<T> Default for Newest<T> {
    fn default() -> Self {
        Self { slot: Mutex::new(Slot { value: None, count: 0, is_closed: false }), changed: Condvar::new() }
    }
}

impl<T> Newest<T> {
    /// Replaces the value.
    pub fn put(&self, value: T) {
        let mut slot = self.lock();
        slot.value = Some(Arc::new(value));
        slot.count += 1;
        self.changed.notify_all();
    }

    /// The value, if there is one yet.
    pub fn get(&self) -> Option<Arc<T>> {
        self.lock().value.clone()
    }

    /// Waits for a value after the one with number `seen` (0: any), and gives its number; `None` once
    /// the slot is closed.
    pub fn wait(&self, seen: u64) -> Option<(u64, Arc<T>)> {
        let mut slot = self.lock();
        loop {
            if slot.is_closed {
                return None;
            }
            if let (Some(value), true) = (&slot.value, slot.count > seen) {
                return Some((slot.count, value.clone()));
            }
            slot = self.changed.wait(slot).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Lets those who wait go.
    pub fn close(&self) {
        self.lock().is_closed = true;
        self.changed.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, Slot<T>> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_value_wins_and_is_seen_once() {
        let slot = Newest::default();
        slot.put(1);
        slot.put(2);
        let (seen, value) = slot.wait(0).expect("open");
        assert_eq!((*value, slot.get().as_deref()), (2, Some(&2)));
        std::thread::scope(|scope| {
            let later = scope.spawn(|| slot.wait(seen).map(|(_, value)| *value));
            slot.put(3);
            assert_eq!(later.join().expect("no panic"), Some(3));
            let never = scope.spawn(|| slot.wait(seen + 1));
            slot.close();
            assert!(never.join().expect("no panic").is_none());
        });
    }
}
