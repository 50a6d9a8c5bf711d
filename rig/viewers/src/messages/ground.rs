//! The ground of a map for 3D views: roads, their paint and sidewalks.

use foxglove::messages::{Point3, SceneEntity, SceneUpdate, TriangleListPrimitive};
use glam::{Quat, Vec3};
use kernel::RoadNetwork;
use kernel::map::{Surface, SurfaceKind};
use render::SemanticTag;

use super::parts::{colour, entity, pose};
use crate::boxes::fractions;

/// Roads, their paint and sidewalks of a map, for a first time.
pub fn ground(network: &RoadNetwork, time_ns: u64) -> SceneUpdate {
    let mesh = |(number, surface): (usize, &Surface)| {
        let tag = class(surface.kind)?;
        let name = format!("{} {number}", tag.name().to_lowercase());
        Some(SceneEntity { triangles: vec![triangles(surface, tag)], ..entity(time_ns, name) })
    };
    SceneUpdate { deletions: Vec::new(), entities: network.surfaces.iter().enumerate().filter_map(mesh).collect() }
}

/// What is drawn of the ground; grass and soil are left out.
fn class(kind: SurfaceKind) -> Option<SemanticTag> {
    match kind {
        SurfaceKind::Road | SurfaceKind::Gravel | SurfaceKind::Setts => Some(SemanticTag::Road),
        SurfaceKind::RoadLine => Some(SemanticTag::RoadLine),
        SurfaceKind::Sidewalk => Some(SemanticTag::SideWalk),
        SurfaceKind::Ground => Some(SemanticTag::Ground),
        SurfaceKind::Track | SurfaceKind::Rail => Some(SemanticTag::RailTrack),
        SurfaceKind::Water => Some(SemanticTag::Water),
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use base::maps::Map;

    use super::*;

    #[test]
    fn the_ground_of_every_bundled_map_is_whole() {
        for name in kernel::map::BUNDLED {
            let update = ground(&Map::find(name).expect("bundled").network, 7);
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
