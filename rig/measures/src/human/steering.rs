//! Steering-wheel reversals: how often a driver turns the wheel to and fro.
//!
//! The method is that of Markkula and Engström (2006), which SAE J2944 (2015) takes over: the angle is
//! low-passed without delay (Butterworth of second order, forwards and backwards), and each movement
//! between turning points that is greater than a gap counts, to either side.

use std::f64::consts::{PI, SQRT_2};

use kernel::time::TICK_HZ;
use kernel::{Controls, Seat};
use replay::Log;

use super::log::{controls, end_of_driving};

/// Steering wheel at full steering, degrees to either side: that of a wheel with 900 degrees from
/// stop to stop, whatever device was used.
pub const FULL_DEG: f32 = 450.0;
/// Least movement that is a reversal, degrees of the steering wheel.
pub const GAP_DEG: f64 = 2.0;
/// Cut-off frequency of the low-pass, hertz.
pub const CUT_OFF_HZ: f64 = 0.6;

/// Angle of the steering wheel, degrees, positive to the right.
pub fn wheel_deg(controls: &Controls) -> f32 {
    FULL_DEG * controls.steer_fraction()
}

/// Ticks of a log until the safety driver intervenes: those over which reversals are counted.
pub fn driven_ticks(log: &Log) -> usize {
    log.inputs.len().min((end_of_driving(log) - log.first_tick()) as usize)
}

/// Reversals a minute of one of the drivers until the safety driver intervenes; 0 in an empty log.
pub fn reversals_per_min(log: &Log, seat: Seat) -> f64 {
    let driven = driven_ticks(log);
    let angles_deg: Vec<f64> =
        log.inputs[..driven].iter().map(|input| f64::from(wheel_deg(controls(input, seat)))).collect();
    let minutes = driven as f64 / f64::from(60 * TICK_HZ);
    if driven == 0 { 0.0 } else { reversals(&low_passed(&angles_deg), GAP_DEG) as f64 / minutes }
}

/// Movements between turning points that are greater than a gap.
fn reversals(angles_deg: &[f64], gap_deg: f64) -> usize {
    let turns = turning_points(angles_deg);
    let mirrored: Vec<f64> = turns.iter().map(|angle| -angle).collect();
    upwards(&turns, gap_deg) + upwards(&mirrored, gap_deg)
}

fn upwards(turns: &[f64], gap_deg: f64) -> usize {
    let mut count = 0;
    let mut from = turns.first().copied().unwrap_or_default();
    for &angle in turns {
        if angle - from > gap_deg {
            count += 1;
            from = angle;
        } else if angle <= from {
            from = angle;
        }
    }
    count
}

/// The angle at the beginning and wherever the wheel stops or turns back.
fn turning_points(angles_deg: &[f64]) -> Vec<f64> {
    let turns = angles_deg.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) <= 0.0).map(|w| w[1]);
    angles_deg.first().copied().into_iter().chain(turns).collect()
}

/// Low-passed forwards and backwards, so that nothing is delayed.
fn low_passed(values: &[f64]) -> Vec<f64> {
    let mut filtered = pass(values.iter().copied());
    filtered.reverse();
    let mut filtered = pass(filtered.into_iter());
    filtered.reverse();
    filtered
}

/// A Butterworth low-pass of second order (bilinear transform) that begins at rest at the first value.
fn pass(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let k = (PI * CUT_OFF_HZ / f64::from(TICK_HZ)).tan();
    let scale = 1.0 / (1.0 + SQRT_2 * k + k * k);
    let [b0, b1, b2] = [k * k * scale, 2.0 * k * k * scale, k * k * scale];
    let [a1, a2] = [2.0 * (k * k - 1.0) * scale, (1.0 - SQRT_2 * k + k * k) * scale];
    let mut state = None;
    let step = |x: f64| {
        let (s1, s2) = state.unwrap_or(((1.0 - b0) * x, (b2 - a2) * x));
        let y = b0 * x + s1;
        state = Some((b1 * x - a1 * y + s2, b2 * x - a2 * y));
        y
    };
    values.map(step).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A sine of the steering wheel, degrees.
    fn sine(amplitude_deg: f64, hz: f64, seconds: usize) -> Vec<f64> {
        let at = |i: usize| amplitude_deg * (2.0 * PI * hz * i as f64 / f64::from(TICK_HZ)).sin();
        (0..seconds * TICK_HZ as usize).map(at).collect()
    }

    #[test]
    fn the_low_pass_has_the_response_of_a_butterworth() {
        for hz in [0.1, 0.3, 0.6, 1.0, 2.0, 5.0] {
            let filtered = low_passed(&sine(1.0, hz, 60));
            let middle = &filtered[1200..2400];
            let amplitude = middle.iter().copied().fold(f64::MIN, f64::max);
            // Both ways give the square of 1 / sqrt(1 + (f / fc)^4), at frequencies bent by the transform.
            let bent = |hz: f64| (PI * hz / f64::from(TICK_HZ)).tan();
            let expected = 1.0 / (1.0 + (bent(hz) / bent(CUT_OFF_HZ)).powi(4));
            assert!((amplitude - expected).abs() < 0.01 * expected + 1e-4, "{hz} Hz: {amplitude}, not {expected}");
        }
        assert_eq!(low_passed(&[3.0; 50]).iter().map(|v| v.round()).collect::<Vec<_>>(), [3.0; 50]);
    }

    #[test]
    fn a_sine_turns_back_twice_a_period() {
        for (amplitude_deg, seconds) in [(10.0, 60), (1.2, 120)] {
            let counted = reversals(&low_passed(&sine(amplitude_deg, 0.25, seconds)), GAP_DEG);
            let turns = seconds as f64 * 0.25 * 2.0;
            // The first movement, from the middle, and the last, which does not end, are smaller or open.
            assert!((counted as f64 - turns).abs() <= 2.0, "{counted} for {turns}");
        }
        assert_eq!(reversals(&low_passed(&sine(0.9, 0.25, 60)), GAP_DEG), 0, "smaller than the gap");
        assert_eq!(reversals(&low_passed(&sine(20.0, 6.0, 60)), GAP_DEG), 0, "trembling is filtered out");
    }

    /// The greatest number of movements that do not overlap, by trying every pair of turning points.
    fn most_movements(turns: &[f64], gap_deg: f64) -> usize {
        let mut best = vec![0; turns.len()];
        for j in 1..turns.len() {
            let moved = (0..j).filter(|i| turns[j] - turns[*i] > gap_deg).map(|i| best[i] + 1);
            best[j] = moved.max().unwrap_or(0).max(best[j - 1]);
        }
        best.last().copied().unwrap_or(0)
    }

    proptest! {
        #[test]
        fn reversals_are_the_most_movements_that_fit(
            angles in prop::collection::vec(-8i32..8, 0..120), gap in 1i32..6,
        ) {
            let angles: Vec<f64> = angles.into_iter().map(f64::from).collect();
            let turns = turning_points(&angles);
            let mirrored: Vec<f64> = turns.iter().map(|a| -a).collect();
            let gap = f64::from(gap);
            let expected = most_movements(&turns, gap) + most_movements(&mirrored, gap);
            prop_assert_eq!(reversals(&angles, gap), expected);
        }

        #[test]
        fn neither_offset_nor_side_matters(angles in prop::collection::vec(-90i32..90, 2..200), offset in -50i32..50) {
            let of = |map: &dyn Fn(i32) -> i32| {
                let angles: Vec<f64> = angles.iter().map(|a| f64::from(map(*a))).collect();
                reversals(&angles, GAP_DEG)
            };
            prop_assert_eq!(of(&|a| a), of(&|a| a + offset));
            prop_assert_eq!(of(&|a| a), of(&|a| -a));
        }
    }
}
