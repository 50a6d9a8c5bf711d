//! Where everybody is: transforms between frames, and the ego car's way.

use base::words;
use foxglove::messages::{FrameTransform, FrameTransforms, PoseInFrame, PosesInFrame};
use kernel::scene::{EgoScene, SceneSnapshot};
use render::Camera;

use super::camera::OPTICAL;
use super::parts::{pose, quaternion, stamp, vector};
use crate::boxes::{EGO, MAP};

/// Where the ego car, its cameras, each in its frame, and every actor are.
pub fn transforms<'a>(
    scene: &SceneSnapshot,
    cameras: impl IntoIterator<Item = (&'a str, &'a Camera)>,
    time_ns: u64,
) -> FrameTransforms {
    let timestamp = stamp(time_ns);
    let frame = |parent: &str, child: String, position, rotation| FrameTransform {
        timestamp,
        parent_frame_id: parent.into(),
        child_frame_id: child,
        translation: vector(position),
        rotation: quaternion(rotation),
    };
    let ego = frame(MAP, EGO.into(), scene.ego.position, scene.ego.rotation);
    let cameras = cameras.into_iter();
    let cameras = cameras.map(|(name, camera)| frame(EGO, name.into(), camera.position, camera.rotation * OPTICAL));
    let actors = scene.actors.iter().map(|actor| frame(MAP, words::actor(actor), actor.position, actor.rotation));
    FrameTransforms { transforms: [ego].into_iter().chain(cameras).chain(actors).collect() }
}

/// Pose of the ego car's rear axle on the ground.
pub fn ego_pose(ego: &EgoScene, time_ns: u64) -> PoseInFrame {
    PoseInFrame { timestamp: stamp(time_ns), frame_id: MAP.into(), pose: pose(ego.position, ego.rotation) }
}

/// Several of these, as a path from a time on.
pub fn ego_path(path: &[EgoScene], time_ns: u64) -> PosesInFrame {
    let poses = path.iter().filter_map(|ego| pose(ego.position, ego.rotation)).collect();
    PosesInFrame { timestamp: stamp(time_ns), frame_id: MAP.into(), poses }
}
