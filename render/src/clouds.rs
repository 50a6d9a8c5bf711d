//! How clouds drift.

use glam::Vec2;
use kernel::time::{TICK_S, Tick};

use crate::wind;

/// How far clouds drift, in units of their pattern a second: as in a quarter of a storm, whatever the wind is below. A snapshot
/// knows the wind of its tick alone, and clouds that had always drifted with that would leap where it changes.
const PER_S: f32 = 0.0125;

/// The noise of clouds is told in so many of its tiles a unit, coarse and fine; as in `sky.wgsl`.
#[cfg(test)]
pub(crate) const SCALES: [f32; 2] = [0.05, 0.21];

/// After so many units along [`wind::DIRECTION`] both have come by whole tiles along both axes, so that they may start again.
const WRAP: f64 = 500.0;

/// What is added to places of the pattern at a tick.
pub(crate) fn drift(tick: Tick) -> Vec2 {
    let units = f64::from(PER_S * TICK_S) * tick as f64 % WRAP;
    wind::DIRECTION * -(units as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clouds_go_on_where_their_drift_starts_again() {
        let whole = |share: f64| (share - share.round()).abs() < 1e-6;
        for (scale, along) in SCALES.iter().flat_map(|scale| wind::DIRECTION.to_array().map(|along| (*scale, along))) {
            // Of decimal numbers: as single precision has them they are off by a millionth of a tile.
            let [scale, along] = [scale, along].map(|it| (f64::from(it) * 100.0).round() / 100.0);
            assert!(whole(WRAP * scale * along), "{scale} {along}");
        }
        let last = (WRAP / f64::from(PER_S * TICK_S)) as Tick;
        let tile = |tick: Tick, scale: f32| drift(tick) * scale;
        for scale in SCALES {
            let step = tile(last + 1, scale) - tile(last, scale);
            assert!((step - step.round()).length() < 1e-3 && step.length() > 1.0, "{scale}: {step}");
        }
    }
}
