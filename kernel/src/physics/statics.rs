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
    ground: Vec<Ground>,
    /// Lies just above the road.
    paint: Option<Ground>,
    floor_m: f32,
    pub(super) scenery: Option<ColliderHandle>,
    /// All parked cars as one; who is pushed leaves it.
    pub(super) parked: Option<ColliderHandle>,
    /// Their boxes, by number.
    parked_cars: Vec<(Pose, SharedShape)>,
}

/// Surfaces of some kinds as one mesh.
struct Ground {
    shape: SharedShape,
    /// The first triangle of each surface, and what that is made of.
    kinds: Vec<(u32, SurfaceKind)>,
}

impl Ground {
    fn kind(&self, triangle: u32) -> SurfaceKind {
        self.kinds[self.kinds.partition_point(|(first, _)| *first <= triangle) - 1].1
    }
}

/// Whether a surface is of a road, paved or not.
fn is_of_road(kind: SurfaceKind) -> bool {
    use SurfaceKind as K;
    matches!(kind, K::Road | K::Ground | K::Gravel | K::Setts | K::Track)
}

/// Whether a wheel on such a surface is off the road.
pub(super) fn is_soft(kind: SurfaceKind) -> bool {
    matches!(kind, SurfaceKind::Sidewalk | SurfaceKind::Terrain | SurfaceKind::Water)
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
        let paint = mesh(map, |kind| kind == SurfaceKind::RoadLine);
        let meshes: Vec<Ground> = [is_of_road, is_soft].into_iter().filter_map(|wanted| mesh(map, wanted)).collect();
        for mesh in &meshes {
            insert(mesh.shape.clone(), ground);
        }
        let floor = insert(SharedShape::halfspace(Vec3::Z), ground);
        let (parked, fixed): (Vec<&Prop>, Vec<&Prop>) = map.props.iter().partition(|p| p.kind == PropKind::ParkedCar);
        let boxes = |props: &[&Prop]| props.iter().map(|prop| solid(prop)).collect::<Vec<_>>();
        let (boxes, parked_cars) = (boxes(&fixed), boxes(&parked));
        let mut compound = |boxes: Vec<_>| {
            (!boxes.is_empty()).then(|| insert(SharedShape::compound(boxes), groups(PROPS, ACTORS | EGO)))
        };
        let (scenery, parked) = (compound(boxes), compound(parked_cars.clone()));
        let floor_m = map.bounds[0].z - CATCH_DEPTH_M;
        colliders[floor].set_translation(Vec3::new(0.0, 0.0, floor_m));
        let broad_phase = filled(&mut colliders);
        Self { broad_phase, colliders, ground: meshes, paint, floor_m, scenery, parked, parked_cars }
    }

    /// The parked cars without some, as one collider; `pushed` says of a number whether it is gone.
    pub(super) fn parked_without(&self, pushed: impl Fn(u32) -> bool) -> Option<Collider> {
        let left = self.parked_cars.iter().zip(0..).filter(|(_, number)| !pushed(*number));
        let boxes: Vec<_> = left.map(|(car, _)| car.clone()).collect();
        let collider =
            |boxes| ColliderBuilder::compound(boxes).collision_groups(groups(PROPS, ACTORS | EGO)).friction(0.6);
        (!boxes.is_empty()).then(|| collider(boxes).build())
    }

    /// The first ground on the way from a place in a direction of unit length: how far away, metres, its normal, and
    /// what it is made of.
    pub(super) fn ground(&self, from: Vec3, direction: Vec3, reach_m: f32) -> Option<(f32, Vec3, SurfaceKind)> {
        let ray = Ray::new(from, direction);
        let floor = (self.floor_m - from.z) / direction.z;
        let caught = (direction.z < 0.0 && (0.0..reach_m).contains(&floor)).then_some(floor);
        let caught = caught.map(|distance| (distance, Vec3::Z, SurfaceKind::Terrain));
        let (distance_m, normal, kind) = self.ground.iter().fold(caught, |nearest, ground| {
            let reach_m = nearest.map_or(reach_m, |(distance, ..)| distance);
            let Some(hit) = ground.shape.cast_local_ray_and_get_normal(&ray, reach_m, false) else { return nearest };
            Some((hit.time_of_impact, hit.normal, ground.kind(hit.subshape)))
        })?;
        let painted = |paint: &Ground| paint.shape.cast_local_ray(&ray, distance_m, false).is_some();
        let is_paint = kind == SurfaceKind::Road && self.paint.as_ref().is_some_and(painted);
        Some((distance_m, normal, if is_paint { SurfaceKind::RoadLine } else { kind }))
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

/// Boxes that slide over the ground do not catch on the edges between its triangles.
const SMOOTH: TriMeshFlags = TriMeshFlags::FIX_INTERNAL_EDGES;

/// All surfaces of some kinds as one mesh; none where the map has no such surface.
fn mesh(map: &MapData, wanted: fn(SurfaceKind) -> bool) -> Option<Ground> {
    let (mut vertices, mut triangles, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
    for surface in map.surfaces.iter().filter(|s| wanted(s.kind)) {
        let first = vertices.len() as u32;
        kinds.push((triangles.len() as u32, surface.kind));
        vertices.extend_from_slice(&surface.positions);
        triangles.extend(surface.triangles.iter().map(|t| t.map(|v| v + first)));
    }
    Some(Ground { shape: SharedShape::trimesh_with_flags(vertices, triangles, SMOOTH).ok()?, kinds })
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
