//! Names of the parts of a map: their places in its lists.

/// Index of a lane in [`MapData::lanes`](super::MapData::lanes).
pub type LaneId = u32;
/// Index in [`MapData::light_groups`](super::MapData::light_groups).
pub type LightGroupId = u32;
/// Index in [`MapData::walk_edges`](super::MapData::walk_edges).
pub type WalkEdgeId = u32;
