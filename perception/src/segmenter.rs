//! Runs a checkpoint on pictures of one size.

use crate::{Checkpoint, Mask, PerceptionError, RgbView};

/// A network made ready for pictures of one size. Single-threaded and deterministic; a clone
/// shares the weights.
#[derive(Clone)]
pub struct Segmenter {}

impl Segmenter {
    /// Makes the network ready for pictures of `width` x `height` pixels. Where the network takes
    /// one size only, pictures are resampled to it; the mask always has the picture's size.
    pub fn new(_checkpoint: &Checkpoint, _width: usize, _height: usize) -> Result<Self, PerceptionError> {
        todo!()
    }

    /// The class of every pixel.
    pub fn run(&mut self, _image: RgbView<'_>) -> Result<Mask, PerceptionError> {
        todo!()
    }
}
