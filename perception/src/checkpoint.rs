//! A segmentation network in a file.

use std::path::Path;

use crate::{ClassMap, PerceptionError};

/// An ONNX segmentation network with one image as input and logits or a class map as output, and
/// what it says about itself.
#[derive(Clone, Debug)]
pub struct Checkpoint {}

impl Checkpoint {
    /// Reads a model with its metadata or sidecar (see [`crate::Metadata`]).
    pub fn load(_path: impl AsRef<Path>) -> Result<Self, PerceptionError> {
        todo!()
    }

    /// Stem of the file's name.
    pub fn name(&self) -> &str {
        todo!()
    }

    /// BLAKE3 over the model and its sidecar.
    pub fn digest(&self) -> blake3::Hash {
        todo!()
    }

    /// What the outputs mean.
    pub fn classes(&self) -> &ClassMap {
        todo!()
    }

    /// Width and height that the network takes, unless it takes any.
    pub fn input_size(&self) -> Option<(usize, usize)> {
        todo!()
    }
}
