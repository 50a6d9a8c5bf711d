//! Rates by exposure, with exact intervals: corner cases are rare.

use statrs::distribution::{Binomial, ContinuousCDF, Discrete, Gamma};

/// Exact 95 % interval of a Poisson mean after `events` (Garwood 1936).
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
