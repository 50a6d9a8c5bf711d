//! How the ego car moves, from where it was: a scene tells its speed ahead alone.

use std::collections::VecDeque;

use glam::{Quat, Vec3};
use kernel::scene::EgoScene;
use kernel::time::{TICK_S, Tick};

/// Ticks over which it is looked at: places are rounded to a millimetre, which over one tick would be 6 cm/s.
pub const SPAN_TICKS: Tick = 6;

/// Velocities along and about the car's axes (x ahead, y left, z up).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Twist {
    /// m/s
    pub linear_mps: Vec3,
    /// rad/s
    pub angular_radps: Vec3,
}

/// The last poses.
#[derive(Default)]
pub struct Motion(VecDeque<(Tick, EgoScene)>);

impl Motion {
    /// Goes on to a tick. Ahead it is the speed of the scene, otherwise the mean over the last ticks, as far as they were seen.
    pub fn at(&mut self, tick: Tick, ego: &EgoScene) -> Twist {
        self.0.retain(|(before, _)| tick - before <= SPAN_TICKS);
        let mean = self.0.front().map_or(Twist::default(), |(since, was)| between(was, ego, (tick - since) as f32));
        self.0.push_back((tick, *ego));
        Twist { linear_mps: Vec3::new(ego.speed_mps, mean.linear_mps.y, mean.linear_mps.z), ..mean }
    }
}

fn between(was: &EgoScene, is: &EgoScene, ticks: f32) -> Twist {
    let seconds = ticks * TICK_S;
    let (from, to) = (was.rotation.normalize(), is.rotation.normalize());
    // Along the axes half way, as those now have turned on.
    let half_way: Quat = from.lerp(to, 0.5);
    let moved = half_way.inverse() * (is.position - was.position);
    let turned = (from.inverse() * to).to_scaled_axis();
    Twist { linear_mps: moved / seconds, angular_radps: turned / seconds }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_a_circle_it_goes_ahead_and_turns_steadily() {
        let (speed_mps, turning_radps) = (10.0_f32, 0.5_f32);
        let mut motion = Motion::default();
        for tick in 0..30 {
            let angle_rad = turning_radps * tick as f32 * TICK_S;
            let radius_m = speed_mps / turning_radps;
            let ego = EgoScene {
                position: radius_m * Vec3::new(angle_rad.sin(), 1.0 - angle_rad.cos(), 0.0),
                rotation: Quat::from_rotation_z(angle_rad),
                speed_mps,
                wheel_angle_rad: 0.0,
                lamps: 0,
            };
            let twist = motion.at(tick, &ego);
            assert_eq!(twist.linear_mps.x, speed_mps);
            if tick > 0 {
                assert!(twist.linear_mps.y.abs() < 2e-3, "{twist:?}");
                assert!((twist.angular_radps.z - turning_radps).abs() < 1e-3, "{twist:?}");
            }
        }
    }
}
