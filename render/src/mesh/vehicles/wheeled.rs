//! People on foot who push something, or sit in it. All of it is of class Pedestrian, as what they carry is.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;

use super::two_wheeler::{ring, sides};
use super::wheel::RUBBER;
use crate::SemanticTag;
use crate::mesh::model::{Detail, Model};
use crate::mesh::people::figure::Look;
use crate::mesh::people::person::{Seat, pusher, ride};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const TAG: SemanticTag = SemanticTag::Pedestrian;
const CLOTHS: [[u8; 3]; 5] = [[38, 44, 62], [120, 30, 40], [84, 92, 84], [30, 30, 34], [146, 128, 104]];
const STEEL: [u8; 3] = [128, 130, 134];
/// From the middle of the whole to the one who pushes, metres.
const PUSHER_M: f32 = -0.5;

/// Somebody who pushes a pram.
pub fn pram(variant: u32, detail: Detail) -> Model {
    let mut model = pusher(variant, detail);
    for part in model.parts.iter_mut().filter(|part| part.parent.is_none()) {
        part.pivot.x += PUSHER_M;
    }
    let cloth = Paint::plain(TAG, Variety::of(variant ^ 0x50).colour(&CLOTHS));
    let steel = Paint::plain(TAG, STEEL).glossy(60);
    let mut mesh = Mesh::default();
    for (x, y) in [(0.1, -0.26), (0.1, 0.26), (0.6, -0.24), (0.6, 0.24)] {
        ring(&mut mesh, Paint::plain(TAG, RUBBER), Vec3::new(x, y, 0.13), 0.13, 0.05, sides(detail));
    }
    mesh.cuboid(cloth, Vec3::new(0.02, -0.22, 0.5), Vec3::new(0.74, 0.22, 0.78));
    mesh.ellipsoid(cloth.shaded(0.8), Vec3::new(0.2, 0.0, 0.82), Vec3::new(0.25, 0.22, 0.26), 5, 8);
    for y in [-0.22, 0.22] {
        mesh.tube(steel, Vec3::new(0.1, y, 0.13), Vec3::new(0.6, y, 0.52), 0.016, 0.016, 5);
        mesh.tube(steel, Vec3::new(0.6, y, 0.13), Vec3::new(-0.12, y, 1.02), 0.016, 0.016, 5);
    }
    mesh.rod(steel, Vec3::new(-0.12, -0.24, 1.02), Vec3::new(-0.12, 0.24, 1.02), 0.02, 5);
    model.add(None, Vec3::ZERO, None, mesh);
    model
}

/// Somebody in a wheelchair.
pub fn wheelchair(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let look = Look::of(&mut variety, TAG, detail).sitting();
    let mut model = Model::rigid(chair(Paint::plain(TAG, variety.colour(&CLOTHS)), detail));
    let seat = Seat {
        hip: Vec3::new(-0.14, 0.0, 0.56),
        lean_rad: 0.02,
        thigh_rad: [-1.45, 0.0],
        shin_rad: [1.2, 0.0],
        arm_rad: -0.35,
    };
    ride(&mut model, &look, &seat, None);
    model
}

fn chair(cloth: Paint, detail: Detail) -> Mesh {
    let (rubber, steel) = (Paint::plain(TAG, RUBBER), Paint::plain(TAG, STEEL).glossy(60));
    let mut mesh = Mesh::default();
    for side in [-1.0f32, 1.0] {
        let hub = Vec3::new(-0.2, side * 0.3, 0.3);
        ring(&mut mesh, rubber, hub, 0.3, 0.04, sides(detail) + 2);
        ring(&mut mesh, rubber, Vec3::new(0.32, side * 0.22, 0.09), 0.09, 0.05, sides(detail));
        if detail == Detail::Fine {
            for spoke in 0..6 {
                let angle = TAU * spoke as f32 / 6.0;
                let (sin, cos) = (ops::sin(angle), ops::cos(angle));
                mesh.tube(steel, hub, hub + Vec3::new(0.27 * cos, 0.0, 0.27 * sin), 0.006, 0.006, 4);
            }
        }
        mesh.tube(steel, Vec3::new(-0.3, side * 0.23, 0.45), Vec3::new(-0.42, side * 0.23, 0.95), 0.016, 0.016, 5);
        mesh.tube(steel, Vec3::new(0.2, side * 0.2, 0.46), Vec3::new(0.42, side * 0.16, 0.14), 0.016, 0.016, 5);
    }
    mesh.cuboid(cloth, Vec3::new(-0.32, -0.22, 0.42), Vec3::new(0.18, 0.22, 0.48));
    mesh.cuboid(cloth, Vec3::new(-0.38, -0.22, 0.48), Vec3::new(-0.32, 0.22, 0.9));
    mesh.cuboid(steel, Vec3::new(0.36, -0.17, 0.1), Vec3::new(0.56, 0.17, 0.13));
    mesh
}
