//! The topics of an export and what each holds.

use std::io::Write;

use foxglove::messages::{
    CameraCalibration, CompressedImage, FrameTransforms, Log, PoseInFrame, PosesInFrame, SceneUpdate,
};

use super::criticality::Criticality;
use super::sink::{Sink, Topic};
use super::telemetry::Telemetry;

/// Frames `map`, `ego`, `camera` and each actor's, a message a picture.
pub const TRANSFORMS: &str = "/tf";
/// Pose of the ego car's rear axle, every tick.
pub const POSE: &str = "/ego/pose";
/// The whole way of the ego car, once.
pub const PATH: &str = "/ego/path";
/// Figures to plot, every tick.
pub const TELEMETRY: &str = "/telemetry";
/// How critical it is, ten times a second.
pub const CRITICALITY: &str = "/criticality";
/// What happened.
pub const EVENTS: &str = "/events";
/// Roads, paint and sidewalks, once.
pub const GROUND: &str = "/map";
/// Every road user as a box, a message a picture.
pub const ACTORS: &str = "/actors";
/// Of the camera, a message a picture.
pub const CALIBRATION: &str = "/camera/calibration";
/// The picture.
pub const RGB: &str = "/camera/rgb";
/// Ground truth of the picture.
pub const TRUTH: &str = "/camera/truth";

/// What a checkpoint predicts for the picture.
pub fn predicted(checkpoint: &str) -> String {
    format!("/camera/predicted/{checkpoint}")
}

/// Every topic, ready to be written to. Masks are PNG files with a palette: the values are the tags of
/// CARLA 0.9.10, the colours are theirs.
pub struct Topics {
    pub transforms: Topic<FrameTransforms>,
    pub pose: Topic<PoseInFrame>,
    pub path: Topic<PosesInFrame>,
    pub telemetry: Topic<Telemetry>,
    pub criticality: Topic<Criticality>,
    pub events: Topic<Log>,
    pub ground: Topic<SceneUpdate>,
    pub actors: Topic<SceneUpdate>,
    pub calibration: Topic<CameraCalibration>,
    pub rgb: Topic<CompressedImage>,
    pub truth: Topic<CompressedImage>,
    /// One for each checkpoint.
    pub predicted: Vec<Topic<CompressedImage>>,
}

impl Topics {
    /// Adds all of them to a file.
    pub fn declare<'a, W: Write>(
        sink: &mut Sink<W>,
        checkpoints: impl Iterator<Item = &'a str>,
    ) -> anyhow::Result<Self> {
        Ok(Self {
            transforms: sink.topic(TRANSFORMS)?,
            pose: sink.topic(POSE)?,
            path: sink.topic(PATH)?,
            telemetry: sink.topic(TELEMETRY)?,
            criticality: sink.topic(CRITICALITY)?,
            events: sink.topic(EVENTS)?,
            ground: sink.topic(GROUND)?,
            actors: sink.topic(ACTORS)?,
            calibration: sink.topic(CALIBRATION)?,
            rgb: sink.topic(RGB)?,
            truth: sink.topic(TRUTH)?,
            predicted: checkpoints.map(|name| sink.topic(&predicted(name))).collect::<anyhow::Result<_>>()?,
        })
    }
}
