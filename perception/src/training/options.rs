//! What one trains with.

use serde::{Deserialize, Serialize};

use super::{adam, network};
use crate::PerceptionError;

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

    /// Refuses what no training can be made of.
    pub(super) fn check(&self) -> Result<(), PerceptionError> {
        let TrainOptions { width, height, batch, replicas, horizon, patience, .. } = *self;
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
}
