//! Places in the car's frame, and the arcs that lead there.

use kernel::ops;

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
}
