//! The figures by which checkpoints are compared, over any choice of cases.

use std::fmt;
use std::str::FromStr;

use kernel::time::TICK_HZ;
use perception::classes::{PEDESTRIAN, TRAIN_CLASSES};
use serde::{Serialize, Serializer};

use super::score::{CaseScore, Hits};
use super::witness::Facts;

/// A hazard is seen in time when it is seen at least so long before the intervention, seconds.
pub const IN_TIME_S: f64 = 1.0;

const CLASSES: usize = TRAIN_CLASSES.len();

/// A figure of a checkpoint over cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// IoU of pedestrians, from one confusion matrix of all frames.
    PedIou,
    /// Mean IoU over the classes that appear, from the same matrix.
    Miou,
    /// Share of the pixels of people on the ego car's path that are predicted as pedestrian.
    PedRecallOnPath,
    /// Share of the hazards that are seen in time.
    HazardsSeen,
    /// Time from the first frame in which a hazard is seen to the intervention, mean over hazards; 0 if it
    /// never is. Seconds.
    FirstSight,
    /// Expected calibration error: how far the share of right pixels is from the confidence. Less is better.
    Ece,
    /// Share of the pixels that are wrong with a confidence of 0.9 or more. Less is better.
    SurelyWrong,
    /// The same of the pixels of pedestrians.
    PedSurelyWrong,
    /// Number of cases whose hazard this checkpoint sees in time and the baseline does not.
    Fixed,
    /// The other way round.
    Broken,
}

impl Metric {
    /// Every one.
    pub const ALL: [Self; 10] = [
        Self::PedIou,
        Self::Miou,
        Self::PedRecallOnPath,
        Self::HazardsSeen,
        Self::FirstSight,
        Self::Ece,
        Self::SurelyWrong,
        Self::PedSurelyWrong,
        Self::Fixed,
        Self::Broken,
    ];

    /// Those of a checkpoint alone; greater is better.
    pub const OWN: [Self; 5] = [Self::PedIou, Self::Miou, Self::PedRecallOnPath, Self::HazardsSeen, Self::FirstSight];

    /// Those of how far a checkpoint's certainty can be believed; less is better.
    pub const OF_TRUST: [Self; 3] = [Self::Ece, Self::SurelyWrong, Self::PedSurelyWrong];

    /// As gates and JSON have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::PedIou => "ped_iou",
            Self::Miou => "miou",
            Self::PedRecallOnPath => "ped_recall_on_path",
            Self::HazardsSeen => "hazards_seen",
            Self::FirstSight => "first_sight_s",
            Self::Ece => "ece",
            Self::SurelyWrong => "surely_wrong",
            Self::PedSurelyWrong => "ped_surely_wrong",
            Self::Fixed => "fixed",
            Self::Broken => "broken",
        }
    }

    /// As tables have it.
    pub fn title(self) -> &'static str {
        match self {
            Self::PedIou => "pedestrian IoU",
            Self::Miou => "mean IoU",
            Self::PedRecallOnPath => "pedestrian recall on path",
            Self::HazardsSeen => "hazards seen in time",
            Self::FirstSight => "first sight before, s",
            Self::Ece => "calibration error",
            Self::SurelyWrong => "surely wrong",
            Self::PedSurelyWrong => "pedestrians surely wrong",
            Self::Fixed => "fixed",
            Self::Broken => "broken",
        }
    }

    /// The figure over the cases with these numbers, which may repeat; `None` where nothing is to be
    /// counted, for figures of trust, and for those that need a baseline.
    pub fn of(self, cases: &[CaseSums], numbers: &[usize]) -> Option<f64> {
        let chosen = || numbers.iter().map(|number| &cases[*number]);
        match self {
            Self::PedIou => iou(chosen(), PEDESTRIAN),
            Self::Miou => mean((0..CLASSES).filter_map(|class| iou(chosen(), class))),
            Self::PedRecallOnPath => {
                let sum = |of: fn(&Hits) -> u64| chosen().map(|case| of(&case.people_on_path)).sum();
                Hits { right: sum(|hits| hits.right), of: sum(|hits| hits.of) }.share()
            }
            Self::HazardsSeen => {
                mean(chosen().filter_map(|case| case.sight_s.map(|s| f64::from(u8::from(in_time(s))))))
            }
            Self::FirstSight => mean(chosen().filter_map(|case| case.sight_s)),
            Self::Ece | Self::SurelyWrong | Self::PedSurelyWrong | Self::Fixed | Self::Broken => None,
        }
    }
}

impl fmt::Display for Metric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Metric {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|metric| metric.name() == text);
        found.ok_or_else(|| format!("no metric {text:?}; expected one of {}", Self::ALL.map(Self::name).join(", ")))
    }
}

impl Serialize for Metric {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// What counts of a case for a checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseSums {
    /// By train id: pixels that are right, and pixels that are true or predicted.
    classes: [Hits; CLASSES],
    people_on_path: Hits,
    /// Time from the first frame in which the hazard is seen to the intervention, seconds; 0 if it never is.
    /// `None` where there is no hazard to see.
    pub sight_s: Option<f64>,
}

impl CaseSums {
    /// Those of a case.
    pub fn of(facts: &Facts, score: &CaseScore) -> Self {
        let last = facts.ticks.last().copied().unwrap_or_default();
        let before_s = |frame: usize| (last - facts.ticks[frame]) as f64 / f64::from(TICK_HZ);
        let sight_s = score.has_visible_hazard().then(|| score.first_seen().map_or(0.0, before_s));
        let class = |id: usize| {
            let (id, right) = (id as u8, score.matrix.count(id as u8, id as u8));
            let predicted: u64 = (0..CLASSES).map(|truth| score.matrix.count(truth as u8, id)).sum();
            Hits { right, of: score.matrix.truth_pixels(id) + predicted - right }
        };
        Self { classes: std::array::from_fn(class), people_on_path: score.people_on_path, sight_s }
    }
}

/// Whether a hazard is seen in time, by how long before the intervention it is seen.
pub fn in_time(sight_s: f64) -> bool {
    sight_s >= IN_TIME_S
}

fn iou<'a>(cases: impl Iterator<Item = &'a CaseSums>, class: usize) -> Option<f64> {
    let add = |sum: Hits, case: &CaseSums| {
        let Hits { right, of } = case.classes[class];
        Hits { right: sum.right + right, of: sum.of + of }
    };
    cases.fold(Hits::default(), add).share()
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use perception::ConfusionMatrix;
    use proptest::prelude::*;

    use super::*;

    fn case(truth: &[u8], predicted: &[u8]) -> CaseSums {
        let mut matrix = ConfusionMatrix::default();
        matrix.add(truth, predicted);
        let facts = Facts { ticks: vec![0], hazard: None, people_on_path: vec![], other_kernel: None };
        CaseSums::of(&facts, &CaseScore { matrix, ..CaseScore::default() })
    }

    proptest! {
        #[test]
        fn ious_are_those_of_one_matrix_over_the_chosen_cases(
            pixels in prop::collection::vec(prop::collection::vec((0u8..23, 0u8..23), 1..60), 1..6),
            picks in prop::collection::vec(0usize..6, 1..8),
        ) {
            let split: Vec<(Vec<u8>, Vec<u8>)> = pixels.iter().map(|case| case.iter().copied().unzip()).collect();
            let cases: Vec<CaseSums> = split.iter().map(|(truth, predicted)| case(truth, predicted)).collect();
            let numbers: Vec<usize> = picks.iter().map(|pick| pick % cases.len()).collect();
            let mut matrix = ConfusionMatrix::default();
            numbers.iter().for_each(|number| matrix.add(&split[*number].0, &split[*number].1));
            let scores = matrix.scores();
            let same = |got: Option<f64>, expected: f64| match got {
                Some(value) => (value - expected).abs() < 1e-12,
                None => expected.is_nan(),
            };
            prop_assert!(same(Metric::Miou.of(&cases, &numbers), scores.miou));
            prop_assert!(same(Metric::PedIou.of(&cases, &numbers), scores.iou[2]));
        }
    }

    #[test]
    fn names_are_read_back() {
        assert!(Metric::ALL.iter().all(|metric| metric.name().parse() == Ok(*metric)));
        assert!("iou".parse::<Metric>().unwrap_err().contains("expected one of ped_iou, miou"));
        assert_eq!(TRAIN_CLASSES[2].name, "Pedestrian");
    }
}
