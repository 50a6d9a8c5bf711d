//! The only file that reads the clock.

use std::time::{Duration, Instant};

/// Says once a second of wall time that a second has passed.
#[derive(Debug)]
pub struct EverySecond {
    next: Instant,
}

impl EverySecond {
    /// Due for the first time at once.
    pub fn new() -> Self {
        Self { next: Instant::now() }
    }

    /// Whether a second has passed since it was last due.
    pub fn is_due(&mut self) -> bool {
        let now = Instant::now();
        let due = now >= self.next;
        if due {
            self.next = now + Duration::from_secs(1);
        }
        due
    }
}

impl Default for EverySecond {
    fn default() -> Self {
        Self::new()
    }
}

/// Seconds that a piece of work takes.
pub fn seconds_of<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let value = work();
    (value, start.elapsed().as_secs_f64())
}

/// Time since a live session began.
#[derive(Clone, Copy, Debug)]
pub struct SessionClock {
    start: Instant,
}

impl SessionClock {
    /// The session begins now.
    pub fn starting_now() -> Self {
        Self { start: Instant::now() }
    }

    /// Microseconds since the session began.
    pub fn now_us(&self) -> u64 {
        self.start.elapsed().as_micros() as u64
    }
}
