//! The kinematic single-track model: which steering drives which curve.

use glam::Vec2;
use kernel::{ego, ops};

/// The steering, [-1, 1], positive to the right, that drives a curvature, 1/m, positive to the left.
pub fn steering(curvature: f32) -> f32 {
    (-ops::atan2(ego::WHEELBASE_M * curvature, 1.0) / ego::MAX_WHEEL_ANGLE_RAD).clamp(-1.0, 1.0)
}

/// The curvature, 1/m, positive to the left, that a steering, [-1, 1], positive to the right, drives.
pub fn curvature(steering: f32) -> f32 {
    -ops::tan(steering * ego::MAX_WHEEL_ANGLE_RAD) / ego::WHEELBASE_M
}

/// The steering, [-1, 1], positive to the right, of the arc from the rear axle to a point (pure pursuit, Coulter 1992),
/// all seen from above.
pub fn pursuit(rear_axle: Vec2, forward: Vec2, aim: Vec2) -> f32 {
    let to = aim - rear_axle;
    steering(2.0 * forward.perp_dot(to) / to.length_squared().max(1.0))
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

    #[test]
    fn who_pursues_a_point_drives_the_arc_to_it() {
        let (axle, radius_m) = (Vec2::new(3.0, -2.0), 20.0);
        for turned in [0.2f32, 0.9, -0.5] {
            let aim = axle + radius_m * Vec2::new(ops::sin(turned.abs()), turned.signum() * (1.0 - ops::cos(turned)));
            let driven = curvature(pursuit(axle, Vec2::X, aim));
            assert!((driven - turned.signum() / radius_m).abs() < 1e-4, "{driven}");
        }
        assert_eq!(pursuit(axle, Vec2::X, axle + 9.0 * Vec2::X), 0.0);
    }
}
