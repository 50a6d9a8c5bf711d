//! Roofs: flat ones behind a parapet, gables and hips with tiles, gutters, dormers and chimneys.

use glam::{Vec2, Vec3};

use super::design::{Design, Roof, style};
use super::outline::{CELL_M, NO_WINDOWS, TAG, corners, rim};
use crate::mesh::model::Detail;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// How far roofs reach over the eaves, and over gables where neighbours may stand.
const EAVES_OUT_M: f32 = 0.45;
const GABLE_OUT_M: f32 = 0.16;
const THICK_M: f32 = 0.18;

/// Painted boards, which only the ground lights.
const BOARD: Paint = Paint::plain(TAG, [228, 224, 214]);
const ZINC: Paint = Paint::plain(TAG, [112, 116, 118]);

pub(super) fn roof(mesh: &mut Mesh, design: &Design, detail: Detail) {
    let mut variety = design.rest;
    match design.roof {
        Roof::Flat => flat(mesh, design, &mut variety),
        Roof::Gabled => gabled(mesh, design),
        Roof::Hipped => hipped(mesh, design),
    }
    if design.roof == Roof::Flat || design.size.x.min(design.size.y) < 6.0 {
        return;
    }
    chimney(mesh, design.size, &mut variety);
    if design.has_dormers {
        dormers(mesh, design);
    } else if design.roof == Roof::Gabled {
        panes(mesh, design, &mut variety, detail);
    }
    if detail != Detail::Rough && design.size.y > design.size.x {
        gutter(mesh, design, detail);
    }
}

/// A part of a roof; its tiles lie in courses along the first edge.
fn tiled(mesh: &mut Mesh, tiles: Paint, slope: &[Vec3]) {
    let normal = (slope[1] - slope[0]).cross(slope[2] - slope[0]).normalize_or_zero();
    let along = (slope[1] - slope[0]).normalize_or_zero();
    let up = normal.cross(along);
    let first = mesh.vertices.len() as u32;
    for &p in slope {
        let off = p - slope[0];
        let uv = Vec2::new(off.dot(along), off.dot(up)) / CELL_M + Vec2::Y * NO_WINDOWS;
        mesh.vertex(tiles, p, normal, uv);
    }
    for i in 2..slope.len() as u32 {
        mesh.triangle(tiles.finish, [first, first + i - 1, first + i]);
    }
}

/// A parapet with a cornice around gravel, and what stands on it.
fn flat(mesh: &mut Mesh, design: &Design, variety: &mut Variety) {
    let Design { size, eaves_m: eaves, .. } = *design;
    let stone = design.plain().shaded(1.1);
    let out = if size.z < 3.6 { 0.08 } else { 0.22 };
    let top = (eaves + 0.3).min(size.z);
    mesh.walls(stone, &corners(size, out, eaves), &corners(size, out, top));
    let under = corners(size, out, eaves);
    mesh.polygon(stone, &[under[3], under[2], under[1], under[0]]);
    if top < size.z {
        rim(mesh, stone, size, [out, 0.0], top);
        mesh.walls(design.plain(), &corners(size, 0.0, top), &corners(size, 0.0, size.z));
    }
    let gravel = Paint::plain(TAG, [128, 126, 122]).grainy(120);
    mesh.polygon(gravel, &corners(size, if top < size.z { 0.0 } else { out }, size.z));
    if size.x.min(size.y) > 8.5 {
        let mut stand = |half: Vec2, height: f32, colour: [u8; 3]| {
            let room = 0.5 * size.truncate() - half - 0.4;
            let at = Vec2::new(variety.between(-1.0, 1.0), variety.between(-1.0, 1.0)) * room;
            let (low, high) = ((at - half).extend(size.z), (at + half).extend(size.z + height));
            mesh.cuboid(Paint::plain(TAG, colour), low, high);
        };
        stand(Vec2::new(1.6, 1.3), 2.0, [150, 150, 150]);
        stand(Vec2::new(0.6, 0.9), 0.9, [178, 180, 180]);
    }
}

/// Sends points along the longer side of the house.
fn along(size: Vec3) -> impl Fn(f32, f32, f32) -> Vec3 {
    let swap = size.y > size.x;
    move |x, y, z| if swap { Vec3::new(-y, x, z) } else { Vec3::new(x, y, z) }
}

/// Half extents along and across the ridge.
fn halves(size: Vec3) -> (f32, f32) {
    (0.5 * size.x.max(size.y), 0.5 * size.x.min(size.y))
}

fn gabled(mesh: &mut Mesh, design: &Design) {
    let Design { size, eaves_m: eaves, tiles, .. } = *design;
    let at = along(size);
    let (a, b) = halves(size);
    let drop = EAVES_OUT_M * (size.z - eaves) / b;
    let (x, y, z) = (a + GABLE_OUT_M, b + EAVES_OUT_M, eaves - drop);
    let ridge = size.z - THICK_M;
    for side in [-1.0f32, 1.0] {
        let slope = |up: f32| {
            [
                at(side * x, side * y, z + up),
                at(-side * x, side * y, z + up),
                at(-side * x, 0.0, ridge + up),
                at(side * x, 0.0, ridge + up),
            ]
        };
        tiled(mesh, tiles, &slope(THICK_M));
        let [p, q, r, s] = slope(0.0);
        mesh.polygon(BOARD, &[s, r, q, p]);
        let [u, v, ..] = slope(THICK_M);
        mesh.polygon(ZINC, &[p, q, v, u]);
        gable(mesh, design, [at(side * a, -side * b, eaves), at(side * a, side * b, eaves), at(side * a, 0.0, ridge)]);
        for half in [-1.0f32, 1.0] {
            let edge = [
                at(side * x, half * y, z),
                at(side * x, half * y, z + THICK_M),
                at(side * x, 0.0, ridge + THICK_M),
                at(side * x, 0.0, ridge),
            ];
            let edge = if side * half > 0.0 { edge } else { [edge[3], edge[2], edge[1], edge[0]] };
            mesh.polygon(BOARD, &edge);
        }
    }
}

/// The wall below a ridge, with the material of those below it and a window.
fn gable(mesh: &mut Mesh, design: &Design, [left, right, top]: [Vec3; 3]) {
    let wide = (right - left).length();
    let normal = (right - left).cross(top - left).normalize_or_zero();
    let columns = (wide / CELL_M.x).floor().max(1.0);
    let rise = (top.z - left.z) / CELL_M.y;
    let uv = |u: f32, v: f32| Vec2::new(u * columns, v + NO_WINDOWS);
    let paint = design.wall;
    let ids = [(left, uv(0.0, 0.0)), (right, uv(1.0, 0.0)), (top, uv(0.5, rise))]
        .map(|(at, uv)| mesh.vertex(paint, at, normal, uv));
    mesh.triangle(paint.finish, ids);
    let high = top.z - left.z;
    if high < 1.8 {
        return;
    }
    let (half, out) = (0.42, 0.02);
    let side = (right - left) / wide;
    let middle = 0.5 * (left + right);
    let pane = |grow: f32, out: f32| {
        let (low, up) = (0.22 * high - grow, 0.22 * high + 1.0 + grow);
        [(-1.0, low), (1.0, low), (1.0, up), (-1.0, up)]
            .map(|(s, z)| middle + side * (s * (half + grow)) + Vec3::Z * z + normal * out)
    };
    mesh.polygon(BOARD, &pane(0.08, out));
    mesh.polygon(Paint::plain(TAG, [44, 50, 58]).glossy(220), &pane(0.0, 1.5 * out));
}

fn hipped(mesh: &mut Mesh, design: &Design) {
    let Design { size, eaves_m: eaves, tiles, .. } = *design;
    let at = along(size);
    let (a, b) = halves(size);
    let out = if b < 3.5 { GABLE_OUT_M } else { EAVES_OUT_M };
    let (x, y) = (a + out, b + out);
    let ridge = (a - b).max(0.0);
    for side in [-1.0f32, 1.0] {
        let long = [
            at(side * x, side * y, eaves),
            at(-side * x, side * y, eaves),
            at(-side * ridge, 0.0, size.z),
            at(side * ridge + side * 0.01, 0.0, size.z),
        ];
        tiled(mesh, tiles, &long);
        tiled(
            mesh,
            tiles,
            &[at(side * x, -side * y, eaves), at(side * x, side * y, eaves), at(side * ridge, 0.0, size.z)],
        );
    }
    mesh.polygon(BOARD, &[at(-x, y, eaves), at(x, y, eaves), at(x, -y, eaves), at(-x, -y, eaves)]);
}

fn chimney(mesh: &mut Mesh, size: Vec3, variety: &mut Variety) {
    let at = along(size);
    let (a, b) = halves(size);
    let foot = at(variety.between(-0.6, 0.6) * a, variety.pick(&[-0.3, 0.3]) * b, 0.0);
    let half = Vec3::new(0.3, 0.4, 0.0);
    let brick = Paint::plain(TAG, [126, 78, 64]);
    mesh.cuboid(brick, foot - half + Vec3::Z * (size.z - 0.4 * b), foot + half + Vec3::Z * (size.z + 0.5));
}

/// Skylights on both slopes of a gabled roof, or solar panels on one.
fn panes(mesh: &mut Mesh, design: &Design, variety: &mut Variety, detail: Detail) {
    let at = along(design.size);
    let (a, b) = halves(design.size);
    let slope = (design.size.z - design.eaves_m) / b;
    let mut pane = |paint: Paint, side: f32, (x, half): (f32, f32), down: [f32; 2]| {
        let place = |x: f32, y: f32| at(side * x, -side * y, design.size.z - y * slope + 0.06);
        mesh.polygon(
            paint,
            &[place(x - half, down[1]), place(x + half, down[1]), place(x + half, down[0]), place(x - half, down[0])],
        );
    };
    let side = variety.pick(&[-1.0, 1.0]);
    if variety.one_in(5) {
        pane(Paint::plain(TAG, [26, 34, 58]).glossy(200), side, (0.0, 0.62 * a), [0.2 * b, 0.8 * b]);
    } else if detail != Detail::Rough && variety.one_in(2) {
        for (side, x) in [(side, -0.4 * a), (side, 0.35 * a), (-side, 0.1 * a)] {
            pane(Paint::plain(TAG, [52, 58, 66]).glossy(230), side, (x, 0.4), [0.45 * b, 0.45 * b + 0.9]);
        }
    }
}

/// On the slope that looks at the street, one above each second column.
fn dormers(mesh: &mut Mesh, design: &Design) {
    let Design { size, eaves_m: eaves, .. } = *design;
    let slope = (size.z - eaves) / (0.5 * size.x);
    let (half, high) = (0.75, (0.5 * (size.z - eaves)).min(1.5));
    let count = (size.y / 4.5).floor().clamp(1.0, 3.0);
    let front_x = 0.5 * size.x - 0.5;
    let foot = eaves + THICK_M + 0.5 * slope;
    let deep = (high / slope).min(front_x - 0.2);
    for i in 0..count as u32 {
        let y = size.y * ((i as f32 + 0.5) / count - 0.5);
        let at = |x: f32, side: f32, z: f32| Vec3::new(front_x - x, y + side * half, foot + z);
        let uv = [(0.0, 1.25), (1.0, 1.25), (1.0, 1.9), (0.0, 1.9)].map(|(u, v)| Vec2::new(u, v));
        let face = design.wall.coded(design.wall.code & !(style::SHUTTERS | style::BANDS | style::FRENCH));
        mesh.quad_uv(face, [at(0.0, -1.0, -0.1), at(0.0, 1.0, -0.1), at(0.0, 1.0, high), at(0.0, -1.0, high)], uv);
        let cheek = Paint::plain(TAG, design.tiles.colour);
        mesh.polygon(cheek, &[at(deep, -1.0, high), at(0.0, -1.0, -0.1), at(0.0, -1.0, high)]);
        mesh.polygon(cheek, &[at(0.0, 1.0, -0.1), at(deep, 1.0, high), at(0.0, 1.0, high)]);
        let lid = [at(-0.2, -1.15, high), at(-0.2, 1.15, high), at(deep, 1.15, high), at(deep, -1.15, high)];
        mesh.polygon(ZINC.shaded(0.8), &lid);
        let edge = Vec3::Z * 0.12;
        mesh.polygon(ZINC, &[lid[0] - edge, lid[1] - edge, lid[1], lid[0]]);
    }
}

/// Along the eaves above the street, with a pipe down at one corner.
fn gutter(mesh: &mut Mesh, design: &Design, detail: Detail) {
    let Design { size, eaves_m: eaves, .. } = *design;
    let x = 0.5 * size.x;
    let y = if design.rest.clone().one_in(2) { 0.5 } else { -0.5 } * (size.y - 0.5);
    let sides = if detail == Detail::Fine { 6 } else { 3 };
    let foot = Vec3::new(x + 0.07, y, 0.3);
    mesh.tube(ZINC, foot, Vec3::new(x + 0.07, y, eaves - 0.2), 0.05, 0.05, sides);
}
