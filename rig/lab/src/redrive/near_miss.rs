//! What counts as close, and as soon, after a moment at which somebody might have taken over.

use kernel::time::{Tick, seconds};
use measures::criticality::Sample;

/// An intervention is early when harm would have come later than this after it.
pub const EARLY_TICKS: Tick = seconds(3);
/// It comes close where the time to collision falls below this, seconds, or more braking than this is required, m/s^2.
const NEAR_MISS_TTC_S: f64 = 1.0;
const NEAR_MISS_MPS2: f64 = 6.0;

/// Whether somebody came close in a time of which these are the samples.
pub fn is_near_miss<'a>(samples: impl IntoIterator<Item = &'a Sample>) -> bool {
    samples.into_iter().any(|sample| {
        sample.ttc_s.as_ref().is_some_and(|ttc| ttc.value < NEAR_MISS_TTC_S)
            || sample.required_deceleration_mps2.as_ref().is_some_and(|needed| needed.value > NEAR_MISS_MPS2)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use measures::criticality::Worst;

    #[test]
    fn close_is_less_than_a_second_or_more_than_six_metres_a_second_squared() {
        let worst = |value| Some(Worst { value, with: "car 1".into() });
        let sample = |ttc_s, required_deceleration_mps2| {
            [Sample { tick: 1, ttc_s, pret_s: None, required_deceleration_mps2, encroachment: None }]
        };
        assert!(is_near_miss(&sample(worst(0.9), None)) && is_near_miss(&sample(worst(3.0), worst(6.1))));
        assert!(!is_near_miss(&sample(worst(1.0), worst(6.0))) && !is_near_miss(&sample(None, None)));
    }
}
