//! The figures of a tick, from a live session or from a world alone.

use kernel::arbiter::Phase;
use kernel::time::Tick;
use kernel::{Seat, TickInput, World};

use crate::events::Events;

/// What a remote control centre shows.
#[derive(Clone, Debug)]
pub struct TickFigures {
    /// Number of the run, from 1.
    pub run: u32,
    /// The world's tick.
    pub tick: Tick,
    /// Where the arbitration stands.
    pub phase: Phase,
    /// Who steers.
    pub steering: Seat,
    /// Who has the pedals.
    pub pedals: Seat,
    /// Both drivers' controls, where they are known.
    pub input: Option<TickInput>,
    /// Speed, m/s.
    pub speed_mps: f32,
    /// Limit, m/s.
    pub limit_mps: f32,
    /// Distance driven in this run, millimetres.
    pub odometer_mm: u64,
    /// Age of the mask on the semantic driver's screen, microseconds.
    pub mask_age_us: Option<u64>,
    /// How late the last tick began, microseconds.
    pub late_us: u64,
    /// By how much the run has fallen behind real time, microseconds.
    pub slowed_us: u64,
    /// The latest events.
    pub events: Events,
}

impl TickFigures {
    /// Of a world that is driven by bots; its events are left to the caller.
    pub fn of_world(world: &World, run: u32) -> Self {
        let (hud, arbiter) = (world.hud(), world.arbiter());
        let seat = |is_safety| if is_safety { Seat::Safety } else { Seat::Semantic };
        Self {
            run,
            tick: world.tick(),
            phase: arbiter.phase,
            steering: seat(arbiter.safety_steers),
            pedals: seat(arbiter.intervention.is_some()),
            input: None,
            speed_mps: hud.speed_mps,
            limit_mps: hud.limit_mps,
            odometer_mm: world.odometer_mm(),
            mask_age_us: None,
            late_us: 0,
            slowed_us: 0,
            events: Events::default(),
        }
    }
}
