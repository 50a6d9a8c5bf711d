//! Maps and scenarios for unit tests.

use glam::Vec3;

use crate::map::{RoadNetwork, Surface, SurfaceKind};

/// A flat square of asphalt of 2 km, without lanes.
pub fn plain() -> RoadNetwork {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0) * 1000.0;
    let positions = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let road = Surface { kind: SurfaceKind::Road, positions, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    RoadNetwork {
        name: String::from("plain"),
        digest: 0,
        lanes: vec![],
        junctions: vec![],
        light_groups: vec![],
        light_heads: vec![],
        crosswalks: vec![],
        walk_nodes: vec![],
        walk_edges: vec![],
        surfaces: vec![road],
        props: vec![],
        bounds: [corner(-1.0, -1.0), corner(1.0, 1.0)],
        statics: Default::default(),
        lookups: crate::traffic::Lookups::default(),
    }
}
