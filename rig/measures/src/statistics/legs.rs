//! What lies between one corner case and the next, as the paper's Table 2 has it.

use serde::Serialize;

use super::ride::Ride;

/// Legs end at a corner case and go on over rides without one. The last leg, which has no end, counts
/// in no mean: that is how the paper counts, and why its means are too small. Where rides ended with the last
/// case there is no such leg, and the mean is that of the true distances.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Legs {
    /// Legs that ended.
    pub completed: usize,
    /// Mean of their kilometres.
    pub km_mean: Option<f64>,
    /// Standard deviation of their kilometres (n - 1).
    pub km_std: Option<f64>,
    /// Mean of their minutes.
    pub minutes_mean: Option<f64>,
    /// Standard deviation of their minutes (n - 1).
    pub minutes_std: Option<f64>,
    /// Standard deviation of kilometres over their mean: 1 if corner cases come at a constant rate.
    pub km_variation: Option<f64>,
    /// Kilometres since the last corner case.
    pub censored_km: f64,
    /// Minutes since the last corner case.
    pub censored_minutes: f64,
}

impl Legs {
    /// Of rides in the order in which they were driven.
    pub fn of(rides: &[Ride]) -> Self {
        let (mut kms, mut minutes) = (Vec::new(), Vec::new());
        let mut open = (0.0, 0.0);
        for ride in rides {
            open = (open.0 + ride.km, open.1 + ride.minutes);
            if ride.is_case {
                kms.push(open.0);
                minutes.push(open.1);
                open = (0.0, 0.0);
            }
        }
        let km_mean = mean(&kms);
        let km_std = deviation(&kms);
        Self {
            completed: kms.len(),
            km_mean,
            km_std,
            minutes_mean: mean(&minutes),
            minutes_std: deviation(&minutes),
            km_variation: km_std.zip(km_mean).map(|(std, mean)| std / mean),
            censored_km: open.0,
            censored_minutes: open.1,
        }
    }
}

fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

fn deviation(values: &[f64]) -> Option<f64> {
    let mean = mean(values).filter(|_| values.len() > 1)?;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    Some((squares / (values.len() - 1) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leg_goes_on_over_rides_without_a_case() {
        let rides = [(1.0, true), (2.0, false), (3.0, true), (4.0, false)].map(|(km, is_case)| Ride {
            km,
            minutes: 10.0 * km,
            is_case,
            label: None,
            perception_caused: None,
            tempers: [None; 2],
        });
        let legs = Legs::of(&rides);
        assert_eq!((legs.completed, legs.km_mean, legs.minutes_mean), (2, Some(3.0), Some(30.0)));
        assert_eq!((legs.km_std, legs.censored_km, legs.censored_minutes), (Some(8.0f64.sqrt()), 4.0, 40.0));
        assert_eq!(Legs::of(&rides[1..2]), Legs { censored_km: 2.0, censored_minutes: 20.0, ..Legs::default() });
    }
}
