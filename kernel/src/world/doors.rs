//! Open doors of parked cars around the ego car. They are no bodies: the ego car drives into them without a jolt.

use crate::ego::{self, Ego};
use crate::events::EventKind;
use crate::geometry::rotation;
use crate::physics::Touched;
use crate::scene::{ActorKind, ActorScene};
use crate::time::Tick;
use crate::traffic::{Door, Obstacle, SIGHT_M, Traffic};
use crate::watch::Log;

use super::bodies::Bodies;

/// The ego car as others see it.
pub fn ego_obstacle(car: &Ego) -> Obstacle {
    Obstacle {
        id: 0,
        position: car.middle(),
        heading_rad: car.heading_rad(),
        velocity_mps: car.motion.velocity_mps,
        size_m: ego::SIZE_M,
        on_foot: false,
    }
}

/// The doors that stand open at the end of a tick. Who was pushed keeps them shut.
pub fn open_doors<'a>(traffic: &'a Traffic, bodies: &'a Bodies, tick: Tick, car: &Ego) -> impl Iterator<Item = Door> {
    let stays = |door: &Door| bodies.loose(door.parked_id()).is_none();
    traffic.open_doors(tick, ego_obstacle(car)).filter(stays)
}

/// Notes those that begin to open in sight of the car, and adds those that it drives into to what it touches.
pub fn heed(doors: impl Iterator<Item = Door>, car: &Ego, touched: &mut Touched, log: &mut Log<'_>) {
    for door in doors {
        if door.begins && door.position.distance(car.middle()) < SIGHT_M {
            log.with(EventKind::HazardDoor, door.id);
        }
        if door.is_hit(&ego_obstacle(car)) {
            touched.actors.push((door.id, true));
        }
    }
    touched.actors.sort_unstable();
}

/// An open door as it is seen.
pub fn scene_of(door: &Door) -> ActorScene {
    ActorScene {
        id: door.id,
        kind: ActorKind::Door,
        variant: 0,
        position: door.position,
        rotation: rotation(door.heading_rad),
        speed_mps: 0.0,
        phase_rad: 0.0,
        lamps: 0,
    }
}
