//! The physics world: the ego car and the actors near it.

use std::sync::Arc;

use glam::{Quat, Vec3};
use rapier3d::control::DynamicRayCastVehicleController;
use rapier3d::prelude::*;

use super::build::{ACTORS, EGO, GROUND, PROPS, car, free, groups, mass, parameters};
use super::statics::Statics;
use crate::actor::ActorKind;
use crate::ego::{self, WheelForces};
use crate::motion::Motion;
use crate::time::TICK_S;

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);
/// Impulse within a tick from which contact counts as a collision, N s.
const COLLISION_IMPULSE_NS: f32 = 1.0;

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
    car: DynamicRayCastVehicleController,
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
            car: self.car.clone(),
            actors: self.actors.clone(),
        }
    }
}

impl Physics {
    /// The ego car alone on a map.
    pub fn new(statics: &Arc<Statics>, ego: &Motion) -> Self {
        let (mut colliders, mut bodies) = (statics.colliders.clone(), RigidBodySet::new());
        let body = bodies.insert(free(ego).additional_mass_properties(MassProperties::new(
            ego::CENTRE_OF_MASS_M,
            ego::MASS_KG,
            ego::INERTIA,
        )));
        let half = ego::SIZE_M * 0.5;
        let shell = ColliderBuilder::cuboid(half.x, half.y, half.z)
            .translation(ego::CENTRE_M)
            .density(0.0)
            .friction(0.3)
            .restitution(0.1)
            .collision_groups(groups(EGO, GROUND | PROPS | ACTORS));
        let ego_collider = colliders.insert_with_parent(shell, body, &mut bodies);
        // The wheels push before the first step would do this: without a mass they give NaN.
        bodies[body].recompute_mass_properties_from_colliders(&colliders);
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
            car: car(body),
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
            .friction(0.6)
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

    /// Where a guided actor shall be after the next step.
    pub fn guide(&mut self, id: u32, position: Vec3, rotation: Quat) {
        if let Ok(at) = self.place(id) {
            self.bodies[self.actors[at].body].set_next_kinematic_position(Pose::from_parts(position, rotation));
        }
    }

    /// Advances by one tick.
    pub fn step(&mut self, forces: &WheelForces) {
        self.drive(forces);
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
    }

    fn drive(&mut self, forces: &WheelForces) {
        for (i, wheel) in self.car.wheels_mut().iter_mut().enumerate() {
            let front = i < 2;
            // Rapier turns the wheel counter-clockwise, we count to the right.
            wheel.steering = if front { -forces.wheel_angle_rad } else { 0.0 };
            wheel.engine_force = if front { 0.5 * forces.drive_n } else { 0.0 };
            wheel.brake = 0.5 * TICK_S * if front { forces.front_brake_n } else { forces.rear_brake_n };
        }
        let filter = QueryFilter::default().groups(groups(EGO, GROUND));
        let dispatcher = self.narrow_phase.query_dispatcher();
        let queries = self.broad_phase.as_query_pipeline_mut(dispatcher, &mut self.bodies, &mut self.colliders, filter);
        self.car.update_vehicle(TICK_S, queries);
    }

    /// Motion of the ego car.
    pub fn ego(&self) -> Motion {
        motion(&self.bodies[self.ego])
    }

    /// Motion of an actor that is in the physics world.
    pub fn actor(&self, id: u32) -> Option<Motion> {
        self.place(id).ok().map(|at| motion(&self.bodies[self.actors[at].body]))
    }

    /// Whether a wheel of the ego car stands on something that is not paved.
    pub fn off_road(&self) -> bool {
        let on = |wheel: &rapier3d::control::Wheel| wheel.raycast_info().ground_object;
        self.car.wheels().iter().filter_map(on).any(|ground| Some(ground) != self.statics.paved)
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
            } else if Some(other) == self.statics.scenery {
                touched.scenery = Some(pushed);
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
