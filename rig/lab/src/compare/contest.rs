//! Two checkpoints over the same cases.

use measures::stats;
use serde::Serialize;

use super::metrics::{CaseSums, Metric, in_time};

/// Seed of the draws behind every interval.
const SEED: u64 = 1;

/// What became of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Change {
    /// The hazard is seen in time, and was not by the baseline.
    Fixed,
    /// The hazard is not seen in time, and was by the baseline.
    Broken,
    /// In time by both, or by none.
    Unchanged,
    /// Nothing visible was about to be touched.
    NoHazard,
}

impl Change {
    /// By how long before the intervention each of the two first saw the hazard.
    pub fn of(baseline_s: Option<f64>, other_s: Option<f64>) -> Self {
        match (baseline_s.map(in_time), other_s.map(in_time)) {
            (Some(false), Some(true)) => Self::Fixed,
            (Some(true), Some(false)) => Self::Broken,
            (Some(_), Some(_)) => Self::Unchanged,
            _ => Self::NoHazard,
        }
    }

    /// As people read it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Broken => "broken",
            Self::Unchanged => "unchanged",
            Self::NoHazard => "no hazard",
        }
    }
}

/// How much greater a figure is than the baseline's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// Which figure.
    pub metric: Metric,
    /// `None` where either has none.
    pub difference: Option<f64>,
    /// 95 %, by drawing cases with replacement and comparing both on the same draw.
    pub interval_95: Option<(f64, f64)>,
}

/// A checkpoint against a baseline.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contest {
    /// Cases whose hazard is seen in time, and was not by the baseline.
    pub fixed: usize,
    /// Cases whose hazard is not seen in time, and was by the baseline.
    pub broken: usize,
    /// Cases in which both see it in time, or neither does.
    pub unchanged: usize,
    /// Cases without a hazard to see.
    pub no_hazard: usize,
    /// One for each of [`Metric::OWN`].
    pub differences: Vec<Difference>,
}

impl Contest {
    /// Over the same cases in the same order.
    pub fn of(baseline: &[CaseSums], other: &[CaseSums]) -> Self {
        let verdicts: Vec<Change> = baseline.iter().zip(other).map(|(a, b)| Change::of(a.sight_s, b.sight_s)).collect();
        let count = |verdict| verdicts.iter().filter(|v| **v == verdict).count();
        let all: Vec<usize> = (0..baseline.len()).collect();
        let difference = |metric: Metric| {
            let figure = |numbers: &[usize]| Some(metric.of(other, numbers)? - metric.of(baseline, numbers)?);
            let interval_95 = stats::interval(baseline.len(), SEED, figure);
            Difference { metric, difference: figure(&all), interval_95 }
        };
        Self {
            fixed: count(Change::Fixed),
            broken: count(Change::Broken),
            unchanged: count(Change::Unchanged),
            no_hazard: count(Change::NoHazard),
            differences: Metric::OWN.map(difference).to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_fixed_or_broken_only_across_the_limit() {
        let of = |a, b| Change::of(Some(a), Some(b));
        assert_eq!((of(0.9, 1.0), of(1.0, 0.9)), (Change::Fixed, Change::Broken));
        assert_eq!((of(1.0, 2.9), of(0.0, 0.9)), (Change::Unchanged, Change::Unchanged));
        assert_eq!(Change::of(None, None), Change::NoHazard);
    }
}
