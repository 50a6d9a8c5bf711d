//! Rigid bodies: the only file that names rapier.
//!
//! Nothing in here is saved. A [`Physics`] is made anew from the world's compact state at every
//! keyframe, live and in replay alike, so that its caches never have to survive.

use std::fmt;
use std::sync::{Arc, OnceLock};

use glam::{Quat, Vec3};
use rapier3d::control::{DynamicRayCastVehicleController, WheelTuning};
use rapier3d::prelude::*;

use crate::ego::{self, WheelForces};
use crate::map::{Prop, PropKind, RoadNetwork, SurfaceKind};
use crate::scene::ActorKind;
use crate::state;
use crate::time::TICK_S;

state! {
    /// Pose and velocities of a free body.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Motion {
        /// Origin of the body, metres.
        pub position: Vec3,
        /// Rotation from the body's axes (x forward, y left, z up) to the world's.
        pub rotation: Quat,
        /// Velocity of the centre of mass, m/s.
        pub velocity_mps: Vec3,
        /// Angular velocity, rad/s.
        pub spin_radps: Vec3,
    }
}

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);
/// How far below the lowest point of a map a car that left it is caught, metres.
const CATCH_DEPTH_M: f32 = 5.0;
/// Impulse within a tick from which contact counts as a collision, N s.
const COLLISION_IMPULSE_NS: f32 = 1.0;

const GROUND: Group = Group::GROUP_1;
const PROPS: Group = Group::GROUP_2;
const ACTORS: Group = Group::GROUP_3;
const EGO: Group = Group::GROUP_4;

fn groups(of: Group, with: Group) -> InteractionGroups {
    InteractionGroups::new(of, with, InteractionTestMode::And)
}

/// The static colliders of a map, built on first use and shared by all its worlds.
#[derive(Clone, Default)]
pub struct Statics(OnceLock<Arc<Template>>);

impl fmt::Debug for Statics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.get().is_some() { "Statics(built)" } else { "Statics(not built)" })
    }
}

/// An engine that holds the static colliders only, its search tree filled.
struct Template {
    colliders: ColliderSet,
    broad_phase: BroadPhaseBvh,
    paved: Option<ColliderHandle>,
    scenery: Option<ColliderHandle>,
}

impl Template {
    fn of(network: &RoadNetwork) -> Arc<Self> {
        network.statics.0.get_or_init(|| Arc::new(Self::build(network))).clone()
    }

    fn build(network: &RoadNetwork) -> Self {
        let mut colliders = ColliderSet::new();
        let ground = groups(GROUND, ACTORS | EGO);
        let mut insert = |shape: SharedShape, groups| {
            colliders.insert(ColliderBuilder::new(shape).collision_groups(groups).friction(0.6))
        };
        let is_paved = |kind| matches!(kind, SurfaceKind::Road | SurfaceKind::Ground);
        let is_soft = |kind| matches!(kind, SurfaceKind::Sidewalk | SurfaceKind::Terrain);
        let paved = mesh(network, is_paved).map(|shape| insert(shape, ground));
        mesh(network, is_soft).map(|shape| insert(shape, ground));
        let floor = insert(SharedShape::halfspace(Vec3::Z), ground);
        let boxes: Vec<_> = network.props.iter().map(solid).collect();
        let scenery = (!boxes.is_empty()).then(|| insert(SharedShape::compound(boxes), groups(PROPS, ACTORS | EGO)));
        let depth = network.bounds[0].z - CATCH_DEPTH_M;
        colliders[floor].set_translation(Vec3::new(0.0, 0.0, depth));
        Self { broad_phase: filled(&mut colliders), colliders, paved, scenery }
    }
}

/// One collision step without time fills the search tree.
fn filled(colliders: &mut ColliderSet) -> BroadPhaseBvh {
    let mut broad_phase = BroadPhaseBvh::new();
    CollisionPipeline::new().step(
        parameters().prediction_distance(),
        &mut IslandManager::new(),
        &mut broad_phase,
        &mut NarrowPhase::new(),
        &mut RigidBodySet::new(),
        colliders,
        &(),
        &(),
    );
    broad_phase
}

/// All surfaces of some kinds as one mesh; none where the map has no such surface.
fn mesh(network: &RoadNetwork, wanted: impl Fn(SurfaceKind) -> bool) -> Option<SharedShape> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for surface in network.surfaces.iter().filter(|s| wanted(s.kind)) {
        let first = vertices.len() as u32;
        vertices.extend_from_slice(&surface.positions);
        triangles.extend(surface.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    SharedShape::trimesh(vertices, triangles).ok()
}

/// The solid box of a prop: of a tree its trunk, of a lamp or a sign its post.
fn solid(prop: &Prop) -> (Pose, SharedShape) {
    let post = |width: f32| Vec3::new(width, width, prop.size.z);
    let size = match prop.kind {
        PropKind::Tree => post(0.4),
        PropKind::Lamp | PropKind::SignalPole => post(0.2),
        PropKind::Sign => post(0.1),
        _ => prop.size,
    };
    let half = (size * 0.5).max(Vec3::splat(0.05));
    let rotation = heading(prop.heading_rad);
    (Pose::from_parts(prop.position + Vec3::Z * half.z, rotation), SharedShape::cuboid(half.x, half.y, half.z))
}

/// The rotation about the vertical that turns east to a heading.
pub fn heading(heading_rad: f32) -> Quat {
    let half = 0.5 * heading_rad;
    Quat::from_xyzw(0.0, 0.0, crate::ops::sin(half), crate::ops::cos(half))
}

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
    template: Arc<Template>,
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
            template: self.template.clone(),
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

fn parameters() -> IntegrationParameters {
    // Recycled contacts may be stale by centimetres, which would blur collision events.
    IntegrationParameters { dt: TICK_S, contact_recycling: false, ..Default::default() }
}

impl Physics {
    /// The ego car alone on a map.
    pub fn new(network: &RoadNetwork, ego: &Motion) -> Self {
        let template = Template::of(network);
        let (mut colliders, mut bodies) = (template.colliders.clone(), RigidBodySet::new());
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
            broad_phase: template.broad_phase.clone(),
            template,
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
        self.car.wheels().iter().filter_map(on).any(|ground| Some(ground) != self.template.paved)
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
            } else if Some(other) == self.template.scenery {
                touched.scenery = Some(pushed);
            }
        }
        touched.actors.sort_unstable();
    }
}

fn free(motion: &Motion) -> RigidBodyBuilder {
    // Rest is a rule of the world's state, so the engine never puts a body to sleep.
    RigidBodyBuilder::dynamic()
        .pose(Pose::from_parts(motion.position, motion.rotation))
        .linvel(motion.velocity_mps)
        .angvel(motion.spin_radps)
        .can_sleep(false)
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

/// A solid box of the kind's size and mass.
fn mass(kind: ActorKind) -> MassProperties {
    let kg = match kind {
        ActorKind::Car => 1400.0,
        ActorKind::Truck => 7000.0,
        ActorKind::Bus => 12000.0,
        ActorKind::Motorcycle => 280.0,
        ActorKind::Bicycle => 90.0,
        ActorKind::Pedestrian => 75.0,
    };
    let size = kind.size_m();
    let square = size * size;
    let inertia = Vec3::new(square.y + square.z, square.x + square.z, square.x + square.y) * (kg / 12.0);
    MassProperties::new(Vec3::Z * 0.45 * size.z, kg, inertia)
}

/// Four wheels, front left, front right, rear left, rear right. The axle points to the right: with
/// the axle to the left, the controller drives backwards.
fn car(chassis: RigidBodyHandle) -> DynamicRayCastVehicleController {
    let tuning = WheelTuning {
        suspension_stiffness: ego::SPRING_PER_S2,
        suspension_compression: ego::BUMP_PER_S,
        suspension_damping: ego::REBOUND_PER_S,
        max_suspension_travel: ego::TRAVEL_M,
        side_friction_stiffness: 1.0,
        friction_slip: ego::GRIP,
        max_suspension_force: ego::MAX_SUSPENSION_N,
    };
    let mut car = DynamicRayCastVehicleController::new(chassis);
    car.index_up_axis = 2;
    car.index_forward_axis = 0;
    for mount in ego::wheel_mounts() {
        car.add_wheel(mount, Vec3::NEG_Z, Vec3::NEG_Y, ego::SPRING_REST_M, ego::WHEEL_RADIUS_M, &tuning);
    }
    car
}
