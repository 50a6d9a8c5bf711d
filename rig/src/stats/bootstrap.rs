//! Intervals by drawing from what was seen again (Efron 1979).

use kernel::rng::{self, Stream};

/// How often is drawn.
const DRAWS: u32 = 4000;

/// 95 % interval of events per exposure, by drawing clusters (rides) of `(events, exposure)` with
/// replacement: unlike the exact interval it allows for rides that differ. `None` for fewer than two clusters.
pub fn rate_interval(clusters: &[(u64, f64)], seed: u64) -> Option<(f64, f64)> {
    let count = u32::try_from(clusters.len()).ok().filter(|n| *n >= 2)?;
    let mut rates: Vec<f64> = (0..DRAWS)
        .map(|draw| {
            let drawn = (0..count).map(|i| rng::below(seed, Stream::Driver, u64::from(draw), i.into(), count));
            let (events, exposure) = drawn.fold((0, 0.0), |(events, exposure), i| {
                let cluster = clusters[i as usize];
                (events + cluster.0, exposure + cluster.1)
            });
            events as f64 / exposure
        })
        .filter(|rate| rate.is_finite())
        .collect();
    rates.sort_by(f64::total_cmp);
    let quantile = |share: f64| rates.get((share * (rates.len() as f64 - 1.0)).round() as usize).copied();
    Some((quantile(0.025)?, quantile(0.975)?))
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
