//! Motorcycles and bicycles with their riders.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;

use super::car::{BRAKE_LAMP, INDICATOR};
use super::figure::Look;
use super::model::{Detail, Model};
use super::person::{Seat, ride};
use super::variety::Variety;
use super::wheel::RUBBER;
use super::{CODE_BRAKE, CODE_HEAD, CODE_LEFT, CODE_RIGHT, Mesh, Paint};
use crate::SemanticTag;

const FRAMES: [[u8; 3]; 7] =
    [[180, 36, 36], [36, 66, 130], [30, 30, 34], [216, 216, 210], [46, 120, 84], [222, 150, 36], [120, 168, 190]];
const HELMETS: [[u8; 3]; 4] = [[230, 230, 226], [30, 30, 34], [190, 36, 36], [36, 70, 140]];

/// A tyre as a ring in the x-z plane, seen from both sides.
pub(super) fn ring(mesh: &mut Mesh, paint: Paint, hub: Vec3, radius: f32, thick: f32, sides: u32) {
    let at = |i: u32, r: f32, y: f32| {
        let angle = TAU * i as f32 / sides as f32;
        hub + Vec3::new(r * ops::cos(angle), y, r * ops::sin(angle))
    };
    let (inner, half) = (radius - thick, 0.5 * thick);
    for i in 0..sides {
        let j = (i + 1) % sides;
        mesh.polygon(paint, &[at(i, radius, half), at(i, radius, -half), at(j, radius, -half), at(j, radius, half)]);
        mesh.polygon(paint, &[at(i, radius, -half), at(i, inner, -half), at(j, inner, -half), at(j, radius, -half)]);
        mesh.polygon(paint, &[at(i, inner, half), at(i, radius, half), at(j, radius, half), at(j, inner, half)]);
        mesh.polygon(paint, &[at(i, inner, -half), at(i, inner, half), at(j, inner, half), at(j, inner, -half)]);
    }
}

/// Corners of a wheel.
pub(super) fn sides(detail: Detail) -> u32 {
    match detail {
        Detail::Fine => 14,
        Detail::Coarse => 8,
        Detail::Rough => 5,
    }
}

/// A motorcycle of class Motorcycle under a rider of class Rider.
pub fn motorcycle(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let tag = SemanticTag::Motorcycle;
    let lacquer = Paint::plain(tag, variety.colour(&FRAMES)).glossy(110);
    let dark = Paint::plain(tag, [40, 40, 42]).glossy(40);
    let mut mesh = Mesh::default();
    for x in [0.72, -0.7] {
        ring(&mut mesh, Paint::plain(tag, RUBBER), Vec3::new(x, 0.0, 0.31), 0.31, 0.12, sides(detail));
        mesh.rod(dark.colour([110, 112, 116]), Vec3::new(x, -0.03, 0.31), Vec3::new(x, 0.03, 0.31), 0.2, 8);
    }
    mesh.cuboid(dark, Vec3::new(-0.3, -0.16, 0.25), Vec3::new(0.32, 0.16, 0.6));
    mesh.ellipsoid(lacquer, Vec3::new(0.2, 0.0, 0.78), Vec3::new(0.34, 0.17, 0.17), 5, 8);
    mesh.ellipsoid(lacquer, Vec3::new(0.62, 0.0, 0.86), Vec3::new(0.2, 0.19, 0.24), 5, 8);
    mesh.cuboid(dark, Vec3::new(-0.75, -0.13, 0.72), Vec3::new(-0.05, 0.13, 0.82));
    mesh.cuboid(lacquer, Vec3::new(-0.92, -0.1, 0.62), Vec3::new(-0.5, 0.1, 0.74));
    for y in [-0.09f32, 0.09] {
        mesh.tube(dark, Vec3::new(0.72, y, 0.31), Vec3::new(0.45, y, 0.98), 0.035, 0.035, 5);
    }
    mesh.rod(dark, Vec3::new(0.42, -0.34, 1.02), Vec3::new(0.42, 0.34, 1.02), 0.025, 5);
    lamps(&mut mesh);
    let mut model = Model::rigid(mesh);
    let look = Look::of(&mut variety, SemanticTag::Rider, detail).riding();
    let seat = Seat {
        hip: Vec3::new(-0.28, 0.0, 0.88),
        lean_rad: 0.32,
        thigh_rad: [-1.15, 0.0],
        shin_rad: [1.45, 0.0],
        arm_rad: -1.05,
    };
    ride(&mut model, &look, &seat, Some(variety.pick(&HELMETS)));
    model
}

/// Head lamp, brake lamp and indicators of a motorcycle.
fn lamps(mesh: &mut Mesh) {
    let tag = SemanticTag::Motorcycle;
    let head = Paint::plain(tag, [238, 238, 228]).glossy(200).coded(CODE_HEAD);
    mesh.disc(head, Vec3::new(0.83, 0.0, 0.9), Vec3::X, 0.09, 8);
    let brake = Paint::plain(tag, BRAKE_LAMP).coded(CODE_BRAKE);
    mesh.disc(brake, Vec3::new(-0.93, 0.0, 0.69), Vec3::NEG_X, 0.06, 6);
    for (side, code) in [(1.0, CODE_LEFT), (-1.0, CODE_RIGHT)] {
        let amber = Paint::plain(tag, INDICATOR).coded(code);
        for at in [Vec3::new(0.6, 0.26, 0.94), Vec3::new(-0.86, 0.16, 0.74)] {
            mesh.ellipsoid(amber, at * Vec3::new(1.0, side, 1.0), Vec3::new(0.05, 0.04, 0.04), 3, 5);
        }
    }
}

/// A scooter of class Motorcycle under a rider of class Rider: a smaller motorcycle.
pub fn scooter(variant: u32, detail: Detail) -> Model {
    let mut model = motorcycle(variant, detail);
    model.parts[0].mesh.scale(Vec3::new(0.9, 0.9, 0.96));
    model
}

/// A bicycle of class Bicycle under a pedalling rider of class Rider.
pub fn bicycle(variant: u32, detail: Detail) -> Model {
    pedalled(variant, detail, false)
}

/// A bicycle with a box before its rider.
pub fn cargo_bike(variant: u32, detail: Detail) -> Model {
    pedalled(variant, detail, true)
}

/// The box of a cargo bike, on a longer frame with a smaller front wheel.
fn cargo(mesh: &mut Mesh, variety: &mut Variety, detail: Detail) {
    let tag = SemanticTag::Bicycle;
    let dark = Paint::plain(tag, RUBBER);
    let hub = Vec3::new(0.99, 0.0, 0.25);
    ring(mesh, dark, hub, 0.25, 0.05, sides(detail));
    let paint = Paint::plain(tag, variety.colour(&FRAMES));
    mesh.cuboid(paint.shaded(0.8), Vec3::new(0.42, -0.32, 0.3), Vec3::new(1.1, 0.32, 0.75));
    mesh.tube(dark, Vec3::new(-0.06, 0.0, 0.3), hub, 0.03, 0.03, 5);
    mesh.tube(dark, Vec3::new(0.38, 0.0, 0.88), Vec3::new(0.4, 0.0, 0.3), 0.022, 0.022, 5);
}

fn pedalled(variant: u32, detail: Detail, carries: bool) -> Model {
    let mut variety = Variety::of(variant);
    let tag = SemanticTag::Bicycle;
    let frame = Paint::plain(tag, variety.colour(&FRAMES)).glossy(80);
    let mut mesh = Mesh::default();
    let hubs = [Vec3::new(0.54, 0.0, 0.35), Vec3::new(-0.54, 0.0, 0.35)];
    for &hub in &hubs[usize::from(carries)..] {
        ring(&mut mesh, Paint::plain(tag, RUBBER), hub, 0.35, 0.05, sides(detail) + 2);
    }
    let (crank, seat, head) = (Vec3::new(-0.06, 0.0, 0.3), Vec3::new(-0.22, 0.0, 0.9), Vec3::new(0.38, 0.0, 0.88));
    for (a, b) in [
        (crank, seat),
        (crank, head - Vec3::Z * 0.12),
        (seat - Vec3::Z * 0.12, head),
        (hubs[1], crank),
        (hubs[1], seat - Vec3::Z * 0.12),
        (head, if carries { crank } else { hubs[0] }),
    ] {
        mesh.tube(frame, a, b, 0.022, 0.022, 5);
    }
    let dark = Paint::plain(tag, [34, 34, 36]);
    mesh.tube(dark, head, head + Vec3::new(-0.02, 0.0, 0.14), 0.018, 0.018, 5);
    mesh.rod(dark, Vec3::new(0.36, -0.28, 1.02), Vec3::new(0.36, 0.28, 1.02), 0.018, 5);
    mesh.ellipsoid(dark, seat + Vec3::Z * 0.03, Vec3::new(0.14, 0.08, 0.04), 4, 6);
    if carries {
        cargo(&mut mesh, &mut { variety }, detail);
    }
    let mut model = Model::rigid(mesh);
    let look = Look::of(&mut variety, SemanticTag::Rider, detail).riding();
    let seat = Seat {
        hip: Vec3::new(-0.22, 0.0, 1.0),
        lean_rad: 0.42,
        thigh_rad: [-0.75, 0.38],
        shin_rad: [0.95, 0.34],
        arm_rad: -1.0,
    };
    let helmet = variety.one_in(2).then(|| variety.pick(&HELMETS));
    ride(&mut model, &look, &seat, helmet);
    model
}
