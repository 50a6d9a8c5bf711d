//! Places in the car's frame, and the arcs that lead there.

use kernel::ego::{self, FRONT_M};
use kernel::ops;

/// Half of the car's width, metres.
pub const HALF_WIDTH_M: f32 = 0.5 * ego::SIZE_M.y;
/// An arc of this radius is straight, metres.
const STRAIGHT_M: f32 = 1e4;
/// Sharpest arc that is tried, 1/m; about the car's turning circle.
pub const SHARPEST: f32 = 0.2;

/// A point in the car's frame, metres: x forward from the rear axle, y left.
pub type Point = (f32, f32);

/// An arc of constant curvature from the rear axle, in the direction of travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Curvature, 1/m, positive to the left.
    pub curvature: f32,
}

impl Arc {
    /// The arc to a point in the car's frame; for one behind, the sharpest arc to its side.
    pub fn to(x_m: f32, y_m: f32) -> Self {
        let sideways = if x_m < 0.0 { SHARPEST.copysign(y_m) } else { 2.0 * y_m / (x_m * x_m + y_m * y_m) };
        Self { curvature: sideways.clamp(-SHARPEST, SHARPEST) }
    }

    /// The point after `s_m` metres and the heading there, in the car's frame.
    pub fn at(&self, s_m: f32) -> (f32, f32, f32) {
        let turned = self.curvature * s_m;
        if turned.abs() < 1e-4 {
            return (s_m, 0.5 * turned * s_m, turned);
        }
        (ops::sin(turned) / self.curvature, (1.0 - ops::cos(turned)) / self.curvature, turned)
    }

    /// Metres to the left of the arc after `s_m` metres.
    pub fn beside(&self, s_m: f32, left_m: f32) -> (f32, f32) {
        let (x, y, heading) = self.at(s_m);
        (x - left_m * ops::sin(heading), y + left_m * ops::cos(heading))
    }

    /// Metres along the arc and to its left of a point in front of the car.
    pub fn project(&self, x_m: f32, y_m: f32) -> (f32, f32) {
        if self.curvature.abs() < 1e-4 {
            return (x_m, y_m);
        }
        let radius = 1.0 / self.curvature;
        let (dx, dy) = (x_m, y_m - radius);
        let turned = ops::atan2(dx * radius.signum(), -dy * radius.signum());
        let left_m = radius - ops::hypot(dx, dy) * radius.signum();
        let turned = if turned < 0.0 && x_m < 0.0 { 0.0 } else { ops::wrap_angle(turned) };
        (turned.abs() * radius.abs(), left_m)
    }
    /// How far from the arc of its rear axle the car reaches on the side of a point so far to the left, metres: on the outer
    /// one of a turn its front swings out.
    pub fn swept_m(&self, left_m: f32) -> f32 {
        let radius_m = 1.0 / self.curvature.abs();
        if left_m * self.curvature >= 0.0 || radius_m > STRAIGHT_M {
            return HALF_WIDTH_M;
        }
        ops::hypot(radius_m + HALF_WIDTH_M, FRONT_M) - radius_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn projecting_undoes_placing() {
        for curvature in [-0.15, -0.02, 0.0, 0.05, 0.12] {
            let arc = Arc { curvature };
            for (s, left) in [(4.0, 0.0), (9.0, 1.5), (7.0, -2.0)] {
                let (x, y) = arc.beside(s, left);
                let (s2, left2) = arc.project(x, y);
                assert!((s - s2).abs() < 1e-2 && (left - left2).abs() < 1e-2, "{curvature} {s} {left}: {s2} {left2}");
            }
        }
    }

    #[test]
    fn the_arc_to_a_point_meets_it() {
        let (s, left) = Arc::to(11.0, 5.0).project(11.0, 5.0);
        assert!(left.abs() < 1e-3 && s > 12.0);
    }

    #[test]
    fn the_front_of_a_turning_car_swings_out() {
        let sharp = Arc { curvature: -0.125 };
        let swings_m = sharp.swept_m(1.0) - HALF_WIDTH_M;
        assert!((0.5..0.8).contains(&swings_m), "{swings_m}");
        assert_eq!(sharp.swept_m(-1.0), HALF_WIDTH_M);
        assert!(Arc { curvature: 0.002 }.swept_m(-1.0) < HALF_WIDTH_M + 0.02);
        assert_eq!([0.0, 1e-8].map(|curvature| Arc { curvature }.swept_m(-1.0)), [HALF_WIDTH_M; 2]);
    }
}
