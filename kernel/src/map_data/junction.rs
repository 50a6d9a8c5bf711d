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
        /// Middle of the junction.
        pub center: Vec3,
    }
}

digested! {
    /// Signals of one approach, green at the same time.
    #[derive(Clone, Debug)]
    pub struct LightGroup {
        /// Index of its junction in [`MapData::junctions`](super::MapData::junctions).
        pub junction: u32,
        /// Its place in [`Junction::light_groups`].
        pub place: u32,
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
