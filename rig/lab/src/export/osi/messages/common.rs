//! `osi_version.proto` and `osi_common.proto`.

use prost::Message;

/// The version of the standard that a message follows.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct InterfaceVersion {
    #[prost(uint32, required, tag = "1")]
    pub version_major: u32,
    #[prost(uint32, required, tag = "2")]
    pub version_minor: u32,
    #[prost(uint32, required, tag = "3")]
    pub version_patch: u32,
}

/// Time since tick 0.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Timestamp {
    /// Whole seconds.
    #[prost(int64, required, tag = "1")]
    pub seconds: i64,
    /// The rest, nanoseconds, [0, 999,999,999].
    #[prost(uint32, required, tag = "2")]
    pub nanos: u32,
}

/// Metres, m/s or m/s².
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Vector3d {
    #[prost(double, required, tag = "1")]
    pub x: f64,
    #[prost(double, required, tag = "2")]
    pub y: f64,
    #[prost(double, required, tag = "3")]
    pub z: f64,
}

/// Extent of a box along its own axes, metres.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Dimension3d {
    /// Along x.
    #[prost(double, required, tag = "1")]
    pub length: f64,
    /// Along y.
    #[prost(double, required, tag = "2")]
    pub width: f64,
    /// Along z.
    #[prost(double, required, tag = "3")]
    pub height: f64,
}

/// Angles, radians, or their rates, rad/s: yaw first, about z, then pitch about the new y, then roll about the new x.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Orientation3d {
    #[prost(double, required, tag = "1")]
    pub roll: f64,
    #[prost(double, required, tag = "2")]
    pub pitch: f64,
    #[prost(double, required, tag = "3")]
    pub yaw: f64,
}

/// What tells a thing from all others of the trace.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Identifier {
    #[prost(uint64, required, tag = "1")]
    pub value: u64,
}

/// Where a thing is that does not move.
#[derive(Clone, PartialEq, Message)]
pub struct BaseStationary {
    #[prost(message, required, tag = "1")]
    pub dimension: Dimension3d,
    /// Middle of its box.
    #[prost(message, required, tag = "2")]
    pub position: Vector3d,
    #[prost(message, required, tag = "3")]
    pub orientation: Orientation3d,
}

/// Where somebody is, and how it moves.
#[derive(Clone, PartialEq, Message)]
pub struct BaseMoving {
    #[prost(message, required, tag = "1")]
    pub dimension: Dimension3d,
    /// Middle of its box.
    #[prost(message, required, tag = "2")]
    pub position: Vector3d,
    #[prost(message, required, tag = "3")]
    pub orientation: Orientation3d,
    /// Of the middle of its box.
    #[prost(message, required, tag = "4")]
    pub velocity: Vector3d,
    /// Of the middle of its box.
    #[prost(message, required, tag = "5")]
    pub acceleration: Vector3d,
    #[prost(message, required, tag = "6")]
    pub orientation_rate: Orientation3d,
}
