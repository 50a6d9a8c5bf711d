//! What is remembered of a person on foot.

use crate::map_data::WalkEdgeId;
use crate::{ops, state, state_enum};

state_enum! {
    /// What a person on foot is doing.
    pub enum WalkerMode {
        /// Walks along an edge, on a sidewalk or a crosswalk.
        Walk = 0,
        /// Stands at a kerb and waits to cross.
        Wait = 1,
        /// Crosses the road where there is no crosswalk: `s_m` stays, `offset_m` grows.
        Jaywalk = 2,
        /// Waits at a stop for a bus; goes to the door of one that stands there, and waits to get on.
        Boards = 3,
        /// Rides in a bus: stands nowhere, is seen by nobody, and is where it got on as far as its place goes.
        Rides = 4,
        /// Goes straight from the road onto its way.
        Alights = 5,
    }
}

state! {
    /// A person on foot. 30 bytes.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Walker {
        /// Id of the actor.
        pub id: u16,
        /// What it does.
        pub mode: WalkerMode,
        /// Walks from the first to the last point of the edge.
        pub forward: bool,
        /// The edge it walks along.
        pub edge: WalkEdgeId,
        /// Metres along the edge from its first point; may lie beyond an end by the width of the way.
        pub s_m: f32,
        /// Metres to the left of the edge, seen from its first point.
        pub offset_m: f32,
        /// Speed, m/s, never negative.
        pub speed_mps: f32,
        /// Edges entered so far (wrapping): the counter of its random choices.
        pub hops: u16,
        /// Ticks it has waited, or ridden, saturating.
        pub wait_ticks: u16,
        /// Phase of its gait, 2^-16 turns.
        pub phase: u16,
        /// Where it faces, 2^-16 turns counter-clockwise from east.
        pub heading: u16,
        /// The bus to which it goes, in which it rides, or out of which it came while that still stands there; 0 for none.
        pub bus: u16,
    }
}

impl Walker {
    /// Rides in a bus, and stands nowhere.
    pub fn rides(&self) -> bool {
        self.mode == WalkerMode::Rides
    }
}

/// Radians in 2^-16 turns.
const TURN_RAD: f32 = core::f32::consts::TAU / 65536.0;

/// 2^-16 turns as radians.
pub(super) fn radians(turns: u16) -> f32 {
    f32::from(turns) * TURN_RAD
}

/// Radians as 2^-16 turns.
pub(super) fn turns(angle_rad: f32) -> u16 {
    (ops::round(angle_rad * (65536.0 / core::f32::consts::TAU)) as i32) as u16
}
