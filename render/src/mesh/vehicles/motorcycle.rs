//! Motorcycles and scooters with their riders.

use glam::Vec3;

use super::fittings::{brake_lamp, facing, glass, head_lamp, indicator, plate};
use super::two_wheeler::{FRAMES, HELMETS, mudguard, ring, sides};
use super::wheel::RUBBER;
use crate::SemanticTag;
use crate::mesh::model::{Detail, Model};
use crate::mesh::people::figure::Look;
use crate::mesh::people::person::{Seat, ride};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const TAG: SemanticTag = SemanticTag::Motorcycle;
const STEEL: [u8; 3] = [120, 122, 126];

/// A motorcycle of class Motorcycle under a rider of class Rider.
pub fn motorcycle(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let lacquer = Paint::plain(TAG, variety.colour(&FRAMES)).glossy(110);
    let dark = Paint::plain(TAG, [40, 40, 42]).glossy(40);
    let mut mesh = Mesh::default();
    wheels(&mut mesh, &[Vec3::new(0.72, 0.0, 0.31), Vec3::new(-0.7, 0.0, 0.31)], 0.12, detail);
    mesh.cuboid(dark, Vec3::new(-0.28, -0.16, 0.25), Vec3::new(0.3, 0.16, 0.56));
    mesh.ellipsoid(lacquer, Vec3::new(0.16, 0.0, 0.78), Vec3::new(0.32, 0.17, 0.15), 5, 8);
    mesh.ellipsoid(lacquer, Vec3::new(0.6, 0.0, 0.88), Vec3::new(0.2, 0.17, 0.2), 5, 8);
    mesh.cuboid(dark, Vec3::new(-0.72, -0.12, 0.74), Vec3::new(-0.06, 0.12, 0.82));
    // The tail rises behind the seat.
    let low = [(-0.62, -0.1), (-0.1, -0.14), (-0.1, 0.14), (-0.62, 0.1)].map(|(x, y)| Vec3::new(x, y, 0.6));
    let high = [(-0.94, -0.07), (-0.3, -0.13), (-0.3, 0.13), (-0.94, 0.07)];
    let high = high.map(|(x, y)| Vec3::new(x, y, if x < -0.5 { 0.84 } else { 0.74 }));
    mesh.frustum(lacquer, &low, &high);
    for y in [-0.09f32, 0.09] {
        mesh.tube(dark, Vec3::new(0.72, y, 0.31), Vec3::new(0.45, y, 0.98), 0.035, 0.035, 5);
    }
    mesh.rod(dark, Vec3::new(0.42, -0.34, 1.02), Vec3::new(0.42, 0.34, 1.02), 0.025, 5);
    let steel = dark.colour(STEEL).glossy(120);
    mesh.rod(steel, Vec3::new(-0.75, -0.2, 0.36), Vec3::new(-0.1, -0.17, 0.3), 0.06, 6);
    mesh.tube(dark, Vec3::new(-0.7, 0.1, 0.31), Vec3::new(-0.15, 0.1, 0.38), 0.03, 0.03, 4);
    shield(&mut mesh, [Vec3::new(0.72, 0.15, 0.98), Vec3::new(0.5, 0.12, 1.2)]);
    if detail == Detail::Fine {
        mudguard(&mut mesh, lacquer, Vec3::new(0.72, 0.0, 0.31), 0.345);
    }
    if detail != Detail::Rough {
        mirrors(&mut mesh, dark, Vec3::new(0.42, 0.3, 1.02));
    }
    lamps(&mut mesh, [Vec3::new(0.81, 0.0, 0.9), Vec3::new(-0.95, 0.0, 0.76)], [0.22, 0.14]);
    let seat = Seat {
        hip: Vec3::new(-0.28, 0.0, 0.88),
        lean_rad: 0.32,
        thigh_rad: [-1.15, 0.0],
        shin_rad: [1.45, 0.0],
        arm_rad: -1.05,
    };
    ridden(mesh, &mut variety, &seat, detail)
}

/// A scooter of class Motorcycle under a rider of class Rider: small wheels, a shield before the knees, a floor for the
/// feet.
pub fn scooter(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let lacquer = Paint::plain(TAG, variety.colour(&FRAMES)).glossy(110);
    let dark = Paint::plain(TAG, [40, 40, 42]).glossy(40);
    let mut mesh = Mesh::default();
    wheels(&mut mesh, &[Vec3::new(0.66, 0.0, 0.23), Vec3::new(-0.6, 0.0, 0.23)], 0.1, detail);
    let level = |x: [f32; 2], half: [f32; 2], z: f32| {
        [(x[1], -half[1]), (x[0], -half[0]), (x[0], half[0]), (x[1], half[1])].map(|(x, y)| Vec3::new(x, y, z))
    };
    // Floor, leg shield, and the body under the seat.
    mesh.cuboid(dark, Vec3::new(-0.3, -0.17, 0.22), Vec3::new(0.4, 0.17, 0.31));
    mesh.frustum(lacquer, &level([0.52, 0.34], [0.12, 0.19], 0.26), &level([0.46, 0.34], [0.1, 0.21], 0.92));
    mesh.frustum(lacquer, &level([-0.12, -0.74], [0.15, 0.12], 0.28), &level([-0.2, -0.9], [0.17, 0.1], 0.7));
    mesh.frustum(dark, &level([-0.18, -0.86], [0.16, 0.1], 0.7), &level([-0.22, -0.84], [0.13, 0.09], 0.79));
    mesh.ellipsoid(lacquer, Vec3::new(0.48, 0.0, 0.97), Vec3::new(0.16, 0.15, 0.11), 5, 8);
    mesh.tube(dark, Vec3::new(0.66, 0.0, 0.23), Vec3::new(0.46, 0.0, 0.9), 0.045, 0.045, 5);
    mesh.rod(dark, Vec3::new(0.38, -0.33, 1.02), Vec3::new(0.38, 0.33, 1.02), 0.025, 5);
    shield(&mut mesh, [Vec3::new(0.56, 0.17, 1.02), Vec3::new(0.42, 0.15, 1.26)]);
    if variety.one_in(3) {
        mesh.cuboid(dark.glossy(20), Vec3::new(-0.95, -0.18, 0.82), Vec3::new(-0.62, 0.18, 1.12));
    }
    if detail == Detail::Fine {
        mudguard(&mut mesh, lacquer, Vec3::new(0.66, 0.0, 0.23), 0.27);
        mesh.rod(dark.colour(STEEL), Vec3::new(-0.72, -0.16, 0.3), Vec3::new(-0.4, -0.15, 0.26), 0.05, 6);
    }
    if detail != Detail::Rough {
        mirrors(&mut mesh, dark, Vec3::new(0.38, 0.28, 1.02));
    }
    lamps(&mut mesh, [Vec3::new(0.65, 0.0, 0.97), Vec3::new(-0.92, 0.0, 0.62)], [0.16, 0.12]);
    let seat = Seat {
        hip: Vec3::new(-0.36, 0.0, 0.84),
        lean_rad: 0.1,
        thigh_rad: [-1.4, 0.0],
        shin_rad: [1.32, 0.0],
        arm_rad: -0.85,
    };
    ridden(mesh, &mut variety, &seat, detail)
}

fn ridden(mesh: Mesh, variety: &mut Variety, seat: &Seat, detail: Detail) -> Model {
    let mut model = Model::rigid(mesh);
    let look = Look::of(variety, SemanticTag::Rider, detail).riding();
    ride(&mut model, &look, seat, Some(variety.pick(&HELMETS)));
    model
}

/// Tyres around rims; the radius is the hub's height.
fn wheels(mesh: &mut Mesh, hubs: &[Vec3], thick: f32, detail: Detail) {
    for &hub in hubs {
        ring(mesh, Paint::plain(TAG, RUBBER), hub, hub.z, thick, sides(detail));
        let rim = Paint::plain(TAG, STEEL).glossy(80);
        mesh.rod(rim, hub - Vec3::Y * 0.03, hub + Vec3::Y * 0.03, hub.z - thick + 0.01, 8);
    }
}

/// A small windscreen: its foot and top on the left, seen from both sides.
fn shield(mesh: &mut Mesh, [foot, top]: [Vec3; 2]) {
    let right = |p: Vec3| p * Vec3::new(1.0, -1.0, 1.0);
    let mut pane = [right(foot), foot, top, right(top)];
    mesh.polygon(glass(TAG).shaded(1.6), &pane);
    pane.reverse();
    mesh.polygon(glass(TAG).shaded(1.6), &pane);
}

/// Mirrors over the ends of the handlebar.
fn mirrors(mesh: &mut Mesh, paint: Paint, bar: Vec3) {
    for side in [-1.0, 1.0] {
        let foot = bar * Vec3::new(1.0, side, 1.0);
        let at = foot + Vec3::new(0.04, side * 0.04, 0.16);
        mesh.tube(paint, foot, at, 0.012, 0.012, 3);
        mesh.cuboid(paint, at - Vec3::new(0.015, 0.06, 0.03), at + Vec3::new(0.015, 0.06, 0.04));
    }
}

/// Head lamp and brake lamp at the ends, indicators so far from the middle, and the number plate.
fn lamps(mesh: &mut Mesh, [front, rear]: [Vec3; 2], aside: [f32; 2]) {
    mesh.disc(head_lamp(TAG), front, Vec3::X, 0.09, 8);
    mesh.disc(brake_lamp(TAG), rear, Vec3::NEG_X, 0.06, 6);
    for side in [1.0, -1.0] {
        for (at, y) in [(front - Vec3::X * 0.16, aside[0] + 0.03), (rear + Vec3::X * 0.06, aside[1])] {
            mesh.ellipsoid(indicator(TAG, side), at.with_y(side * y), Vec3::new(0.05, 0.04, 0.04), 3, 5);
        }
    }
    facing(mesh, plate(TAG), rear.x - 0.004, [-0.1, 0.1], [rear.z - 0.26, rear.z - 0.1]);
}
