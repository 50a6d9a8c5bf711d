//! Things that somebody may take away, and stalls.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;

use super::piece::{IRON, Piece, WHITE, WOOD, lengthwise};
use crate::mesh::variety::Variety;
use crate::mesh::{CODE_RETRO, Mesh, Paint};

/// What is as slim and higher is a bin, metres.
const HIGHEST_CONE_M: f32 = 0.95;
/// What is as flat is a pallet, metres.
const HIGHEST_PALLET_M: f32 = 0.8;
const ORANGE: [u8; 3] = [226, 92, 30];
const RED: [u8; 3] = [200, 30, 34];

/// A cone, beacon, barricade, pallet or bin of class Dynamic, whichever fits its box.
pub(super) fn movable(piece: &Piece, variant: u32) -> Mesh {
    let size = piece.size;
    let (wide, slim) = (size.x.max(size.y), size.x.min(size.y));
    if slim > 0.6 && wide > 1.1 * size.z && size.z < HIGHEST_PALLET_M {
        pallet(piece)
    } else if wide > 1.5 * size.z {
        barricade(piece)
    } else if wide < 0.6 * size.z && size.z < HIGHEST_CONE_M && slim > 0.6 * wide {
        cone(piece)
    } else if slim < 0.6 * wide {
        beacon(piece)
    } else {
        bin(piece, variant)
    }
}

/// Rubber with two bands that headlights show, on a square foot.
pub(super) fn cone(piece: &Piece) -> Mesh {
    let size = piece.size;
    let sides = if piece.is_fine() { 14 } else { 6 };
    let (foot, radius) = (0.5 * size.x.min(size.y), 0.4 * size.x.min(size.y));
    let mut mesh = Mesh::default();
    mesh.cuboid(piece.paint([40, 40, 42]), Vec3::new(-foot, -foot, 0.0), Vec3::new(foot, foot, 0.05));
    let ring = |share: f32| (Vec3::Z * (0.05 + share * (size.z - 0.05)), radius * (1.0 - 0.8 * share));
    let band = piece.paint(WHITE).coded(CODE_RETRO);
    for (k, paint) in
        [piece.paint(ORANGE), band, piece.paint(ORANGE), band, piece.paint(ORANGE)].into_iter().enumerate()
    {
        let ((a, wide), (b, narrow)) = (ring(0.2 * k as f32), ring(0.2 * (k + 1) as f32));
        mesh.tube(paint, a, b, wide, narrow, sides);
    }
    mesh.disc(piece.paint([60, 30, 20]), ring(1.0).0, Vec3::Z, ring(1.0).1, sides);
    mesh
}

/// Slanting stripes of white and red between two edges of a board across `along`, by its height; `board` gives the point at
/// shares of its width and height.
fn stripes(mesh: &mut Mesh, piece: &Piece, [width, height]: [f32; 2], mut board: impl FnMut(f32, f32) -> Vec3) {
    let pitch = 0.16;
    let count = ((height + width) / pitch).ceil() as u32;
    for k in 0..count {
        // The line x + z = d in metres, cut off at the board's edges.
        let (d0, d1) = (pitch * k as f32, (pitch * (k + 1) as f32).min(width + height));
        let cut = |d: f32| [(d.min(width), (d - width).max(0.0)), ((d - height).max(0.0), d.min(height))];
        let ([a, b], [c, e]) = (cut(d0), cut(d1));
        let mut corners = vec![a];
        // Where the band goes around a corner of the board.
        if a.1 <= 0.0 && c.1 > 0.0 {
            corners.push((width, 0.0));
        }
        corners.extend([c, e]);
        if b.0 <= 0.0 && e.0 > 0.0 {
            corners.push((0.0, height));
        }
        corners.push(b);
        corners.dedup();
        let colour = if k % 2 == 0 { WHITE } else { RED };
        let corners: Vec<Vec3> = corners.iter().map(|(x, z)| board(x / width, z / height)).collect();
        let is_flat = |c: &[Vec3]| c.len() < 3 || (c[1] - c[0]).cross(c[2] - c[0]).length_squared() < 1e-12;
        if !is_flat(&corners) {
            mesh.polygon(piece.paint(colour).coded(CODE_RETRO), &corners);
        }
    }
}

/// A board with slanting stripes on a foot of rubber, which faces along the shorter side of its box.
pub(super) fn beacon(piece: &Piece) -> Mesh {
    let (size, half) = (piece.size, 0.5 * piece.size);
    let mut mesh = Mesh::default();
    let foot = 0.12;
    mesh.cuboid(piece.paint([40, 40, 42]), Vec3::new(-half.x, -half.y, 0.0), Vec3::new(half.x, half.y, foot));
    let thick = half.min(Vec3::splat(0.03)).x;
    let across = size.x < size.y;
    let (x, y) = if across { (thick, 0.95 * half.y) } else { (0.95 * half.x, thick) };
    if piece.is_rough() {
        mesh.cuboid(piece.paint([224, 130, 128]), Vec3::new(-x, -y, foot), Vec3::new(x, y, size.z));
        return mesh;
    }
    mesh.cuboid(piece.paint([150, 150, 148]), Vec3::new(-x, -y, foot), Vec3::new(x, y, size.z));
    let (wide, high) = (2.0 * x.max(y), size.z - foot);
    for side in [-1.0, 1.0] {
        stripes(&mut mesh, piece, [wide, high], |u, v| {
            let (along, out) = (side * (u - 0.5) * wide, side * (thick + 0.004));
            let z = foot + v * high;
            if across { Vec3::new(out, along, z) } else { Vec3::new(-along, out, z) }
        });
    }
    mesh
}

/// Red and white boards on two feet.
pub(super) fn barricade(piece: &Piece) -> Mesh {
    lengthwise(piece, |piece| {
        let (size, half) = (piece.size, 0.5 * piece.size);
        let mut mesh = Mesh::default();
        let (steel, foot) = (piece.paint([90, 92, 94]), piece.paint([40, 40, 42]));
        let reach = 0.12f32.min(0.2 * half.x);
        for x in [-0.8 * half.x, 0.8 * half.x] {
            mesh.cuboid(
                foot,
                Vec3::new(x - reach, -half.y, 0.0),
                Vec3::new(x + reach, half.y, 0.1f32.min(0.3 * size.z)),
            );
            mesh.cuboid(steel, Vec3::new(x - 0.03, -0.03, 0.0), Vec3::new(x + 0.03, 0.03, 0.98 * size.z));
        }
        let boards: &[[f32; 2]] = if piece.is_fine() { &[[0.42, 0.6], [0.76, 1.0]] } else { &[[0.6, 1.0]] };
        let count = (size.x / 0.4).round().clamp(2.0, 16.0) as u32;
        let length = size.x / count as f32;
        for (k, [low, high]) in (0..count).flat_map(|k| boards.iter().map(move |board| (k, *board))) {
            let x = -half.x + length * k as f32;
            let paint = piece.paint(if k % 2 == 0 { WHITE } else { RED }).coded(CODE_RETRO);
            mesh.cuboid(paint, Vec3::new(x, -0.04, low * size.z), Vec3::new(x + length, 0.04, high * size.z));
        }
        mesh
    })
}

/// Boards on blocks, stacked up.
fn pallet(piece: &Piece) -> Mesh {
    let wood = piece.paint(WOOD);
    let mut mesh = Mesh::default();
    let layers = (piece.size.z / 0.15).round().clamp(1.0, 5.0) as u32;
    for k in 0..layers {
        let (low, high) = (k as f32 / layers as f32, (k + 1) as f32 / layers as f32);
        let board = high - 0.3 / layers as f32;
        if !piece.is_rough() {
            for y in [-1.0, -0.1, 0.8] {
                mesh.cuboid(wood.shaded(0.7), piece.at(-1.0, y, low), piece.at(1.0, y + 0.2, board));
            }
        }
        mesh.cuboid(wood.shaded(0.9 + 0.06 * (k % 3) as f32), piece.at(-1.0, -1.0, board), piece.at(1.0, 1.0, high));
    }
    mesh
}

/// A bin on two wheels whose lid falls to its front, or, when small, a round one for litter.
pub(super) fn bin(piece: &Piece, variant: u32) -> Mesh {
    let mut variety = Variety::of(variant);
    let body = piece.paint(variety.colour(&[[62, 66, 70], [50, 86, 60], [54, 74, 120], [196, 160, 46]])).glossy(20);
    let mut mesh = Mesh::default();
    let (sides, radius) = (if piece.is_fine() { 12 } else { 6 }, 0.5 * piece.size.x.min(piece.size.y));
    if radius < 0.26 && variety.one_in(2) {
        litter_bin(&mut mesh, piece, body, radius, sides);
        return mesh;
    }
    let ring = |share: f32, front: f32, back: f32| {
        [(1.0, -1.0, front), (1.0, 1.0, front), (-1.0, 1.0, back), (-1.0, -1.0, back)]
            .map(|(x, y, z)| piece.at(share * x, share * y, z))
    };
    // Its front looks along x, away from handle and wheels.
    mesh.walls(body, &ring(0.74, 0.02, 0.02), &ring(0.9, 0.84, 0.9));
    mesh.frustum(body.shaded(0.8), &ring(0.98, 0.84, 0.9), &ring(0.94, 0.92, 1.0));
    if !piece.is_rough() {
        let wheel = (0.09 * piece.size.z).min(0.15 * piece.size.x);
        for y in [-0.75, 0.75] {
            let hub = piece.at(-0.72, y, 0.0) + Vec3::Z * wheel;
            mesh.rod(piece.paint([30, 30, 32]), hub - Vec3::Y * 0.025, hub + Vec3::Y * 0.025, wheel, sides.min(8));
        }
    }
    if piece.is_fine() {
        let grip = piece.at(-0.97, 0.0, 0.93);
        let reach = 0.35 * piece.size.y * Vec3::Y;
        mesh.tube(body.shaded(0.6), grip - reach, grip + reach, 0.018, 0.018, 5);
        let label = [(0.35, 0.5), (0.35, 0.68), (-0.35, 0.68), (-0.35, 0.5)];
        let slope = |z: f32| 0.74 + 0.16 * z / 0.84 + 0.012;
        mesh.polygon(body.shaded(1.5), &label.map(|(y, z)| piece.at(slope(z), -y, z)));
    }
    mesh
}

/// A drum with an opening under its hood.
fn litter_bin(mesh: &mut Mesh, piece: &Piece, body: Paint, radius: f32, sides: u32) {
    let at = |share: f32| Vec3::Z * (share * piece.size.z);
    mesh.tube(piece.paint(IRON), at(0.0), at(0.08), 0.8 * radius, 0.8 * radius, sides);
    mesh.tube(body, at(0.08), at(0.72), 0.92 * radius, 0.92 * radius, sides);
    mesh.tube(body.shaded(0.6), at(0.72), at(0.75), radius, radius, sides);
    mesh.disc(piece.paint([24, 24, 26]), at(0.75), Vec3::Z, radius, sides);
    for k in 0..3 {
        let angle = TAU * k as f32 / 3.0;
        let foot = at(0.75) + 0.85 * radius * Vec3::new(ops::cos(angle), ops::sin(angle), 0.0);
        mesh.tube(body.shaded(0.6), foot, foot + at(0.13), 0.02, 0.02, 3);
    }
    mesh.tube(body.shaded(0.85), at(0.88), at(1.0), radius, 0.35 * radius, sides);
    mesh.disc(body.shaded(0.85), at(1.0), Vec3::Z, 0.35 * radius, sides);
    mesh.disc(body.shaded(0.4), at(0.88), Vec3::NEG_Z, radius, sides);
}

/// An awning in stripes on four posts, with a counter of goods and, behind some, a wall.
pub(super) fn stall(piece: &Piece, variant: u32) -> Mesh {
    let mut variety = Variety::of(variant);
    let cloth = piece.paint(variety.colour(&[[196, 168, 60], [150, 62, 54], [70, 96, 120], [60, 110, 72]]));
    let mut mesh = Mesh::default();
    let (half, size) = (piece.half(), piece.size);
    let post = piece.paint([96, 98, 100]);
    let eaves = (size.z - 0.45).max(0.6 * size.z);
    for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let at = Vec3::new(x * (half.x - 0.06), y * (half.y - 0.06), 0.0);
        mesh.cuboid(post, at - Vec3::new(0.03, 0.03, 0.0), at + Vec3::new(0.03, 0.03, eaves));
    }
    let counter = 0.9f32.min(eaves);
    let back = if variety.one_in(2) { counter } else { eaves };
    let wood = piece.paint(WOOD);
    mesh.cuboid(wood.shaded(0.9), Vec3::new(-half.x, half.y - 0.12, 0.0), Vec3::new(half.x, half.y - 0.06, back));
    mesh.cuboid(wood, Vec3::new(-half.x, -half.y + 0.1, 0.0), Vec3::new(half.x, 0.0, counter));
    if piece.is_fine() && counter < eaves - 0.3 {
        goods(&mut mesh, piece, counter, &mut variety);
    }
    awning(&mut mesh, piece, cloth, eaves);
    mesh
}

/// Boxes of fruit side by side.
fn goods(mesh: &mut Mesh, piece: &Piece, counter: f32, variety: &mut Variety) {
    let half = piece.half();
    let count = (piece.size.x / 0.55).clamp(1.0, 6.0) as u32;
    let step = 0.96 * piece.size.x / count as f32;
    for k in 0..count {
        let colour = variety.colour(&[[196, 60, 40], [222, 150, 40], [90, 140, 50], [226, 204, 90], [120, 60, 110]]);
        let low = Vec3::new(0.04 - 0.96 * half.x + step * k as f32, -half.y + 0.14, counter);
        let high = Vec3::new(low.x + step - 0.08, -0.05, counter + variety.between(0.1, 0.16));
        mesh.cuboid(piece.paint(colour), low, high);
    }
}

/// A ridge along x with a slope to both sides and a hem in front, in stripes.
fn awning(mesh: &mut Mesh, piece: &Piece, cloth: Paint, eaves: f32) {
    let (half, top) = (piece.half(), piece.size.z);
    let count = if piece.is_rough() {
        1
    } else {
        (piece.size.x / if piece.is_fine() { 0.4 } else { 0.8 }).round().clamp(2.0, 10.0) as u32
    };
    let x = |k: u32| -half.x + piece.size.x * k as f32 / count as f32;
    for k in 0..count {
        let paint = if k % 2 == 1 { cloth.colour(WHITE) } else { cloth };
        let at = |k: u32, y: f32, z: f32| Vec3::new(x(k), y * half.y, z);
        let hem = eaves - 0.14;
        for (y0, z0, y1, z1) in
            [(-1.0, hem, -1.0, eaves), (-1.0, eaves, 0.0, top), (0.0, top, 1.0, eaves), (1.0, eaves, 1.0, hem)]
        {
            let strip = [at(k, y0, z0), at(k + 1, y0, z0), at(k + 1, y1, z1), at(k, y1, z1)];
            mesh.polygon(paint, &strip);
            mesh.polygon(paint.shaded(0.6), &[strip[3], strip[2], strip[1], strip[0]]);
        }
    }
    for side in [-1.0f32, 1.0] {
        let mut gable = [(-1.0, eaves), (1.0, eaves), (0.0, top)].map(|(y, z)| Vec3::new(side * half.x, y * half.y, z));
        if side < 0.0 {
            gable.reverse();
        }
        mesh.polygon(cloth.shaded(0.9), &gable);
    }
}
