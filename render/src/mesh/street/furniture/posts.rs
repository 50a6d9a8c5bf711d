//! Bollards, hydrants and hoops.

use glam::Vec3;

use super::piece::{IRON, Piece, STEEL, WHITE};
use crate::mesh::{CODE_RETRO, Mesh};

/// What is higher is a pole, and no bollard, metres.
const BOLLARD_M: f32 = 1.6;
/// From one hoop of a bicycle stand to the next, metres.
const HOOP_PITCH_M: f32 = 0.8;

/// A bollard with two bands that headlights show, or a pole of steel with a foot.
pub(super) fn post(piece: &Piece) -> Mesh {
    let mut mesh = Mesh::default();
    let (sides, radius, top) = (piece.sides(), 0.5 * piece.size.x.min(piece.size.y), Vec3::Z * piece.size.z);
    if piece.size.z > BOLLARD_M {
        let steel = piece.paint(STEEL).glossy(30);
        if !piece.is_rough() {
            mesh.tube(steel.shaded(0.8), Vec3::ZERO, 0.08 * top, radius, radius, sides);
            mesh.disc(steel.shaded(0.8), 0.08 * top, Vec3::Z, radius, sides);
        }
        mesh.tube(steel, Vec3::ZERO, top, 0.8 * radius, 0.8 * radius, sides);
        mesh.disc(steel, top, Vec3::Z, 0.8 * radius, sides);
        return mesh;
    }
    let (iron, band) = (piece.paint(IRON), piece.paint(WHITE).coded(CODE_RETRO));
    let foot = if piece.is_rough() { radius } else { 0.85 * radius };
    mesh.tube(iron, Vec3::ZERO, 0.1 * top, radius, foot, sides);
    let parts = [(0.1, 0.6, iron), (0.6, 0.68, band), (0.68, 0.76, iron), (0.76, 0.86, band), (0.86, 0.93, iron)];
    for (from, to, paint) in parts {
        mesh.tube(paint, from * top, to * top, foot, foot, sides);
    }
    mesh.tube(iron, 0.93 * top, top, foot, 0.6 * foot, sides);
    mesh.disc(iron, top, Vec3::Z, 0.6 * foot, sides);
    mesh
}

/// A red pillar on a flange, with two outlets under a cap.
pub(super) fn hydrant(piece: &Piece) -> Mesh {
    let red = piece.paint([178, 36, 30]).glossy(50);
    let mut mesh = Mesh::default();
    let (sides, radius, top) = (piece.sides(), 0.5 * piece.size.x.min(piece.size.y), Vec3::Z * piece.size.z);
    if !piece.is_rough() {
        mesh.tube(red.shaded(0.8), Vec3::ZERO, 0.06 * top, 0.95 * radius, 0.95 * radius, sides);
        mesh.disc(red.shaded(0.8), 0.06 * top, Vec3::Z, 0.95 * radius, sides);
        let outlet = piece.paint([188, 188, 182]).glossy(60);
        let (middle, reach) = (0.64 * top, Vec3::Y * radius);
        mesh.rod(outlet, middle - reach, middle + reach, 0.24 * radius, sides.min(8));
    }
    mesh.tube(red, Vec3::ZERO, 0.76 * top, 0.6 * radius, 0.6 * radius, sides);
    mesh.tube(red.shaded(0.8), 0.76 * top, 0.8 * top, 0.75 * radius, 0.75 * radius, sides);
    mesh.tube(red.shaded(0.9), 0.8 * top, 0.93 * top, 0.7 * radius, 0.35 * radius, sides);
    mesh.tube(red.shaded(0.8), 0.93 * top, top, 0.2 * radius, 0.2 * radius, 5);
    mesh.disc(red.shaded(0.8), top, Vec3::Z, 0.2 * radius, 5);
    mesh.disc(red.shaded(0.9), 0.93 * top, Vec3::Z, 0.35 * radius, sides);
    mesh
}

/// A row of hoops across its length, bent at the top.
pub(super) fn bicycle_stand(piece: &Piece) -> Mesh {
    let steel = piece.paint(STEEL).glossy(60);
    let mut mesh = Mesh::default();
    let (half, sides) = (piece.half(), if piece.is_fine() { 4 } else { 3 });
    let radius = 0.03f32.min(0.3 * half.y).min(half.x);
    let count = ((piece.size.x / HOOP_PITCH_M) as u32).clamp(1, 12);
    for k in 0..count {
        let x = ((2 * k + 1) as f32 / count as f32 - 1.0) * half.x;
        let (y, top) = (half.y - radius, piece.size.z);
        let bend = if piece.is_fine() { (0.25 * top).min(0.6 * y) } else { 0.0 };
        let at = |y: f32, z: f32| Vec3::new(x, y, z);
        for side in [-1.0, 1.0] {
            mesh.tube(steel, at(side * y, 0.0), at(side * y, top - radius - bend), radius, radius, sides);
            if bend > 0.0 {
                let corner = at(side * (y - bend), top - radius);
                mesh.tube(steel, at(side * y, top - radius - bend), corner, radius, radius, sides);
            }
        }
        let low = Vec3::new(x - radius, bend - half.y, top - 2.0 * radius);
        mesh.cuboid(steel, low, Vec3::new(x + radius, half.y - bend, top));
    }
    mesh
}
