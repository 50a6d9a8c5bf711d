//! Every road user for 3D views, as a box of its class's colour.

use foxglove::messages::{CubePrimitive, SceneEntity, SceneEntityDeletion, SceneUpdate, scene_entity_deletion};
use kernel::scene::SceneSnapshot;

use super::parts::{colour, entity, pose, stamp, vector};
use crate::boxes::{RoadUser, road_users};

/// Every road user of a tick; those of the tick before are gone.
pub fn actors(scene: &SceneSnapshot, time_ns: u64) -> SceneUpdate {
    let everything = scene_entity_deletion::Type::All as i32;
    let deletion = SceneEntityDeletion { timestamp: stamp(time_ns), r#type: everything, id: String::new() };
    SceneUpdate { deletions: vec![deletion], entities: road_users(scene).map(|user| cube(time_ns, user)).collect() }
}

fn cube(time_ns: u64, user: RoadUser) -> SceneEntity {
    let cube =
        CubePrimitive { pose: pose(user.middle, user.rotation), size: vector(user.size_m), color: colour(user.colour) };
    SceneEntity { cubes: vec![cube], ..entity(time_ns, user.name) }
}

#[cfg(test)]
mod tests {
    use base::maps::Map;
    use kernel::World;

    use super::*;

    fn city() -> SceneSnapshot {
        let map = Map::find("city").expect("bundled");
        World::new(&map.scenario(1), &map.network).expect("a world").scene()
    }

    #[test]
    fn every_road_user_has_a_box_and_replaces_those_before() {
        let scene = city();
        let update = actors(&scene, 1_500_000_000);
        assert_eq!((update.deletions.len(), update.entities.len()), (1, 1 + scene.actors.len()));
        let names: std::collections::BTreeSet<_> = update.entities.iter().map(|entity| &entity.id).collect();
        assert_eq!(names.len(), update.entities.len(), "one must not replace another");
        for entity in &update.entities {
            assert_eq!((entity.timestamp, entity.cubes.len()), (stamp(1_500_000_000), 1));
        }
    }

    #[test]
    fn boxes_stand_on_the_ground_around_their_actors() {
        let scene = city();
        let update = actors(&scene, 0);
        for (actor, entity) in scene.actors.iter().zip(update.entities.iter().skip(1)) {
            let place = entity.cubes[0].pose.as_ref().and_then(|pose| pose.position.as_ref()).expect("a place");
            let height = place.z as f32 - actor.position.z - actor.kind.size_m().z / 2.0;
            assert!(height.abs() < 0.2, "{actor:?}: {height}");
        }
    }
}
