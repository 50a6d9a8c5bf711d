//! What moves the joints of a model: a function of one snapshot, so that its picture needs no other.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;
use kernel::scene::{ActorScene, EgoScene};

/// Vehicles' phases advance by a turn in this distance, be there pedals or not, metres. Those that were hit or pushed keep theirs:
/// they slide.
pub const LAP_M: f32 = 5.0;

/// Directions that the ego car's heading is rounded to.
const SECTORS: f32 = 12.0;

/// How somebody moves at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Phase of gait or pedalling, radians.
    pub phase_rad: f32,
    /// Speed forward, m/s.
    pub speed_mps: f32,
    /// Mean angle of the front wheels, radians, positive to the left.
    pub steer_rad: f32,
    /// How far it has rolled since a multiple of [`LAP_M`], metres in [0, [`LAP_M`]).
    pub rolled_m: f32,
}

impl Motion {
    /// That of a road user. Where its front wheels point is not known, so they point ahead.
    pub fn of_actor(actor: &ActorScene) -> Self {
        let ActorScene { phase_rad, speed_mps, .. } = *actor;
        Self { phase_rad, speed_mps, steer_rad: 0.0, rolled_m: phase_rad / TAU * LAP_M }
    }

    /// That of the ego car.
    pub fn of_ego(ego: &EgoScene) -> Self {
        Self { phase_rad: 0.0, speed_mps: ego.speed_mps, steer_rad: -ego.wheel_angle_rad, rolled_m: rolled_m(ego) }
    }
}

/// How far the ego car is along the direction nearest to its heading. Along the heading itself it would roll by turning,
/// the more the farther from the origin; so in bends it rolls up to 4 % too little, and starts anew every 30 degrees.
fn rolled_m(ego: &EgoScene) -> f32 {
    let ahead = ego.rotation * Vec3::X;
    let sector = ops::round(ops::atan2(ahead.y, ahead.x) * (SECTORS / TAU));
    let direction_rad = sector * (TAU / SECTORS);
    let along_m = ego.position.x * ops::cos(direction_rad) + ego.position.y * ops::sin(direction_rad);
    along_m.rem_euclid(LAP_M)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use glam::Quat;
    use kernel::{Scenario, TickInput, World, map};

    use super::*;

    fn ego(position: Vec3, heading_rad: f32) -> EgoScene {
        let rotation = Quat::from_rotation_z(heading_rad);
        EgoScene { position, rotation, speed_mps: 2.0, wheel_angle_rad: 0.3, lamps: 0 }
    }

    /// From -half a lap to half a lap.
    fn advance_m(from: &Motion, to: &Motion) -> f32 {
        (to.rolled_m - from.rolled_m + 0.5 * LAP_M).rem_euclid(LAP_M) - 0.5 * LAP_M
    }

    #[test]
    fn the_ego_car_rolls_as_far_as_it_drives_and_not_by_turning() {
        for (heading, share) in [(0.0, 0.999), (0.25, 0.96), (1.5, 0.99), (-2.6, 0.96), (3.1, 0.99)] {
            let (at, ahead) = (Vec3::new(812.0, -431.0, 3.0), Quat::from_rotation_z(heading) * Vec3::X);
            for way_m in [0.3f32, -0.3] {
                let moved = Motion::of_ego(&ego(at + ahead * way_m, heading));
                let rolled = advance_m(&Motion::of_ego(&ego(at, heading)), &moved) / way_m;
                assert!((share..1.001).contains(&rolled), "{heading}: {rolled}");
            }
            let turned = Motion::of_ego(&ego(at, heading + 0.005));
            assert!(advance_m(&Motion::of_ego(&ego(at, heading)), &turned).abs() < 1e-3, "{heading}");
        }
    }

    #[test]
    fn left_is_positive() {
        assert_eq!(Motion::of_ego(&ego(Vec3::ZERO, 0.0)).steer_rad, -0.3, "the wheel angle is positive to the right");
    }

    #[test]
    fn traffic_rolls_as_far_as_it_drives() {
        let city = map::bundled("city").expect("it is bundled");
        let mut world = World::new(&Scenario::default_for("city", 7), &city).expect("it fits");
        let vehicles = |world: &World| -> BTreeMap<u32, ActorScene> {
            let actors = world.scene().actors.into_iter().filter(|a| a.kind.is_car_or_heavier());
            actors.map(|actor| (actor.id, actor)).collect()
        };
        let (mut driven, mut rolled) = (BTreeMap::<u32, f32>::new(), BTreeMap::<u32, f32>::new());
        let mut before = vehicles(&world);
        for _ in 0..60 {
            world.step(&TickInput::default());
            let after = vehicles(&world);
            for (id, actor) in &after {
                let Some(was) = before.get(id) else { continue };
                *driven.entry(*id).or_default() += actor.position.distance(was.position);
                *rolled.entry(*id).or_default() += advance_m(&Motion::of_actor(was), &Motion::of_actor(actor));
            }
            before = after;
        }
        let far: Vec<(f32, f32)> = driven.iter().map(|(id, m)| (*m, rolled[id])).filter(|(m, _)| *m > 4.0).collect();
        assert!(far.len() > 5, "{driven:?}");
        for (driven, rolled) in far {
            assert!((rolled - driven).abs() < 0.06 * driven, "{rolled} of {driven} m");
        }
    }
}
