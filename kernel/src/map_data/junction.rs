//! Junctions and their traffic lights.

use glam::Vec3;

use super::digest::digested;
use super::ids::{LaneId, LightGroupId};

digested! {
    /// A junction.
    #[derive(Clone, Debug, Default)]
    pub struct Junction {
        /// OpenDRIVE id.
        pub name: String,
        /// Its lanes.
        pub lanes: Vec<LaneId>,
        /// Light groups in the order in which they turn green; empty when it has no lights.
        pub light_groups: Vec<LightGroupId>,
        /// Length of its signal programme, ticks; 0 when it has no lights.
        pub cycle_ticks: u32,
        /// Middle of the junction.
        pub center: Vec3,
    }
}

digested! {
    /// Signals of one approach that always show the same, and their part of the programme of their junction: green,
    /// then yellow, red for the rest of it.
    #[derive(Clone, Debug)]
    pub struct LightGroup {
        /// Index of its junction in [`MapData::junctions`](super::MapData::junctions).
        pub junction: u32,
        /// When it turns green, ticks from the start of the programme.
        pub green_from_ticks: u32,
        /// Length of green, ticks.
        pub green_ticks: u32,
        /// Length of yellow, ticks.
        pub yellow_ticks: u32,
    }
}

digested! {
    /// A signal head.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct LightHead {
        /// Its group.
        pub group: LightGroupId,
        /// Foot of its pole.
        pub position: Vec3,
        /// Direction in which its lamps shine (towards the traffic it governs), radians.
        pub facing_rad: f32,
        /// Height of its lamps above the foot, metres.
        pub height_m: f32,
    }
}
