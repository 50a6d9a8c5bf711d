//! What is mounted on passenger cars: lamps, plates, grilles, mirrors, and the lines of doors.

use glam::Vec3;

use super::car_shape::Shape;
use super::fittings::{brake_lamp, facing, head_lamp, indicator, mirrors, plastic, plate};
use super::loft::Loft;
use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::{Mesh, Paint};

const TAG: SemanticTag = SemanticTag::Vehicles;

/// Dark arcs around wheels are so far before the flank, metres.
const ARC_OUT_M: f32 = 0.02;

/// Head lamps, brake lamps, indicators and number plates; at its finest lamps reach around the corners.
pub(super) fn lights(mesh: &mut Mesh, shape: &Shape, body: &Loft<'_>, detail: Detail) {
    let [bumper, nose, ..] = shape.stations;
    let [.., tail, rear] = shape.stations;
    let [width, low, high] = shape.rear_lamp;
    let (head, brake) = (head_lamp(TAG), brake_lamp(TAG));
    let [front_x, rear_x] = [nose.x + 0.025, rear.x.min(tail.x) - 0.012];
    let head_z = [nose.top - 0.13, nose.top - 0.02];
    for side in [-1.0f32, 1.0] {
        let amber = indicator(TAG, side);
        let (y, rear_y) = (side * (nose.half - 0.02), side * (tail.half - 0.03));
        facing(mesh, head, front_x, [y, side * (nose.half - 0.36)], head_z);
        facing(mesh, amber, bumper.x + 0.01, [side * (bumper.half - 0.03), side * (bumper.half - 0.2)], [0.42, 0.48]);
        facing(mesh, brake, rear_x, [rear_y, rear_y - side * width], [low, high]);
        facing(mesh, amber, rear_x, [rear_y, rear_y - side * width], [low - 0.075, low - 0.005]);
        if detail == Detail::Fine {
            let back_z = [head_z[0] + 0.03, head_z[1] + 0.01];
            let corner = |z: f32| Vec3::new(front_x, y, z);
            let behind = |z: f32| body.flank(nose.x - 0.16, z, side, 0.012);
            around(mesh, head, [corner(head_z[0]), behind(back_z[0]), behind(back_z[1]), corner(head_z[1])], side);
            let corner = |z: f32| Vec3::new(rear_x, rear_y, z);
            let before = |z: f32| body.flank(tail.x + 0.16, z, side, 0.012);
            around(mesh, brake, [before(low + 0.03), corner(low), corner(high), before(high)], side);
        }
    }
    facing(mesh, plate(TAG), bumper.x + 0.025, [-0.26, 0.26], [0.36, 0.47]);
    facing(mesh, plate(TAG), rear_x - 0.006, [-0.26, 0.26], [low - 0.14, low - 0.03]);
}

/// A pane around a corner, given as on the left.
fn around(mesh: &mut Mesh, paint: Paint, mut ring: [Vec3; 4], side: f32) {
    if side < 0.0 {
        ring.reverse();
    }
    mesh.polygon(paint, &ring);
}

/// Dark arcs over the wheels.
pub(super) fn arcs(mesh: &mut Mesh, shape: &Shape, body: &Loft<'_>, detail: Detail) {
    let steps = if detail == Detail::Fine { 6 } else { 4 };
    for x in shape.axles {
        body.arc(mesh, plastic(TAG).glossy(0).shaded(0.6), (x, shape.wheel_radius), steps, ARC_OUT_M);
    }
}

/// Mirrors, and at its finest grille, air intake, bumper, door lines, handles and sills.
pub(super) fn trim(mesh: &mut Mesh, paint: Paint, shape: &Shape, body: &Loft<'_>, detail: Detail) {
    let foot = body.station(shape.cabin.feet[0] - 0.28);
    let at = Vec3::new(foot.x, foot.half + 0.03, foot.top + 0.07);
    mirrors(mesh, paint.shaded(0.9), at, Vec3::new(0.05, 0.1, 0.065), detail == Detail::Fine);
    if detail != Detail::Fine {
        return;
    }
    let [bumper, nose, ..] = shape.stations;
    let rear = shape.stations[6];
    let dark = plastic(paint.tag);
    facing(mesh, dark, bumper.x + 0.01, [-0.56, 0.56], [0.25, 0.35]);
    facing(mesh, dark, bumper.x + 0.004, [-0.4, 0.4], [bumper.top, nose.top - 0.06]);
    facing(mesh, dark, rear.x - 0.01, [-0.66, 0.66], [0.25, 0.4]);
    doors(mesh, paint, shape, body);
}

/// Lines around two doors on each side, with handles, above a dark sill.
fn doors(mesh: &mut Mesh, paint: Paint, shape: &Shape, body: &Loft<'_>) {
    let (line, dark) = (paint.shaded(0.35).glossy(0), plastic(paint.tag));
    let [front, rear] = shape.axles.map(|x| x - 0.42 * x.signum());
    let middle = 0.5 * (front + rear) - 0.06;
    let rear = rear - 0.16;
    for x in [front, middle, rear] {
        let top = body.station(x).top - 0.07;
        let low: f32 = if x == rear { 0.62 } else { 0.34 };
        body.boards(mesh, line, [x - 0.008, x + 0.008], [low.max(0.57), top], 0.005);
        if low < 0.5 {
            body.boards(mesh, line, [x - 0.008, x + 0.008], [low, 0.55], 0.005);
        }
    }
    for x in [middle + 0.08, rear + 0.08] {
        body.boards(mesh, paint.shaded(0.55), [x, x + 0.2], [0.83, 0.86], 0.015);
    }
    body.boards(mesh, dark, [shape.axles[1] + 0.4, shape.axles[0] - 0.4], [0.23, 0.32], 0.008);
}
