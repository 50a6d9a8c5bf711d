//! How far a checkpoint's certainty can be believed, as it is printed and written.

use std::collections::BTreeMap;

use perception::classes::{PEDESTRIAN, TRAIN_CLASSES};
use perception::{Calibration, Reliability};
use serde::Serialize;

/// Figures of a calibration over pixels; shares and means are in [0, 1], null of nothing.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trust {
    /// Expected calibration error over 15 ranges of confidence (Guo et al. 2017): how far, on average, the share of right
    /// pixels is from the confidence.
    pub ece: Option<f64>,
    /// Mean confidence, to be compared with the accuracy.
    pub confidence: Option<f64>,
    /// Mean entropy of the pixels that are right, as a share of the greatest there can be.
    pub entropy_if_right: Option<f64>,
    /// The same of those that are wrong; where it is no higher, entropy warns of nothing.
    pub entropy_if_wrong: Option<f64>,
    /// Share of the pixels that are wrong with a confidence of 0.9 or more.
    pub surely_wrong: Option<f64>,
    /// The same of the pixels of each true class.
    pub surely_wrong_of: BTreeMap<&'static str, Option<f64>>,
    /// The reliability diagram: ranges of confidence of equal width from 0 to 1.
    pub ranges: Vec<Bin>,
}

/// The pixels whose confidence lies in a range.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bin {
    /// How many.
    pub pixels: u64,
    /// Their mean confidence.
    pub confidence: Option<f64>,
    /// Share of them that is right.
    pub accuracy: Option<f64>,
}

impl Trust {
    /// That of a calibration; `None` of an empty one, as that of a checkpoint that gives classes only.
    pub fn of(calibration: &Calibration) -> Option<Self> {
        if calibration.is_empty() {
            return None;
        }
        let trust = calibration.trust();
        let bin = |range: &Reliability| Bin {
            pixels: range.pixels,
            confidence: number(range.confidence),
            accuracy: number(range.accuracy),
        };
        let of_classes = TRAIN_CLASSES.iter().zip(trust.surely_wrong_of);
        Some(Self {
            ece: number(trust.ece),
            confidence: number(trust.confidence),
            entropy_if_right: number(trust.entropy_if_right),
            entropy_if_wrong: number(trust.entropy_if_wrong),
            surely_wrong: number(trust.surely_wrong),
            surely_wrong_of: of_classes.map(|(class, share)| (class.name, number(share))).collect(),
            ranges: trust.ranges.iter().map(bin).collect(),
        })
    }

    /// Share of the pixels of pedestrians that are wrong with a confidence of 0.9 or more.
    pub fn surely_wrong_of_people(&self) -> Option<f64> {
        self.surely_wrong_of[TRAIN_CLASSES[PEDESTRIAN].name]
    }
}

fn number(value: f64) -> Option<f64> {
    Some(value).filter(|value| !value.is_nan())
}
