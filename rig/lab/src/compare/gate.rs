//! Conditions that a checkpoint must meet.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use super::contest::{Contest, Difference};
use super::metrics::Metric;

/// A limit of a figure, as in `ped_iou>=0.5`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    metric: Metric,
    relation: Relation,
    limit: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Relation {
    AtLeast,
    AtMost,
    Above,
    Below,
}

impl Relation {
    /// Longer ones first, as they begin like shorter ones.
    const ALL: [(&'static str, Self); 4] =
        [(">=", Self::AtLeast), ("<=", Self::AtMost), (">", Self::Above), ("<", Self::Below)];

    fn holds(self, value: f64, limit: f64) -> bool {
        match self {
            Self::AtLeast => value >= limit,
            Self::AtMost => value <= limit,
            Self::Above => value > limit,
            Self::Below => value < limit,
        }
    }
}

impl FromStr for Gate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let split = |(sign, relation)| text.split_once(sign).map(|(name, limit)| (name, relation, limit));
        // A sign that there is not, such as => or ==, leaves a part of it in the name or the number.
        let found = Relation::ALL.into_iter().find_map(split).filter(|(name, ..)| !name.contains(['=', '<', '>']));
        let expected = || "expected a metric, one of >= <= > <, and a number, as in ped_iou>=0.5".to_owned();
        let (name, relation, limit) = found.ok_or_else(expected)?;
        let limit = limit.trim().parse::<f64>().ok().filter(|limit| limit.is_finite()).ok_or_else(expected)?;
        Ok(Self { metric: name.trim().parse()?, relation, limit })
    }
}

impl fmt::Display for Gate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = Relation::ALL.iter().find(|(_, relation)| *relation == self.relation).map_or("", |(sign, _)| sign);
        write!(f, "{}{sign}{}", self.metric, self.limit)
    }
}

/// How a checkpoint did at a gate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Passage {
    /// The condition.
    pub gate: String,
    /// Who.
    pub checkpoint: String,
    /// The figure; `None` where there is nothing to count.
    pub value: Option<f64>,
    /// Whether the condition holds; it does not for a figure that there is not.
    pub passed: bool,
    /// What is to be said.
    pub sentence: String,
}

impl Gate {
    /// For a checkpoint with these figures of its own and this contest with the baseline.
    pub fn passage(&self, checkpoint: &str, own: impl Fn(Metric) -> Option<f64>, contest: &Contest) -> Passage {
        let value = match self.metric {
            Metric::Fixed => Some(contest.fixed as f64),
            Metric::Broken => Some(contest.broken as f64),
            metric => own(metric),
        };
        let passed = value.is_some_and(|value| self.relation.holds(value, self.limit));
        let found = value.map_or_else(|| "there is nothing to count".into(), |value| format!("it is {value:.4}"));
        let verb = if passed { "passes" } else { "fails" };
        let sentence = format!("{checkpoint} {verb} {self}: {found}");
        Passage { gate: self.to_string(), checkpoint: checkpoint.to_owned(), value, passed, sentence }
    }
}

/// Whether a checkpoint is no worse than another, figure by figure: it is worse where the whole interval of
/// the difference lies below 0.
pub fn no_worse(checkpoint: &str, than: &str, contest: &Contest) -> Vec<Passage> {
    let passage = |difference: &Difference| {
        let Difference { metric, difference: value, interval_95 } = *difference;
        let passed = interval_95.is_none_or(|(_, high)| high >= 0.0);
        let found = match (value, interval_95) {
            (Some(value), Some((low, high))) => format!("{value:+.4} [{low:+.4}, {high:+.4}]"),
            (Some(value), None) => format!("{value:+.4}, too few cases for an interval"),
            _ => "there is nothing to count".into(),
        };
        let gate = format!("{metric} no worse than {than}");
        let verb = if passed { "passes" } else { "fails" };
        let sentence = format!("{checkpoint} {verb} {gate}: {found}");
        Passage { gate, checkpoint: checkpoint.to_owned(), value, passed, sentence }
    };
    contest.differences.iter().map(passage).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contest(interval_95: Option<(f64, f64)>) -> Contest {
        let differences = vec![Difference { metric: Metric::Miou, difference: Some(-0.1), interval_95 }];
        Contest { fixed: 2, broken: 1, unchanged: 0, no_hazard: 0, differences }
    }

    #[test]
    fn gates_are_read_and_hold_as_they_say() {
        let passes = |text: &str| {
            let gate: Gate = text.parse().expect("a gate");
            gate.passage("full", |metric| (metric == Metric::PedIou).then_some(0.5), &contest(None)).passed
        };
        assert!(passes("ped_iou>=0.5") && passes("ped_iou <= 0.5") && passes("fixed>1") && passes("broken<2"));
        assert!(!passes("ped_iou>0.5") && !passes("ped_iou<0.5") && !passes("broken>=2"));
        assert!(!passes("miou>=0") && !passes("miou<=1"), "a figure that there is not passes nothing");
        for unknown_sign in ["ped_iou=>0.5", "ped_iou==0.5", "ped_iou>>0.5", "ped_iou=<0.5"] {
            let said = unknown_sign.parse::<Gate>().unwrap_err();
            assert!(said.starts_with("expected a metric, one of >= <= > <, and a number"), "{unknown_sign}: {said}");
        }
        for nonsense in ["ped_iou", "ped_iou=0.5", "ped_iou>=much", "ped_iou>=nan", "speed>=3", ">=1"] {
            assert!(nonsense.parse::<Gate>().is_err(), "{nonsense}");
        }
    }

    #[test]
    fn worse_is_an_interval_wholly_below_zero() {
        let passed = |interval| no_worse("b", "a", &contest(interval))[0].passed;
        assert!(passed(Some((-0.2, 0.0))) && passed(Some((0.1, 0.2))) && passed(None));
        assert!(!passed(Some((-0.2, -0.01))));
    }
}
