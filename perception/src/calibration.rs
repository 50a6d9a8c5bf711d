//! Whether a network is right as often as it says.
//!
//! Pixels are sorted by confidence into 15 ranges of equal width; where the network is well calibrated, the share of
//! the right ones in each is the mean confidence there. The expected calibration error is the mean gap between the
//! two, weighted by pixels (Guo et al. 2017, "On Calibration of Modern Neural Networks"). Everything is counted in
//! integers, so that nothing depends on the order of frames.

use serde::{Deserialize, Serialize};

use crate::Certainty;
use crate::classes::{IGNORE, TRAIN_CLASSES, TRAIN_ID_OF_TAG};

const CLASSES: usize = TRAIN_CLASSES.len();
/// Ranges of confidence.
const BINS: usize = 15;
/// From here on a network is sure.
pub const SURE: f32 = 0.9;
/// What stands for 1 in sums of confidence and entropy.
const ONE: f64 = (1u32 << 20) as f64;

/// Pixels by how sure a network is of them.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Calibration {
    bins: [Bin; BINS],
    /// Entropy of right and of wrong pixels, in parts of [`ONE`].
    right_entropy: u64,
    wrong_entropy: u64,
    /// By true class: all, and those that are wrong though the network is sure.
    pixels: [u64; CLASSES],
    surely_wrong: [u64; CLASSES],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Bin {
    pixels: u64,
    right: u64,
    /// In parts of [`ONE`].
    confidence: u64,
}

/// What a calibration says; shares and means are in [0, 1], NaN of nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Trust {
    /// Expected calibration error.
    pub ece: f64,
    /// Mean confidence.
    pub confidence: f64,
    /// Mean entropy of the pixels that are right, as a share of the greatest (all classes alike).
    pub entropy_if_right: f64,
    /// The same of those that are wrong.
    pub entropy_if_wrong: f64,
    /// Share of the pixels that are wrong with a confidence of [`SURE`] or more.
    pub surely_wrong: f64,
    /// The same by true class, at the index of its train id.
    pub surely_wrong_of: [f64; CLASSES],
    /// The ranges of confidence, from the lowest.
    pub ranges: Vec<Reliability>,
}

/// Pixels whose confidence lies in a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reliability {
    /// How many.
    pub pixels: u64,
    /// Their mean confidence; NaN of none.
    pub confidence: f64,
    /// Share of them that is right; NaN of none.
    pub accuracy: f64,
}

impl Calibration {
    /// Counts a picture in tags; pixels whose truth is not trained count nowhere.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn add(&mut self, truth: &[u8], predicted: &[u8], certainty: &Certainty) {
        let Certainty { confidence, entropy } = certainty;
        let same = [predicted.len(), confidence.len(), entropy.len()].iter().all(|len| *len == truth.len());
        assert!(same, "truth, prediction and certainty must have the same size");
        let sure = confidence.iter().zip(entropy);
        for ((&t, &p), (&confidence, &entropy)) in truth.iter().zip(predicted).zip(sure) {
            let class = TRAIN_ID_OF_TAG[usize::from(t)];
            if class == IGNORE {
                continue;
            }
            let is_right = class == TRAIN_ID_OF_TAG[usize::from(p)];
            let bin = &mut self.bins[((confidence * BINS as f32) as usize).min(BINS - 1)];
            bin.pixels += 1;
            bin.right += u64::from(is_right);
            bin.confidence += (f64::from(confidence) * ONE) as u64;
            *(if is_right { &mut self.right_entropy } else { &mut self.wrong_entropy }) +=
                (f64::from(entropy) * ONE) as u64;
            self.pixels[usize::from(class)] += 1;
            self.surely_wrong[usize::from(class)] += u64::from(!is_right && confidence >= SURE);
        }
    }

    /// Whether nothing was counted.
    pub fn is_empty(&self) -> bool {
        self.pixels.iter().all(|pixels| *pixels == 0)
    }

    /// Adds the counts of another one.
    pub fn merge(&mut self, other: &Self) {
        for (bin, other) in self.bins.iter_mut().zip(&other.bins) {
            bin.pixels += other.pixels;
            bin.right += other.right;
            bin.confidence += other.confidence;
        }
        self.right_entropy += other.right_entropy;
        self.wrong_entropy += other.wrong_entropy;
        let add = |sums: &mut [u64], others: &[u64]| sums.iter_mut().zip(others).for_each(|(sum, more)| *sum += more);
        add(&mut self.pixels, &other.pixels);
        add(&mut self.surely_wrong, &other.surely_wrong);
    }

    /// What the counts say.
    pub fn trust(&self) -> Trust {
        let sum = |of: fn(&Bin) -> u64| self.bins.iter().map(of).sum::<u64>() as f64;
        let (pixels, right) = (sum(|bin| bin.pixels), sum(|bin| bin.right));
        let gap = |bin: &Bin| (bin.right as f64 - bin.confidence as f64 / ONE).abs();
        let share = |class: usize| self.surely_wrong[class] as f64 / self.pixels[class] as f64;
        Trust {
            ece: self.bins.iter().map(gap).sum::<f64>() / pixels,
            confidence: sum(|bin| bin.confidence) / ONE / pixels,
            entropy_if_right: self.right_entropy as f64 / ONE / right,
            entropy_if_wrong: self.wrong_entropy as f64 / ONE / (pixels - right),
            surely_wrong: self.surely_wrong.iter().sum::<u64>() as f64 / pixels,
            surely_wrong_of: std::array::from_fn(share),
            ranges: self.bins.iter().map(Bin::reliability).collect(),
        }
    }
}

impl Bin {
    fn reliability(&self) -> Reliability {
        let of = |sum: f64| sum / self.pixels as f64;
        let (confidence, accuracy) = (of(self.confidence as f64 / ONE), of(self.right as f64));
        Reliability { pixels: self.pixels, confidence, accuracy }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROAD: u8 = 7;
    const WALKER: u8 = 4;
    const GROUND: u8 = 14;

    fn certainty(confidence: &[f32]) -> Certainty {
        Certainty { confidence: confidence.to_vec(), entropy: confidence.iter().map(|c| 1.0 - c).collect() }
    }

    #[test]
    fn a_case_done_by_hand() {
        let mut calibration = Calibration::default();
        // Two in the highest range (mean 0.96, half of them right), two around 0.5 (both right), one that does not count.
        let sure = certainty(&[0.96, 0.96, 0.5, 0.5, 1.0]);
        calibration.add(&[WALKER, ROAD, ROAD, WALKER, GROUND], &[ROAD, ROAD, ROAD, WALKER, ROAD], &sure);
        let trust = calibration.trust();
        let near = |a: f64, b: f64| (a - b).abs() < 1e-5;
        assert!(near(trust.ece, 0.5 * (0.96 - 0.5) + 0.5 * (1.0 - 0.5)), "{trust:?}");
        assert!(near(trust.confidence, 0.73) && near(trust.surely_wrong, 0.25));
        assert!(near(trust.entropy_if_wrong, 0.04) && near(trust.entropy_if_right, (0.04 + 0.5 + 0.5) / 3.0));
        assert_eq!((trust.surely_wrong_of[2], trust.ranges[14].pixels), (0.5, 2));
        assert!(trust.surely_wrong_of[0].is_nan() && trust.ranges[0].accuracy.is_nan());
    }

    #[test]
    fn who_is_right_as_often_as_said_has_no_error_and_parts_make_a_whole() {
        let (truth, predicted) = ([ROAD; 8], [ROAD, ROAD, ROAD, WALKER, ROAD, ROAD, ROAD, WALKER]);
        let count = |range: std::ops::Range<usize>| {
            let mut calibration = Calibration::default();
            let sure = certainty(&vec![0.75; range.len()]);
            calibration.add(&truth[range.clone()], &predicted[range], &sure);
            calibration
        };
        let (whole, mut parts) = (count(0..8), count(0..3));
        assert_eq!(whole.trust().ece, 0.0);
        assert!(parts.trust().ece > 0.2, "three of three are right");
        parts.merge(&count(3..8));
        assert_eq!(parts, whole);
    }

    #[test]
    fn nothing_counted_is_nan() {
        let mut calibration = Calibration::default();
        calibration.add(&[GROUND], &[ROAD], &certainty(&[1.0]));
        let trust = calibration.trust();
        assert!(trust.ece.is_nan() && trust.surely_wrong.is_nan() && trust.entropy_if_wrong.is_nan());
    }
}
