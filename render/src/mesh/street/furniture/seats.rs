//! Where people sit and wait.

use glam::Vec3;

use super::piece::{GLASS, IRON, Piece, WHITE, WOOD};
use crate::mesh::Mesh;
use crate::mesh::variety::Variety;

/// A bench this long has room for a bin beside it, metres.
const BIN_BESIDE_M: f32 = 1.5;

/// Slats on two feet with its back at positive y, and beside some a bin for litter.
pub(super) fn bench(piece: &Piece, variant: u32) -> Mesh {
    let wood = piece.paint(WOOD);
    let mut mesh = Mesh::default();
    let (half, height) = (piece.half(), piece.size.z);
    let has_bin = piece.size.x > BIN_BESIDE_M && Variety::of(variant).one_in(3);
    let end = half.x - if has_bin { 0.45 } else { 0.0 };
    let (seat, thick) = (0.5 * height, 0.06 * height);
    if !piece.is_rough() {
        for x in [-0.85 * half.x, end - 0.15 * half.x] {
            foot(&mut mesh, piece, x, seat);
        }
    }
    // Slats with air between them, one plank where that cannot be told.
    let slats: &[[f32; 2]] =
        if piece.is_fine() { &[[-1.0, -0.62], [-0.53, -0.15], [-0.06, 0.32], [0.41, 0.79]] } else { &[[-1.0, 0.8]] };
    for (k, [from, to]) in slats.iter().enumerate() {
        let paint = wood.shaded([1.0, 0.93, 1.04, 0.97][k]);
        mesh.cuboid(paint, Vec3::new(-half.x, from * half.y, seat), Vec3::new(end, to * half.y, seat + thick));
    }
    let planks: &[[f32; 2]] = if piece.is_fine() { &[[0.62, 0.72], [0.75, 0.86], [0.89, 1.0]] } else { &[[0.64, 1.0]] };
    for (k, [low, high]) in planks.iter().enumerate() {
        let paint = wood.shaded([0.95, 1.03, 0.98][k]);
        mesh.cuboid(paint, Vec3::new(-half.x, 0.84 * half.y, low * height), Vec3::new(end, half.y, high * height));
    }
    if has_bin {
        litter_bin(&mut mesh, piece);
    }
    mesh
}

/// Cast iron: two legs under the seat, and what its back leans on.
fn foot(mesh: &mut Mesh, piece: &Piece, x: f32, seat: f32) {
    let (iron, half, height) = (piece.paint(IRON), piece.half(), piece.size.z);
    let slab = |y: [f32; 2], z: [f32; 2]| {
        [Vec3::new(x - 0.035, y[0] * half.y, z[0]), Vec3::new(x + 0.035, y[1] * half.y, z[1])]
    };
    if !piece.is_fine() {
        let [low, high] = slab([-0.8, 0.9], [0.0, seat]);
        mesh.cuboid(iron, low, high);
        return;
    }
    for [low, high] in [
        slab([-0.85, -0.68], [0.0, seat]),
        slab([0.6, 0.77], [0.0, seat]),
        slab([-0.85, 0.77], [seat - 0.06 * height, seat]),
        slab([0.7, 0.83], [seat, 0.98 * height]),
    ] {
        mesh.cuboid(iron, low, high);
    }
}

fn litter_bin(mesh: &mut Mesh, piece: &Piece) {
    let iron = piece.paint(IRON);
    let (half, height) = (piece.half(), piece.size.z);
    let middle = Vec3::new(half.x - 0.17, 0.0, 0.0);
    let radius = 0.16f32.min(half.y);
    mesh.tube(iron, middle + Vec3::Z * 0.15, middle + Vec3::Z * 0.85 * height, 0.85 * radius, radius, piece.sides());
    mesh.disc(iron.shaded(0.5), middle + Vec3::Z * 0.85 * height, Vec3::Z, radius, piece.sides());
    if !piece.is_rough() {
        mesh.tube(iron, middle, middle + Vec3::Z * 0.15, 0.05, 0.05, 4);
    }
}

/// A roof on a back of panes at positive y, short sides one of which shows a poster, a bench and the times.
pub(super) fn shelter(piece: &Piece, variant: u32) -> Mesh {
    let (steel, glass) = (piece.paint([92, 96, 100]).glossy(40), piece.paint(GLASS).glossy(200));
    let mut mesh = Mesh::default();
    let (half, height) = (piece.half(), piece.size.z);
    let roof = 0.94 * height;
    let sheet = 0.03f32.min(0.2 * half.y);
    mesh.cuboid(steel, Vec3::new(-half.x, -half.y, roof), Vec3::new(half.x, half.y, height));
    mesh.cuboid(glass, Vec3::new(-half.x, 0.92 * half.y - sheet, 0.15), Vec3::new(half.x, 0.92 * half.y, roof));
    for x in [-1.0f32, 1.0] {
        let (out, within) = (0.98 * x * half.x, 0.98 * x * half.x - x * sheet);
        let (low, high) = (out.min(within), out.max(within));
        mesh.cuboid(glass, Vec3::new(low, -0.2 * half.y, 0.15), Vec3::new(high, 0.9 * half.y, roof));
        if !piece.is_rough() {
            for y in [-0.25, 0.88] {
                let foot = Vec3::new(x * (half.x - 0.06), y * half.y, 0.0);
                mesh.cuboid(steel, foot - Vec3::new(0.04, 0.04, 0.0), foot + Vec3::new(0.04, 0.04, roof));
            }
        }
    }
    if piece.is_fine() {
        fittings(&mut mesh, piece, variant, [sheet, roof]);
    }
    mesh
}

/// What one sees of a shelter from near: bars between the panes, a bench, a poster and the times of departure.
fn fittings(mesh: &mut Mesh, piece: &Piece, variant: u32, [sheet, roof]: [f32; 2]) {
    let (half, height) = (piece.half(), piece.size.z);
    let steel = piece.paint([92, 96, 100]).glossy(40);
    let front = 0.92 * half.y - sheet;
    for x in [-1.0 / 3.0, 1.0 / 3.0] {
        let low = Vec3::new(x * half.x - 0.02, front - 0.012, 0.15);
        mesh.cuboid(steel, low, Vec3::new(low.x + 0.04, front, roof));
    }
    mesh.cuboid(steel, Vec3::new(-half.x, -half.y, roof - 0.05), Vec3::new(half.x, -0.94 * half.y, roof));
    for slat in 0..3 {
        let y = 0.25 + 0.2 * slat as f32;
        let (low, high) = (
            Vec3::new(-0.7 * half.x, y * half.y, 0.18 * height),
            Vec3::new(0.7 * half.x, (y + 0.17) * half.y, 0.2 * height),
        );
        mesh.cuboid(piece.paint(WOOD), low, high);
    }
    for x in [-0.5, 0.5] {
        let low = Vec3::new(x * half.x - 0.03, 0.45 * half.y, 0.0);
        mesh.cuboid(steel, low, low + Vec3::new(0.06, 0.06, 0.18 * height));
    }
    // On both sides of the pane at negative x.
    let mut variety = Variety::of(variant);
    let colours = [[176, 56, 52], [52, 96, 150], [196, 150, 60], [70, 120, 90]];
    let (ground, figure) = (piece.paint(variety.colour(&colours)), piece.paint(WHITE));
    for (x, turn) in [(-0.98 * half.x - 0.004, -1.0f32), (-0.98 * half.x + sheet + 0.004, 1.0)] {
        let board = |x: f32, [y0, y1]: [f32; 2], [z0, z1]: [f32; 2]| {
            let mut corners =
                [(y0, z0), (y1, z0), (y1, z1), (y0, z1)].map(|(y, z)| Vec3::new(x, y * half.y, z * height));
            if turn < 0.0 {
                corners.reverse();
            }
            corners
        };
        mesh.polygon(ground, &board(x, [-0.12, 0.82], [0.16, 0.86]));
        mesh.polygon(figure, &board(x + 0.003 * turn, [0.0, 0.7], [0.62, 0.8]));
        mesh.polygon(ground.shaded(0.6), &board(x + 0.003 * turn, [0.0, 0.7], [0.24, 0.5]));
    }
    let times = [(0.45, 0.45), (0.45, 0.72), (0.3, 0.72), (0.3, 0.45)];
    mesh.polygon(figure, &times.map(|(x, z)| Vec3::new((0.75 - x) * half.x, front - 0.004, z * height)));
}
