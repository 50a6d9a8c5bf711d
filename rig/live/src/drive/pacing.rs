//! Real time: when the next tick is due. A machine that cannot keep up makes time slower, visibly; no
//! tick is left out, and none is hurried.

use kernel::time::TICK_HZ;

/// Lateness beyond which the schedule moves instead of being caught up with, microseconds.
const CATCH_UP_US: u64 = 50_000;

/// The schedule of a run: one tick every sixtieth of a second.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pacing {
    /// When tick 0 was due, microseconds since the session began.
    origin_us: u64,
    ticks: u64,
    late_us: u64,
    slowed_us: u64,
    started_us: u64,
    /// When the last tick began.
    last_us: u64,
}

impl Pacing {
    /// The first tick is due one tick from now.
    pub fn starting_at(now_us: u64) -> Self {
        Self { origin_us: now_us, ticks: 0, late_us: 0, slowed_us: 0, started_us: now_us, last_us: now_us }
    }

    /// Time until the next tick is due, microseconds; 0 when it is.
    pub fn wait_us(&self, now_us: u64) -> u64 {
        self.due_us().saturating_sub(now_us)
    }

    /// Notes that the next tick begins now.
    pub fn begin_tick(&mut self, now_us: u64) {
        self.late_us = now_us.saturating_sub(self.due_us());
        let lost_us = self.late_us.saturating_sub(CATCH_UP_US);
        self.origin_us += lost_us;
        self.slowed_us += lost_us;
        self.ticks += 1;
        self.last_us = now_us;
    }

    /// Time has stood for so long, microseconds: the schedule goes on where it was.
    pub fn stood(&mut self, us: u64) {
        self.origin_us += us;
        self.started_us += us;
        self.last_us += us;
    }

    /// How late the last tick began, microseconds.
    pub fn late_us(&self) -> u64 {
        self.late_us
    }

    /// By how much the run has fallen behind real time for good, microseconds.
    pub fn slowed_us(&self) -> u64 {
        self.slowed_us
    }

    /// Time from the start to the last tick, microseconds.
    pub fn driven_us(&self) -> u64 {
        self.last_us - self.started_us
    }

    fn due_us(&self) -> u64 {
        self.origin_us + (self.ticks + 1) * 1_000_000 / u64::from(TICK_HZ)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixty_ticks_are_due_in_a_second_without_drift() {
        let mut pacing = Pacing::starting_at(5_000);
        let mut now_us = 5_000;
        for _ in 0..3600 {
            now_us += pacing.wait_us(now_us);
            pacing.begin_tick(now_us);
        }
        assert_eq!((now_us, pacing.late_us(), pacing.slowed_us()), (60_005_000, 0, 0));
    }

    #[test]
    fn a_short_delay_is_caught_up_with() {
        let mut pacing = Pacing::starting_at(0);
        pacing.begin_tick(46_667);
        assert_eq!((pacing.late_us(), pacing.slowed_us()), (30_001, 0));
        assert_eq!(pacing.wait_us(46_667), 0, "the second tick is due already");
        pacing.begin_tick(46_667);
        assert_eq!(pacing.wait_us(46_667), 3_333);
    }

    #[test]
    fn time_that_stood_is_neither_late_nor_driven() {
        let mut pacing = Pacing::starting_at(0);
        (1..=60).for_each(|i| pacing.begin_tick(i * 1_000_000 / 60));
        pacing.stood(7_000_000);
        assert_eq!(pacing.wait_us(8_000_000), 16_666);
        pacing.begin_tick(8_016_666);
        assert_eq!((pacing.late_us(), pacing.slowed_us(), pacing.driven_us()), (0, 0, 1_016_666));
    }

    #[test]
    fn a_machine_that_cannot_keep_up_slows_time_and_says_so() {
        let mut pacing = Pacing::starting_at(0);
        for i in 1..=100 {
            pacing.begin_tick(i * 25_000);
            assert!(pacing.late_us() <= CATCH_UP_US + 25_000, "lateness is bounded: {}", pacing.late_us());
        }
        let real_us = 100 * 25_000;
        let simulated_us = 100 * 1_000_000 / 60;
        let behind = real_us - simulated_us - pacing.slowed_us();
        assert!(behind <= CATCH_UP_US, "{behind}");
    }
}
