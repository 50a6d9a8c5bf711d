//! What vehicles of all sizes carry: glass, lamps and number plates.

use glam::Vec3;

use crate::SemanticTag;
use crate::mesh::{CODE_BRAKE, CODE_CENTRE_BRAKE, CODE_HEAD, CODE_LEFT, CODE_RIGHT, Mesh, Paint};

const GLASS: [u8; 3] = [30, 38, 46];
/// Brake lamps and indicators that are off, which also in the sun look darker than those that shine.
const BRAKE_LAMP: [u8; 3] = [96, 10, 12];
const INDICATOR: [u8; 3] = [132, 70, 18];
const PLATE: [u8; 3] = [226, 226, 220];
/// Grilles, bumpers without paint, seals.
const PLASTIC: [u8; 3] = [26, 26, 28];

pub(super) fn glass(tag: SemanticTag) -> Paint {
    Paint::plain(tag, GLASS).glossy(230)
}

pub(super) fn plastic(tag: SemanticTag) -> Paint {
    Paint::plain(tag, PLASTIC).glossy(30)
}

pub(super) fn head_lamp(tag: SemanticTag) -> Paint {
    Paint::plain(tag, [236, 238, 228]).glossy(200).coded(CODE_HEAD)
}

pub(super) fn brake_lamp(tag: SemanticTag) -> Paint {
    Paint::plain(tag, BRAKE_LAMP).coded(CODE_BRAKE)
}

/// The lamp in the middle, above the others, which is no tail lamp.
pub(super) fn centre_brake_lamp(tag: SemanticTag) -> Paint {
    brake_lamp(tag).coded(CODE_CENTRE_BRAKE)
}

/// The indicator of a side (the sign of y).
pub(super) fn indicator(tag: SemanticTag, side: f32) -> Paint {
    Paint::plain(tag, INDICATOR).coded(if side > 0.0 { CODE_LEFT } else { CODE_RIGHT })
}

pub(super) fn plate(tag: SemanticTag) -> Paint {
    Paint::plain(tag, PLATE)
}

/// A small board across a vehicle that looks forward at positive x and backward at negative x.
pub(super) fn facing(mesh: &mut Mesh, paint: Paint, x: f32, y: [f32; 2], z: [f32; 2]) {
    let (lo, hi) = (y[0].min(y[1]), y[0].max(y[1]));
    let (a, b) = if x > 0.0 { (lo, hi) } else { (hi, lo) };
    mesh.polygon(paint, &[Vec3::new(x, a, z[0]), Vec3::new(x, b, z[0]), Vec3::new(x, b, z[1]), Vec3::new(x, a, z[1])]);
}

/// Mirrors on both sides of `at`, of which only the outer faces are there when they are not `solid`.
pub(super) fn mirrors(mesh: &mut Mesh, paint: Paint, at: Vec3, half: Vec3, solid: bool) {
    for side in [-1.0, 1.0] {
        let middle = at * Vec3::new(1.0, side, 1.0);
        let (low, high) = (middle - half, middle + half);
        if solid {
            mesh.cuboid(paint, low, high);
        } else {
            let corner = |y: f32, z: f32| Vec3::new(middle.x, y, z);
            let ring = [corner(low.y, low.z), corner(high.y, low.z), corner(high.y, high.z), corner(low.y, high.z)];
            mesh.polygon(paint, &ring);
            let [a, b, c, d] = ring;
            mesh.polygon(paint.shaded(0.5), &[d, c, b, a]);
        }
    }
}
