//! Everything that can go wrong here.

use std::path::PathBuf;

/// Why a checkpoint, an image or a dataset cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PerceptionError {
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file holds no ONNX model.
    #[error("{path}: not an ONNX model ({reason})")]
    NotOnnx {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The model is no segmentation network that can be run.
    #[error("{path}: not a usable segmentation network: {reason}")]
    NotSegmentation {
        /// The file.
        path: PathBuf,
        /// What was expected and what was found.
        reason: String,
    },
    /// The description of the network's input and output lacks something or contradicts it.
    #[error("{path}: {reason}")]
    Metadata {
        /// The model or its sidecar.
        path: PathBuf,
        /// Which key, what was expected.
        reason: String,
    },
    /// A class name that is no tag.
    #[error("unknown class name {name:?}; expected a tag of CARLA 0.9.10 such as \"Pedestrian\"")]
    UnknownClass {
        /// The name.
        name: String,
    },
    /// A naming scheme that is not known.
    #[error("unknown class scheme {name:?}; expected aeye, cityscapes, carla-0.9.10 or carla-0.9.14")]
    UnknownScheme {
        /// The name.
        name: String,
    },
    /// Too few or too many classes.
    #[error("{count} classes; expected 1 to 256")]
    ClassCount {
        /// How many.
        count: usize,
    },
    /// An image does not have the size that was asked for.
    #[error("image of {bytes} bytes; expected {width} x {height} pixels of {channels} bytes")]
    ImageSize {
        /// Bytes given.
        bytes: usize,
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
        /// Bytes a pixel.
        channels: usize,
    },
    /// This machine cannot compute networks so.
    #[error("inference on {name} does not work here: {reason}")]
    Compute {
        /// Name of what was to compute.
        name: &'static str,
        /// What is missing or wrong.
        reason: String,
    },
    /// The network failed while it ran.
    #[error("{path}: inference failed: {reason}")]
    Inference {
        /// The model.
        path: PathBuf,
        /// What the engine says.
        reason: String,
    },
    /// A dataset folder is not what training and evaluation need.
    #[error("{path}: {reason}")]
    Dataset {
        /// The file or folder.
        path: PathBuf,
        /// What was found and what was expected.
        reason: String,
    },
    /// What is asked of training contradicts itself.
    #[error("cannot train with a {reason}")]
    TrainOptions {
        /// What was asked and what was expected.
        reason: String,
    },
    /// An unfinished training cannot be continued.
    #[error("{path}: this unfinished training cannot be continued: {reason}; remove it to start anew")]
    Unfinished {
        /// Its file.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
}
