//! What is remembered of a vehicle.

use crate::actor::ActorKind;
use crate::map_data::LaneId;
use crate::state;
use crate::time::{Tick, seconds};

use super::lapse::Lapse;
use super::manoeuvre::Manoeuvre;

/// After this long at an open line a vehicle without room behind the junction is left the next that there is.
const ROOM_TICKS: u16 = seconds(30) as u16;
/// Drivers decide so often: 20 times a second, faster than anybody reacts. Between that they hold pedals and wheel.
pub(super) const DECIDE_TICKS: u8 = 3;

state! {
    /// A vehicle on a lane. 40 bytes.
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
        /// Acceleration that its driver holds, 1/100 m/s².
        pub accel_cmps2: i16,
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
        /// The same that its driver steers for.
        pub drift_aim: i8,
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
    /// Asks to enter the junction before it.
    pub const ASKING: u8 = 64;
    /// Every flag with a meaning.
    pub const ALL_FLAGS: u8 = 127;

    /// Stands where it is no part of the traffic: it crashed, or halted at the kerb or a bus stop.
    pub(super) fn is_aside(&self) -> bool {
        matches!(self.lapse, Lapse::Crashed | Lapse::Halts | Lapse::Boards)
    }

    /// Whether it is in a junction, may enter one, or asks for that.
    pub(super) fn counts_at_junction(&self) -> bool {
        self.flags & (Self::GRANTED | Self::ASKING | Self::CROSSING) != 0
    }

    /// Whether it has waited so long that others leave it the room behind its junction.
    pub(super) fn wants_room(&self) -> bool {
        self.wait_ticks > ROOM_TICKS
    }

    /// Ticks for which it has waited at a tick, also since its driver last counted: so that all compare the same.
    pub(super) fn waited_ticks(&self, tick: Tick) -> u16 {
        let every = Tick::from(DECIDE_TICKS);
        let since = (tick + Tick::from(self.id) + every - 1) % every + 1;
        if self.wait_ticks == 0 { 0 } else { self.wait_ticks.saturating_add(since as u16) }
    }

    /// Whether its driver decides in a tick.
    pub(super) fn decides(&self, tick: Tick) -> bool {
        self.is_due(tick, Tick::from(DECIDE_TICKS))
    }

    /// Whether what is done every so many ticks is due: not for everybody in the same tick.
    pub(super) fn is_due(&self, tick: Tick, every_ticks: Tick) -> bool {
        (tick + Tick::from(self.id)).is_multiple_of(every_ticks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actor::ActorKind;

    #[test]
    fn two_who_wait_agree_in_every_tick_who_came_first() {
        let came = [(1, 100), (2, 101), (3, 101), (4, 99), (5, 103), (6, 104)];
        let waits = |id, from: Tick, tick: Tick| {
            // As counted when its driver decided before this tick.
            let decisions = (from..tick).filter(|t| Vehicle { id, ..Vehicle::standing() }.decides(*t)).count() as u16;
            Vehicle { id, wait_ticks: decisions * u16::from(DECIDE_TICKS), ..Vehicle::standing() }
        };
        for (a, from_a) in came {
            for (b, from_b) in came {
                let lead =
                    |t| i32::from(waits(a, from_a, t).waited_ticks(t)) - i32::from(waits(b, from_b, t).waited_ticks(t));
                let leads: Vec<i32> = (110..130).map(lead).collect();
                assert!(leads.iter().all(|l| *l == leads[0]), "{a} and {b}: {leads:?}");
            }
        }
    }

    impl Vehicle {
        pub(in crate::traffic) fn standing() -> Self {
            Self {
                id: 0,
                kind: ActorKind::Car,
                flags: 0,
                lane: 0,
                before: 0,
                s_m: 0.0,
                offset_m: 0.0,
                speed_mps: 0.0,
                accel_cmps2: 0,
                trips: 0,
                wait_ticks: 0,
                phase: 0,
                stuck_s: 0,
                manoeuvre: Manoeuvre::Keep,
                signal_ticks: 0,
                drift: 0,
                drift_aim: 0,
                lapse: Lapse::None,
                lapse_left: 0,
                late_ticks: 0,
            }
        }
    }
}
