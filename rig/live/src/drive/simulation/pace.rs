//! When the next tick is due, and how well the session has kept real time.

use std::time::Duration;

use base::clock::SessionClock;
use kernel::Seat;

use crate::drive::pacing::Pacing;
use crate::drive::timings::Timings;

/// While nothing drives, the units are asked this often, microseconds.
const IDLE_US: u64 = 16_667;

/// The ticks of a session against its clock.
pub struct Pace {
    clock: SessionClock,
    pacing: Pacing,
    timings: Timings,
    /// When time was stopped, while it stands, microseconds.
    paused_us: Option<u64>,
}

impl Pace {
    /// Nothing drives yet.
    pub fn new(clock: SessionClock) -> Self {
        Self { clock, pacing: Pacing::starting_at(0), timings: Timings::default(), paused_us: None }
    }

    /// Time since the session began, microseconds.
    pub fn now_us(&self) -> u64 {
        self.clock.now_us()
    }

    /// The schedule of the run.
    pub fn schedule(&self) -> &Pacing {
        &self.pacing
    }

    /// The schedule begins anew: a run starts, or waits for its start.
    pub fn restart(&mut self) {
        self.pacing = Pacing::starting_at(self.now_us());
        self.paused_us = None;
    }

    /// Time stands from now on.
    pub fn pause(&mut self) {
        self.paused_us = Some(self.now_us());
    }

    /// Time goes on where it stopped.
    pub fn resume(&mut self) {
        if let Some(paused_us) = self.paused_us.take() {
            self.pacing.stood(self.now_us().saturating_sub(paused_us));
        }
    }

    /// Time until the units are to be asked again; while a run drives, until its next tick.
    pub fn wait(&self, is_driving: bool) -> Duration {
        Duration::from_micros(if is_driving { self.pacing.wait_us(self.now_us()) } else { IDLE_US })
    }

    /// A tick begins.
    pub fn begin_tick(&mut self) {
        self.pacing.begin_tick(self.now_us());
        self.timings.tick(self.pacing.late_us());
    }

    /// A picture of this age came onto a driver's screen, microseconds.
    pub fn shown(&mut self, seat: Seat, age_us: u64) {
        self.timings.shown(seat, age_us);
    }

    /// The run is over.
    pub fn end_run(&mut self) {
        self.timings.run(self.pacing.driven_us(), self.pacing.slowed_us());
    }

    /// How well the session kept real time, with so many gaps in what was heard.
    pub fn timings(mut self, sound_gaps: u64) -> Timings {
        self.timings.sound(sound_gaps);
        self.timings
    }
}
