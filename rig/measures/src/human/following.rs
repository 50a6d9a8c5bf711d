//! What following the route asks of the steering wheel: a driver who gives no more follows it.
//!
//! Someone who steers to any point of the route between a near and a far look-ahead (pure pursuit, Coulter 1992)
//! follows it, in a curve, before it, and back from beside the lane.

use kernel::World;
use kernel::scene::EgoScene;
use kernel::{ego, ops};

use super::steering::FULL_DEG;

/// Look-ahead of those who follow the route, seconds: drivers look 1 to 2 s ahead (Land and Lee 1994), and steer by
/// what is nearer than that, too.
const LOOK_S: [f32; 2] = [0.8, 2.0];
/// The same at low speed, metres.
const LEAST_LOOK_M: [f32; 2] = [6.0, 12.0];

/// The angles of the steering wheel that follow the route, degrees, positive to the right.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Following {
    /// Furthest to the left.
    pub least_deg: f32,
    /// Furthest to the right.
    pub most_deg: f32,
}

impl Following {
    /// Those at the world's tick; straight ahead where no route is.
    pub fn of(world: &World, car: &EgoScene) -> Self {
        let [near_m, far_m] = [0, 1].map(|i| (LOOK_S[i] * car.speed_mps).max(LEAST_LOOK_M[i]));
        let local = |point| car.rotation.inverse() * (point - car.position);
        let ahead = world.route_ahead(far_m).into_iter().map(local);
        let ahead = ahead.filter(|p| p.x > 0.0 && p.truncate().length() >= near_m);
        let angles = ahead.map(|p| wheel_deg(p.x, p.y)).map(|deg| Self { least_deg: deg, most_deg: deg });
        angles.reduce(Self::or).unwrap_or_default()
    }

    /// These angles or others.
    pub fn or(self, other: Self) -> Self {
        Self { least_deg: self.least_deg.min(other.least_deg), most_deg: self.most_deg.max(other.most_deg) }
    }
}

/// Angle of the steering wheel whose arc leads to a point in the car's frame, which is at its rear axle.
fn wheel_deg(x_m: f32, y_m: f32) -> f32 {
    let curvature = 2.0 * y_m / (x_m * x_m + y_m * y_m);
    let wheels_rad = -ops::atan2(ego::WHEELBASE_M * curvature, 1.0);
    (wheels_rad / ego::MAX_WHEEL_ANGLE_RAD).clamp(-1.0, 1.0) * FULL_DEG
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_to_the_left_needs_the_wheel_to_the_left() {
        // A circle of 27 m: the wheels at atan(0.1) = 5.71 degrees of 35, the steering wheel at that share of 450.
        let (sin, cos) = 0.3f32.sin_cos();
        let deg = wheel_deg(27.0 * sin, 27.0 * (1.0 - cos));
        assert!((deg + 450.0 * 5.7106 / 35.0).abs() < 0.01, "{deg}");
        assert_eq!((wheel_deg(8.0, 0.0), wheel_deg(0.1, 3.0)), (0.0, -450.0));
    }
}
