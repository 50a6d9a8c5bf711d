//! What a training tells of itself, on its way and at its end.

use crate::Scores;

/// What an epoch came to.
#[derive(Clone, Debug, PartialEq)]
pub struct EpochReport {
    /// Passes over the training split so far.
    pub epoch: u32,
    /// Mean loss over the epoch's steps.
    pub loss: f64,
    /// Mean of the classes' IoU on the validation split.
    pub miou: Option<f64>,
    /// IoU on the validation split by train id; absent where a class neither appears nor is
    /// predicted.
    pub iou: Vec<Option<f64>>,
}

impl EpochReport {
    pub(super) fn new(epoch: u32, loss: f64, scores: &Scores) -> Self {
        let known = |v: f64| (!v.is_nan()).then_some(v);
        Self { epoch, loss, miou: known(scores.miou), iou: scores.iou.map(known).to_vec() }
    }
}

/// What happens while training.
#[derive(Clone, Copy, Debug)]
pub enum Progress<'a> {
    /// The dataset is in memory, and training goes on after `epochs` finished epochs.
    Loaded {
        /// Frames to learn from.
        train: usize,
        /// Frames to measure on.
        val: usize,
        /// Of the unfinished training that was found.
        epochs: u32,
        /// Of an epoch.
        steps: usize,
    },
    /// A step of the current epoch is done.
    Step {
        /// Steps of this epoch so far.
        step: usize,
        /// Of this step.
        loss: f64,
    },
    /// An epoch is done, measured and saved.
    Epoch(&'a EpochReport),
}

/// A network with its history.
#[derive(Clone, Debug)]
pub struct Trained {
    /// The ONNX file.
    pub onnx: Vec<u8>,
    /// The epoch whose network it is, counted from 1.
    pub epoch: u32,
    /// Whether more epochs would change nothing: the horizon is reached, or patience is at its end.
    pub is_final: bool,
    /// One report an epoch.
    pub history: Vec<EpochReport>,
    /// BLAKE3 over both splits.
    pub dataset: blake3::Hash,
    /// Frames learned from.
    pub train_frames: usize,
    /// Frames measured on.
    pub val_frames: usize,
    /// How many numbers were learned.
    pub parameters: usize,
}
