//! Where people walk.

use glam::Vec3;

use super::digest::digested;
use super::ids::{LaneId, WalkEdgeId};

digested! {
    /// A crosswalk.
    #[derive(Clone, Debug)]
    pub struct Crosswalk {
        /// The ends of its axis at the two kerbs.
        pub ends: [Vec3; 2],
        /// Half of its extent along the road, metres.
        pub half_width_m: f32,
        /// The lanes it crosses, each with the place of the crosswalk, metres from the lane's start.
        pub lanes: Vec<(LaneId, f32)>,
        /// Its junction, when that has lights: walkers go while every crossed lane has red.
        pub junction: Option<u32>,
    }
}

digested! {
    /// A place where ways of pedestrians meet.
    #[derive(Clone, Debug)]
    pub struct WalkNode {
        /// Where.
        pub position: Vec3,
        /// Edges that start or end here.
        pub edges: Vec<WalkEdgeId>,
    }
}

digested! {
    /// A way of pedestrians, walked in both directions.
    #[derive(Clone, Debug)]
    pub struct WalkEdge {
        /// Indices in [`MapData::walk_nodes`](super::MapData::walk_nodes) of the first and the last point.
        pub nodes: [u32; 2],
        /// Polyline of at least two points.
        pub points: Vec<Vec3>,
        /// Half of its width, metres.
        pub half_width_m: f32,
        /// Length in metres.
        pub length_m: f32,
        /// The crosswalk it runs on, an index in [`MapData::crosswalks`](super::MapData::crosswalks).
        pub crosswalk: Option<u32>,
        /// For a sidewalk: the driving lane beside it, which a jaywalker steps on.
        pub beside: Option<LaneId>,
    }
}
