//! Rates by exposure, with exact intervals: corner cases are rare.

mod bootstrap;
mod inverse;
mod power;

use serde::Serialize;
use statrs::distribution::{Beta, Binomial, ContinuousCDF, Discrete, Gamma};

pub use bootstrap::{interval, percentile_interval, rate_interval, resample};
pub use inverse::{inverse_interval, inverse_power, inverse_rate_ratio_interval, inverse_same_rate_p};
pub use power::{exposure_factor_for, power};

/// Exact 95 % interval of a Poisson mean after `events` in an exposure that was fixed beforehand (Garwood 1936).
pub fn poisson_interval(events: u64) -> (f64, f64) {
    let quantile = |shape: u64, p: f64| Gamma::new(shape as f64, 1.0).map_or(f64::NAN, |g| g.inverse_cdf(p));
    let low = if events == 0 { 0.0 } else { quantile(events, 0.025) };
    (low, quantile(events + 1, 0.975))
}

/// Two-sided exact p-value that two Poisson processes have the same rate: given the sum, the first
/// count is binomial (Przyborowski and Wilenski 1940). `None` without events or exposure.
pub fn same_rate_p(events: (u64, u64), exposure: (f64, f64)) -> Option<f64> {
    let total = events.0 + events.1;
    let share = exposure.0 / (exposure.0 + exposure.1);
    if total == 0 || !(0.0..=1.0).contains(&share) {
        return None;
    }
    let binomial = Binomial::new(share, total).ok()?;
    let observed = binomial.pmf(events.0);
    let as_unlikely = (0..=total).map(|k| binomial.pmf(k)).filter(|p| *p <= observed * (1.0 + 1e-7));
    Some(as_unlikely.sum::<f64>().min(1.0))
}

/// Exact 95 % interval of the second rate over the first: given the sum, the second count is binomial
/// (Clopper and Pearson 1934). The limits are 0 and infinity where a count is 0.
pub fn rate_ratio_interval(events: (u64, u64), exposure: (f64, f64)) -> (f64, f64) {
    let share = |a: u64, b: u64, p: f64| Beta::new(a as f64, b as f64).map_or(f64::NAN, |beta| beta.inverse_cdf(p));
    let ratio = |share: f64| share / (1.0 - share) * exposure.0 / exposure.1;
    let (first, second) = events;
    let low = if second == 0 { 0.0 } else { ratio(share(second, first + 1, 0.025)) };
    let high = if first == 0 { f64::INFINITY } else { ratio(share(second + 1, first, 0.975)) };
    (low, high)
}

/// How values spread.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Number of values.
    pub n: usize,
    /// The value in the middle, or the mean of the two there.
    pub median: f64,
    /// 99 % of the values are not greater.
    pub p99: f64,
    /// 99.9 % of the values are not greater.
    pub p999: f64,
    /// The greatest.
    pub max: f64,
}

impl Spread {
    /// That of some values, all but the median by nearest rank; `None` of none.
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let n = values.len();
        let rank = |permille: usize| values.get((permille * n).div_ceil(1000).max(1) - 1).copied();
        let middle = (rank(500)? + values[n / 2]) / 2.0;
        Some(Self { n, median: middle, p99: rank(990)?, p999: rank(999)?, max: rank(1000)? })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn so_many_values_are_not_greater(values in prop::collection::vec(0u8..30, 1..300)) {
            let spread = Spread::of(values.iter().map(|v| f64::from(*v)).collect()).expect("values");
            let share = |limit: f64| values.iter().filter(|v| f64::from(**v) <= limit).count() as f64 / values.len() as f64;
            let above = values.iter().filter(|v| f64::from(**v) >= spread.median).count() as f64 / values.len() as f64;
            prop_assert!(share(spread.median) >= 0.5 && above >= 0.5);
            prop_assert!(share(spread.p99) >= 0.99 && share(spread.p99 - 1.0) < 0.99);
            prop_assert!(share(spread.max) == 1.0 && share(spread.max - 1.0) < 1.0);
        }
    }

    #[test]
    fn quantiles_are_of_the_nearest_rank() {
        let all = Spread::of((1..=1000).rev().map(f64::from).collect());
        assert_eq!(all, Some(Spread { n: 1000, median: 500.5, p99: 990.0, p999: 999.0, max: 1000.0 }));
        assert_eq!(Spread::of(vec![7.0]), Some(Spread { n: 1, median: 7.0, p99: 7.0, p999: 7.0, max: 7.0 }));
        assert_eq!(Spread::of(Vec::new()), None);
    }

    #[test]
    fn the_papers_figures_come_out() {
        // 13 corner cases in 121.32 km: 9.33 [5.5, 17.5] km each.
        let (low, high) = poisson_interval(13);
        assert!((121.32 / high - 5.46).abs() < 0.02 && (121.32 / low - 17.53).abs() < 0.02);
        // Corner-case enriched against natural: not significant.
        let p = same_rate_p((13, 11), (121.32, 153.38)).expect("events and exposure");
        assert!((p - 0.41).abs() < 0.02, "{p}");
        assert_eq!(poisson_interval(0).0, 0.0);
        assert_eq!(same_rate_p((0, 0), (1.0, 1.0)), None);
    }

    #[test]
    fn a_ratio_lies_within_its_interval_and_leaves_one_out_when_the_rates_differ() {
        // By SciPy's beta.ppf.
        let (low, high) = rate_ratio_interval((13, 11), (121.32, 153.38));
        assert!((low - 0.271_493_1).abs() < 1e-6 && (high - 1.619_008_7).abs() < 1e-6, "{low} {high}");
        let (low, high) = rate_ratio_interval((5, 40), (10.0, 10.0));
        assert!(1.0 < low && low < 8.0 && 8.0 < high);
        assert_eq!(rate_ratio_interval((3, 0), (1.0, 1.0)).0, 0.0);
        assert_eq!(rate_ratio_interval((0, 3), (1.0, 1.0)).1, f64::INFINITY);
    }
}
