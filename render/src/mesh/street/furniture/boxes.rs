//! Cabinets, post boxes, containers and troughs.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};
use kernel::ops;

use super::piece::{IRON, Piece, RECTANGLE, STEEL, WHITE, lengthwise};
use crate::mesh::foliage::Leaf;
use crate::mesh::shape::Lump;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// What is so many times as long as it is high, and so long, is a beam across a road, metres.
const BEAM_M: f32 = 6.0;

/// Concrete without any shape, or the beam of a gantry.
pub(super) fn block(piece: &Piece) -> Mesh {
    let size = piece.size;
    if size.x.max(size.y) > BEAM_M && size.x.min(size.y) < size.z && size.z < 2.5 {
        return lengthwise(piece, beam);
    }
    let mut mesh = Mesh::default();
    mesh.cuboid(piece.paint([152, 150, 144]).grainy(40), piece.at(-1.0, -1.0, 0.0), piece.at(1.0, 1.0, 1.0));
    mesh
}

/// Four chords with struts between them, along x.
fn beam(piece: &Piece) -> Mesh {
    let steel = piece.paint(STEEL).glossy(30);
    let mut mesh = Mesh::default();
    if piece.is_rough() {
        mesh.cuboid(steel, piece.at(-1.0, -1.0, 0.0), piece.at(1.0, 1.0, 1.0));
        return mesh;
    }
    let (half, thick) = (piece.half(), 0.1f32.min(0.4 * piece.half().y));
    for (y, z) in [(-1.0, 0.0), (1.0, 0.0), (-1.0, 1.0), (1.0, 1.0)] {
        let low = Vec3::new(-half.x, y * half.y - thick * (0.5 + 0.5 * y), z * (piece.size.z - thick));
        mesh.cuboid(steel, low, low + Vec3::new(piece.size.x, thick, thick));
    }
    let count = (piece.size.x / piece.size.z).round().clamp(2.0, 14.0) as u32;
    let x = |k: u32| -half.x + thick + (piece.size.x - 2.0 * thick) * k as f32 / count as f32;
    for (k, y) in (0..count).flat_map(|k| [-1.0, 1.0].map(|y| (k, y * (half.y - 0.5 * thick)))) {
        let (low, high) = (Vec3::new(0.0, y, 0.5 * thick), Vec3::new(0.0, y, piece.size.z - 0.5 * thick));
        let (from, to) = if k % 2 == 0 { (low, high) } else { (high, low) };
        mesh.tube(steel.shaded(0.9), from + Vec3::X * x(k), to + Vec3::X * x(k + 1), 0.4 * thick, 0.4 * thick, 3);
    }
    mesh
}

/// A shell on a plinth, with two doors that have a handle and slots for air, under a lid that juts out.
pub(super) fn cabinet(piece: &Piece, variant: u32) -> Mesh {
    let mut variety = Variety::of(variant);
    let colour = variety.colour(&[[150, 152, 146], [122, 126, 120], [104, 116, 100]]);
    let shell = piece.paint(colour).glossy(30);
    let mut mesh = Mesh::default();
    mesh.cuboid(shell.shaded(0.55), piece.at(-0.92, -0.92, 0.0), piece.at(0.92, 0.92, 0.12));
    mesh.cuboid(shell, piece.at(-0.94, -0.94, 0.12), piece.at(0.94, 0.94, 0.93));
    mesh.frustum(shell.shaded(0.85), &piece.ring(1.0, 0.93), &piece.ring(0.97, 1.0));
    let [a, b, c, d] = piece.ring(1.0, 0.93);
    mesh.polygon(shell.shaded(0.6), &[d, c, b, a]);
    if piece.is_fine() {
        let sticker = variety.one_in(2);
        for y in [-0.955f32, 0.955] {
            let mut patch = |colour: Paint, x: [f32; 2], z: [f32; 2]| {
                let corners = [(x[0], z[0]), (x[1], z[0]), (x[1], z[1]), (x[0], z[1])];
                mesh.polygon(colour, &corners.map(|(x, z): (f32, f32)| piece.at(-x * y.signum(), y, z)));
            };
            patch(shell.shaded(0.4), [-0.015, 0.015], [0.16, 0.9]);
            patch(shell.shaded(0.3), [0.06, 0.12], [0.5, 0.6]);
            for k in 0..3 {
                let z = 0.2 + 0.05 * k as f32;
                patch(shell.shaded(0.5), [-0.75, -0.2], [z, z + 0.022]);
                patch(shell.shaded(0.5), [0.2, 0.75], [z, z + 0.022]);
            }
            if sticker {
                patch(piece.paint([214, 190, 70]), [-0.7, -0.4], [0.66, 0.78]);
            }
        }
    }
    mesh
}

/// A yellow box under a sloping roof on a foot, with a horn, a slot and a lock to both sides.
pub(super) fn mailbox(piece: &Piece) -> Mesh {
    let yellow = piece.paint([228, 182, 34]).glossy(40);
    let mut mesh = Mesh::default();
    mesh.cuboid(piece.paint(IRON), piece.at(-0.35, -0.35, 0.0), piece.at(0.35, 0.35, 0.35));
    mesh.cuboid(yellow, piece.at(-0.95, -0.95, 0.35), piece.at(0.95, 0.95, 0.86));
    mesh.frustum(yellow.shaded(0.92), &piece.ring(1.0, 0.86), &piece.ring(0.93, 0.93));
    mesh.frustum(yellow.shaded(0.85), &piece.ring(0.93, 0.93), &piece.ring(0.6, 1.0));
    if piece.is_fine() {
        for x in [-0.97f32, 0.97] {
            let mut patch = |colour: [u8; 3], y: [f32; 2], z: [f32; 2], above: f32| {
                let corners = [(y[0], z[0]), (y[1], z[0]), (y[1], z[1]), (y[0], z[1])];
                let at = x * (1.0 + 0.01 * above);
                mesh.polygon(piece.paint(colour), &corners.map(|(y, z): (f32, f32)| piece.at(at, x.signum() * y, z)));
            };
            patch([188, 148, 28], [-0.75, 0.75], [0.735, 0.83], 0.0);
            patch([30, 30, 32], [-0.6, 0.6], [0.76, 0.8], 1.0);
            patch(WHITE, [-0.5, 0.1], [0.55, 0.68], 0.0);
            patch([40, 38, 34], [-0.42, 0.02], [0.6, 0.615], 1.0);
            patch([40, 38, 34], [-0.42, -0.1], [0.635, 0.65], 1.0);
            patch([60, 58, 52], [0.4, 0.55], [0.58, 0.63], 0.0);
        }
    }
    mesh
}

/// A body that widens upwards with ribs, under two lids that rise to its back, on wheels.
pub(super) fn dumpster(piece: &Piece, variant: u32) -> Mesh {
    let colour = Variety::of(variant).colour(&[[56, 86, 62], [62, 76, 104], [92, 94, 96]]);
    let steel = piece.paint(colour).glossy(30);
    let mut mesh = Mesh::default();
    let ring = |share: f32, front: f32, back: f32| {
        let corners = [(-1.0, -1.0, front), (1.0, -1.0, front), (1.0, 1.0, back), (-1.0, 1.0, back)];
        corners.map(|(x, y, z)| piece.at(share * x, share * y, z))
    };
    mesh.walls(steel, &ring(0.84, 0.1, 0.1), &ring(0.95, 0.76, 0.9));
    mesh.walls(steel.shaded(1.12), &ring(0.98, 0.74, 0.88), &ring(0.98, 0.79, 0.93));
    mesh.frustum(steel.shaded(0.45), &ring(1.0, 0.79, 0.92), &ring(1.0, 0.86, 1.0));
    if !piece.is_rough() {
        for (x, y) in [(-0.7, -0.7), (0.7, -0.7), (0.7, 0.7), (-0.7, 0.7)] {
            mesh.cuboid(piece.paint(IRON), piece.at(x - 0.06, y - 0.1, 0.0), piece.at(x + 0.06, y + 0.1, 0.12));
        }
    }
    if piece.is_fine() {
        for x in [-0.5, 0.0, 0.5] {
            let slope = |z: f32| -(0.84 + 0.11 * (z - 0.1) / 0.66) - 0.02;
            let rib = [(x - 0.04, 0.14), (x + 0.04, 0.14), (x + 0.04, 0.72), (x - 0.04, 0.72)];
            mesh.polygon(steel.shaded(0.8), &rib.map(|(x, z)| piece.at(x, slope(z), z)));
        }
        // Handles to lift it by, and the gap between the lids.
        for x in [-1.0, 0.94] {
            mesh.cuboid(piece.paint(STEEL), piece.at(x, -0.2, 0.66), piece.at(x + 0.06, 0.2, 0.7));
        }
        let gap = [(-0.01, -1.0, 0.862), (0.01, -1.0, 0.862), (0.01, 1.0, 1.0), (-0.01, 1.0, 1.0)];
        mesh.polygon(
            steel.shaded(0.25),
            &gap.map(|(x, y, z)| piece.at(x, y, z) + Vec3::Z * 0.002 * f32::from(z < 1.0)),
        );
    }
    mesh
}

/// A trough of concrete with plants in it, near ones with leaves and flowers.
pub(super) fn planter(piece: &Piece, variant: u32) -> Mesh {
    let concrete = piece.paint([158, 154, 146]).grainy(40);
    let mut mesh = Mesh::default();
    let rim = if piece.is_fine() { 0.86 } else { 1.0 };
    mesh.walls(concrete, &piece.ring(0.92, 0.0), &piece.ring(0.96, 0.47));
    mesh.walls(concrete.shaded(1.06), &piece.ring(1.0, 0.47), &piece.ring(1.0, 0.55));
    for k in 0..RECTANGLE.len() {
        let (outer, inner, next) = (piece.ring(1.0, 0.55), piece.ring(rim, 0.55), (k + 1) % RECTANGLE.len());
        if rim < 1.0 {
            mesh.polygon(concrete.shaded(1.08), &[outer[k], outer[next], inner[next], inner[k]]);
        }
    }
    mesh.polygon(piece.paint([70, 56, 44]), &piece.ring(rim, 0.55));
    let mut variety = Variety::of(variant);
    let green = piece.paint(variety.colour(&[[74, 108, 54], [92, 122, 62], [112, 96, 74]])).grainy(120);
    let bloom = piece.paint(variety.pick(&[[206, 70, 84], [226, 186, 66], [214, 206, 214], [150, 92, 170]]));
    let count = ((piece.size.x / piece.size.y).round() as u32).clamp(1, 4);
    let (rings, sides) = if piece.is_fine() { (4, 6) } else { (2, 5) };
    for k in 0..count {
        let x = (2.0 * k as f32 + 1.0) / count as f32 - 1.0;
        let radii = Vec3::new(0.46 * piece.size.x / count as f32, 0.43 * piece.size.y, 0.25 * piece.size.z);
        let lump = Lump { centre: piece.at(x, 0.0, 0.75), radii, rings, sides, rough: 0.0 };
        mesh.lump(green, &lump, &mut variety);
        if piece.is_fine() {
            sprigs(&mut mesh, [green, bloom], &lump, &mut variety);
        }
    }
    mesh
}

/// Leaves around a lump, and flowers on it.
fn sprigs(mesh: &mut Mesh, [green, bloom]: [Paint; 2], lump: &Lump, variety: &mut Variety) {
    let side_m = 0.7 * lump.radii.min_element();
    for k in 0..7 {
        let (turn, lift) = (variety.between(0.0, TAU), variety.between(0.1, 0.75));
        let out = Vec2::new(ops::cos(turn), ops::sin(turn)) * ops::sqrt(1.0 - lift * lift);
        let on = lump.centre + 0.8 * lump.radii * out.extend(lift);
        let [u, v] = [Vec3::new(-out.y, out.x, 0.0).normalize_or(Vec3::X), Vec3::Z];
        let paint = Leaf::Small.paint(if k % 3 == 2 { bloom } else { green.shaded(1.1) }, 150);
        mesh.leaf_card(paint, on, [u, v], side_m, lump.centre);
    }
}
