//! What one trains with.

use serde::{Deserialize, Serialize};

use super::light::Looks;
use super::sampling::Sampling;
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
    /// How pictures are changed beyond what every training does.
    #[serde(default, skip_serializing_if = "Looks::is_none")]
    pub looks: Looks,
    /// How what is rare is shown more often.
    #[serde(default, skip_serializing_if = "Sampling::is_none")]
    pub sampling: Sampling,
}

/// Looks and sampling under a name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// Neither, as the bundled networks were trained.
    #[default]
    Plain,
    /// People and what else is rare more often, under many looks.
    People,
}

impl Preset {
    /// Every one.
    pub const ALL: [Self; 2] = [Self::Plain, Self::People];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::People => "people",
        }
    }

    /// What it stands for.
    pub fn choice(self) -> (Looks, Sampling) {
        match self {
            Self::Plain => (Looks::default(), Sampling::default()),
            Self::People => (Looks::WIDE, Sampling::PEOPLE),
        }
    }
}

impl Default for TrainOptions {
    fn default() -> Self {
        let (looks, sampling) = Preset::default().choice();
        Self {
            horizon: 30,
            seed: 1,
            width: 256,
            height: 128,
            batch: 12,
            replicas: 2,
            rate: 2e-3,
            patience: None,
            looks,
            sampling,
        }
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
        match self.looks.refused().or_else(|| self.sampling.refused()) {
            Some(reason) => refuse(reason),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_of_before_there_were_looks_and_sampling_are_read_and_written_as_they_were() {
        let text = r#"{"horizon":30,"seed":1,"width":256,"height":128,"batch":12,"replicas":2,"rate":0.002}"#;
        let read: TrainOptions = serde_json::from_str(text).unwrap();
        assert_eq!(read, TrainOptions::default());
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
        let (looks, sampling) = Preset::People.choice();
        let people = TrainOptions { looks, sampling, ..read };
        let again: TrainOptions = serde_json::from_str(&serde_json::to_string(&people).unwrap()).unwrap();
        assert_eq!(again, people);
    }
}
