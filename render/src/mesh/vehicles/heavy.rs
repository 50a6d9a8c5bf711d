//! What lorries, vans, buses and trams have in common.

use glam::Vec3;

use super::fittings::{brake_lamp, facing, head_lamp, indicator, plate};
use crate::SemanticTag;
use crate::mesh::{Mesh, Paint};

/// A solid of class `paint.tag` whose upper edges are rounded off by `bevel` metres.
pub(super) fn hull(mesh: &mut Mesh, paint: Paint, low: Vec3, high: Vec3, bevel: f32) {
    let ring = |inset: f32, z: f32| {
        let (a, b) = (low + Vec3::splat(inset), high - Vec3::splat(inset));
        [Vec3::new(a.x, a.y, z), Vec3::new(b.x, a.y, z), Vec3::new(b.x, b.y, z), Vec3::new(a.x, b.y, z)]
    };
    mesh.walls(paint, &ring(0.0, low.z), &ring(0.0, high.z - bevel));
    mesh.frustum(paint, &ring(0.0, high.z - bevel), &ring(bevel, high.z));
    let [a, b, c, d] = ring(0.0, low.z);
    mesh.polygon(paint.shaded(0.3), &[d, c, b, a]);
}

/// Upright boards on both sides of a vehicle, so far from its middle.
pub(super) fn side_boards(mesh: &mut Mesh, paint: Paint, x: [f32; 2], y: f32, z: [f32; 2]) {
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    mesh.polygon(paint, &[at(x[1], y, z[0]), at(x[0], y, z[0]), at(x[0], y, z[1]), at(x[1], y, z[1])]);
    mesh.polygon(paint, &[at(x[0], -y, z[0]), at(x[1], -y, z[0]), at(x[1], -y, z[1]), at(x[0], -y, z[1])]);
}

/// Where the lamps of a vehicle are.
pub(super) struct Lamps {
    /// Fronts of the head lamps and backs of the brake lamps, metres from the middle.
    pub(super) ends: [f32; 2],
    /// Outer edges of the lamps at both ends.
    pub(super) half: [f32; 2],
    /// Widths of those.
    pub(super) width: [f32; 2],
    /// Lower and upper edges of those.
    pub(super) front_z: [f32; 2],
    pub(super) rear_z: [f32; 2],
    /// Lower edge of the number plates.
    pub(super) plate_z: f32,
}

impl Lamps {
    /// Head lamps, brake lamps, indicators below and above them, and number plates.
    pub(super) fn add_to(&self, mesh: &mut Mesh, tag: SemanticTag) {
        let Self { ends: [front, rear], half, width, front_z, rear_z, plate_z } = *self;
        let high = 0.4 * (rear_z[1] - rear_z[0]);
        for side in [-1.0f32, 1.0] {
            let [y, rear_y] = [0, 1].map(|end| [side * half[end], side * (half[end] - width[end])]);
            let amber = indicator(tag, side);
            facing(mesh, head_lamp(tag), front, y, front_z);
            facing(mesh, amber, front, y, [front_z[0] - 0.09, front_z[0] - 0.01]);
            facing(mesh, brake_lamp(tag), -rear, rear_y, rear_z);
            facing(mesh, amber, -rear, rear_y, [rear_z[1] + 0.01, rear_z[1] + 0.01 + high]);
        }
        for x in [front, -rear] {
            facing(mesh, plate(tag), x, [-0.26, 0.26], [plate_z, plate_z + 0.12]);
        }
    }
}
