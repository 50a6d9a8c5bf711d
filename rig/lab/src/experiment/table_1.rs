//! Table 1 of the paper: how good networks are that learned from different data, on the frames before
//! takeovers and on ordinary ones.

use measures::stats;
use perception::ConfusionMatrix;
use perception::classes::PEDESTRIAN;
use serde::Serialize;

use super::set::Set;

/// Seed of the draws of networks and scenes.
const BOOTSTRAP_SEED: u64 = 1;

/// A network on a test: the confusion matrix of each scene.
pub type Scenes = Vec<ConfusionMatrix>;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Metric {
    PedestrianIou,
    MeanIou,
}

impl Metric {
    /// Over some of the scenes; NaN where there is nothing to measure.
    fn of(self, scenes: &Scenes, chosen: impl Iterator<Item = usize>) -> f64 {
        let mut sum = ConfusionMatrix::default();
        chosen.for_each(|scene| sum.merge(&scenes[scene]));
        match self {
            Self::PedestrianIou => sum.scores().iou[PEDESTRIAN],
            Self::MeanIou => sum.scores().miou,
        }
    }
}

/// A figure of Table 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Mean over the trainings; absent where there is nothing to measure.
    pub mean: Option<f64>,
    /// Of each training, in the order of their seeds.
    pub trainings: Vec<Option<f64>>,
    /// Mean minus that of the networks that learned from natural data; absent for these.
    pub gain: Option<f64>,
    /// 95 % interval of the gain: trainings (pairs of the same seed) and scenes are drawn again, the same for
    /// both.
    pub gain_95: Option<(f64, f64)>,
}

/// The figures of a test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TestScores {
    /// IoU of pedestrians.
    pub pedestrian_iou: Score,
    /// Mean IoU of the classes.
    pub miou: Score,
}

/// A row of Table 1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What the networks learned from.
    pub set: Set,
    /// Mean pedestrian pixels of a frame of it.
    pub pedestrian_pixels_per_frame: f64,
    /// On the frames before takeovers.
    pub safety_critical: TestScores,
    /// On ordinary frames.
    pub natural: TestScores,
}

/// What the networks of a set came to on one test, a training each.
type Trainings = Vec<Scenes>;

/// Scores of one set's networks on one test beside those of the natural set's.
pub fn test_scores(natural: &Trainings, set: &Trainings, is_natural: bool) -> TestScores {
    let reference = (!is_natural).then_some(natural);
    TestScores {
        pedestrian_iou: score(Metric::PedestrianIou, reference, set),
        miou: score(Metric::MeanIou, reference, set),
    }
}

fn score(metric: Metric, reference: Option<&Trainings>, set: &Trainings) -> Score {
    let scenes = set.first().map_or(0, Vec::len);
    let whole = |networks: &Trainings| mean(networks.iter().map(|network| metric.of(network, 0..scenes)));
    let drawn = |networks: &Trainings, draw| {
        let trainings = stats::resample(BOOTSTRAP_SEED, draw, 0, networks.len());
        mean(trainings.map(|i| metric.of(&networks[i], stats::resample(BOOTSTRAP_SEED, draw, 1, scenes))))
    };
    let gain_95 = reference.and_then(|other| stats::percentile_interval(|draw| drawn(set, draw) - drawn(other, draw)));
    Score {
        mean: finite(whole(set)),
        trainings: set.iter().map(|network| finite(metric.of(network, 0..scenes))).collect(),
        gain: reference.and_then(|other| finite(whole(set) - whole(other))),
        gain_95,
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (count, sum) = values.fold((0, 0.0), |(count, sum), value| (count + 1, sum + value));
    sum / f64::from(count)
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use perception::classes::PEDESTRIAN_TAG;

    use super::*;

    const ROAD: u8 = 7;

    /// A scene of eight pixels of walkers, of which so many are found.
    fn scene(found: usize) -> ConfusionMatrix {
        let mut matrix = ConfusionMatrix::default();
        let predicted: Vec<u8> = (0..8).map(|i| if i < found { PEDESTRIAN_TAG } else { ROAD }).collect();
        matrix.add(&[PEDESTRIAN_TAG; 8], &predicted);
        matrix
    }

    #[test]
    fn a_gain_in_every_scene_and_training_is_sure() {
        let natural = vec![vec![scene(2), scene(3)], vec![scene(2), scene(3)]];
        let better = vec![vec![scene(4), scene(5)], vec![scene(4), scene(5)]];
        let score = test_scores(&natural, &better, false).pedestrian_iou;
        assert_eq!((score.mean, score.gain), (Some(9.0 / 16.0), Some(4.0 / 16.0)));
        assert_eq!(score.gain_95, Some((0.25, 0.25)), "scenes are drawn in pairs");
        let alone = test_scores(&natural, &natural, true).pedestrian_iou;
        assert_eq!((alone.mean, alone.gain, alone.gain_95), (Some(5.0 / 16.0), None, None));
    }

    #[test]
    fn a_gain_of_one_training_in_two_is_not() {
        let natural = vec![vec![scene(4); 4]; 2];
        let mixed = vec![vec![scene(8); 4], vec![scene(2); 4]];
        let (low, high) = test_scores(&natural, &mixed, false).pedestrian_iou.gain_95.expect("an interval");
        assert!(low < 0.0 && high > 0.0, "{low} {high}");
    }

    #[test]
    fn nothing_to_measure_is_null() {
        let empty = vec![vec![ConfusionMatrix::default()]];
        let score = test_scores(&empty, &empty, false).pedestrian_iou;
        assert_eq!((score.mean, score.gain, score.gain_95), (None, None, None));
    }
}
