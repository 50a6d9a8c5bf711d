//! Image to mask: segmentation checkpoints, class maps and metrics.
//!
//! One space of class ids is spoken at every boundary: the 23 semantic tags of CARLA 0.9.10 as
//! `u8`. What a network's output channels mean is its checkpoint's business ([`ClassMap`]); the 16
//! classes that are trained and measured are one table ([`classes::TRAIN_CLASSES`]).

mod boundary;
mod bundled;
mod calibration;
mod checkpoint;
pub mod cityscapes;
pub mod classes;
mod compute;
mod decode;
#[cfg(test)]
mod devices;
mod ends;
mod error;
#[cfg(test)]
mod forms;
#[cfg(test)]
mod fuzz;
mod image;
mod metadata;
mod metrics;
mod onnx;
mod operators;
mod parts;
mod peel;
mod scale;
mod segmenter;
mod simd;
mod single;
mod taps;
mod tensors;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod toy;
pub mod training;
#[cfg(test)]
mod zoo;

pub use boundary::BoundaryCounts;
pub use bundled::{BUNDLED, TRUTH, bundled};
pub use calibration::{Calibration, Reliability, SURE, Trust};
pub use checkpoint::Checkpoint;
pub use classes::ClassMap;
pub use compute::Compute;
pub use decode::Certainty;
pub use error::PerceptionError;
pub use image::{Mask, RgbView};
pub use metadata::{Channels, Layout, Metadata, Normalisation, ScoreKind};
pub use metrics::{ConfusionMatrix, Scores};
pub use onnx::environment as onnxruntime;
pub use segmenter::Segmenter;
