//! Intersection over union from one global confusion matrix of integers.
//!
//! As in cityscapesscripts: `TP / (TP + FP + FN)` per class over all pixels of all images, pixels
//! with an ignored ground truth count nowhere, and a class that neither appears nor is predicted
//! is NaN and left out of the mean.

use serde::{Deserialize, Serialize};

use crate::classes::{IGNORE, TRAIN_CLASSES, TRAIN_ID_OF_TAG};

const CLASSES: usize = TRAIN_CLASSES.len();
/// Predictions of a class that is not trained: wrong for the true class, nobody's false positive.
const ELSEWHERE: usize = CLASSES;

/// Pixels by true and predicted class; serialised as its rows.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ConfusionMatrix {
    counts: [[u64; CLASSES + 1]; CLASSES],
}

/// What a confusion matrix says, by train id.
#[derive(Clone, Debug, PartialEq)]
pub struct Scores {
    /// IoU of each class in [0, 1], at the index of its train id; NaN for an absent class.
    pub iou: [f64; CLASSES],
    /// Mean of those that are not NaN; NaN when all are.
    pub miou: f64,
    /// Share of correct pixels among those that count; NaN when none do.
    pub accuracy: f64,
    /// Pixels that count.
    pub pixels: u64,
}

impl Default for ConfusionMatrix {
    fn default() -> Self {
        Self { counts: [[0; CLASSES + 1]; CLASSES] }
    }
}

impl ConfusionMatrix {
    /// Counts one image of tag ids; `truth` and `predicted` must be equally long.
    ///
    /// # Panics
    /// If they are not.
    pub fn add(&mut self, truth: &[u8], predicted: &[u8]) {
        assert_eq!(truth.len(), predicted.len(), "truth and prediction must have the same size");
        for (&t, &p) in truth.iter().zip(predicted) {
            let t = TRAIN_ID_OF_TAG[usize::from(t)];
            if t != IGNORE {
                let p = usize::from(TRAIN_ID_OF_TAG[usize::from(p)]).min(ELSEWHERE);
                self.counts[usize::from(t)][p] += 1;
            }
        }
    }

    /// Adds the counts of another matrix.
    pub fn merge(&mut self, other: &Self) {
        for (row, other) in self.counts.iter_mut().zip(&other.counts) {
            for (count, other) in row.iter_mut().zip(other) {
                *count += other;
            }
        }
    }

    /// Pixels of true class `truth` that were predicted as `predicted`, both train ids.
    pub fn count(&self, truth: u8, predicted: u8) -> u64 {
        self.counts[usize::from(truth)][usize::from(predicted)]
    }

    /// A row for each true class, in it the pixels by predicted class; the last number is of classes
    /// that are not trained.
    pub fn rows(&self) -> &[[u64; TRAIN_CLASSES.len() + 1]] {
        &self.counts
    }

    /// Pixels whose true class has this train id.
    pub fn truth_pixels(&self, train_id: u8) -> u64 {
        self.counts[usize::from(train_id)].iter().sum()
    }

    /// IoU of one class, by train id; NaN when it neither appears nor is predicted.
    pub fn iou(&self, train_id: u8) -> f64 {
        let class = usize::from(train_id);
        let hit = self.counts[class][class];
        let predicted: u64 = self.counts.iter().map(|row| row[class]).sum();
        hit as f64 / (self.truth_pixels(train_id) + predicted - hit) as f64
    }

    /// All scores at once.
    pub fn scores(&self) -> Scores {
        let iou: [f64; CLASSES] = std::array::from_fn(|class| self.iou(class as u8));
        let present: Vec<f64> = iou.iter().copied().filter(|v| !v.is_nan()).collect();
        let pixels = self.counts.iter().flatten().sum();
        let hits: u64 = (0..CLASSES).map(|class| self.counts[class][class]).sum();
        Scores {
            iou,
            miou: present.iter().sum::<f64>() / present.len() as f64,
            accuracy: hits as f64 / pixels as f64,
            pixels,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classes::{TAGS, tag_of_train_id, train_id};

    const ROAD: u8 = 7;
    const LINE: u8 = 6;
    const WALKER: u8 = 4;
    const GROUND: u8 = 14;

    fn matrix(truth: &[u8], predicted: &[u8]) -> ConfusionMatrix {
        let mut matrix = ConfusionMatrix::default();
        matrix.add(truth, predicted);
        matrix
    }

    #[test]
    fn a_case_done_by_hand() {
        // Road: 2 hits, 1 false positive, 1 false negative. Line: 0 hits, 1 of each.
        let scores = matrix(&[ROAD, ROAD, ROAD, LINE, GROUND], &[ROAD, ROAD, LINE, ROAD, ROAD]).scores();
        let of = |tag| scores.iou[usize::from(train_id(tag).unwrap())];
        assert_eq!(of(ROAD), 0.5);
        assert_eq!(of(LINE), 0.0);
        assert!(of(WALKER).is_nan());
        assert_eq!(scores.miou, 0.25);
        assert_eq!(scores.pixels, 4);
        assert_eq!(scores.accuracy, 0.5);
    }

    #[test]
    fn a_prediction_of_an_untrained_class_is_a_miss_only() {
        let matrix = matrix(&[ROAD, ROAD], &[ROAD, GROUND]);
        assert_eq!(matrix.scores().miou, 0.5);
        assert_eq!(matrix.truth_pixels(train_id(ROAD).unwrap()), 2);
    }

    #[test]
    fn nothing_counted_is_nan() {
        let scores = matrix(&[GROUND; 3], &[ROAD; 3]).scores();
        assert!(scores.miou.is_nan() && scores.accuracy.is_nan());
        assert_eq!(scores.pixels, 0);
    }

    /// The definition, class by class, without a matrix.
    fn oracle(truth: &[u8], predicted: &[u8], class: u8) -> f64 {
        let tag = tag_of_train_id(class);
        let counted = || truth.iter().zip(predicted).filter(|(t, _)| train_id(**t).is_some());
        let both = counted().filter(|(t, p)| **t == tag && **p == tag).count();
        let either = counted().filter(|(t, p)| **t == tag || **p == tag).count();
        both as f64 / either as f64
    }

    #[test]
    fn agrees_with_the_definition_on_random_images_and_merges() {
        let mut state = 1u64;
        let mut tags = |n: usize| -> Vec<u8> {
            let mut next = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                ((state >> 33) % TAGS as u64) as u8
            };
            (0..n).map(|_| next()).collect()
        };
        for n in [1, 7, 500] {
            let (t, p) = (tags(n), tags(n));
            let mut halves = matrix(&t[..n / 2], &p[..n / 2]);
            halves.merge(&matrix(&t[n / 2..], &p[n / 2..]));
            assert_eq!(halves, matrix(&t, &p));
            for class in 0..CLASSES as u8 {
                let (got, expected) = (halves.iou(class), oracle(&t, &p, class));
                assert!(got == expected || got.is_nan() && expected.is_nan(), "class {class}: {got} {expected}");
            }
        }
    }
}
