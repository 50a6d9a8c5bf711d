//! What a tick is in Foxglove's messages (github.com/foxglove/foxglove-sdk/tree/main/schemas): poses,
//! transforms, camera, pictures.

use base::words;
use foxglove::messages::{
    CameraCalibration, CompressedImage, FrameTransform, FrameTransforms, Pose, PoseInFrame, PosesInFrame, Quaternion,
    Timestamp, Vector3,
};
use glam::{Quat, Vec3};
use kernel::scene::{EgoScene, SceneSnapshot};
use kernel::time::Tick;
use render::Camera;
use replay::nanoseconds;
use viewers::boxes::{EGO, MAP};

/// Frame of the camera's optical axes: x right, y down, z along the view.
pub const CAMERA: &str = "camera";
/// From optical axes to those of [`Camera`]: x along the view, y left, z up.
const OPTICAL: Quat = Quat::from_xyzw(-0.5, 0.5, -0.5, 0.5);

/// Simulated time of a tick.
pub fn stamp(tick: Tick) -> Option<Timestamp> {
    let ns = nanoseconds(tick);
    Some(Timestamp::new(u32::try_from(ns / 1_000_000_000).unwrap_or(u32::MAX), (ns % 1_000_000_000) as u32))
}

/// A vector.
pub fn vector(v: Vec3) -> Option<Vector3> {
    Some(Vector3 { x: v.x.into(), y: v.y.into(), z: v.z.into() })
}

/// A place with a rotation.
pub fn pose(position: Vec3, rotation: Quat) -> Option<Pose> {
    Some(Pose { position: vector(position), orientation: quaternion(rotation) })
}

fn quaternion(q: Quat) -> Option<Quaternion> {
    let q = q.normalize();
    Some(Quaternion { x: q.x.into(), y: q.y.into(), z: q.z.into(), w: q.w.into() })
}

/// Where the ego car, its camera and every actor are.
pub fn transforms(scene: &SceneSnapshot, camera: &Camera) -> FrameTransforms {
    let timestamp = stamp(scene.tick);
    let frame = |parent: &str, child: String, position, rotation| FrameTransform {
        timestamp,
        parent_frame_id: parent.into(),
        child_frame_id: child,
        translation: vector(position),
        rotation: quaternion(rotation),
    };
    let ego = frame(MAP, EGO.into(), scene.ego.position, scene.ego.rotation);
    let camera = frame(EGO, CAMERA.into(), camera.position, camera.rotation * OPTICAL);
    let actors = scene.actors.iter().map(|actor| frame(MAP, words::actor(actor), actor.position, actor.rotation));
    FrameTransforms { transforms: [ego, camera].into_iter().chain(actors).collect() }
}

/// Pose of the ego car's rear axle on the ground.
pub fn ego_pose(tick: Tick, ego: &EgoScene) -> PoseInFrame {
    PoseInFrame { timestamp: stamp(tick), frame_id: MAP.into(), pose: pose(ego.position, ego.rotation) }
}

/// Several of these, as a path from a tick on.
pub fn ego_path(tick: Tick, path: &[EgoScene]) -> PosesInFrame {
    let poses = path.iter().filter_map(|ego| pose(ego.position, ego.rotation)).collect();
    PosesInFrame { timestamp: stamp(tick), frame_id: MAP.into(), poses }
}

/// What the camera's pixels are: square, and without distortion.
pub fn calibration(tick: Tick, camera: &Camera) -> CameraCalibration {
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let focal = 0.5 * width / f64::from(kernel::ops::tan(0.5 * camera.fov_x_rad));
    let (cx, cy) = (0.5 * width, 0.5 * height);
    CameraCalibration {
        timestamp: stamp(tick),
        frame_id: CAMERA.into(),
        width: camera.width,
        height: camera.height,
        distortion_model: "plumb_bob".into(),
        d: vec![0.0; 5],
        k: vec![focal, 0.0, cx, 0.0, focal, cy, 0.0, 0.0, 1.0],
        r: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: vec![focal, 0.0, cx, 0.0, 0.0, focal, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
    }
}

/// A picture that the camera took, a PNG file.
pub fn image(tick: Tick, png: Vec<u8>) -> CompressedImage {
    CompressedImage { timestamp: stamp(tick), frame_id: CAMERA.into(), data: png.into(), format: "png".into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn optical_axes_are_right_down_and_ahead() {
        let near = |axis: Vec3, expected: Vec3| assert!((OPTICAL * axis).distance(expected) < 1e-6);
        near(Vec3::Z, Vec3::X);
        near(Vec3::X, Vec3::NEG_Y);
        near(Vec3::Y, Vec3::NEG_Z);
    }

    #[test]
    fn the_calibration_sees_as_wide_as_the_camera() {
        let camera = Camera::driver(512, 256);
        let k = calibration(0, &camera).k;
        let half_width = (k[2] / k[0]).atan();
        assert!((2.0 * half_width - f64::from(camera.fov_x_rad)).abs() < 1e-6);
        assert_eq!((k[0], k[5]), (k[4], 128.0));
    }
}
