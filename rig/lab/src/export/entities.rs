//! The scene for 3D views: road users as boxes of their classes' colours, and the ground of the map.

use foxglove::messages::{
    Color, CubePrimitive, Point3, SceneEntity, SceneEntityDeletion, SceneUpdate, TriangleListPrimitive,
    scene_entity_deletion,
};
use glam::{Quat, Vec3};
use kernel::RoadNetwork;
use kernel::map::{Surface, SurfaceKind};
use kernel::scene::SceneSnapshot;
use kernel::time::Tick;
use render::SemanticTag;
use viewers::boxes::{MAP, RoadUser, fractions, road_users};

use super::messages::{pose, stamp, vector};

/// Every road user of a tick; those of the tick before are gone.
pub fn actors(scene: &SceneSnapshot) -> SceneUpdate {
    let everything = scene_entity_deletion::Type::All as i32;
    let deletion = SceneEntityDeletion { timestamp: stamp(scene.tick), r#type: everything, id: String::new() };
    SceneUpdate { deletions: vec![deletion], entities: road_users(scene).map(|user| cube(scene.tick, user)).collect() }
}

fn cube(tick: Tick, user: RoadUser) -> SceneEntity {
    let cube =
        CubePrimitive { pose: pose(user.middle, user.rotation), size: vector(user.size_m), color: colour(user.colour) };
    SceneEntity { cubes: vec![cube], ..entity(tick, user.name) }
}

/// Roads, their paint and sidewalks of a map, for a first tick.
pub fn ground(tick: Tick, network: &RoadNetwork) -> SceneUpdate {
    let entity = |(number, surface): (usize, &Surface)| {
        let tag = class(surface.kind)?;
        let name = format!("{} {number}", tag.name().to_lowercase());
        Some(SceneEntity { triangles: vec![triangles(surface, tag)], ..self::entity(tick, name) })
    };
    SceneUpdate { deletions: Vec::new(), entities: network.surfaces.iter().enumerate().filter_map(entity).collect() }
}

/// What is drawn of the ground; grass and soil are left out.
fn class(kind: SurfaceKind) -> Option<SemanticTag> {
    match kind {
        SurfaceKind::Road => Some(SemanticTag::Road),
        SurfaceKind::RoadLine => Some(SemanticTag::RoadLine),
        SurfaceKind::Sidewalk => Some(SemanticTag::SideWalk),
        SurfaceKind::Ground => Some(SemanticTag::Ground),
        SurfaceKind::Terrain => None,
    }
}

fn triangles(surface: &Surface, tag: SemanticTag) -> TriangleListPrimitive {
    let point = |p: &Vec3| Point3 { x: p.x.into(), y: p.y.into(), z: p.z.into() };
    TriangleListPrimitive {
        pose: pose(Vec3::ZERO, Quat::IDENTITY),
        points: surface.positions.iter().map(point).collect(),
        color: colour(fractions(tag.colour())),
        colors: Vec::new(),
        indices: surface.triangles.iter().flatten().copied().collect(),
    }
}

fn entity(tick: Tick, id: String) -> SceneEntity {
    SceneEntity { timestamp: stamp(tick), frame_id: MAP.into(), id, ..SceneEntity::default() }
}

fn colour([r, g, b]: [f32; 3]) -> Option<Color> {
    Some(Color { r: r.into(), g: g.into(), b: b.into(), a: 1.0 })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use base::maps::Map;

    #[test]
    fn the_ground_of_every_bundled_map_is_whole() {
        for name in kernel::map::BUNDLED {
            let update = ground(7, &Map::find(name).expect("bundled").network);
            let meshes: Vec<_> = update.entities.iter().flat_map(|entity| &entity.triangles).collect();
            assert!(meshes.len() >= 2, "{name}: roads and paint at least");
            for mesh in meshes {
                assert!(!mesh.indices.is_empty() && mesh.indices.len().is_multiple_of(3), "{name}");
                assert!(mesh.indices.iter().all(|i| (*i as usize) < mesh.points.len()), "{name}");
            }
            let names: BTreeSet<_> = update.entities.iter().map(|entity| &entity.id).collect();
            assert_eq!(names.len(), update.entities.len(), "{name}: one entity must not replace another");
        }
    }
}
