//! What messages are made of: times, places, colours.

use foxglove::messages::{Color, Pose, Quaternion, SceneEntity, Timestamp, Vector3};
use glam::{Quat, Vec3};

use crate::boxes::MAP;

/// A time, from nanoseconds.
pub fn stamp(time_ns: u64) -> Option<Timestamp> {
    let seconds = u32::try_from(time_ns / 1_000_000_000).unwrap_or(u32::MAX);
    Some(Timestamp::new(seconds, (time_ns % 1_000_000_000) as u32))
}

/// A vector.
pub fn vector(v: Vec3) -> Option<Vector3> {
    Some(Vector3 { x: v.x.into(), y: v.y.into(), z: v.z.into() })
}

/// A rotation.
pub fn quaternion(q: Quat) -> Option<Quaternion> {
    let q = q.normalize();
    Some(Quaternion { x: q.x.into(), y: q.y.into(), z: q.z.into(), w: q.w.into() })
}

/// A place with a rotation.
pub fn pose(position: Vec3, rotation: Quat) -> Option<Pose> {
    Some(Pose { position: vector(position), orientation: quaternion(rotation) })
}

/// A colour that hides what is behind it.
pub fn colour([r, g, b]: [f32; 3]) -> Option<Color> {
    Some(Color { r: r.into(), g: g.into(), b: b.into(), a: 1.0 })
}

/// Something of a 3D scene that has no form yet, in the map's frame.
pub fn entity(time_ns: u64, id: String) -> SceneEntity {
    SceneEntity { timestamp: stamp(time_ns), frame_id: MAP.into(), id, ..SceneEntity::default() }
}
