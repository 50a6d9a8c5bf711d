//! Intervals by drawing from what was seen again (Efron 1979).

use kernel::rng::{self, Stream};

/// How often is drawn.
const DRAWS: u32 = 4000;

/// One drawing again: `count` of the numbers below `count`, with replacement. `what` tells apart what is
/// drawn within one draw.
pub fn resample(seed: u64, draw: u32, what: u32, count: usize) -> impl Iterator<Item = usize> {
    let below = u32::try_from(count).unwrap_or(u32::MAX);
    let entity = u64::from(what) << 32 | u64::from(draw);
    (0..count).map(move |i| rng::below(seed, Stream::Driver, entity, i as u64, below) as usize)
}

/// 95 % interval of a statistic by its percentiles over all draws, whose numbers it is given. Draws where it
/// is not finite are left out; `None` if all are.
pub fn percentile_interval(statistic: impl Fn(u32) -> f64) -> Option<(f64, f64)> {
    let mut values: Vec<f64> = (0..DRAWS).map(statistic).filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let quantile = |share: f64| values.get((share * (values.len() as f64 - 1.0)).round() as usize).copied();
    Some((quantile(0.025)?, quantile(0.975)?))
}

/// 95 % interval of events per exposure, by drawing clusters (rides) of `(events, exposure)` with
/// replacement: unlike the exact interval it allows for rides that differ. `None` for fewer than two clusters.
pub fn rate_interval(clusters: &[(u64, f64)], seed: u64) -> Option<(f64, f64)> {
    let rate = |draw| {
        let drawn = resample(seed, draw, 0, clusters.len()).map(|i| clusters[i]);
        let (events, exposure) = drawn.fold((0, 0.0), |(n, sum), (events, exposure)| (n + events, sum + exposure));
        events as f64 / exposure
    };
    if clusters.len() < 2 { None } else { percentile_interval(rate) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::poisson_interval;

    #[test]
    fn rides_that_do_not_differ_give_about_the_exact_interval() {
        let rides: Vec<(u64, f64)> = (0..200).map(|i| (u64::from(i % 5 == 0), 1.0)).collect();
        let (low, high) = rate_interval(&rides, 1).expect("many rides");
        // A ride has at most one event: the spread is binomial, narrower than that of Poisson's.
        let deviation = (0.2f64 * 0.8 / 200.0).sqrt();
        assert!((low - (0.2 - 1.96 * deviation)).abs() < 0.01 && (high - (0.2 + 1.96 * deviation)).abs() < 0.01);
        let (least, most) = poisson_interval(40);
        assert!(low > least / 200.0 && high < most / 200.0);
    }

    #[test]
    fn few_rides_with_all_the_events_make_it_wide() {
        let lumped: Vec<(u64, f64)> = (0..40).map(|i| (if i < 2 { 20 } else { 0 }, 1.0)).collect();
        let (_, high) = rate_interval(&lumped, 1).expect("many rides");
        assert!(high > poisson_interval(40).1 / 40.0);
        assert_eq!(rate_interval(&[(1, 1.0)], 1), None);
        assert_eq!(rate_interval(&lumped, 7), rate_interval(&lumped, 7));
    }
}
