//! Road users: where they are, and how they move, which follows from this scene and the one before.

use std::collections::BTreeMap;

use glam::{DVec3, Quat, Vec3};
use kernel::ego::{CENTRE_M, FRONT_M, REAR_OVERHANG_M, SIZE_M, WHEEL_RADIUS_M, WHEELBASE_M};
use kernel::ops;
use kernel::scene::{ActorKind, ActorScene, EgoScene, SceneSnapshot};
use kernel::time::{TICK_HZ, Tick};

use super::ids;
use super::kinds;
use super::messages::{BaseMoving, Identifier, MovingObject, Orientation3d, VehicleAttributes};
use super::place::{Frame, dimension, orientation, vector};

/// How many scenes it takes until everybody's acceleration is known.
pub const WARM_UP_SCENES: Tick = 2;
/// The ego car from the ground to its roof, metres.
const HEIGHT_M: f32 = CENTRE_M.z + 0.5 * SIZE_M.z;
const WHEELS: u32 = 4;

/// A road user in a scene.
struct Mover {
    id: Identifier,
    /// Nothing for the ego car.
    kind: Option<ActorKind>,
    size_m: Vec3,
    rotation: Quat,
    middle: Vec3,
    /// From where the speed is told to the middle of the box, in the world's axes, metres.
    to_middle_m: Vec3,
    speed_mps: f32,
    lamps: u8,
}

impl Mover {
    fn of_ego(car: &EgoScene) -> Self {
        let size_m = Vec3::new(SIZE_M.x, SIZE_M.y, HEIGHT_M);
        let to_middle_m = car.rotation * Vec3::new(0.5 * (FRONT_M - REAR_OVERHANG_M), 0.0, 0.5 * HEIGHT_M);
        Self {
            id: ids::EGO,
            kind: None,
            size_m,
            rotation: car.rotation,
            middle: car.position + to_middle_m,
            to_middle_m,
            speed_mps: car.speed_mps,
            lamps: car.lamps,
        }
    }

    fn of_actor(actor: &ActorScene) -> Self {
        let size_m = actor.kind.size_m();
        let to_middle_m = actor.rotation * Vec3::new(0.0, 0.0, 0.5 * size_m.z);
        Self {
            id: ids::actor(actor.id),
            kind: Some(actor.kind),
            size_m,
            rotation: actor.rotation,
            middle: actor.position + to_middle_m,
            to_middle_m,
            speed_mps: actor.speed_mps,
            lamps: actor.lamps,
        }
    }
}

/// How somebody moved at a time.
#[derive(Clone, Copy)]
struct Motion {
    orientation: Orientation3d,
    velocity_mps: DVec3,
}

/// Follows everybody from scene to scene.
#[derive(Default)]
pub struct Followed {
    tick: Tick,
    motions: BTreeMap<u64, Motion>,
}

impl Followed {
    /// Everybody in the next scene, the ego car first. Who was not in the one before neither turns nor accelerates yet.
    pub fn look(&mut self, scene: &SceneSnapshot, frame: Frame) -> Vec<MovingObject> {
        let since_s = scene.tick.saturating_sub(self.tick) as f64 / f64::from(TICK_HZ);
        let before = std::mem::take(&mut self.motions);
        self.tick = scene.tick;
        let movers = std::iter::once(Mover::of_ego(&scene.ego)).chain(scene.actors.iter().map(Mover::of_actor));
        let object = |mover: Mover| {
            let base = self.base(&mover, before.get(&mover.id.value), since_s, frame);
            MovingObject {
                id: mover.id,
                base,
                r#type: kinds::moving(mover.kind) as i32,
                vehicle_attributes: attributes(&mover),
                vehicle_classification: kinds::classification(mover.kind, mover.lamps),
                model_reference: kinds::name(mover.kind),
            }
        };
        movers.map(object).collect()
    }

    fn base(&mut self, mover: &Mover, before: Option<&Motion>, since_s: f64, frame: Frame) -> BaseMoving {
        let orientation = orientation(mover.rotation);
        let before = before.filter(|_| since_s > 0.0);
        let rate = before.map_or(Orientation3d::default(), |b| rate(&b.orientation, &orientation, since_s));
        let ahead_mps = f64::from(mover.speed_mps) * (mover.rotation * Vec3::X).as_dvec3();
        let swing_mps = DVec3::new(0.0, 0.0, rate.yaw).cross(mover.to_middle_m.as_dvec3());
        let velocity_mps = ahead_mps + swing_mps;
        let acceleration_mps2 = before.map_or(DVec3::ZERO, |b| (velocity_mps - b.velocity_mps) / since_s);
        self.motions.insert(mover.id.value, Motion { orientation, velocity_mps });
        BaseMoving {
            dimension: dimension(mover.size_m),
            position: frame.place(mover.middle),
            orientation,
            velocity: vector(velocity_mps),
            acceleration: vector(acceleration_mps2),
            orientation_rate: rate,
        }
    }
}

fn rate(from: &Orientation3d, to: &Orientation3d, since_s: f64) -> Orientation3d {
    let by = |from: f64, to: f64| f64::from(ops::wrap_angle((to - from) as f32)) / since_s;
    Orientation3d { roll: by(from.roll, to.roll), pitch: by(from.pitch, to.pitch), yaw: by(from.yaw, to.yaw) }
}

/// Every vehicle has some; those of the ego car alone are known.
fn attributes(mover: &Mover) -> Option<VehicleAttributes> {
    kinds::classification(mover.kind, mover.lamps)?;
    if mover.kind.is_some() {
        return Some(VehicleAttributes::default());
    }
    let rear =
        DVec3::new(f64::from(0.5 * (REAR_OVERHANG_M - FRONT_M)), 0.0, f64::from(WHEEL_RADIUS_M - 0.5 * HEIGHT_M));
    Some(VehicleAttributes {
        radius_wheel: Some(WHEEL_RADIUS_M.into()),
        number_wheels: Some(WHEELS),
        bbcenter_to_rear: Some(vector(rear)),
        bbcenter_to_front: Some(vector(rear + f64::from(WHEELBASE_M) * DVec3::X)),
        ground_clearance: Some(f64::from(HEIGHT_M - SIZE_M.z)),
    })
}

#[cfg(test)]
mod tests {
    use kernel::geometry::rotation;
    use kernel::scene::Weather;

    use super::*;

    const FRAME: Frame = Frame { origin_m: [0.0; 2] };

    /// The ego car on a circle to the left of so many metres about (0, 0), at its rear axle, after some ticks.
    fn circling(radius_m: f32, speed_mps: f32, tick: Tick) -> SceneSnapshot {
        let turned_rad = speed_mps / radius_m * tick as f32 / TICK_HZ as f32;
        let ego = EgoScene {
            position: radius_m * Vec3::new(ops::sin(turned_rad), -ops::cos(turned_rad), 0.0),
            rotation: rotation(turned_rad),
            speed_mps,
            wheel_angle_rad: 0.0,
            lamps: 0,
        };
        let weather = Weather::dry(0.0, 0.0, 45.0, 0.0);
        SceneSnapshot { tick, ego, actors: Vec::new(), lights: Vec::new(), weather }
    }

    #[test]
    fn the_middle_of_the_ego_car_swings_about_its_rear_axle() {
        let (radius_m, speed_mps, stride) = (20.0, 8.0, 6);
        let mut followed = Followed::default();
        let look =
            |tick, followed: &mut Followed| followed.look(&circling(radius_m, speed_mps, tick), FRAME).remove(0).base;
        let bases: Vec<BaseMoving> = (1..=4).map(|step| look(step * stride, &mut followed)).collect();
        let [.., before, last] = bases.as_slice() else { panic!("four") };
        let place = |base: &BaseMoving| DVec3::new(base.position.x, base.position.y, base.position.z);
        let told = |v: super::super::messages::Vector3d| DVec3::new(v.x, v.y, v.z);
        let middle_m = f64::from(radius_m).hypot(1.35);
        assert!((place(last).truncate().length() - middle_m).abs() < 1e-3);
        assert!((last.orientation_rate.yaw - 0.4).abs() < 1e-4, "{:?}", last.orientation_rate);
        // Round a circle of the middle's own radius, which the same turn takes it round.
        assert!((told(last.velocity).length() - 0.4 * middle_m).abs() < 1e-3);
        assert!((told(last.acceleration).length() - 0.16 * middle_m).abs() < 0.01);
        let moved_mps = (place(last) - place(before)) / 0.1;
        assert!(moved_mps.distance(told(last.velocity)) < 0.2, "{moved_mps} and {:?}", last.velocity);
    }

    #[test]
    fn nobody_accelerates_in_the_first_scene() {
        let first = Followed::default().look(&circling(20.0, 8.0, 600), FRAME).remove(0).base;
        assert_eq!((first.acceleration, first.orientation_rate), Default::default());
    }

    #[test]
    fn the_ego_car_stands_on_the_ground_and_its_axles_are_where_they_are() {
        let car = Followed::default().look(&circling(20.0, 0.0, 0), FRAME).remove(0);
        let (base, attributes) = (car.base, car.vehicle_attributes.expect("a vehicle"));
        assert!((base.position.z - 0.5 * base.dimension.height).abs() < 1e-6);
        assert!((base.dimension.height - 1.5).abs() < 1e-6);
        let rear = attributes.bbcenter_to_rear.expect("known");
        assert!((base.position.x + rear.x).abs() < 1e-6, "it is below the place of the scene");
        assert!((base.position.z + rear.z - 0.32).abs() < 1e-6, "it is a wheel's radius above the ground");
    }
}
