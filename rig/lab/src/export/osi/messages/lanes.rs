//! `osi_lane.proto`.

use prost::{Enumeration, Message};

use super::common::{Identifier, Vector3d};

/// A lane.
#[derive(Clone, PartialEq, Message)]
pub struct Lane {
    #[prost(message, required, tag = "1")]
    pub id: Identifier,
    #[prost(message, required, tag = "2")]
    pub classification: LaneClassification,
}

/// What a lane is for, and where.
#[derive(Clone, PartialEq, Message)]
pub struct LaneClassification {
    #[prost(enumeration = "LaneType", required, tag = "1")]
    pub r#type: i32,
    #[prost(message, repeated, tag = "3")]
    pub centerline: Vec<Vector3d>,
    #[prost(bool, required, tag = "4")]
    pub centerline_is_driving_direction: bool,
    #[prost(message, repeated, tag = "5")]
    pub left_adjacent_lane_id: Vec<Identifier>,
    #[prost(message, repeated, tag = "6")]
    pub right_adjacent_lane_id: Vec<Identifier>,
    #[prost(message, repeated, tag = "7")]
    pub lane_pairing: Vec<LanePairing>,
    #[prost(message, repeated, tag = "8")]
    pub right_lane_boundary_id: Vec<Identifier>,
    #[prost(message, repeated, tag = "9")]
    pub left_lane_boundary_id: Vec<Identifier>,
    #[prost(enumeration = "LaneSubtype", required, tag = "12")]
    pub subtype: i32,
}

/// A way over a lane: from which lane it comes, and to which it goes on.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct LanePairing {
    #[prost(message, optional, tag = "1")]
    pub antecessor_lane_id: Option<Identifier>,
    #[prost(message, optional, tag = "2")]
    pub successor_lane_id: Option<Identifier>,
}

/// An edge of a lane.
#[derive(Clone, PartialEq, Message)]
pub struct LaneBoundary {
    #[prost(message, required, tag = "1")]
    pub id: Identifier,
    #[prost(message, repeated, tag = "2")]
    pub boundary_line: Vec<BoundaryPoint>,
    #[prost(message, required, tag = "3")]
    pub classification: LaneBoundaryClassification,
}

/// A vertex of an edge.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct BoundaryPoint {
    #[prost(message, required, tag = "1")]
    pub position: Vector3d,
}

/// What marks an edge.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct LaneBoundaryClassification {
    #[prost(enumeration = "BoundaryKind", required, tag = "1")]
    pub r#type: i32,
}

/// What a lane is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum LaneType {
    Unknown = 0,
    Driving = 2,
    NonDriving = 3,
    Intersection = 4,
}

/// The same in more detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum LaneSubtype {
    Unknown = 0,
    Other = 1,
    Normal = 2,
    Biking = 3,
    Sidewalk = 4,
    Parking = 5,
    Shoulder = 9,
}

/// What an edge is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Enumeration)]
#[repr(i32)]
pub enum BoundaryKind {
    Unknown = 0,
    Other = 1,
}
