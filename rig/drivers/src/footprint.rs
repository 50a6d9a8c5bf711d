//! What a road user covers of the ground.

use glam::{Vec2, Vec3};
use kernel::ego;
use kernel::geometry::direction;
use kernel::map::Prop;
use kernel::scene::{ActorScene, EgoScene};

/// Who is more above or below than this, and than this for each metre away, is on another road, metres: a slope is no bridge.
const LEVEL_M: f32 = 2.5;
const STEEPEST: f32 = 0.1;

/// Whether two places may belong to the same road, not to one that passes over the other.
pub fn on_level(a: Vec3, b: Vec3) -> bool {
    let between = a - b;
    between.z.abs() < LEVEL_M + STEEPEST * between.truncate().length()
}

/// A rectangle on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footprint {
    /// Middle, metres.
    pub centre: Vec2,
    /// Unit vector to the front.
    pub forward: Vec2,
    /// Half of length and width, metres.
    pub half: Vec2,
}

impl Footprint {
    /// Whether two footprints share ground (separating axes).
    pub fn overlaps(&self, other: &Self) -> bool {
        let between = other.centre - self.centre;
        let mut axes = self.axes().into_iter().chain(other.axes());
        axes.all(|axis| between.dot(axis).abs() <= self.reach(axis) + other.reach(axis))
    }

    /// Unit vectors to the front and to the left.
    pub fn axes(&self) -> [Vec2; 2] {
        [self.forward, self.forward.perp()]
    }

    /// How far it extends from its middle along a direction, metres.
    pub fn reach(&self, axis: Vec2) -> f32 {
        let [forward, left] = self.axes();
        self.half.x * forward.dot(axis).abs() + self.half.y * left.dot(axis).abs()
    }

    /// That of the ego car.
    pub fn of_ego(car: &EgoScene) -> Self {
        Self { centre: middle(car), forward: forward(car), half: 0.5 * ego::SIZE_M.truncate() }
    }

    /// That of an actor.
    pub fn of_actor(actor: &ActorScene) -> Self {
        let forward = (actor.rotation * Vec3::X).truncate().normalize_or(Vec2::X);
        Self { centre: actor.position.truncate(), forward, half: 0.5 * actor.kind.size_m().truncate() }
    }

    /// That of a parked car.
    pub fn of_prop(prop: &Prop) -> Self {
        Self {
            centre: prop.position.truncate(),
            forward: direction(prop.heading_rad),
            half: 0.5 * prop.size.truncate(),
        }
    }
}

/// Middle of the ego car, seen from above.
pub fn middle(car: &EgoScene) -> Vec2 {
    car.position.truncate() + ego::CENTRE_M.x * forward(car)
}

/// Direction of the ego car, seen from above.
pub fn forward(car: &EgoScene) -> Vec2 {
    (car.rotation * Vec3::X).truncate().normalize_or(Vec2::X)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_on_the_bridge_above_is_on_another_road() {
        let here = Vec3::new(3.0, 4.0, 7.0);
        let at = |ahead_m: f32, up_m: f32| on_level(here, here + Vec3::new(ahead_m, 0.0, up_m));
        assert!(at(5.0, 0.5) && at(50.0, 5.0) && at(50.0, -5.0));
        assert!(!at(10.0, 5.5) && !at(10.0, -5.5));
    }

    #[test]
    fn footprints_overlap_as_boxes_do() {
        let car = |x, y, heading: f32| Footprint {
            centre: Vec2::new(x, y),
            forward: Vec2::from_angle(heading),
            half: Vec2::new(2.25, 0.9),
        };
        assert!(car(0.0, 0.0, 0.0).overlaps(&car(4.0, 0.0, 0.0)));
        assert!(!car(0.0, 0.0, 0.0).overlaps(&car(0.0, 1.9, 0.0)));
        assert!(car(0.0, 0.0, 0.0).overlaps(&car(0.0, 2.5, 1.57)));
        assert!(!car(0.0, 0.0, 0.0).overlaps(&car(3.0, 3.0, -0.785)));
    }
}
