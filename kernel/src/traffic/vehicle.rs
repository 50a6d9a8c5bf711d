//! What is remembered of a vehicle.

use crate::actor::ActorKind;
use crate::map_data::LaneId;
use crate::state;

use super::lapse::Lapse;
use super::manoeuvre::Manoeuvre;

state! {
    /// A vehicle on a lane. 37 bytes.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Vehicle {
        /// Id of the actor.
        pub id: u16,
        /// What it is.
        pub kind: ActorKind,
        /// Bit set of the `Vehicle::*` flags.
        pub flags: u8,
        /// Lane under its middle.
        pub lane: LaneId,
        /// Lane from which it came there, where its tail may still be; the same lane if it did not come from another.
        pub before: LaneId,
        /// Its middle, metres from the start of the lane.
        pub s_m: f32,
        /// Its middle, metres to the left of the lane's centre line.
        pub offset_m: f32,
        /// Speed, m/s, never negative.
        pub speed_mps: f32,
        /// Journeys begun after the first (wrapping): the counter of its drawn goals.
        pub trips: u16,
        /// Ticks it has waited at the line before it, saturating.
        pub wait_ticks: u16,
        /// Phase of pedalling, 2^-16 turns.
        pub phase: u16,
        /// Seconds for which it has stood without a reason, saturating.
        pub stuck_s: u8,
        /// What it does across its lane.
        pub manoeuvre: Manoeuvre,
        /// Ticks for which it has signalled, or moved over or passed since then, saturating.
        pub signal_ticks: u8,
        /// Sideways motion to the left for each metre driven, 1/100.
        pub drift: i8,
        /// What its driver does wrong at the moment.
        pub lapse: Lapse,
        /// Time until that is over, in units that depend on what it is.
        pub lapse_left: u8,
        /// Ticks for which the driver has not yet reacted to the vehicle ahead.
        pub late_ticks: u8,
    }
}

impl Vehicle {
    /// Brake lights on.
    pub const BRAKING: u8 = 1;
    /// May enter the junction before it.
    pub const GRANTED: u8 = 2;
    /// Has halted at the stop sign before it.
    pub const HALTED: u8 = 4;
    /// Is inside a junction, or its rear still is.
    pub const CROSSING: u8 = 8;
    /// Turns left at the junction before it or in it.
    pub const TURNS_LEFT: u8 = 16;
    /// Turns right there.
    pub const TURNS_RIGHT: u8 = 32;
    /// Stands where it is no part of the traffic: it crashed, or halted at the kerb or a bus stop.
    pub(super) fn is_aside(&self) -> bool {
        matches!(self.lapse, Lapse::Crashed | Lapse::Halts | Lapse::Boards)
    }

    /// Every flag with a meaning.
    pub const ALL_FLAGS: u8 = 63;
}
