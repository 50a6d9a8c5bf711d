//! Which actors are in the physics world, and which of them were hit.

use glam::{Vec3, Vec3Swizzles};

use crate::actor::ActorKind;
use crate::ego::{self, Ego};
use crate::geometry::{rectangles_overlap, rotation};
use crate::motion::Motion;
use crate::physics::{Hold, Physics};
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
    /// An actor that was hit. It is no traffic any more.
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
        /// Actors that were hit, near or far.
        pub loose: Vec<Loose>,
    }
}

impl Loose {
    fn hold(&self) -> Hold {
        if self.resting { Hold::Resting(self.motion) } else { Hold::Free(self.motion) }
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

    /// Puts every near actor into a fresh physics world, in the order of ids.
    pub fn insert_all(&self, traffic: &[Body], physics: &mut Physics) {
        for &id in &self.near {
            if let Some(body) = find(traffic, id) {
                physics.hold(id, body.kind, &self.hold(body));
            }
        }
    }

    fn hold(&self, body: &Body) -> Hold {
        let guided = Hold::Guided { position: body.position, rotation: body.rotation };
        self.loose(body.id).map_or(guided, Loose::hold)
    }

    /// Lets actors in and out by their distance, guides the near ones to their new places, and
    /// frees those that the car is about to hit. `near` is working memory.
    pub fn prepare(&mut self, traffic: &[Body], car: &Ego, physics: &mut Physics, near: &mut Vec<u32>) {
        near.clear();
        let middle = car.middle();
        for body in traffic {
            let place = self.loose(body.id).map_or(body.position, |loose| loose.motion.position);
            let distance = (place - middle).xy().length();
            let was_near = self.near.binary_search(&body.id).is_ok();
            if distance > if was_near { LEAVE_M } else { ENTER_M } {
                if was_near {
                    self.leave(body.id, physics);
                }
                continue;
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
        std::mem::swap(&mut self.near, near);
    }

    fn leave(&mut self, id: u32, physics: &mut Physics) {
        physics.release(id);
        if let Ok(at) = self.loose_place(id) {
            self.loose[at].rest();
        }
    }

    /// A guided body would push the car like a wall, so it is freed in the tick before the hit.
    fn free_if_hit(&mut self, body: &Body, car: &Ego, physics: &mut Physics) {
        let found = self.loose_place(body.id);
        let motion = match found {
            Ok(at) if !self.loose[at].resting => return,
            Ok(at) => self.loose[at].motion,
            Err(_) => before(body),
        };
        if !will_touch(car, &motion, body.kind.size_m()) {
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

/// Whether the boxes of the car and of a body overlap after a tick of straight motion, seen from
/// above and in height.
fn will_touch(car: &Ego, other: &Motion, size_m: Vec3) -> bool {
    if (car.motion.velocity_mps - other.velocity_mps).length() < LEAST_HIT_MPS {
        return false;
    }
    let forward = other.rotation * Vec3::X;
    let turned = rotation(car.heading_rad()).conjugate();
    let gap = other.position + other.velocity_mps * TICK_S - (car.middle() + (car.motion.velocity_mps * TICK_S));
    let (gap, axis) = (turned * gap, turned * forward);
    if gap.z.abs() > ego::SIZE_M.z + size_m.z {
        return false;
    }
    let (half_car, half) = (ego::SIZE_M.xy() * 0.5 + GAP_M, size_m.xy() * 0.5 + GAP_M);
    rectangles_overlap(half_car, gap.xy(), axis.xy(), half)
}
