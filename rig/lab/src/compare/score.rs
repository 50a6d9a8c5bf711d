//! What a checkpoint made of a case, in numbers.

use perception::classes::{IGNORE, PEDESTRIAN_TAG, TRAIN_ID_OF_TAG};
use perception::{Calibration, Certainty, ConfusionMatrix, Mask};
use render::{Frame, SemanticTag};
use serde::{Deserialize, Serialize};

use super::witness::Facts;

/// A hazard is seen in a frame when at least this share of its visible pixels has the right class...
const SEEN_SHARE: f64 = 0.5;
/// ... and at least so many pixels of it are visible: what is smaller is seen by chance.
const VISIBLE_PIXELS: u64 = 8;

/// Pixels with the right class, of how many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hits {
    /// With the right class.
    pub right: u64,
    /// All.
    pub of: u64,
}

impl Hits {
    /// Counts a pixel.
    pub fn count(&mut self, is_right: bool) {
        self.right += u64::from(is_right);
        self.of += 1;
    }

    fn add(&mut self, other: Self) {
        self.right += other.right;
        self.of += other.of;
    }

    /// Whether there are enough pixels to see it by.
    pub fn is_visible(self) -> bool {
        self.of >= VISIBLE_PIXELS
    }

    /// Whether it is visible and seen as what it is.
    pub fn is_seen(self) -> bool {
        self.is_visible() && self.right as f64 >= SEEN_SHARE * self.of as f64
    }

    /// The share with the right class; `None` of none.
    pub fn share(self) -> Option<f64> {
        (self.of > 0).then(|| self.right as f64 / self.of as f64)
    }
}

/// A frame, as far as it is told apart from the others of its case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameScore {
    /// Pixels of people and vehicles, true or predicted, that are wrong.
    pub wrong: u64,
    /// Pixels of the hazard.
    pub hazard: Hits,
}

/// A case.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaseScore {
    /// Pixels of all frames by true and predicted class.
    pub matrix: ConfusionMatrix,
    /// Pixels by how sure the checkpoint is of them; empty where it gives classes only.
    pub calibration: Calibration,
    /// Pixels of the people on the ego car's path, in all frames.
    pub people_on_path: Hits,
    /// Each frame.
    pub frames: Vec<FrameScore>,
}

impl CaseScore {
    /// Adds the next frame and what the checkpoint made of it.
    pub fn add(&mut self, other: &Self) {
        self.matrix.merge(&other.matrix);
        self.calibration.merge(&other.calibration);
        self.people_on_path.add(other.people_on_path);
        self.frames.extend(&other.frames);
    }

    /// That of a single frame.
    pub fn of_frame(frame: &Frame, mask: &Mask, certainty: Option<&Certainty>, facts: &Facts) -> Self {
        let mut score = Self::default();
        score.matrix.add(&frame.class_ids, &mask.ids);
        if let Some(certainty) = certainty {
            score.calibration.add(&frame.class_ids, &mask.ids, certainty);
        }
        let hazard = facts.hazard.as_ref().map(|hazard| hazard.instance);
        let mut own = FrameScore::default();
        for ((&truth, &predicted), &instance) in frame.class_ids.iter().zip(&mask.ids).zip(&frame.instance_ids) {
            let is_right = truth == predicted;
            let counts = TRAIN_ID_OF_TAG[usize::from(truth)] != IGNORE;
            own.wrong += u64::from(!is_right && counts && (is_road_user(truth) || is_road_user(predicted)));
            if instance == 0 {
                continue;
            }
            if hazard == Some(instance) {
                own.hazard.count(is_right);
            }
            if truth == PEDESTRIAN_TAG && facts.people_on_path.contains(&instance) {
                score.people_on_path.count(is_right);
            }
        }
        score.frames.push(own);
        score
    }

    /// Whether there is a hazard in any frame that could be seen.
    pub fn has_visible_hazard(&self) -> bool {
        self.frames.iter().any(|frame| frame.hazard.is_visible())
    }

    /// Number of the first frame in which the hazard is seen.
    pub fn first_seen(&self) -> Option<usize> {
        self.frames.iter().position(|frame| frame.hazard.is_seen())
    }
}

fn is_road_user(tag: u8) -> bool {
    tag == PEDESTRIAN_TAG || tag == SemanticTag::Vehicles as u8
}

#[cfg(test)]
mod tests {
    use super::super::witness::Hazard;
    use super::*;

    const ROAD: u8 = SemanticTag::Road as u8;

    /// A row of pixels: 4 of person 5, 8 of person 9, 4 of road.
    fn frame() -> Frame {
        let class_ids = [vec![PEDESTRIAN_TAG; 12], vec![ROAD; 4]].concat();
        let instance_ids = [vec![5; 4], vec![9; 8], vec![0; 4]].concat();
        Frame { width: 16, height: 1, class_ids, instance_ids, ..Frame::default() }
    }

    fn score(predicted: Vec<u8>) -> CaseScore {
        let hazard = Some(Hazard { instance: 9, what: "pedestrian 9".into() });
        let facts = Facts { ticks: vec![0], hazard, people_on_path: vec![5, 9], other_kernel: None };
        CaseScore::of_frame(&frame(), &Mask::new(16, 1, predicted).expect("16 pixels"), None, &facts)
    }

    #[test]
    fn pixels_are_counted_by_whose_they_are() {
        let predicted = [vec![ROAD; 6], vec![PEDESTRIAN_TAG; 8], vec![ROAD; 2]].concat();
        let score = score(predicted);
        assert_eq!(score.people_on_path, Hits { right: 6, of: 12 });
        assert_eq!(score.frames, [FrameScore { wrong: 8, hazard: Hits { right: 6, of: 8 } }]);
    }

    #[test]
    fn seen_is_half_of_what_is_visible() {
        let first = |right: usize| {
            let mut case = score(vec![ROAD; 16]);
            case.add(&score([vec![ROAD; 4], vec![PEDESTRIAN_TAG; right], vec![ROAD; 12 - right]].concat()));
            case.first_seen()
        };
        assert_eq!((first(3), first(4), first(8)), (None, Some(1), Some(1)));
        assert!(!Hits { right: 7, of: 7 }.is_seen(), "too small to tell");
    }
}
