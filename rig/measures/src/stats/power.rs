//! How likely an exact test of two Poisson rates finds a difference that is there.

use statrs::distribution::{Binomial, Discrete, Poisson};

/// Level of the test.
const LEVEL: f64 = 0.05;
/// Outcomes this many standard deviations from the mean and further are left out.
const DEVIATIONS: f64 = 8.0;
/// More expected events than this are not computed: the difference would be found long before.
const MOST_EVENTS: f64 = 4000.0;
/// Nobody drives so many times as long.
const MOST_FACTOR: f64 = 4096.0;

/// Probability that [`super::same_rate_p`] is below 5 %, when so many events are expected on either
/// side and the exposures are these.
pub fn power(expected: (f64, f64), exposure: (f64, f64)) -> Option<f64> {
    let total = Poisson::new(expected.0 + expected.1).ok()?;
    let (mean, share) = (expected.0 + expected.1, exposure.0 / (exposure.0 + exposure.1));
    let first = expected.0 / mean;
    if mean > MOST_EVENTS || !(0.0..=1.0).contains(&share) {
        return None;
    }
    let spread = DEVIATIONS * mean.sqrt() + DEVIATIONS;
    let (least, most) = ((mean - spread).max(0.0) as u64, (mean + spread) as u64);
    let given = |n: u64| Some(total.pmf(n) * rejected(n, share, first)?);
    (least..=most).map(given).sum::<Option<f64>>().map(|power| power.min(1.0))
}

/// Probability that the test rejects, given the sum: the first count has one share under the null
/// hypothesis and another in truth.
fn rejected(total: u64, null: f64, truth: f64) -> Option<f64> {
    let (null, truth) = (Binomial::new(null, total).ok()?, Binomial::new(truth, total).ok()?);
    let mut counts: Vec<(f64, u64)> = (0..=total).map(|k| (null.pmf(k), k)).collect();
    counts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut tail, mut power) = (0.0, 0.0);
    // Counts that are equally likely are rejected together or not at all.
    for equals in counts.chunk_by(|a, b| b.0 <= a.0 * (1.0 + 1e-7)) {
        tail += equals.iter().map(|(p, _)| p).sum::<f64>();
        if tail >= LEVEL {
            break;
        }
        power += equals.iter().map(|(_, k)| truth.pmf(*k)).sum::<f64>();
    }
    Some(power)
}

/// By how much both exposures must grow for the power, a function of that factor, to reach `wanted`, if the rates are
/// those seen; within 1 %. `None` where even [`MOST_FACTOR`] does not suffice, or the power is not computed.
pub fn exposure_factor_for(wanted: f64, power: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let (mut low, mut high) = (0.0, 1.0);
    while power(high)? < wanted {
        (low, high) = (high, 2.0 * high);
        if high > MOST_FACTOR {
            return None;
        }
    }
    while high - low > 0.01 * high {
        let middle = 0.5 * (low + high);
        if power(middle)? < wanted { low = middle } else { high = middle }
    }
    Some(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::same_rate_p;

    #[test]
    fn the_papers_campaigns_were_too_short() {
        // 9.33 and 13.94 km for each corner case.
        let at = |km: f64| power((km / 9.33, km / 13.94), (km, km)).expect("computable");
        assert!((at(150.0) - 0.13).abs() < 0.03, "{}", at(150.0));
        assert!((at(1000.0) - 0.73).abs() < 0.03, "{}", at(1000.0));
        let factor = exposure_factor_for(0.73, |f| power((16.0 * f, 11.0 * f), (150.0, 153.38))).expect("reachable");
        assert!((5.0..8.0).contains(&factor), "{factor}");
    }

    #[test]
    fn it_is_the_sum_over_all_outcomes() {
        let (expected, exposure) = ((6.0, 1.5), (30.0, 20.0));
        let (first, second) = (Poisson::new(expected.0).expect("valid"), Poisson::new(expected.1).expect("valid"));
        let mut sum = 0.0;
        for (a, b) in (0..60).flat_map(|a| (0..40).map(move |b| (a, b))) {
            if same_rate_p((a, b), exposure).is_some_and(|p| p < LEVEL) {
                sum += first.pmf(a) * second.pmf(b);
            }
        }
        let power = power(expected, exposure).expect("computable");
        assert!((power - sum).abs() < 1e-9, "{power} {sum}");
    }

    #[test]
    fn equal_rates_are_found_to_differ_at_most_at_the_level() {
        for expected in [2.0, 10.0, 80.0] {
            assert!(power((expected, expected), (1.0, 1.0)).expect("computable") <= LEVEL);
        }
        assert_eq!(exposure_factor_for(0.8, |f| power((7.0 * f, 7.0 * f), (1.0, 1.0))), None);
    }
}
