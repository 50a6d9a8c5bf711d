//! What never moves: the ground and the props of a map as colliders.

use std::fmt;

use glam::Vec3;
use rapier3d::prelude::*;

use super::build::{ACTORS, EGO, GROUND, PROPS, groups, parameters};
use crate::geometry::rotation;
use crate::map_data::{MapData, Prop, PropKind, SurfaceKind};

/// How far below the lowest point of a map a car that left it is caught, metres.
const CATCH_DEPTH_M: f32 = 5.0;

/// The static colliders of a map with their search tree filled: what every engine on it starts from.
pub struct Statics {
    pub(super) colliders: ColliderSet,
    pub(super) broad_phase: BroadPhaseBvh,
    pub(super) paved: Option<ColliderHandle>,
    pub(super) scenery: Option<ColliderHandle>,
}

impl fmt::Debug for Statics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Statics({} colliders)", self.colliders.len())
    }
}

impl Statics {
    /// Those of a map.
    pub fn new(map: &MapData) -> Self {
        let mut colliders = ColliderSet::new();
        let ground = groups(GROUND, ACTORS | EGO);
        let mut insert = |shape: SharedShape, groups| {
            colliders.insert(ColliderBuilder::new(shape).collision_groups(groups).friction(0.6))
        };
        let is_paved = |kind| matches!(kind, SurfaceKind::Road | SurfaceKind::Ground);
        let is_soft = |kind| matches!(kind, SurfaceKind::Sidewalk | SurfaceKind::Terrain);
        let paved = mesh(map, is_paved).map(|shape| insert(shape, ground));
        mesh(map, is_soft).map(|shape| insert(shape, ground));
        let floor = insert(SharedShape::halfspace(Vec3::Z), ground);
        let boxes: Vec<_> = map.props.iter().map(solid).collect();
        let scenery = (!boxes.is_empty()).then(|| insert(SharedShape::compound(boxes), groups(PROPS, ACTORS | EGO)));
        let depth = map.bounds[0].z - CATCH_DEPTH_M;
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
fn mesh(map: &MapData, wanted: impl Fn(SurfaceKind) -> bool) -> Option<SharedShape> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for surface in map.surfaces.iter().filter(|s| wanted(s.kind)) {
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
    let turned = rotation(prop.heading_rad);
    (Pose::from_parts(prop.position + Vec3::Z * half.z, turned), SharedShape::cuboid(half.x, half.y, half.z))
}
