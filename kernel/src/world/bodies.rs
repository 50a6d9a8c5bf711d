//! Which actors are in the physics world, and which of them were hit.

use glam::{Vec3, Vec3Swizzles};

use crate::actor::{ActorKind, FIRST_PARKED_ID};
use crate::ego::{self, Ego};
use crate::geometry::{rectangles_overlap, rotation};
use crate::map_data::Prop;
use crate::motion::Motion;
use crate::physics::{Hold, Physics};
use crate::places::ParkedCars;
use crate::time::{TICK_S, seconds};
use crate::traffic::{Body, Obstacle};
use crate::{ops, state};

/// An actor enters the physics world at this distance from the ego car, metres.
const ENTER_M: f32 = 60.0;
/// It leaves at this distance, metres.
const LEAVE_M: f32 = 70.0;
/// Beyond this distance no actor can be about to be hit, metres.
const REACH_M: f32 = 15.0;
/// Gap below which a hit is certain, metres.
const GAP_M: f32 = 0.03;
/// Slower than this relative to the car, nothing is about to be hit, m/s.
const LEAST_HIT_MPS: f32 = 0.1;
/// Slower than this in m/s and rad/s, a loose body comes to rest.
const REST_SPEED: f32 = 0.15;
/// A loose body moves at least this long.
const LEAST_LOOSE_TICKS: u16 = seconds(1) as u16;
/// A loose body comes to rest at the latest after this time.
const MOST_LOOSE_TICKS: u16 = seconds(10) as u16;

state! {
    /// An actor that was hit, or a parked car that was. It is no traffic any more.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Loose {
        /// Id of the actor.
        pub id: u32,
        /// Its kind.
        pub kind: ActorKind,
        /// Pose and velocities.
        pub motion: Motion,
        /// Ticks since it was hit; stays when it has come to rest.
        pub ticks: u16,
        /// It has come to rest.
        pub resting: bool,
    }
}

state! {
    /// The actors in the physics world, and all that were hit, each by ascending id.
    #[derive(Clone, Debug, Default, PartialEq)]
    pub struct Bodies {
        /// Actors near the ego car: those in the physics world.
        pub near: Vec<u32>,
        /// Actors and parked cars that were hit, near or far.
        pub loose: Vec<Loose>,
    }
}

impl Loose {
    fn hold(&self) -> Hold {
        if self.resting { Hold::Resting(self.motion) } else { Hold::Free(self.motion) }
    }

    /// As an actor that is nowhere else.
    fn body(&self) -> Body {
        let Motion { position, rotation, velocity_mps, .. } = self.motion;
        let (variant, phase_rad, lamps) = (0, 0.0, 0);
        Body { id: self.id, kind: self.kind, variant, position, rotation, velocity_mps, phase_rad, lamps }
    }

    /// What the others see of it.
    pub fn obstacle(&self) -> Obstacle {
        let forward = self.motion.rotation * Vec3::X;
        Obstacle {
            id: self.id,
            position: self.motion.position,
            heading_rad: ops::atan2(forward.y, forward.x),
            velocity_mps: self.motion.velocity_mps,
            size_m: self.kind.size_m(),
            on_foot: self.kind.is_on_foot(),
        }
    }
}

impl Bodies {
    /// The actor, if it was hit.
    pub fn loose(&self, id: u32) -> Option<&Loose> {
        self.loose_place(id).ok().map(|at| &self.loose[at])
    }

    fn loose_place(&self, id: u32) -> Result<usize, usize> {
        self.loose.binary_search_by_key(&id, |loose| loose.id)
    }

    /// Parked cars that were pushed, by ascending id.
    pub fn pushed(&self) -> &[Loose] {
        &self.loose[self.loose.partition_point(|loose| loose.id < FIRST_PARKED_ID)..]
    }

    /// Puts every near actor into a fresh physics world, in the order of ids.
    pub fn insert_all(&self, traffic: &[Body], physics: &mut Physics) {
        for &id in &self.near {
            let guided = || find(traffic, id).map(|body| (body.kind, self.hold(body)));
            let held = self.loose(id).map(|loose| (loose.kind, loose.hold())).or_else(guided);
            if let Some((kind, hold)) = held {
                physics.hold(id, kind, &hold);
            }
        }
        if !self.pushed().is_empty() {
            physics.unpark(|number| self.loose(FIRST_PARKED_ID + number).is_some());
        }
    }

    fn hold(&self, body: &Body) -> Hold {
        let guided = Hold::Guided { position: body.position, rotation: body.rotation };
        self.loose(body.id).map_or(guided, Loose::hold)
    }

    /// Lets actors in and out by their distance, guides the near ones to their new places, and
    /// frees those that the car is about to hit. `near` is working memory.
    pub fn prepare(
        &mut self,
        traffic: &[Body],
        parked: &ParkedCars,
        car: &Ego,
        physics: &mut Physics,
        near: &mut Vec<u32>,
    ) {
        near.clear();
        let mover = Mover::of_car(car);
        for body in traffic {
            self.attend(body, &mover, physics, near);
        }
        for at in self.loose.len() - self.pushed().len()..self.loose.len() {
            let body = self.loose[at].body();
            self.attend(&body, &mover, physics, near);
        }
        self.push_parked(parked, &mover, physics, near);
        // Who got on a bus is nowhere any more.
        let gone = self.near.iter().filter(|id| near.binary_search(id).is_err());
        gone.for_each(|id| physics.release(*id));
        std::mem::swap(&mut self.near, near);
    }

    /// Looks after one body.
    fn attend(&mut self, body: &Body, car: &Mover, physics: &mut Physics, near: &mut Vec<u32>) {
        let place = self.loose(body.id).map_or(body.position, |loose| loose.motion.position);
        let distance = (place - car.middle).xy().length();
        let was_near = self.near.binary_search(&body.id).is_ok();
        if distance > if was_near { LEAVE_M } else { ENTER_M } {
            if was_near {
                self.leave(body.id, physics);
            }
            return;
        }
        near.push(body.id);
        if !was_near {
            physics.hold(body.id, body.kind, &self.hold(body));
        }
        if distance < REACH_M {
            self.free_if_hit(body, car, physics);
        }
        physics.guide(body.id, body.position, body.rotation);
    }

    /// Parked cars that the car or a loose body is about to hit are loose from now on.
    fn push_parked(&mut self, parked: &ParkedCars, car: &Mover, physics: &mut Physics, near: &mut Vec<u32>) {
        let mut hit = Vec::new();
        let moving = self.loose.iter().filter(|loose| !loose.resting).map(Mover::of_loose);
        for mover in std::iter::once(*car).chain(moving) {
            let numbers = parked.around(mover.middle, mover.size_m.x);
            let stands = numbers.filter(|number| self.loose(FIRST_PARKED_ID + number).is_none());
            hit.extend(stands.filter(|number| {
                let prop = &parked.cars[*number as usize];
                mover.will_touch(&standing(prop), prop.size)
            }));
        }
        if hit.is_empty() {
            return;
        }
        hit.sort_unstable();
        hit.dedup();
        for number in hit {
            let (id, prop) = (FIRST_PARKED_ID + number, &parked.cars[number as usize]);
            let loose = Loose { id, kind: prop.parked_kind(), motion: standing(prop), ticks: 0, resting: false };
            let at = self.loose_place(id).unwrap_or_else(|at| at);
            self.loose.insert(at, loose);
            near.insert(near.partition_point(|near| *near < id), id);
            physics.hold(id, loose.kind, &loose.hold());
        }
        physics.unpark(|number| self.loose(FIRST_PARKED_ID + number).is_some());
    }

    fn leave(&mut self, id: u32, physics: &mut Physics) {
        physics.release(id);
        if let Ok(at) = self.loose_place(id) {
            self.loose[at].rest();
        }
    }

    /// A guided body would push the car like a wall, so it is freed in the tick before the hit.
    fn free_if_hit(&mut self, body: &Body, car: &Mover, physics: &mut Physics) {
        let found = self.loose_place(body.id);
        let motion = match found {
            Ok(at) if !self.loose[at].resting => return,
            Ok(at) => self.loose[at].motion,
            Err(_) => before(body),
        };
        if !car.will_touch(&motion, body.kind.size_m()) {
            return;
        }
        let loose = Loose { id: body.id, kind: body.kind, motion, ticks: 0, resting: false };
        match found {
            Ok(at) => self.loose[at] = loose,
            Err(at) => self.loose.insert(at, loose),
        }
        physics.hold(body.id, body.kind, &loose.hold());
    }

    /// Takes over what physics made of the loose bodies, and lets slow ones rest, but none of those
    /// that the car touches.
    pub fn moved(&mut self, touching: &[u32], physics: &mut Physics) {
        for loose in self.loose.iter_mut().filter(|loose| !loose.resting) {
            let Some(motion) = physics.actor(loose.id) else { continue };
            loose.motion = motion;
            loose.ticks = loose.ticks.saturating_add(1);
            if touching.binary_search(&loose.id).is_ok() {
                continue;
            }
            let slow = motion.velocity_mps.length().max(motion.spin_radps.length()) < REST_SPEED;
            if (slow && loose.ticks > LEAST_LOOSE_TICKS) || loose.ticks >= MOST_LOOSE_TICKS {
                loose.rest();
                physics.hold(loose.id, loose.kind, &loose.hold());
            }
        }
    }
}

impl Loose {
    fn rest(&mut self) {
        self.resting = true;
        self.motion.velocity_mps = Vec3::ZERO;
        self.motion.spin_radps = Vec3::ZERO;
    }
}

/// The actor with an id in a list by ascending id.
pub fn find(traffic: &[Body], id: u32) -> Option<&Body> {
    traffic.binary_search_by_key(&id, |body| body.id).ok().map(|at| &traffic[at])
}

/// Where a guided body was a tick ago, moving freely.
fn before(body: &Body) -> Motion {
    Motion {
        position: body.position - body.velocity_mps * TICK_S,
        rotation: body.rotation,
        velocity_mps: body.velocity_mps,
        spin_radps: Vec3::ZERO,
    }
}

/// A parked car before anybody touched it.
fn standing(car: &Prop) -> Motion {
    let (position, rotation) = (car.position, rotation(car.heading_rad));
    Motion { position, rotation, velocity_mps: Vec3::ZERO, spin_radps: Vec3::ZERO }
}

/// A box that runs into others.
#[derive(Clone, Copy)]
struct Mover {
    /// Middle of its footprint, metres.
    middle: Vec3,
    heading_rad: f32,
    velocity_mps: Vec3,
    turn_radps: f32,
    size_m: Vec3,
}

impl Mover {
    fn of_car(car: &Ego) -> Self {
        let Motion { velocity_mps, spin_radps, .. } = car.motion;
        let (middle, heading_rad) = (car.middle(), car.heading_rad());
        Self { middle, heading_rad, velocity_mps, turn_radps: spin_radps.z, size_m: ego::SIZE_M }
    }

    fn of_loose(loose: &Loose) -> Self {
        let Obstacle { position, heading_rad, velocity_mps, size_m, .. } = loose.obstacle();
        Self { middle: position, heading_rad, velocity_mps, turn_radps: loose.motion.spin_radps.z, size_m }
    }

    /// Whether its box and that of a body overlap after a tick of straight motion, seen from above and in height.
    fn will_touch(&self, other: &Motion, size_m: Vec3) -> bool {
        let swings_mps = 0.5 * self.size_m.x * self.turn_radps.abs();
        if (self.velocity_mps - other.velocity_mps).length() + swings_mps < LEAST_HIT_MPS {
            return false;
        }
        let forward = other.rotation * Vec3::X;
        let turned = rotation(self.heading_rad + self.turn_radps * TICK_S).conjugate();
        let gap = other.position + other.velocity_mps * TICK_S - (self.middle + self.velocity_mps * TICK_S);
        let (gap, axis) = (turned * gap, turned * forward);
        if gap.z.abs() > self.size_m.z + size_m.z {
            return false;
        }
        let (half_self, half) = (self.size_m.xy() * 0.5 + GAP_M, size_m.xy() * 0.5 + GAP_M);
        rectangles_overlap(half_self, gap.xy(), axis.xy(), half)
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::map::bundled;
    use crate::scenario::Scenario;
    use crate::world::World;

    #[test]
    fn who_gets_on_a_bus_is_in_the_physics_world_no_more() {
        let network = bundled("city").expect("it is bundled");
        let world = World::new(&Scenario::default_for("city", 1), &network).expect("the scenario fits");
        let car = &world.parts.ego.car;
        let mut physics = Physics::new(network.statics(), &car.motion);
        let person = |id: u32| Body {
            id,
            kind: ActorKind::Pedestrian,
            variant: 0,
            position: car.middle() + Vec3::Y * (20.0 + id as f32),
            rotation: Quat::IDENTITY,
            velocity_mps: Vec3::ZERO,
            phase_rad: 0.0,
            lamps: 0,
        };
        let (mut bodies, mut near) = (Bodies::default(), Vec::new());
        for there in [&[1, 2, 3][..], &[1, 3], &[1, 2, 3], &[2]] {
            let people: Vec<_> = there.iter().map(|id| person(*id)).collect();
            bodies.prepare(&people, &network.places().parked, car, &mut physics, &mut near);
            assert_eq!(bodies.near, there);
            assert!((1..4).all(|id| physics.actor(id).is_some() == there.contains(&id)), "{there:?}");
        }
    }
}
