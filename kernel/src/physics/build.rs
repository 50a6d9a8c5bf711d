//! What bodies are made of: groups and masses.

use glam::Vec3;
use rapier3d::prelude::*;

use crate::actor::ActorKind;
use crate::motion::Motion;
use crate::time::TICK_S;

pub(super) const GROUND: Group = Group::GROUP_1;
pub(super) const PROPS: Group = Group::GROUP_2;
pub(super) const ACTORS: Group = Group::GROUP_3;
pub(super) const EGO: Group = Group::GROUP_4;

/// Collides with some groups as a member of one.
pub(super) fn groups(of: Group, with: Group) -> InteractionGroups {
    InteractionGroups::new(of, with, InteractionTestMode::And)
}

/// How the engine computes.
pub(super) fn parameters() -> IntegrationParameters {
    // Recycled contacts may be stale by centimetres, which would blur collision events.
    IntegrationParameters { dt: TICK_S, contact_recycling: false, ..Default::default() }
}

/// A body that forces move.
pub(super) fn free(motion: &Motion) -> RigidBodyBuilder {
    // Rest is a rule of the world's state, so the engine never puts a body to sleep.
    RigidBodyBuilder::dynamic()
        .pose(Pose::from_parts(motion.position, motion.rotation))
        .linvel(motion.velocity_mps)
        .angvel(motion.spin_radps)
        .can_sleep(false)
}

/// A solid box of the kind's size and mass.
pub(super) fn mass(kind: ActorKind) -> MassProperties {
    let kg = kind.mass_kg();
    let size = kind.size_m();
    let square = size * size;
    let inertia = Vec3::new(square.y + square.z, square.x + square.z, square.x + square.y) * (kg / 12.0);
    MassProperties::new(Vec3::Z * 0.45 * size.z, kg, inertia)
}
