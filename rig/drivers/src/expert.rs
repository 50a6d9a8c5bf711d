//! A driver who knows everything: it makes the drives of datasets.
//!
//! Steering is pure pursuit on the route, speed the intelligent driver model
//! (Treiber et al. 2000) behind whatever stands on the route, is about to, or a light asks for.

use glam::{Vec2, Vec3};
use kernel::scene::{ActorScene, EgoScene};
use kernel::signals::LightPhase;
use kernel::{Controls, World, ego, ops};

use crate::readout::Readout;
use crate::{Driver, indicate, single_track};

/// How far the route is looked at, metres.
const SIGHT_M: f32 = 60.0;
/// Time headway of pure pursuit, seconds, and its least distance, metres.
const PURSUIT_S: f32 = 0.7;
const PURSUIT_M: f32 = 5.0;
/// Lateral acceleration in bends, m/s^2.
const LATERAL_MPS2: f32 = 2.0;
/// Comfortable acceleration and deceleration, m/s^2.
const ACCELERATION_MPS2: f32 = 1.5;
const DECELERATION_MPS2: f32 = 2.5;
/// Distance kept at standstill, metres, and headway, seconds.
const STANDOFF_M: f32 = 3.0;
const HEADWAY_S: f32 = 1.2;
/// Half of the width that must be free, metres.
const HALF_CORRIDOR_M: f32 = 1.4;
/// How far into it what stands across reaches at most, counted from its middle, metres.
const REACHES_M: f32 = 0.9;
/// How far ahead others are predicted, seconds, and in which steps.
const PREDICTED_S: [f32; 5] = [0.0, 0.5, 1.0, 1.5, 2.0];
/// From the middle of the car to its front bumper, metres.
const NOSE_M: f32 = ego::FRONT_M - ego::CENTRE_M.x;
/// Deceleration at full brake and acceleration at full throttle, m/s^2.
const FULL_BRAKE_MPS2: f32 = 8.4;
const FULL_THROTTLE_MPS2: f32 = 4.0;

/// Drives by the state of the world.
#[derive(Clone, Copy, Debug, Default)]
pub struct Expert;

impl Driver<World> for Expert {
    fn controls(&mut self, world: &World) -> Controls {
        let scene = world.scene();
        let route = Route::new(world.route_ahead(SIGHT_M).iter().map(|p| p.truncate()).collect());
        let hud = world.hud();
        let speed_mps = hud.speed_mps;
        let wanted_mps = hud.limit_mps.min(route.bend_mps());
        let ahead = scene.actors.iter().filter_map(|actor| route.leader(actor, speed_mps));
        let line = stop_line_m(hud.light, f32::from(hud.light_distance_m), speed_mps)
            .map(|gap_m| Leader { gap_m: gap_m + STANDOFF_M - 1.0, speed_mps: 0.0 });
        let acceleration = ahead
            .chain(line)
            .map(|leader| follow(speed_mps, wanted_mps, leader))
            .fold(free(speed_mps, wanted_mps), f32::min);
        let (throttle, brake) = pedals(acceleration, speed_mps);
        let flags = indicate::turn(&Readout::of(&hud));
        Controls { flags, ..Controls::from_fractions(route.steer(&scene.ego), throttle, brake) }
    }
}

/// The middle of the route ahead from the middle of the car on, seen from above, a point a metre.
struct Route {
    points: Vec<Vec2>,
    /// The corners of a box that holds the whole corridor.
    bounds: [Vec2; 2],
}

/// Something to keep a distance to.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Leader {
    /// Metres from the front of the car to it.
    gap_m: f32,
    /// Its speed along the route, m/s.
    speed_mps: f32,
}

impl Route {
    fn new(points: Vec<Vec2>) -> Self {
        // A little more, so that rounding leaves nobody out.
        let margin_m = HALF_CORRIDOR_M + REACHES_M + 0.1;
        let low = points.iter().copied().fold(Vec2::MAX, Vec2::min) - margin_m;
        let high = points.iter().copied().fold(Vec2::MIN, Vec2::max) + margin_m;
        Self { points, bounds: [low, high] }
    }

    /// Whether the corridor may come near the way between two places.
    fn may_hold(&self, [a, b]: [Vec2; 2]) -> bool {
        let [low, high] = self.bounds;
        a.max(b).cmpge(low).all() && a.min(b).cmple(high).all()
    }

    /// Steering towards the route, [-1, 1], positive to the right.
    fn steer(&self, ego: &EgoScene) -> f32 {
        let distance_m = PURSUIT_M.max(PURSUIT_S * ego.speed_mps);
        let at = (distance_m - ego::CENTRE_M.x).max(1.0) as usize;
        let Some(aim) = self.points.get(at).or(self.points.last()) else { return 0.0 };
        single_track::pursuit(ego.position.truncate(), (ego.rotation * Vec3::X).truncate(), *aim)
    }

    /// Highest speed now that lets every bend ahead be taken in comfort.
    fn bend_mps(&self) -> f32 {
        const CHORD: usize = 4;
        let speed = |i: usize| {
            let [a, b, c] = [i, i + CHORD, i + 2 * CHORD].map(|i| self.points[i]);
            let bend2 = LATERAL_MPS2 * CHORD as f32 / angle(b - a, c - b).abs().max(1e-3);
            (bend2 + 2.0 * ACCELERATION_MPS2 * i as f32).sqrt()
        };
        (0..self.points.len().saturating_sub(2 * CHORD)).map(speed).fold(f32::INFINITY, f32::min)
    }

    /// An actor as something to keep a distance to, if it is on the route or about to be.
    fn leader(&self, actor: &ActorScene, speed_mps: f32) -> Option<Leader> {
        let size = actor.kind.size_m();
        let direction = (actor.rotation * Vec3::X).truncate();
        let velocity = direction * actor.speed_mps;
        let place = actor.position.truncate();
        let farthest_s = PREDICTED_S.into_iter().fold(0.0, f32::max);
        if !self.may_hold([place, place + velocity * farthest_s]) {
            return None;
        }
        PREDICTED_S.iter().find_map(|&after_s| {
            let (i, tangent) = self.nearest(place + velocity * after_s, 0.5 * size.x)?;
            let along = direction.dot(tangent).abs();
            let half_length_m = 0.5 * (size.x * along + size.y * (1.0 - along));
            let gap_m = i as f32 - NOSE_M - half_length_m;
            // What crosses later matters only if the car is there by then.
            let relevant = after_s == 0.0 || gap_m < speed_mps * (after_s + 1.0) + STANDOFF_M;
            let along_mps = velocity.dot(tangent).max(0.0);
            let leader_mps = if after_s == 0.0 { along_mps } else { along_mps.min(0.5 * speed_mps) };
            (relevant && gap_m > -NOSE_M).then_some(Leader { gap_m, speed_mps: leader_mps })
        })
    }

    /// The first point of the route whose corridor holds a box at `place`, and the direction there.
    fn nearest(&self, place: Vec2, half_length_m: f32) -> Option<(usize, Vec2)> {
        let (i, distance2) = self
            .points
            .iter()
            .map(|p| p.distance_squared(place))
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|(i, _)| *i + 1 < self.points.len())?;
        let tangent = (self.points[i + 1] - self.points[i]).normalize_or_zero();
        let reach_m = HALF_CORRIDOR_M + half_length_m.min(REACHES_M);
        (distance2 < reach_m * reach_m).then_some((i, tangent))
    }
}

/// Angle from one direction to another, radians counter-clockwise.
fn angle(from: Vec2, to: Vec2) -> f32 {
    ops::atan2(from.perp_dot(to), from.dot(to))
}

/// Metres to a stop line that has to be respected.
fn stop_line_m(light: Option<LightPhase>, distance_m: f32, speed_mps: f32) -> Option<f32> {
    let can_stop = speed_mps * speed_mps < 2.0 * 3.5 * distance_m;
    match light? {
        LightPhase::Green => None,
        LightPhase::Yellow => can_stop.then_some(distance_m),
        LightPhase::Red => Some(distance_m),
    }
}

/// Acceleration on a free road, m/s^2.
fn free(speed_mps: f32, wanted_mps: f32) -> f32 {
    let share = speed_mps.max(0.0) / wanted_mps.max(0.1);
    (ACCELERATION_MPS2 * (1.0 - share * share * share * share)).max(-DECELERATION_MPS2)
}

/// Acceleration behind a leader, m/s^2.
fn follow(speed_mps: f32, wanted_mps: f32, leader: Leader) -> f32 {
    let closing = speed_mps * (speed_mps - leader.speed_mps) / (2.0 * (ACCELERATION_MPS2 * DECELERATION_MPS2).sqrt());
    let gap_wanted_m = STANDOFF_M + (speed_mps * HEADWAY_S + closing).max(0.0);
    let pressure = gap_wanted_m / leader.gap_m.max(0.1);
    free(speed_mps, wanted_mps) - ACCELERATION_MPS2 * pressure * pressure
}

fn pedals(acceleration: f32, speed_mps: f32) -> (f32, f32) {
    if speed_mps < 0.3 && acceleration < 0.1 {
        (0.0, 0.5)
    } else if acceleration >= 0.0 {
        // Rolling resistance and drag take about this much.
        ((acceleration + 0.15 + 0.0003 * speed_mps * speed_mps) / FULL_THROTTLE_MPS2, 0.0)
    } else {
        (0.0, -acceleration / FULL_BRAKE_MPS2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn straight() -> Route {
        Route::new((0..60).map(|i| Vec2::new(i as f32, 0.0)).collect())
    }

    #[test]
    fn it_keeps_a_distance_and_stops_for_red() {
        let far = follow(10.0, 13.9, Leader { gap_m: 60.0, speed_mps: 10.0 });
        let near = follow(10.0, 13.9, Leader { gap_m: 8.0, speed_mps: 0.0 });
        assert!(far > 0.0 && near < -5.0, "{far} {near}");
        assert_eq!(stop_line_m(Some(LightPhase::Red), 20.0, 10.0), Some(20.0));
        assert_eq!(stop_line_m(Some(LightPhase::Yellow), 5.0, 13.0), None);
        assert_eq!(stop_line_m(Some(LightPhase::Green), 5.0, 13.0), None);
    }

    #[test]
    fn who_is_beside_its_box_is_in_the_way_nowhere() {
        let (mut held, mut left_out) = (0, 0);
        let arc = |i: i32| 30.0 * Vec2::new(ops::sin(i as f32 / 30.0), 1.0 - ops::cos(i as f32 / 30.0));
        let route = Route::new((0..60).map(arc).collect());
        for step in 0..40_000 {
            let at = |step: i32| Vec2::new((step % 200) as f32, (step / 200) as f32) * 0.4 - Vec2::splat(20.0);
            let (a, b) = (at(step), at((step * 7 + 1234) % 40_000));
            let places = PREDICTED_S.map(|after_s| a.lerp(b, after_s / 2.0));
            let is_held = places.iter().any(|place| route.nearest(*place, 6.0).is_some());
            assert!(route.may_hold([a, b]) || !is_held, "{a} to {b}");
            (held, left_out) = (held + usize::from(is_held), left_out + usize::from(!route.may_hold([a, b])));
        }
        assert!(held > 1000 && left_out > 1000, "{held} {left_out}");
    }

    #[test]
    fn bends_are_taken_slowly_and_straights_are_not() {
        let arc = |i: i32| 10.0 * Vec2::new(ops::sin(i as f32 / 10.0), 1.0 - ops::cos(i as f32 / 10.0));
        let bend = Route::new((0..60).map(arc).collect());
        assert!(straight().bend_mps() > 50.0);
        assert!((bend.bend_mps() - 20f32.sqrt()).abs() < 0.5, "{}", bend.bend_mps());
    }
}
