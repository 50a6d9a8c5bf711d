//! Two rates side by side.

use serde::Serialize;

use super::{Sampling, Statistics};
use crate::stats;

/// Power that is asked for when the needed exposure is computed.
const WANTED_POWER: f64 = 0.8;

/// A rate of corner cases against a reference. Where both were driven until there were so many cases, interval, p and
/// power are those of that design, otherwise those of lengths that were fixed beforehand.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Corner cases a kilometre over those of the reference; absent where the reference has none.
    pub ratio: Option<f64>,
    /// Exact 95 % interval of the ratio; `null` stands for no limit.
    pub ratio_95: (f64, f64),
    /// Two-sided exact p-value that the rates are the same; absent without corner cases.
    pub p: Option<f64>,
    /// Probability that such a campaign gives p < 0.05, if the rates are those seen.
    pub power: Option<f64>,
    /// Kilometres with this checkpoint (and in proportion with the reference) for a power of 80 %.
    pub km_for_power_80: Option<f64>,
}

impl Comparison {
    /// Against a reference.
    pub fn of(reference: &Statistics, other: &Statistics) -> Self {
        let (events, exposure) = ((reference.cases, other.cases), (reference.km, other.km));
        let ratio = other.cases_per_km / reference.cases_per_km;
        let is_inverse = [reference, other].iter().all(|s| s.sampling == Sampling::Cases);
        let power = |factor: f64| {
            let expected = (factor * events.0 as f64, factor * events.1 as f64);
            if is_inverse { stats::inverse_power(expected, ratio) } else { stats::power(expected, exposure) }
        };
        let (ratio_95, p) = if is_inverse {
            (stats::inverse_rate_ratio_interval(events, exposure), stats::inverse_same_rate_p(events, exposure))
        } else {
            (stats::rate_ratio_interval(events, exposure), stats::same_rate_p(events, exposure))
        };
        Self {
            ratio: ratio.is_finite().then_some(ratio),
            ratio_95,
            p,
            power: power(1.0),
            km_for_power_80: stats::exposure_factor_for(WANTED_POWER, power).map(|factor| factor * other.km),
        }
    }
}
