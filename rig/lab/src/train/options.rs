//! What may be chosen.

use std::path::PathBuf;

use perception::training::Preset;

/// What is learned from, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Dataset folder.
    pub dataset: PathBuf,
    /// Where the checkpoint goes.
    pub out: PathBuf,
    /// Passes over the training split.
    pub epochs: u32,
    /// Seed of weights, order and augmentation.
    pub seed: u64,
    /// Size at which the network is trained.
    pub size: (u32, u32),
    /// Epochs after which the learning rate would be 0 (default: `--epochs`). A larger one makes a
    /// training that is stopped early, and that can go on later.
    pub horizon: Option<u32>,
    /// Stop after so many epochs without a better validation mIoU, and keep the best epoch's network
    /// instead of the last one's.
    pub patience: Option<u32>,
    /// Frames a step.
    pub batch: u32,
    /// Threads that share a batch; the result depends on their number, not on the machine's.
    pub replicas: u32,
    /// First learning rate.
    pub rate: f32,
    /// Looks of the pictures, and how often what is rare is shown.
    pub preset: Preset,
    /// People less high than this, pixels of the network's input, count nowhere, instead of what the preset has.
    pub min_height_px: Option<u32>,
}
