//! The topics of an export, and the type of each one's messages.

use std::io::Write;

use foxglove::messages::{
    CameraCalibration, CompressedImage, FrameTransforms, Log, PoseInFrame, PosesInFrame, SceneUpdate,
};
use viewers::messages::telemetry::Telemetry;
use viewers::messages::topics::{
    ACTORS, CALIBRATION, CRITICALITY, EVENTS, GROUND, PATH, POSE, RGB, TELEMETRY, TRANSFORMS, TRUTH, predicted,
};

use super::criticality::Criticality;
use super::sink::{Sink, Topic};

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
