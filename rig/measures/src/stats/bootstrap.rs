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

/// 95 % interval of a figure of so many units, which is given the numbers of those drawn; draws of which there
/// is no figure are left out. `None` for fewer than two units. A figure that compares two measurements of the
/// same units is thereby paired.
pub fn interval(units: usize, seed: u64, figure: impl Fn(&[usize]) -> Option<f64>) -> Option<(f64, f64)> {
    let statistic = |draw| {
        let drawn: Vec<usize> = resample(seed, draw, 0, units).collect();
        figure(&drawn).unwrap_or(f64::NAN)
    };
    if units < 2 { None } else { percentile_interval(statistic) }
}

/// 95 % interval of events per exposure, by drawing clusters (rides) of `(events, exposure)`: unlike the
/// exact interval it allows for rides that differ. `None` for fewer than two clusters, or without events, of
/// which drawing again can say nothing.
pub fn rate_interval(clusters: &[(u64, f64)], seed: u64) -> Option<(f64, f64)> {
    if clusters.iter().all(|(events, _)| *events == 0) {
        return None;
    }
    interval(clusters.len(), seed, |drawn| {
        let add = |(events, exposure), i: &usize| (events + clusters[*i].0, exposure + clusters[*i].1);
        let (events, exposure) = drawn.iter().fold((0, 0.0), add);
        Some(events as f64 / exposure)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::stats::poisson_interval;

    proptest! {
        #[test]
        fn the_mean_lies_in_its_interval_which_moves_and_scales_with_the_values(
            values in prop::collection::vec(-50i32..50, 2..40), shift in -9i32..9, scale in 1i32..5, seed: u64,
        ) {
            let mean = |f: &dyn Fn(i32) -> i32| {
                let of = |drawn: &[usize]| drawn.iter().map(|i| f64::from(f(values[*i]))).sum::<f64>() / drawn.len() as f64;
                let all: Vec<usize> = (0..values.len()).collect();
                let (low, high) = interval(values.len(), seed, |drawn| Some(of(drawn))).expect("two or more");
                (of(&all), low, high)
            };
            let (middle, low, high) = mean(&|v| v);
            prop_assert!(low <= middle + 1e-9 && middle <= high + 1e-9);
            let (_, moved_low, moved_high) = mean(&|v| scale * v + shift);
            let expected = |v: f64| f64::from(scale) * v + f64::from(shift);
            prop_assert!((moved_low - expected(low)).abs() < 1e-9 && (moved_high - expected(high)).abs() < 1e-9);
        }
    }

    #[test]
    fn pairs_that_all_gain_the_same_leave_no_doubt_however_they_differ() {
        let before = [0.1, 0.9, 0.4, 0.2];
        let gain = |drawn: &[usize]| Some(drawn.iter().map(|i| (before[*i] + 0.05) - before[*i]).sum::<f64>() / 4.0);
        let (low, high) = interval(4, 3, gain).expect("pairs");
        assert!((low - 0.05).abs() < 1e-9 && (high - 0.05).abs() < 1e-9);
        assert_eq!(interval(4, 3, |_| None), None);
        assert_eq!(interval(1, 3, |_| Some(1.0)), None);
    }

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
        assert_eq!(rate_interval(&[(0, 1.0), (0, 2.0)], 1), None);
        assert_eq!(rate_interval(&lumped, 7), rate_interval(&lumped, 7));
    }
}
