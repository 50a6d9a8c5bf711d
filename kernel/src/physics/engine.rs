//! The physics world: the ego car and the actors near it.

use std::sync::Arc;

use glam::{Quat, Vec3};
use rapier3d::prelude::*;

use super::build::{ACTORS, EGO, GROUND, PROPS, free, groups, mass, parameters};
use super::statics::{Statics, is_soft};
use crate::actor::{ActorKind, FIRST_PARKED_ID};
use crate::car::{self, CarSetup, Footing, Footprint, RunningGear, WHEELS};
use crate::controls::Controls;
use crate::ego::Ego;
use crate::map_data::SurfaceKind;
use crate::motion::Motion;
use crate::time::TICK_S;
use crate::weather::Water;

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -car::GRAVITY_MPS2);
/// Ground that is steeper than this along the car's z axis carries no wheel.
const LEAST_NORMAL_Z: f32 = 0.3;
/// Impulse within a tick from which contact counts as a collision, N s.
const COLLISION_IMPULSE_NS: f32 = 1.0;

/// Friction of what was hit, and of a parked car, whose brakes are on. With that of the ground it comes to the mean: tyres
/// that slide on a dry road have 0.7.
const FRICTION: f32 = 0.6;
const PARKED_FRICTION: f32 = 0.8;

/// How an actor is in the physics world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// Traffic moves it; nothing pushes it away.
    Guided {
        /// Centre of its footprint, metres.
        position: Vec3,
        /// Its rotation.
        rotation: Quat,
    },
    /// It was hit and moves freely.
    Free(Motion),
    /// It was hit and has come to rest.
    Resting(Motion),
}

#[derive(Clone)]
struct Actor {
    id: u32,
    body: RigidBodyHandle,
    collider: ColliderHandle,
}

/// What the ego car touched in a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Touched {
    /// Actors, by ascending id, each with whether an impulse passed in this tick.
    pub actors: Vec<(u32, bool)>,
    /// Scenery, and whether an impulse passed in this tick.
    pub scenery: Option<bool>,
}

/// The physics world: the ego car and the actors near it on the static map.
pub struct Physics {
    statics: Arc<Statics>,
    colliders: ColliderSet,
    broad_phase: BroadPhaseBvh,
    bodies: RigidBodySet,
    islands: IslandManager,
    narrow_phase: NarrowPhase,
    impulse_joints: ImpulseJointSet,
    multibody_joints: MultibodyJointSet,
    soft_bodies: SoftBodySet,
    ccd: CCDSolver,
    pipeline: PhysicsPipeline,
    parameters: IntegrationParameters,
    ego: RigidBodyHandle,
    ego_collider: ColliderHandle,
    parked: Option<ColliderHandle>,
    off_road: bool,
    footprints: [Footprint; WHEELS],
    actors: Vec<Actor>,
}

impl Clone for Physics {
    fn clone(&self) -> Self {
        Self {
            statics: self.statics.clone(),
            colliders: self.colliders.clone(),
            broad_phase: self.broad_phase.clone(),
            bodies: self.bodies.clone(),
            islands: self.islands.clone(),
            narrow_phase: self.narrow_phase.clone(),
            impulse_joints: self.impulse_joints.clone(),
            multibody_joints: self.multibody_joints.clone(),
            soft_bodies: self.soft_bodies.clone(),
            ccd: self.ccd.clone(),
            // Working memory only.
            pipeline: PhysicsPipeline::new(),
            parameters: self.parameters,
            ego: self.ego,
            ego_collider: self.ego_collider,
            parked: self.parked,
            off_road: self.off_road,
            footprints: self.footprints,
            actors: self.actors.clone(),
        }
    }
}

impl Physics {
    /// The ego car alone on a map.
    pub fn new(statics: &Arc<Statics>, ego: &Motion) -> Self {
        let (mut colliders, mut bodies) = (statics.colliders.clone(), RigidBodySet::new());
        let mass = MassProperties::new(car::CENTRE_OF_MASS_M, car::MASS_KG, car::INERTIA);
        // Its weight is among the forces that it steps under within a tick.
        let body = bodies.insert(free(ego).additional_mass_properties(mass).gravity_scale(0.0));
        let half = car::SIZE_M * 0.5;
        let shell = ColliderBuilder::cuboid(half.x, half.y, half.z)
            .translation(car::CENTRE_M)
            .density(0.0)
            .friction(0.3)
            .restitution(0.1)
            .collision_groups(groups(EGO, GROUND | PROPS | ACTORS));
        let ego_collider = colliders.insert_with_parent(shell, body, &mut bodies);
        Self {
            statics: statics.clone(),
            broad_phase: statics.broad_phase.clone(),
            colliders,
            bodies,
            islands: IslandManager::new(),
            narrow_phase: NarrowPhase::new(),
            impulse_joints: ImpulseJointSet::new(),
            multibody_joints: MultibodyJointSet::new(),
            soft_bodies: SoftBodySet::new(),
            ccd: CCDSolver::new(),
            pipeline: PhysicsPipeline::new(),
            parameters: parameters(),
            ego: body,
            ego_collider,
            parked: statics.parked,
            off_road: false,
            footprints: Default::default(),
            actors: Vec::new(),
        }
    }

    fn place(&self, id: u32) -> Result<usize, usize> {
        self.actors.binary_search_by_key(&id, |actor| actor.id)
    }

    /// Puts an actor in, or holds it differently from now on.
    pub fn hold(&mut self, id: u32, kind: ActorKind, hold: &Hold) {
        self.release(id);
        let size = kind.size_m();
        let body = match hold {
            Hold::Guided { position, rotation } => RigidBodyBuilder::kinematic_position_based()
                .pose(Pose::from_parts(*position, *rotation))
                .can_sleep(false),
            Hold::Free(motion) => free(motion).additional_mass_properties(mass(kind)),
            Hold::Resting(motion) => RigidBodyBuilder::fixed().pose(Pose::from_parts(motion.position, motion.rotation)),
        };
        let body = self.bodies.insert(body);
        let shape = ColliderBuilder::cuboid(0.5 * size.x, 0.5 * size.y, 0.5 * size.z)
            .translation(Vec3::Z * 0.5 * size.z)
            .density(0.0)
            .friction(if id < FIRST_PARKED_ID { FRICTION } else { PARKED_FRICTION })
            .restitution(0.1)
            .collision_groups(groups(ACTORS, GROUND | PROPS | ACTORS | EGO));
        let collider = self.colliders.insert_with_parent(shape, body, &mut self.bodies);
        let at = self.place(id).unwrap_or_else(|at| at);
        self.actors.insert(at, Actor { id, body, collider });
    }

    /// Takes an actor out.
    pub fn release(&mut self, id: u32) {
        if let Ok(at) = self.place(id) {
            let actor = self.actors.remove(at);
            self.bodies.remove(
                actor.body,
                &mut self.islands,
                &mut self.colliders,
                &mut self.impulse_joints,
                &mut self.multibody_joints,
                &mut self.soft_bodies,
                true,
            );
        }
    }

    /// Leaves of the parked cars only those that are not pushed.
    pub fn unpark(&mut self, pushed: impl Fn(u32) -> bool) {
        if let Some(parked) = self.parked {
            self.colliders.remove(parked, &mut self.islands, &mut self.bodies, &mut self.soft_bodies, true);
            self.parked = self.statics.parked_without(pushed).map(|parked| self.colliders.insert(parked));
        }
    }

    /// Where a guided actor shall be after the next step.
    pub fn guide(&mut self, id: u32, position: Vec3, rotation: Quat) {
        if let Ok(at) = self.place(id) {
            self.bodies[self.actors[at].body].set_next_kinematic_position(Pose::from_parts(position, rotation));
        }
    }

    /// Advances by one tick, after [`Physics::drive`] or [`Physics::carry`].
    pub fn step(&mut self, ego: &mut Ego) {
        self.pipeline.step(
            GRAVITY,
            &self.parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &mut self.impulse_joints,
            &mut self.multibody_joints,
            &mut self.soft_bodies,
            &mut self.ccd,
            &(),
            &(),
        );
        ego.moved(motion(&self.bodies[self.ego]));
    }

    /// The ego car gets the velocities that bring the middle of its footprint to a place in the next step.
    pub fn carry(&mut self, ego: &mut Ego, middle: Vec3, rotation: Quat) {
        let now = &ego.motion;
        let position = middle - rotation * Vec3::new(car::CENTRE_M.x, 0.0, 0.0);
        let way = position + rotation * car::CENTRE_OF_MASS_M - now.position - now.rotation * car::CENTRE_OF_MASS_M;
        let turn = rotation * now.rotation.conjugate();
        // The shorter way round, and small: twice its vector part is the angle.
        let turn = Vec3::new(turn.x, turn.y, turn.z) * (2.0 * turn.w.signum());
        (self.off_road, self.footprints) = (false, Default::default());
        let body = &mut self.bodies[self.ego];
        body.set_linvel(way / TICK_S, true);
        body.set_angvel(turn / TICK_S, true);
        let speed_mps = way.dot(rotation * Vec3::X) / TICK_S;
        ego.gear = RunningGear::rolling(speed_mps);
    }

    /// The ego car gets the velocities that its wheels give it under the controls of its driver, with water on the ground. What
    /// it runs into is for the engine.
    pub fn drive(&mut self, ego: &mut Ego, controls: &Controls, setup: &CarSetup, water: &Water) {
        let ground = self.ground(&ego.motion, water);
        self.off_road = ground.iter().flatten().any(|footing| is_soft(footing.kind));
        let (velocity, spin, footprints) = ego.gear.advance(&ego.motion, controls, setup, &ground);
        self.footprints = footprints;
        let body = &mut self.bodies[self.ego];
        body.set_linvel(velocity, true);
        body.set_angvel(spin, true);
    }

    /// The ground below each wheel.
    fn ground(&self, motion: &Motion, water: &Water) -> [Option<Footing>; WHEELS] {
        let (to_body, down) = (motion.rotation.conjugate(), motion.rotation * Vec3::NEG_Z);
        car::mounts().map(|mount| {
            let from = motion.position + motion.rotation * mount;
            let (distance_m, normal, kind) = self.statics.ground(from, down, car::reach_m())?;
            let normal = to_body * normal;
            let normal = if normal.z < 0.0 { -normal } else { normal };
            let place = from + down * distance_m;
            // Soil drinks what falls on it.
            let water_mm = if kind == SurfaceKind::Terrain { 0.0 } else { water.depth_mm(place.truncate()) };
            (normal.z > LEAST_NORMAL_Z).then_some(Footing { distance_m, normal, kind, wet: water.wet, water_mm })
        })
    }

    /// What the wheels of the ego car and the ground did to each other at the end of the last step.
    pub fn footprints(&self) -> &[Footprint; WHEELS] {
        &self.footprints
    }

    /// Motion of an actor that is in the physics world.
    pub fn actor(&self, id: u32) -> Option<Motion> {
        self.place(id).ok().map(|at| motion(&self.bodies[self.actors[at].body]))
    }

    /// Whether a wheel of the ego car stood on something that is not paved at the beginning of the last step.
    pub fn off_road(&self) -> bool {
        self.off_road
    }

    /// What the ego car touched in the last step; reuses `touched`.
    pub fn touched(&self, touched: &mut Touched) {
        touched.actors.clear();
        touched.scenery = None;
        for pair in self.narrow_phase.contact_pairs_with(self.ego_collider) {
            if !pair.has_any_active_contact() {
                continue;
            }
            let pushed = pair.total_impulse_magnitude() > COLLISION_IMPULSE_NS;
            let other = if pair.collider1 == self.ego_collider { pair.collider2 } else { pair.collider1 };
            if let Some(actor) = self.actors.iter().find(|actor| actor.collider == other) {
                touched.actors.push((actor.id, pushed));
            } else if Some(other) == self.statics.scenery || Some(other) == self.parked {
                touched.scenery = Some(pushed || touched.scenery == Some(true));
            }
        }
        touched.actors.sort_unstable();
    }
}

fn motion(body: &RigidBody) -> Motion {
    let pose = body.position();
    Motion {
        position: pose.translation,
        rotation: pose.rotation,
        velocity_mps: body.linvel(),
        spin_radps: body.angvel(),
    }
}
