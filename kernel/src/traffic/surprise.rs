//! What the driver of the ego car can still do about somebody who steps out: nobody steps out where even a driver who sees it
//! at once has no chance, since such a crash tells nothing of what was overlooked.

use glam::Vec2;

use super::hazard::Hazard;

/// A surprised driver brakes after this time, s (Green 2000: 1.25 s for signals that are common but not expected).
const REACTION_S: f32 = 1.25;
/// And this hard, m/s²: emergency braking on a wet road.
const BRAKE_MPS2: f32 = 6.0;
/// Stops so far before the way, metres.
const SPARE_M: f32 = 0.5;
/// The car's lane reaches so far aside, metres, and may bend with this radius.
const LANE_M: f32 = 3.0;
const BEND_M: f32 = 60.0;
/// Slower than this a car stops at once, m/s.
const CREEP_MPS: f32 = 1.0;
/// Places on the way that are looked at.
const STRIDES: u32 = 8;

/// Whether the ego car can still stop before a way that somebody goes from now on, metres, m/s, or has passed by then.
pub(super) fn leaves_time(ego: &Hazard, [from, to]: [Vec2; 2], pace_mps: f32) -> bool {
    let speed = ego.velocity.length();
    if speed < CREEP_MPS {
        return true;
    }
    let course = ego.velocity / speed;
    let stop_m = ego.half.x + SPARE_M + speed * REACTION_S + speed * speed / (2.0 * BRAKE_MPS2);
    (0..=STRIDES).all(|k| {
        let share = k as f32 / STRIDES as f32;
        let offset = from.lerp(to, share) - ego.position.truncate();
        let (ahead_m, aside_m) = (offset.dot(course), course.perp_dot(offset).abs());
        let there_s = from.distance(to) * share / pace_mps;
        let is_past = ahead_m + ego.half.x < speed * there_s;
        is_past || ahead_m > stop_m || ahead_m < -ego.half.x || aside_m > LANE_M + ahead_m * ahead_m / (2.0 * BEND_M)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::traffic::body::Obstacle;
    use glam::Vec3;

    /// An ego car at 14 m/s along x, so far before somebody who goes over its lane from the right.
    fn at(ahead_m: f32, aside_m: f32) -> bool {
        let ego = Obstacle {
            velocity_mps: Vec3::X * 14.0,
            size_m: Vec3::new(4.6, 1.8, 1.5),
            ..crate::traffic::tests::nowhere()
        };
        let ego = Hazard { position: Vec3::ZERO, ..Hazard::of(&ego) };
        leaves_time(&ego, [Vec2::new(ahead_m, -aside_m), Vec2::new(ahead_m, 8.0)], 1.5)
    }

    #[test]
    fn nobody_steps_out_before_an_ego_car_that_cannot_stop() {
        // 2.3 + 0.5 + 17.5 + 16.3 metres.
        assert!(at(37.0, 2.5), "it can stop");
        assert!(!at(36.0, 2.5), "it cannot");
        assert!(at(-3.0, 2.5), "it has passed");
        assert!(at(15.0, 8.0), "it passes before somebody is there");
    }
}
