//! The road network, baked once from OpenDRIVE into plain data.
//!
//! Coordinates are rounded to 2^-10 m, so that differing libm results vanish; the digest over all
//! of it is part of every recording.

use glam::Vec3;

use crate::physics::Statics;
use crate::state_enum;
use crate::traffic::Lookups;

/// Index of a lane in [`RoadNetwork::lanes`].
pub type LaneId = u32;
/// Index in [`RoadNetwork::light_groups`].
pub type LightGroupId = u32;
/// Index in [`RoadNetwork::walk_edges`].
pub type WalkEdgeId = u32;

state_enum! {
    /// What a lane is for.
    pub enum LaneKind {
        /// Motor traffic.
        Driving = 0,
        /// Bicycles only.
        Biking = 1,
        /// Pedestrians, raised by a kerb.
        Sidewalk = 2,
        /// Paved edge of a road, not driven on.
        Shoulder = 3,
        /// Parked cars.
        Parking = 4,
        /// Anything else: medians, borders, restricted areas.
        Other = 5,
    }
}

state_enum! {
    /// Which way a lane leads through a junction.
    pub enum Turn {
        /// Straight on, or no junction.
        Straight = 0,
        /// To the left.
        Left = 1,
        /// To the right.
        Right = 2,
    }
}

/// One vertex of a lane's centre line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanePoint {
    /// Position on the surface, metres.
    pub position: Vec3,
    /// Direction of travel, radians counter-clockwise from east.
    pub heading_rad: f32,
    /// Half of the lane's width, metres.
    pub half_width_m: f32,
    /// Distance along the centre line from its start, metres.
    pub s_m: f32,
}

/// What makes a vehicle stop at the end of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopKind {
    /// A traffic light.
    Light(LightGroupId),
    /// A stop sign: halt, then give way.
    Stop,
    /// A yield sign, or a junction without signs: give way.
    Yield,
}

/// A stop line across a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopLine {
    /// Where on the lane's centre line, metres from its start.
    pub s_m: f32,
    /// Why to stop there.
    pub kind: StopKind,
}

/// Where another lane's area overlaps this one inside a junction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conflict {
    /// The other lane.
    pub lane: LaneId,
    /// Stretch of this lane that overlaps, metres from its start.
    pub from_m: f32,
    /// End of that stretch.
    pub to_m: f32,
    /// Whether traffic on the other lane goes first when no light says otherwise.
    pub other_first: bool,
}

/// A lane in its direction of travel.
#[derive(Clone, Debug)]
pub struct Lane {
    /// What it is for.
    pub kind: LaneKind,
    /// OpenDRIVE ids of its road and lane, as in `"12/-1"`.
    pub name: String,
    /// Centre line in the direction of travel, at least two points, at most 2 m apart.
    pub points: Vec<LanePoint>,
    /// Length of the centre line in metres.
    pub length_m: f32,
    /// Lanes that follow.
    pub successors: Vec<LaneId>,
    /// Lanes that lead here.
    pub predecessors: Vec<LaneId>,
    /// Neighbour in the same direction to the left, where a change is possible.
    pub left: Option<LaneId>,
    /// Neighbour in the same direction to the right, where a change is possible.
    pub right: Option<LaneId>,
    /// Speed limit in m/s.
    pub speed_limit_mps: f32,
    /// Index in [`RoadNetwork::junctions`] when it crosses one.
    pub junction: Option<u32>,
    /// Which way it leads through that junction.
    pub turn: Turn,
    /// Stop line on it, if any (on the lane before the junction).
    pub stop: Option<StopLine>,
    /// Lanes of the same junction that overlap it.
    pub conflicts: Vec<Conflict>,
}

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

/// Signals of one approach, green at the same time.
#[derive(Clone, Debug)]
pub struct LightGroup {
    /// Index of its junction in [`RoadNetwork::junctions`].
    pub junction: u32,
    /// Its place in [`Junction::light_groups`].
    pub place: u32,
}

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

/// A zebra crossing.
#[derive(Clone, Debug)]
pub struct Crosswalk {
    /// The ends of its axis at the two kerbs.
    pub ends: [Vec3; 2],
    /// Half of its extent along the road, metres.
    pub half_width_m: f32,
    /// The lanes it crosses, each with the place of the crossing, metres from the lane's start.
    pub lanes: Vec<(LaneId, f32)>,
    /// Its junction, when that has lights: walkers go while every crossed lane has red.
    pub junction: Option<u32>,
}

/// A place where ways of pedestrians meet.
#[derive(Clone, Debug)]
pub struct WalkNode {
    /// Where.
    pub position: Vec3,
    /// Edges that start or end here.
    pub edges: Vec<WalkEdgeId>,
}

/// A way of pedestrians, walked in both directions.
#[derive(Clone, Debug)]
pub struct WalkEdge {
    /// Indices in [`RoadNetwork::walk_nodes`] of the first and the last point.
    pub nodes: [u32; 2],
    /// Polyline of at least two points.
    pub points: Vec<Vec3>,
    /// Half of its width, metres.
    pub half_width_m: f32,
    /// Length in metres.
    pub length_m: f32,
    /// The crosswalk it runs on, an index in [`RoadNetwork::crosswalks`].
    pub crosswalk: Option<u32>,
    /// For a sidewalk: the driving lane beside it, which a jaywalker steps on.
    pub beside: Option<LaneId>,
}

state_enum! {
    /// What a static surface is made of.
    pub enum SurfaceKind {
        /// Asphalt.
        Road = 0,
        /// Paint on the asphalt.
        RoadLine = 1,
        /// Pavement of a sidewalk with its kerb.
        Sidewalk = 2,
        /// Grass and soil.
        Terrain = 3,
        /// Paved ground that is none of the above.
        Ground = 4,
    }
}

/// A triangle mesh of one material.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Material.
    pub kind: SurfaceKind,
    /// Vertices.
    pub positions: Vec<Vec3>,
    /// Counter-clockwise seen from above.
    pub triangles: Vec<[u32; 3]>,
}

state_enum! {
    /// What a static object is.
    pub enum PropKind {
        /// A house; `size` is its box.
        Building = 0,
        /// A tree; `size.x` is the diameter of its crown, `size.z` its height.
        Tree = 1,
        /// A hedge or bush.
        Hedge = 2,
        /// A street lamp.
        Lamp = 3,
        /// A traffic sign on its post; `variant` is a `SIGN_*` constant.
        Sign = 4,
        /// The pole of a signal head.
        SignalPole = 5,
        /// A parked car; part of the static world.
        ParkedCar = 6,
        /// A fence; `size.x` is its length.
        Fence = 7,
        /// A wall; `size.x` is its length.
        Wall = 8,
        /// A guard rail; `size.x` is its length.
        GuardRail = 9,
        /// Street furniture: bins, benches, boxes.
        Furniture = 10,
    }
}

/// A static object standing on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prop {
    /// What it is.
    pub kind: PropKind,
    /// Centre of its footprint on the ground.
    pub position: Vec3,
    /// Direction of its x axis, radians.
    pub heading_rad: f32,
    /// Extent along its own x, y and z in metres.
    pub size: Vec3,
    /// Selects colour, shape or sign.
    pub variant: u32,
}

/// [`Prop::variant`] of a stop sign.
pub const SIGN_STOP: u32 = 0;
/// [`Prop::variant`] of a yield sign.
pub const SIGN_YIELD: u32 = 1;
/// [`Prop::variant`] of a speed limit: this plus the limit in km/h.
pub const SIGN_LIMIT: u32 = 1000;

/// Everything about a map, as plain data.
#[derive(Clone, Debug, Default)]
pub struct RoadNetwork {
    /// Name of a bundled map, or the file's stem.
    pub name: String,
    /// xxh3 over everything below.
    pub digest: u128,
    /// All lanes.
    pub lanes: Vec<Lane>,
    /// All junctions.
    pub junctions: Vec<Junction>,
    /// Signal groups.
    pub light_groups: Vec<LightGroup>,
    /// Signal heads.
    pub light_heads: Vec<LightHead>,
    /// Zebra crossings.
    pub crosswalks: Vec<Crosswalk>,
    /// Where the ways of pedestrians meet.
    pub walk_nodes: Vec<WalkNode>,
    /// The ways of pedestrians.
    pub walk_edges: Vec<WalkEdge>,
    /// Static surfaces.
    pub surfaces: Vec<Surface>,
    /// Static objects.
    pub props: Vec<Prop>,
    /// Least and greatest corner of everything.
    pub bounds: [Vec3; 2],
    /// The colliders of all that, built on first use; start with `Statics::default()`.
    pub statics: Statics,
    /// What traffic looks up in it, built on first use; start with `Lookups::default()`.
    pub lookups: Lookups,
    /// Grids for questions about places, built on first use; start with `Index::default()`.
    pub index: Index,
}

mod bake;
mod bundled;
mod crosswalks;
mod digest;
mod dressing;
mod grid;
mod junctions;
mod lanes;
mod lights;
mod props;
mod query;
mod surfaces;
mod terrain;
mod walk;

pub use bake::{BakeError, bake};
pub use bundled::{BUNDLED, bundled};
pub use query::{Ground, Index, Projection};

#[cfg(test)]
mod tests;
