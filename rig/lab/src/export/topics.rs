//! The topics of an export, and the type of each one's messages.

use std::io::Write;

use base::png;
use foxglove::messages::{
    CameraCalibration, CompressedImage, FrameTransforms, Log, PoseInFrame, PosesInFrame, SceneUpdate,
};
use render::{Camera, Frame};
use replay::nanoseconds;
use viewers::messages::camera::{CAMERA, calibration, frame_of, image};
use viewers::messages::telemetry::Telemetry;
use viewers::messages::topics::{
    ACTORS, CALIBRATION, CRITICALITY, EVENTS, GROUND, PATH, POSE, RGB, TELEMETRY, TRANSFORMS, TRUTH, calibration_of,
    predicted, rgb_of, truth_of,
};

use super::criticality::Criticality;
use super::sink::{Sink, Topic};
use crate::cameras::Named;

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
    pub driver: Pictures,
    /// One for each camera beside the drivers'.
    pub others: Vec<Pictures>,
    /// One for each checkpoint.
    pub predicted: Vec<Topic<CompressedImage>>,
}

/// What a camera is, what it sees, and the ground truth of that.
pub struct Pictures {
    /// Of its optical axes.
    frame: String,
    calibration: Topic<CameraCalibration>,
    rgb: Topic<CompressedImage>,
    truth: Topic<CompressedImage>,
}

impl Pictures {
    fn of<W: Write>(sink: &mut Sink<W>, Named { name, .. }: &Named) -> anyhow::Result<Self> {
        Ok(Self {
            frame: frame_of(name),
            calibration: sink.topic(&calibration_of(name))?,
            rgb: sink.topic(&rgb_of(name))?,
            truth: sink.topic(&truth_of(name))?,
        })
    }

    /// Of its optical axes.
    pub fn frame(&self) -> &str {
        &self.frame
    }

    /// Writes what the camera saw.
    pub fn put<W: Write>(&self, sink: &mut Sink<W>, camera: &Camera, seen: &Frame) -> anyhow::Result<()> {
        let (tick, time_ns, size) = (seen.tick, nanoseconds(seen.tick), (seen.width, seen.height));
        sink.put(&self.calibration, tick, &calibration(camera, &self.frame, time_ns))?;
        sink.put(&self.rgb, tick, &image(png::rgb(size, &seen.rgb)?, &self.frame, time_ns))?;
        sink.put(&self.truth, tick, &image(png::tags(size, &seen.class_ids)?, &self.frame, time_ns))
    }
}

impl Topics {
    /// Adds all of them to a file.
    pub fn declare<'a, W: Write>(
        sink: &mut Sink<W>,
        checkpoints: impl Iterator<Item = &'a str>,
        others: &[Named],
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
            driver: Pictures {
                frame: CAMERA.to_owned(),
                calibration: sink.topic(CALIBRATION)?,
                rgb: sink.topic(RGB)?,
                truth: sink.topic(TRUTH)?,
            },
            others: others.iter().map(|named| Pictures::of(sink, named)).collect::<anyhow::Result<_>>()?,
            predicted: checkpoints.map(|name| sink.topic(&predicted(name))).collect::<anyhow::Result<_>>()?,
        })
    }
}
