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
        surfaces: vec![road],
        bounds: [corner(-1.0, -1.0), corner(1.0, 1.0)],
        ..RoadNetwork::default()
    }
}
