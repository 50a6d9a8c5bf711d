//! Trains Fast-SCNN from a dataset folder and writes it as ONNX.
//!
//! The network is told once (`network`) and read three times: to draw first weights, to run on
//! burn's tape, to write ONNX. A batch is shared out over a fixed number of replicas, each with its
//! own thread and batch statistics, whose derivatives are averaged in order: the same options and
//! dataset give the same bytes on one machine, however many cores it has.

mod adam;
mod dataset;
mod export;
mod flex;
mod kernels;
mod network;
mod pictures;
mod random;
mod resample;
mod run;
mod state;
mod tape;
mod weights;

use std::ops::ControlFlow;
use std::path::Path;

use serde::{Deserialize, Serialize};

pub use dataset::{Frame, Split, check_train_ids, image_paths};
pub use network::LOGIT_STRIDE;
pub use pictures::CLASS_WEIGHT_OFFSET;

use crate::{Checkpoint, PerceptionError, Scores};

/// What determines a trained network, together with the dataset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainOptions {
    /// Passes over the training split after which the learning rate would be 0.
    pub horizon: u32,
    /// Seed of first weights, order and augmentation.
    pub seed: u64,
    /// Width of the pictures, pixels; a multiple of 32.
    pub width: usize,
    /// Height of the pictures, pixels; a multiple of 32.
    pub height: usize,
    /// Frames a step; a multiple of `replicas`. What remains of an epoch is left out.
    pub batch: usize,
    /// Threads that share a batch, with batch statistics of their own.
    pub replicas: usize,
    /// Adam's first rate; it decays with power 0.9.
    pub rate: f32,
    /// Stop after so many epochs without a better validation mIoU, and keep the network of the best
    /// epoch. Without it all epochs are done, and the last one's network is kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub patience: Option<u32>,
}

impl Default for TrainOptions {
    fn default() -> Self {
        Self { horizon: 30, seed: 1, width: 256, height: 128, batch: 12, replicas: 2, rate: 2e-3, patience: None }
    }
}

impl TrainOptions {
    /// The learning rate at the begin of an epoch, counted from 1.
    pub fn rate_of(&self, epoch: u32) -> f32 {
        adam::rate(self.rate, u64::from(epoch.saturating_sub(1)), u64::from(self.horizon))
    }
}

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
    fn new(epoch: u32, loss: f64, scores: &Scores) -> Self {
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

/// Trains until `epochs` passes over the split `train` are done or patience is at its end, or until
/// `watch` breaks; then `None` comes back. After every epoch the network is measured on the split `val` and saved at
/// `unfinished`, from where the same call goes on. The caller removes that file when it is no longer
/// needed.
pub fn train(
    dataset: &Path,
    unfinished: &Path,
    options: &TrainOptions,
    epochs: u32,
    watch: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
) -> Result<Option<Trained>, PerceptionError> {
    check(options)?;
    let mut run = run::Run::open(dataset, unfinished, options)?;
    if run.epochs() > epochs {
        let reason = format!(
            "{epochs} epochs, but {} has {} already; expected at least as many, or another file",
            unfinished.display(),
            run.epochs()
        );
        return Err(PerceptionError::TrainOptions { reason });
    }
    if run.announce(watch).is_break() {
        return Ok(None);
    }
    while run.epochs() < epochs && !run.is_out_of_patience() {
        if run.epoch(watch)?.is_break() {
            return Ok(None);
        }
        run.save(unfinished)?;
        if run.report(watch).is_break() {
            return Ok(None);
        }
    }
    run.finish(epochs).map(Some)
}

/// Which training a checkpoint comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// It is what [`train`] would give.
    This,
    /// The same training with another number of epochs.
    OtherEpochs,
    /// Another one, or none that it tells of.
    Foreign,
}

/// Whether a checkpoint comes from [`train`] with these options, this number of epochs and this dataset,
/// by what it tells of itself.
pub fn origin(
    checkpoint: &Checkpoint,
    dataset: &Path,
    options: &TrainOptions,
    epochs: u32,
) -> Result<Origin, PerceptionError> {
    check(options)?;
    let text = checkpoint.recipe().unwrap_or_default();
    let told: serde_json::Value = serde_json::from_str(text).unwrap_or_default();
    let (Some(digest), Some(epoch)) = (told["dataset"].as_str(), told["epochs"].as_u64()) else {
        return Ok(Origin::Foreign);
    };
    // With patience the best epoch is known only afterwards.
    let limit = told["limit"].as_u64().map_or(epochs, |limit| limit as u32);
    let is_known = run::recipe(options, epoch, limit, digest) == text
        && run::digest(&run::read(dataset, options)?).to_hex().as_str() == digest;
    let is_long_enough = if options.patience.is_some() { limit == epochs } else { epoch == u64::from(epochs) };
    Ok(match (is_known, is_long_enough) {
        (false, _) => Origin::Foreign,
        (true, false) => Origin::OtherEpochs,
        (true, true) => Origin::This,
    })
}

fn check(options: &TrainOptions) -> Result<(), PerceptionError> {
    let TrainOptions { width, height, batch, replicas, horizon, patience, .. } = *options;
    let multiple = network::SIDE_MULTIPLE;
    let refuse = |reason| Err(PerceptionError::TrainOptions { reason });
    if width == 0 || height == 0 || width % multiple != 0 || height % multiple != 0 {
        return refuse(format!("size {width}x{height}; expected sides that are multiples of {multiple}"));
    }
    if replicas == 0 || batch < 2 * replicas || batch % replicas != 0 {
        return refuse(format!("batch of {batch} for {replicas} replicas; expected at least 2 frames for each"));
    }
    if horizon == 0 {
        return refuse("a horizon of 0 epochs; expected at least 1".into());
    }
    if patience == Some(0) {
        return refuse("a patience of 0 epochs; expected at least 1".into());
    }
    Ok(())
}

#[cfg(test)]
mod tests;
