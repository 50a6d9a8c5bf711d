//! Who is in control, and what counts as an intervention (DOMAIN: the safety driver always wins).

use crate::controls::{Controls, Seat};
use crate::time::Tick;
use crate::{state, state_enum};

state_enum! {
    /// How a run ended.
    pub enum Outcome {
        /// The safety driver intervened.
        Intervened = 0,
        /// The ego car collided and nobody had intervened.
        Missed = 1,
        /// The time of the run was over.
        Censored = 2,
    }
}

state_enum! {
    /// Where a run stands.
    pub enum Phase {
        /// The first three seconds, so that every corner case has its full window.
        Arming = 0,
        /// The semantic driver drives.
        Driving = 1,
        /// The safety driver took over; runs on to standstill, 5 s at most.
        TakenOver = 2,
        /// The run is over.
        Done = 3,
    }
}

state! {
    /// A takeover by the safety driver.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Intervention {
        /// The tick at which a threshold was passed.
        pub tick: Tick,
        /// The safety driver's controls at that tick.
        pub controls: Controls,
        /// Whether the brake passed its threshold.
        pub by_brake: bool,
        /// Whether the steering passed its threshold.
        pub by_steering: bool,
        /// Speed of the ego car, m/s.
        pub speed_mps: f32,
    }
}

state! {
    /// The arbitration's own state.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Arbiter {
        /// Where the run stands.
        pub phase: Phase,
        /// The safety driver has taken the wheel over and keeps it.
        pub safety_steers: bool,
        /// The intervention, once there was one.
        pub intervention: Option<Intervention>,
        /// How the run ended, once it has.
        pub outcome: Option<Outcome>,
        /// Tick of the end.
        pub ended_at: Option<Tick>,
    }
}

state! {
    /// What the arbitration decided in one tick.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Applied {
        /// Controls that reach the car.
        pub controls: Controls,
        /// Who steers.
        pub steering: Seat,
        /// Who brakes or accelerates.
        pub pedals: Seat,
    }
}
