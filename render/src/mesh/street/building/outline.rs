//! What all parts of a house share: its class, the grid of its windows and its outline.

use glam::{Vec2, Vec3};

use crate::SemanticTag;
use crate::mesh::{Mesh, Paint};

pub(super) const TAG: SemanticTag = SemanticTag::Building;

/// Height of a storey, metres.
pub(super) const STOREY_M: f32 = 3.0;
/// Size of a window's part of a wall, metres: about that of all, and what `facade.wgsl` takes it for.
pub(crate) const CELL_M: Vec2 = Vec2::new(2.7, STOREY_M);
/// Below 0, where surfaces count their storeys from when they have no windows.
pub(super) const NO_WINDOWS: f32 = -64.0;

pub(super) fn corners(size: Vec3, grow: f32, z: f32) -> [Vec3; 4] {
    let (x, y) = (0.5 * size.x + grow, 0.5 * size.y + grow);
    [Vec3::new(-x, -y, z), Vec3::new(x, -y, z), Vec3::new(x, y, z), Vec3::new(-x, y, z)]
}

/// A flat ring between two outlines of the house at a height, seen from above.
pub(super) fn rim(mesh: &mut Mesh, paint: Paint, size: Vec3, grow: [f32; 2], z: f32) {
    let (outer, inner) = (corners(size, grow[0], z), corners(size, grow[1], z));
    for i in 0..4 {
        let j = (i + 1) % 4;
        mesh.polygon(paint, &[outer[i], outer[j], inner[j], inner[i]]);
    }
}
