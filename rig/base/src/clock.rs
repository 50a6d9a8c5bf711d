//! The only file that reads the clock.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// Says now and then, by wall time, that it is time again.
#[derive(Debug)]
pub struct Every {
    period: Duration,
    next: Instant,
}

impl Every {
    /// Due at once, and then once a second.
    pub fn second() -> Self {
        Self { period: Duration::from_secs(1), next: Instant::now() }
    }

    /// Due when the period has passed, and then once in each.
    pub fn next(period: Duration) -> Self {
        Self { period, next: Instant::now() + period }
    }

    /// Whether it is time.
    pub fn is_due(&mut self) -> bool {
        let now = Instant::now();
        let due = now >= self.next;
        if due {
            self.next = now + self.period;
        }
        due
    }
}

/// When a step has to be done.
#[derive(Clone, Copy, Debug)]
pub struct Deadline(Instant);

impl Deadline {
    /// So long from now.
    pub fn after(time: Duration) -> Self {
        Self(Instant::now() + time)
    }

    /// What is left until then; `None` when it has passed.
    pub fn left(self) -> Option<Duration> {
        self.0.checked_duration_since(Instant::now()).filter(|left| !left.is_zero())
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
    /// When that was by the calendar, nanoseconds since 1970.
    start_unix_ns: u64,
}

impl SessionClock {
    /// The session begins now.
    pub fn starting_now() -> Self {
        // A calendar before 1970 is as good as none.
        let start_unix_ns = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64);
        Self { start: Instant::now(), start_unix_ns }
    }

    /// A moment of the session, microseconds since it began, as nanoseconds since 1970. It never goes
    /// back, whatever happens to the calendar.
    pub fn unix_ns(&self, session_us: u64) -> u64 {
        self.start_unix_ns + 1000 * session_us
    }

    /// Microseconds since the session began.
    pub fn now_us(&self) -> u64 {
        self.start.elapsed().as_micros() as u64
    }
}
