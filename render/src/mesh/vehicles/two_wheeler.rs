//! Bicycles with their riders.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;

use super::wheel::RUBBER;
use crate::SemanticTag;
use crate::mesh::model::{Detail, Model};
use crate::mesh::people::figure::Look;
use crate::mesh::people::person::{Seat, ride};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

pub(super) const FRAMES: [[u8; 3]; 7] =
    [[180, 36, 36], [36, 66, 130], [30, 30, 34], [216, 216, 210], [46, 120, 84], [222, 150, 36], [120, 168, 190]];
pub(super) const HELMETS: [[u8; 3]; 4] = [[230, 230, 226], [30, 30, 34], [190, 36, 36], [36, 70, 140]];

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
    let paint = Paint::plain(tag, variety.colour(&FRAMES)).shaded(0.8);
    // Wider at the rim than at the floor, with a bench and what is carried under the rim.
    let level = |inset: f32, z: f32| {
        let (rear, front, half) = (0.42 + inset, 1.12 - inset, 0.33 - 0.5 * inset);
        [(rear, -half), (front, -half), (front, half), (rear, half)].map(|(x, y)| Vec3::new(x, y, z))
    };
    let [mut floor, rim] = [level(0.1, 0.28), level(0.0, 0.78)];
    mesh.walls(paint, &floor, &rim);
    floor.reverse();
    mesh.polygon(dark, &floor);
    mesh.polygon(dark, &level(0.02, 0.72));
    if variety.one_in(2) {
        mesh.frustum(paint.colour([214, 206, 186]), &level(0.05, 0.72), &level(0.12, 0.98));
    }
    mesh.tube(dark, Vec3::new(-0.06, 0.0, 0.3), hub, 0.03, 0.03, 5);
    mesh.tube(dark, Vec3::new(0.38, 0.0, 0.88), Vec3::new(0.4, 0.0, 0.3), 0.022, 0.022, 5);
}

/// Mudguards, rack, basket, crank and chain, and lamps that do not shine.
fn fitted(mesh: &mut Mesh, mut variety: Variety, carries: bool, detail: Detail) {
    let tag = SemanticTag::Bicycle;
    let (dark, steel) = (Paint::plain(tag, [34, 34, 36]), Paint::plain(tag, [150, 152, 156]).glossy(60));
    if detail != Detail::Rough {
        let crank = Vec3::new(-0.06, 0.0, 0.3);
        mesh.disc(steel, crank - Vec3::Y * 0.05, Vec3::NEG_Y, 0.09, 6);
        mesh.disc(dark, crank + Vec3::Y * 0.05, Vec3::Y, 0.05, 4);
        mesh.disc(Paint::plain(tag, [150, 20, 22]), Vec3::new(-0.84, 0.0, 0.62), Vec3::NEG_X, 0.045, 5);
    }
    if detail == Detail::Fine {
        for (x, z) in [(-0.54, 0.35), (0.54, 0.35)] {
            if x < 0.0 || !carries {
                spokes(mesh, steel, Vec3::new(x, 0.0, z), 0.3);
                mudguard(mesh, dark, Vec3::new(x, 0.0, z), 0.385);
            }
        }
    }
    // A rack with or without a bag, or a basket before the handlebar.
    match variety.bits() % 3 {
        0 if !carries => mesh.cuboid(steel.shaded(0.6), Vec3::new(0.42, -0.17, 0.84), Vec3::new(0.72, 0.17, 1.02)),
        1 => mesh.cuboid(dark.colour([150, 92, 52]), Vec3::new(-0.84, -0.18, 0.5), Vec3::new(-0.52, 0.18, 0.84)),
        _ if detail != Detail::Rough => {
            mesh.cuboid(dark, Vec3::new(-0.84, -0.08, 0.76), Vec3::new(-0.36, 0.08, 0.79));
        }
        _ => {}
    }
}

/// Thin bars through a hub, seen from both sides.
fn spokes(mesh: &mut Mesh, paint: Paint, hub: Vec3, radius: f32) {
    for i in 0..4 {
        let angle = TAU * i as f32 / 8.0;
        let (out, aside) =
            (Vec3::new(ops::cos(angle), 0.0, ops::sin(angle)), Vec3::new(-ops::sin(angle), 0.0, ops::cos(angle)));
        let (out, aside) = (out * radius, aside * 0.006);
        let mut bar = [hub - out - aside, hub + out - aside, hub + out + aside, hub - out + aside];
        mesh.polygon(paint, &bar);
        bar.reverse();
        mesh.polygon(paint, &bar);
    }
}

/// An arc over the rear upper quarter of a wheel.
pub(super) fn mudguard(mesh: &mut Mesh, paint: Paint, hub: Vec3, radius: f32) {
    let at = |step: u32, y: f32| {
        let angle = TAU * (0.17 + 0.09 * step as f32);
        hub + Vec3::new(radius * ops::cos(angle), y, radius * ops::sin(angle))
    };
    for step in 0..3 {
        let ring = [at(step, -0.04), at(step, 0.04), at(step + 1, 0.04), at(step + 1, -0.04)];
        mesh.polygon(paint, &ring);
    }
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
    fitted(&mut mesh, variety, carries, detail);
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
