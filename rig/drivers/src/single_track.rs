//! The kinematic single-track model: which steering drives which curve.

use kernel::{ego, ops};

/// The steering, [-1, 1], positive to the right, that drives a curvature, 1/m, positive to the left.
pub fn steering(curvature: f32) -> f32 {
    (-ops::atan2(ego::WHEELBASE_M * curvature, 1.0) / ego::MAX_WHEEL_ANGLE_RAD).clamp(-1.0, 1.0)
}

/// The curvature, 1/m, positive to the left, that a steering, [-1, 1], positive to the right, drives.
pub fn curvature(steering: f32) -> f32 {
    -ops::tan(steering * ego::MAX_WHEEL_ANGLE_RAD) / ego::WHEELBASE_M
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_undoes_the_other() {
        for steer in [-1.0, -0.3, 0.0, 0.1, 1.0] {
            assert!((steering(curvature(steer)) - steer).abs() < 1e-5, "{steer}");
        }
        assert!(curvature(0.5) < 0.0, "to the right");
    }
}
