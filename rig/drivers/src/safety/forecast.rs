//! Where everyone will be in the next seconds if nobody changes his mind.

use glam::Vec2;
use kernel::geometry::direction;
use kernel::map::RoadNetwork;
use kernel::scene::{ActorScene, EgoScene};
use kernel::{World, ego, ops};

use crate::footprint::{Footprint, forward, middle};

/// Room kept around the ego car on each side, metres.
pub const MARGIN_M: f32 = 0.15;
/// Who speeds up goes on for so long, seconds.
const SPEEDS_UP_S: f32 = 1.0;
/// Who is turned away from the route turns back to its direction on this way, metres; by so much at most, radians.
const TURNS_BACK_M: f32 = 6.0;
const TURNED_RAD: f32 = 0.7;
/// An actor belongs to a lane whose middle is nearer than this, metres.
const ON_LANE_M: f32 = 1.5;

/// The ego car's way along its route, beside the middle of it as far as it is now.
pub struct EgoWay {
    points: Vec<Vec2>,
    /// Metres to the left of the route.
    pub left_m: f32,
    speed_mps: f32,
    acceleration_mps2: f32,
    /// Room kept on each side.
    margin_m: f32,
    /// How far the car is turned to the left of its route now, radians.
    turned_rad: f32,
}

impl EgoWay {
    /// From the present; a braking car goes on braking, one that speeds up does so for 1 s, any other keeps its speed.
    pub fn new(world: &World, car: &EgoScene, acceleration_mps2: f32) -> Self {
        let points: Vec<Vec2> = world.route_ahead(60.0).iter().map(|p| p.truncate()).collect();
        let middle = middle(car);
        let left_m = match points[..] {
            [first, second, ..] => (second - first).normalize_or(Vec2::X).perp_dot(middle - first),
            _ => 0.0,
        };
        let speed_mps = car.speed_mps.max(0.0);
        Self { points, left_m, speed_mps, acceleration_mps2, margin_m: MARGIN_M, turned_rad: 0.0 }
    }

    /// The same from the present with this braking, m/s^2.
    pub fn braking(&self, mps2: f32) -> Self {
        Self { acceleration_mps2: self.acceleration_mps2.min(-mps2), points: self.points.clone(), ..*self }
    }

    /// The same of a car that is turned as it is, and turns back to the direction of its route within [`TURNS_BACK_M`]; its
    /// middle stays as far beside the route as it is.
    pub fn turned_as(self, car: &EgoScene) -> Self {
        let turned_rad = match self.points[..] {
            [first, second, ..] => {
                let (along, heading) = ((second - first).normalize_or(Vec2::X), forward(car));
                ops::atan2(along.perp_dot(heading), along.dot(heading)).clamp(-TURNED_RAD, TURNED_RAD)
            }
            _ => 0.0,
        };
        Self { turned_rad, ..self }
    }

    /// The same with this room on each side, metres.
    pub fn with_margin(self, margin_m: f32) -> Self {
        Self { margin_m, ..self }
    }

    /// The same with this much more room on each side, metres.
    pub fn wider(&self, by_m: f32) -> Self {
        Self { margin_m: self.margin_m + by_m, points: self.points.clone(), ..*self }
    }

    /// Speed in `t_s` seconds, m/s.
    pub fn speed_mps_at(&self, t_s: f32) -> f32 {
        let changes_s = if self.acceleration_mps2 > 0.0 { t_s.min(SPEEDS_UP_S) } else { t_s };
        (self.speed_mps + self.acceleration_mps2 * changes_s).max(0.0)
    }

    /// Metres driven in `t_s` seconds.
    pub fn driven_m(&self, t_s: f32) -> f32 {
        driven_m(self.speed_mps, self.acceleration_mps2, t_s)
    }

    /// Footprint in `t_s` seconds; `None` beyond the known route.
    pub fn at(&self, t_s: f32) -> Option<Footprint> {
        let driven_m = self.driven_m(t_s);
        let index = driven_m as usize;
        let (from, to) = (*self.points.get(index)?, *self.points.get(index + 1)?);
        let along = (to - from).normalize_or(Vec2::X);
        let turned_rad = self.turned_rad * (1.0 - driven_m / TURNS_BACK_M).max(0.0);
        let forward = direction(turned_rad).rotate(along);
        let centre = from.lerp(to, driven_m - index as f32) + self.left_m * along.perp();
        Some(Footprint { centre, forward, half: 0.5 * ego::SIZE_M.truncate() + self.margin_m })
    }
}

/// Metres driven in `t_s` seconds by one who goes on braking until he stands, or speeds up for 1 s.
pub fn driven_m(speed_mps: f32, acceleration_mps2: f32, t_s: f32) -> f32 {
    if acceleration_mps2 <= -0.1 {
        let t_s = t_s.min(-speed_mps / acceleration_mps2);
        return speed_mps * t_s + 0.5 * acceleration_mps2 * t_s * t_s;
    }
    let speeds_up_s = t_s.min(SPEEDS_UP_S);
    speed_mps * t_s + acceleration_mps2.max(0.0) * speeds_up_s * (t_s - 0.5 * speeds_up_s)
}

/// Footprint of another actor after some metres: vehicles keep their lane, people their direction.
pub fn actor_after(network: &RoadNetwork, actor: &ActorScene, driven_m: f32) -> Footprint {
    let now = Footprint::of_actor(actor);
    let straight = || Footprint { centre: now.centre + driven_m * now.forward, ..now };
    if actor.kind.is_on_foot() || actor.speed_mps < 0.5 {
        return straight();
    }
    let heading = ops::atan2(now.forward.y, now.forward.x);
    // Who passes another beside the oncoming lane's middle, or turns across other lanes, does not turn back along them.
    match network.nearest_leading(actor.position, heading, ON_LANE_M) {
        Some(place) => along_lane(network, place.lane, place.s_m + driven_m, place.lateral_m, now),
        None => straight(),
    }
}

/// At a distance along a lane and the only way on from it; straight on where ways part.
fn along_lane(network: &RoadNetwork, lane: u32, s_m: f32, lateral_m: f32, now: Footprint) -> Footprint {
    let (mut lane, mut s_m) = (lane, s_m);
    while let [next] = network.lanes[lane as usize].successors[..]
        && s_m > network.lanes[lane as usize].length_m
    {
        s_m -= network.lanes[lane as usize].length_m;
        lane = next;
    }
    let beyond_m = (s_m - network.lanes[lane as usize].length_m).max(0.0);
    let point = network.lane_point(lane, s_m);
    let forward = direction(point.heading_rad);
    Footprint { centre: point.position.truncate() + beyond_m * forward + lateral_m * forward.perp(), forward, ..now }
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use kernel::map;
    use kernel::scene::ActorKind;

    use super::*;

    /// In the middle of any lane, in its direction or against it as one who passes another: nobody is expected behind.
    #[test]
    fn nobody_is_expected_to_turn_back() {
        for name in ["city", "rural"] {
            let network = map::bundled(name).expect("it is bundled");
            for lane in 0..network.lanes.len() as u32 {
                let point = network.lane_point(lane, 0.5 * network.lanes[lane as usize].length_m);
                for heading in [point.heading_rad, point.heading_rad + core::f32::consts::PI] {
                    let actor = ActorScene {
                        id: 1,
                        kind: ActorKind::Car,
                        variant: 0,
                        position: point.position,
                        rotation: Quat::from_rotation_z(heading),
                        speed_mps: 8.0,
                        phase_rad: 0.0,
                        lamps: 0,
                    };
                    let moved = actor_after(&network, &actor, 6.0).centre - point.position.truncate();
                    assert!(moved.dot(direction(heading)) > 0.0, "{name}, lane {lane}: {moved}");
                }
            }
        }
    }

    #[test]
    fn a_car_that_is_turned_comes_back_to_its_route() {
        let network = map::bundled("city").expect("it is bundled");
        let world = World::new(&kernel::Scenario::default_for("city", 3), &network).expect("it fits");
        let straight = world.scene().ego;
        let along = EgoWay::new(&world, &straight, 0.0).at(0.1).expect("there is a route").forward;
        for turned_rad in [-0.4, 0.4] {
            let rotation = Quat::from_rotation_z(turned_rad) * straight.rotation;
            let car = EgoScene { rotation, speed_mps: 3.0, ..straight };
            let way = EgoWay::new(&world, &car, 0.0).turned_as(&car);
            let heading_rad = |t_s: f32| {
                let forward = way.at(t_s).expect("there is a route").forward;
                ops::atan2(along.perp_dot(forward), along.dot(forward))
            };
            assert!((heading_rad(0.0) - turned_rad).abs() < 0.02, "{turned_rad}: {}", heading_rad(0.0));
            assert!((heading_rad(1.0) - 0.5 * turned_rad).abs() < 0.02, "{turned_rad}: {}", heading_rad(1.0));
            assert!(heading_rad(2.1).abs() < 0.02, "{turned_rad}: {}", heading_rad(2.1));
        }
    }

    #[test]
    fn who_brakes_comes_to_a_stand_and_who_speeds_up_does_so_for_a_second() {
        assert_eq!(driven_m(6.0, 0.0, 2.0), 12.0);
        assert_eq!(driven_m(6.0, 1.0, 0.5), 3.125);
        assert_eq!(driven_m(6.0, 1.0, 3.0), 6.5 + 14.0);
        assert_eq!(driven_m(6.0, -2.0, 2.0), 8.0);
        assert_eq!(driven_m(6.0, -2.0, 9.0), 9.0);
    }
}
