//! Rates where it was fixed beforehand how many events there would be, and the exposure is what it took:
//! inverse sampling. At a constant rate twice the expected events in that exposure are chi-squared with two degrees of
//! freedom for each event (Epstein and Sobel 1953), and a ratio of two such rates follows the F distribution
//! (Epstein and Tsao 1953). How many events of one kind there are until there are enough of another does not
//! depend on when they come, so the same holds for all of them.

use statrs::distribution::{Beta, ContinuousCDF, Gamma};

/// Level of the test.
const LEVEL: f64 = 0.05;

/// Exact 95 % interval of the expected events in an exposure that ended with the last of `events`: the quantiles of
/// chi-squared with 2 `events` degrees of freedom, halved. Garwood's upper limit has 2 `events` + 2 of them, and is that
/// of no events at all.
pub fn inverse_interval(events: u64) -> (f64, f64) {
    let Ok(gamma) = Gamma::new(events as f64, 1.0) else { return (0.0, -(LEVEL / 2.0).ln()) };
    (gamma.inverse_cdf(LEVEL / 2.0), gamma.inverse_cdf(1.0 - LEVEL / 2.0))
}

/// Two-sided exact p-value that two rates are the same. `None` without events on either side, or exposure.
pub fn inverse_same_rate_p(events: (u64, u64), exposure: (f64, f64)) -> Option<f64> {
    let below = share(events)?.cdf(exposure.1 / (exposure.0 + exposure.1));
    (exposure.0 > 0.0 && exposure.1 > 0.0).then(|| (2.0 * below.min(1.0 - below)).min(1.0))
}

/// Exact 95 % interval of the second rate over the first; without limits where a count is 0.
pub fn inverse_rate_ratio_interval(events: (u64, u64), exposure: (f64, f64)) -> (f64, f64) {
    let Some(beta) = share(events) else { return (0.0, f64::INFINITY) };
    let ratio = |p: f64| odds(beta.inverse_cdf(p)) * exposure.0 / exposure.1;
    (ratio(LEVEL / 2.0), ratio(1.0 - LEVEL / 2.0))
}

/// Probability that [`inverse_same_rate_p`] is below 5 % with so many events (which may be parts of one), if the second
/// rate is so many times the first.
pub fn inverse_power(events: (f64, f64), ratio: f64) -> Option<f64> {
    let beta = Beta::new(events.1, events.0).ok()?;
    let scaled = |p: f64| beta.cdf(from_odds(ratio * odds(beta.inverse_cdf(p))));
    (ratio > 0.0 && ratio.is_finite()).then(|| scaled(LEVEL / 2.0) + 1.0 - scaled(1.0 - LEVEL / 2.0))
}

/// How the second's part of all expected events is distributed: that of its exposure, if the rates are the same.
fn share((first, second): (u64, u64)) -> Option<Beta> {
    Beta::new(second as f64, first as f64).ok()
}

fn odds(share: f64) -> f64 {
    share / (1.0 - share)
}

fn from_odds(odds: f64) -> f64 {
    odds / (1.0 + odds)
}

#[cfg(test)]
mod tests {
    use kernel::rng::{self, Stream};
    use proptest::prelude::*;

    use super::*;
    use crate::stats::{poisson_interval, rate_ratio_interval};

    /// Exposure up to the last of so many events at a rate of 1, drawn.
    fn exposure(seed: u64, trial: u64, events: u64) -> f64 {
        let uniform = |i| (rng::bits(seed, Stream::Driver, trial, i) >> 11) as f64 / (1u64 << 53) as f64;
        (0..events).map(|i| -(1.0 - uniform(i)).ln()).sum()
    }

    #[test]
    fn tables_of_chi_squared_come_out() {
        // Chi-squared with 20 degrees of freedom: 9.5908 and 34.1696.
        let (low, high) = inverse_interval(10);
        assert!((2.0 * low - 9.5908).abs() < 1e-3 && (2.0 * high - 34.1696).abs() < 1e-3, "{low} {high}");
        assert!(high < poisson_interval(10).1 && low == poisson_interval(10).0);
        // F with 4 and 6 degrees of freedom: 0.975 quantile 6.2272; with 6 and 4: 9.1973.
        let (low, high) = inverse_rate_ratio_interval((3, 2), (3.0, 2.0));
        assert!((high - 6.2272).abs() < 1e-3 && (1.0 / low - 9.1973).abs() < 1e-3, "{low} {high}");
    }

    /// Coverage where the number of events is fixed: 95 % by this interval, more by Garwood's.
    #[test]
    fn the_interval_holds_the_rate_as_often_as_it_says() {
        let trials = 20_000;
        for events in [1, 3, 8] {
            let holds = |(low, high): (f64, f64), t: f64| low / t <= 1.0 && 1.0 <= high / t;
            let times: Vec<f64> = (0..trials).map(|trial| exposure(7, trial, events)).collect();
            let share = |interval| times.iter().filter(|t| holds(interval, **t)).count() as f64 / trials as f64;
            let (inverse, garwood) = (share(inverse_interval(events)), share(poisson_interval(events)));
            assert!((inverse - 0.95).abs() < 0.006, "{events}: {inverse}");
            assert!(garwood > 0.96, "{events}: {garwood}");
        }
    }

    #[test]
    fn equal_rates_are_found_to_differ_at_the_level_and_others_as_often_as_the_power_says() {
        let trials = 10_000;
        for (events, ratio) in [((4, 4), 1.0), ((5, 9), 1.0), ((6, 10), 3.0), ((12, 3), 0.3)] {
            let rejects = |trial: u64| {
                let exposures = (exposure(1, trial, events.0), exposure(2, trial, events.1) / ratio);
                inverse_same_rate_p(events, exposures).expect("events") < LEVEL
            };
            let seen = (0..trials).filter(|trial| rejects(*trial)).count() as f64 / trials as f64;
            let power = inverse_power((events.0 as f64, events.1 as f64), ratio).expect("computable");
            assert!((seen - power).abs() < 0.015, "{events:?} {ratio}: {seen}, not {power}");
            assert!(ratio != 1.0 || (power - LEVEL).abs() < 1e-6);
        }
    }

    proptest! {
        #[test]
        fn p_is_small_when_the_interval_leaves_one_out(
            first in 1u64..40, second in 1u64..40, km in (0.1f64..50.0, 0.1f64..50.0),
        ) {
            let (events, swapped) = ((first, second), (second, first));
            let p = inverse_same_rate_p(events, km).expect("events");
            let (low, high) = inverse_rate_ratio_interval(events, km);
            prop_assert!((p < LEVEL) == (low > 1.0 || high < 1.0) || (p - LEVEL).abs() < 1e-6);
            prop_assert!((inverse_same_rate_p(swapped, (km.1, km.0)).expect("events") - p).abs() < 1e-6);
            let (wide_low, wide_high) = rate_ratio_interval(events, km);
            prop_assert!(wide_low <= low * (1.0 + 1e-6) && high <= wide_high * (1.0 + 1e-6));
        }
    }

    #[test]
    fn without_events_nothing_is_known() {
        assert_eq!(inverse_interval(0).0, 0.0);
        assert!((inverse_interval(0).1 - poisson_interval(0).1).abs() < 1e-6);
        assert_eq!(inverse_same_rate_p((0, 4), (1.0, 1.0)), None);
        assert_eq!(inverse_rate_ratio_interval((3, 0), (1.0, 1.0)), (0.0, f64::INFINITY));
        assert_eq!((inverse_power((0.0, 3.0), 1.0), inverse_power((2.0, 3.0), 0.0)), (None, None));
    }
}
