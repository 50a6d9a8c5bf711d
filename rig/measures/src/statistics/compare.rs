//! Two rates side by side.

use serde::Serialize;

use super::Statistics;
use crate::stats;

/// Power that is asked for when the needed exposure is computed.
const WANTED_POWER: f64 = 0.8;

/// A rate of corner cases against a reference.
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
        let expected = (events.0 as f64, events.1 as f64);
        Self {
            ratio: ratio.is_finite().then_some(ratio),
            ratio_95: stats::rate_ratio_interval(events, exposure),
            p: stats::same_rate_p(events, exposure),
            power: stats::power(expected, exposure),
            km_for_power_80: stats::exposure_factor_for(WANTED_POWER, events, exposure).map(|f| f * other.km),
        }
    }
}
