//! What no name is told of: what it is follows from its size.

use core::f32::consts::TAU;

use glam::Vec3;
use kernel::ops;

use super::loose;
use super::piece::{GLASS, IRON, Piece, STEEL, WHITE, WOOD, lengthwise};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const STONE: [u8; 3] = [164, 158, 146];
const SAND: [u8; 3] = [206, 186, 140];
const WATER: [u8; 3] = [70, 104, 112];

/// A thing of class Other by its box: what is flat is a sand pit, a wide square one a basin, a slender one stands on a plinth,
/// a long one is a boat or a frame to swing on, and what one can stand in is a kiosk or a stall.
pub(super) fn sundry(piece: &Piece, variant: u32) -> Mesh {
    let size = piece.size;
    let (long, short) = (size.x.max(size.y), size.x.min(size.y));
    let is_square = short > 0.8 * long;
    if is_square && short > 1.5 && size.z < 0.5 {
        sand_pit(piece)
    } else if is_square && short > 1.8 && size.z < 1.6 {
        basin(piece)
    } else if is_square && long < 1.7 && size.z > 1.8 {
        if Variety::of(variant).one_in(2) { column(piece, variant) } else { statue(piece) }
    } else if long > 2.2 * short && long > 2.8 && size.z < 1.4 {
        lengthwise(piece, |piece| boat(piece, variant))
    } else if long > 2.2 * short && size.z > 1.6 {
        let frame = if short > 1.2 { swing } else { slide };
        lengthwise(piece, frame)
    } else if size.z > 2.4 && short > 1.5 {
        kiosk(piece, variant)
    } else if size.z > 1.9 && short > 0.8 {
        loose::stall(piece, variant)
    } else {
        container(piece, variant)
    }
}

/// Planks around sand.
fn sand_pit(piece: &Piece) -> Mesh {
    let (wood, half) = (piece.paint(WOOD), piece.half());
    let (mut mesh, board) = (Mesh::default(), 0.15);
    for side in [-1.0f32, 1.0] {
        let y = [side * half.y, side * (half.y - board)];
        let (low, high) = (y[0].min(y[1]), y[0].max(y[1]));
        mesh.cuboid(wood, Vec3::new(-half.x, low, 0.0), Vec3::new(half.x, high, piece.size.z));
        let x = [side * half.x, side * (half.x - board)];
        let (low, high) = (x[0].min(x[1]), x[0].max(x[1]));
        mesh.cuboid(
            wood.shaded(0.93),
            Vec3::new(low, board - half.y, 0.0),
            Vec3::new(high, half.y - board, piece.size.z),
        );
    }
    mesh.polygon(piece.paint(SAND).grainy(120), &piece.ring(0.95, 0.6));
    mesh
}

/// A round basin of stone with water, and a pillar in its middle.
fn basin(piece: &Piece) -> Mesh {
    let stone = piece.paint(STONE).grainy(80);
    let mut mesh = Mesh::default();
    let (sides, radius, height) =
        (if piece.is_fine() { 16 } else { 8 }, 0.5 * piece.size.x.min(piece.size.y), piece.size.z);
    let at = |share: f32| Vec3::Z * (share * height);
    let rim = 0.5;
    mesh.tube(stone, at(0.0), at(rim), 0.96 * radius, 0.96 * radius, sides);
    mesh.tube(stone.shaded(1.1), at(rim - 0.1), at(rim), radius, radius, sides);
    let ring = |share: f32| -> Vec<Vec3> {
        let corner = |k: u32| TAU * k as f32 / sides as f32;
        (0..sides)
            .map(|k| at(rim) + share * radius * Vec3::new(ops::cos(corner(k)), ops::sin(corner(k)), 0.0))
            .collect()
    };
    let (outer, inner) = (ring(1.0), ring(0.84));
    for k in 0..sides as usize {
        let next = (k + 1) % sides as usize;
        mesh.polygon(stone.shaded(1.1), &[outer[k], outer[next], inner[next], inner[k]]);
        mesh.polygon(stone.shaded(0.8), &[inner[k], inner[next], inner[next] - at(0.1), inner[k] - at(0.1)]);
    }
    mesh.disc(piece.paint(WATER).glossy(220), at(rim - 0.1), Vec3::Z, 0.86 * radius, sides);
    for (from, to, thick, slim) in [(0.4, 0.8, 0.14, 0.1), (0.8, 0.88, 0.1, 0.34), (0.88, 1.0, 0.12, 0.03)] {
        mesh.tube(stone, at(from), at(to), thick * radius, slim * radius, sides.min(10));
    }
    mesh.disc(piece.paint(WATER).glossy(220), at(0.88), Vec3::Z, 0.33 * radius, sides.min(10));
    mesh
}

/// A column for posters under a hood.
fn column(piece: &Piece, variant: u32) -> Mesh {
    let mut variety = Variety::of(variant ^ 0x5eed);
    let mut mesh = Mesh::default();
    let (sides, radius) = (if piece.is_fine() { 16u32 } else { 8 }, 0.5 * piece.size.x.min(piece.size.y));
    let at = |share: f32| Vec3::Z * (share * piece.size.z);
    let green = piece.paint([54, 78, 66]);
    mesh.tube(green, at(0.0), at(0.1), 0.95 * radius, 0.95 * radius, sides);
    mesh.disc(green, at(0.1), Vec3::Z, 0.95 * radius, sides);
    mesh.tube(piece.paint([196, 190, 176]), at(0.1), at(0.88), 0.88 * radius, 0.88 * radius, sides);
    mesh.tube(green, at(0.88), at(0.92), radius, radius, sides);
    mesh.tube(green, at(0.92), at(1.0), radius, 0.2 * radius, sides);
    mesh.disc(green, at(1.0), Vec3::Z, 0.2 * radius, sides);
    mesh.disc(green.shaded(0.6), at(0.88), Vec3::NEG_Z, radius, sides);
    if !piece.is_rough() {
        let colours = [[176, 56, 52], [52, 96, 150], [206, 160, 60], [70, 120, 90], [220, 216, 206], [60, 58, 66]];
        let corner = |k: u32, z: f32| {
            let angle = TAU * (k % sides) as f32 / sides as f32;
            at(z) + 0.895 * radius * Vec3::new(ops::cos(angle), ops::sin(angle), 0.0)
        };
        for k in (0..sides).step_by(2).flat_map(|k| [(k, 0.14, 0.48), (k, 0.5, 0.86)]) {
            let (k, low, high) = k;
            let paint = piece.paint(variety.colour(&colours));
            for k in [k, k + 1] {
                mesh.polygon(paint, &[corner(k, low), corner(k + 1, low), corner(k + 1, high), corner(k, high)]);
            }
        }
    }
    mesh
}

/// Somebody of bronze on a plinth.
fn statue(piece: &Piece) -> Mesh {
    let (stone, bronze) = (piece.paint(STONE).grainy(80), piece.paint([74, 92, 80]).glossy(50));
    let mut mesh = Mesh::default();
    mesh.frustum(stone.shaded(0.9), &piece.ring(1.0, 0.0), &piece.ring(1.0, 0.06));
    mesh.walls(stone, &piece.ring(0.72, 0.06), &piece.ring(0.66, 0.38));
    mesh.frustum(stone.shaded(1.08), &piece.ring(0.8, 0.38), &piece.ring(0.8, 0.43));
    let (sides, width) = (piece.sides(), 0.5 * piece.size.x.min(piece.size.y));
    let at = |x: f32, y: f32, z: f32| Vec3::new(x * width, y * width, z * piece.size.z);
    let mut limb = |a: Vec3, b: Vec3, thick: f32, slim: f32| {
        mesh.tube(bronze, a, b, thick * width, slim * width, sides.min(7));
    };
    limb(at(0.0, 0.0, 0.43), at(0.0, 0.0, 0.68), 0.34, 0.22);
    limb(at(0.0, 0.0, 0.68), at(0.0, 0.0, 0.86), 0.22, 0.27);
    limb(at(0.0, 0.0, 0.86), at(0.0, 0.0, 0.88), 0.27, 0.09);
    limb(at(0.0, 0.28, 0.84), at(0.14, 0.4, 0.7), 0.1, 0.08);
    limb(at(0.0, -0.28, 0.84), at(0.4, -0.36, 0.82), 0.1, 0.07);
    let head = Vec3::new(0.14, 0.14, 0.0) * width + Vec3::Z * 0.06 * piece.size.z;
    mesh.ellipsoid(bronze, at(0.0, 0.0, 0.94), head, 5, sides.min(8));
    mesh
}

/// A hull that gets slim to its bow, with a seat across it.
fn boat(piece: &Piece, variant: u32) -> Mesh {
    let colour = Variety::of(variant).colour(&[[222, 218, 206], [60, 98, 130], [150, 60, 48], [130, 92, 58]]);
    let (hull, inside) = (piece.paint(colour).glossy(60), piece.paint(WOOD).shaded(0.8));
    let mut mesh = Mesh::default();
    // Stations from stern to bow: where, half the beam at the gunwale and at the keel, height of the gunwale.
    let stations = [(-1.0, 0.8, 0.5, 0.86), (-0.3, 1.0, 0.6, 0.8), (0.4, 0.82, 0.42, 0.86), (1.0, 0.05, 0.02, 1.0)];
    let line = |y: fn(f32, f32) -> (f32, f32)| {
        stations.map(|(x, gunwale, keel, z)| {
            let (side, height) = y(gunwale, keel);
            piece.at(x, side, height * z)
        })
    };
    let lines = [
        line(|_, keel| (-keel, 0.02)),
        line(|gunwale, _| (-gunwale, 1.0)),
        line(|gunwale, _| (gunwale, 1.0)),
        line(|_, keel| (keel, 0.02)),
    ];
    for k in 0..stations.len() - 1 {
        let quad = |a: &[Vec3; 4], b: &[Vec3; 4]| [a[k], a[k + 1], b[k + 1], b[k]];
        mesh.polygon(hull, &quad(&lines[0], &lines[1]));
        mesh.polygon(hull, &[lines[2][k], lines[2][k + 1], lines[3][k + 1], lines[3][k]]);
        let floor = [lines[1][k], lines[1][k + 1], lines[2][k + 1], lines[2][k]];
        mesh.polygon(inside, &floor.map(|p| Vec3::new(p.x, 0.82 * p.y, 0.72 * p.z)));
        for (line, side) in [(&lines[1], 1.0f32), (&lines[2], -1.0)] {
            let within = |p: Vec3| Vec3::new(p.x, 0.82 * p.y, 0.72 * p.z);
            let mut wall = [line[k], line[k + 1], within(line[k + 1]), within(line[k])];
            if side < 0.0 {
                wall.reverse();
            }
            mesh.polygon(inside.shaded(1.1), &wall);
        }
    }
    mesh.polygon(hull.shaded(0.9), &[lines[0][0], lines[1][0], lines[2][0], lines[3][0]]);
    for x in [-0.5, 0.15] {
        mesh.cuboid(piece.paint(WOOD), piece.at(x, -0.66, 0.64), piece.at(x + 0.14, 0.66, 0.69));
    }
    mesh
}

/// Two trestles under a bar from which two seats hang.
fn swing(piece: &Piece) -> Mesh {
    let (wood, chain) = (piece.paint(WOOD), piece.paint(STEEL));
    let mut mesh = Mesh::default();
    let (sides, half, top) = (piece.sides().min(6), piece.half(), piece.size.z);
    let thick = 0.05f32.min(0.2 * half.y);
    for x in [-half.x + thick, half.x - thick] {
        for y in [-half.y + thick, half.y - thick] {
            mesh.tube(wood, Vec3::new(x, y, 0.0), Vec3::new(x, 0.0, top - thick), thick, thick, sides);
        }
    }
    mesh.cuboid(wood, Vec3::new(-half.x, -thick, top - 2.0 * thick), Vec3::new(half.x, thick, top));
    for x in [-0.4 * half.x, 0.4 * half.x] {
        let seat = Vec3::new(x, 0.0, 0.2 * top);
        mesh.cuboid(piece.paint(IRON), seat - Vec3::new(0.22, 0.09, 0.0), seat + Vec3::new(0.22, 0.09, 0.04));
        for side in [-0.2, 0.2] {
            let foot = seat + Vec3::X * side;
            mesh.tube(chain, foot, Vec3::new(foot.x, 0.0, top - 2.0 * thick), 0.012, 0.012, 3);
        }
    }
    mesh
}

/// A chute down along x from a platform with a ladder.
fn slide(piece: &Piece) -> Mesh {
    let (red, chute) = (piece.paint([186, 60, 46]), piece.paint([196, 200, 204]).glossy(120));
    let mut mesh = Mesh::default();
    let deck = 0.62;
    for (x, y) in [(-0.95, -0.85), (-0.95, 0.7), (-0.62, -0.85), (-0.62, 0.7)] {
        mesh.cuboid(red, piece.at(x, y, 0.0), piece.at(x + 0.05, y + 0.15, 1.0));
    }
    mesh.cuboid(piece.paint(WOOD), piece.at(-0.97, -0.85, deck - 0.03), piece.at(-0.56, 0.85, deck));
    mesh.cuboid(red, piece.at(-1.0, -1.0, 0.94), piece.at(-0.54, 1.0, 1.0));
    for step in 1..5 {
        let z = deck * step as f32 / 5.0;
        mesh.cuboid(red, piece.at(-0.98, -0.7, z - 0.012), piece.at(-0.94, 0.7, z + 0.012));
    }
    let way = [(-0.56, deck), (0.7, 0.14), (1.0, 0.12)];
    for pair in way.windows(2) {
        let at = |(x, z): (f32, f32), y: f32, up: f32| piece.at(x, y, z + up);
        let bed = [at(pair[0], -0.75, 0.0), at(pair[1], -0.75, 0.0), at(pair[1], 0.75, 0.0), at(pair[0], 0.75, 0.0)];
        mesh.polygon(chute, &bed);
        mesh.polygon(chute.shaded(0.5), &[bed[3], bed[2], bed[1], bed[0]]);
        for y in [-0.75, 0.75] {
            let rail = [at(pair[0], y, 0.0), at(pair[1], y, 0.0), at(pair[1], y, 0.08), at(pair[0], y, 0.08)];
            mesh.polygon(red, &rail);
            mesh.polygon(red, &[rail[3], rail[2], rail[1], rail[0]]);
        }
    }
    mesh
}

/// A hut with a hatch over a counter, under a flat roof with a coloured band.
fn kiosk(piece: &Piece, variant: u32) -> Mesh {
    let mut variety = Variety::of(variant);
    let wall = piece.paint(variety.colour(&[[196, 188, 170], [150, 162, 160], [176, 150, 116]]));
    let band = piece.paint(variety.colour(&[[150, 46, 42], [46, 84, 130], [54, 104, 70]]));
    let mut mesh = Mesh::default();
    mesh.cuboid(wall, piece.at(-0.9, -0.9, 0.0), piece.at(0.9, 0.9, 0.86));
    mesh.cuboid(band, piece.at(-1.0, -1.0, 0.86), piece.at(1.0, 1.0, 1.0));
    if piece.is_rough() {
        return mesh;
    }
    let glass = piece.paint(GLASS).shaded(0.5).glossy(200);
    for turn in 0..4 {
        let to_side = |u: f32, out: f32, z: f32| match turn {
            0 => piece.at(u, -out, z),
            1 => piece.at(out, u, z),
            2 => piece.at(-u, out, z),
            _ => piece.at(-out, -u, z),
        };
        let board = |[u0, u1]: [f32; 2], [z0, z1]: [f32; 2], out: f32| {
            [to_side(u0, out, z0), to_side(u1, out, z0), to_side(u1, out, z1), to_side(u0, out, z1)]
        };
        if turn % 2 == 0 {
            mesh.polygon(glass, &board([-0.7, 0.7], [0.42, 0.8], 0.91));
            mesh.polygon(wall.colour(WHITE), &board([-0.75, 0.75], [0.38, 0.41], 0.96));
        } else if turn == 1 {
            mesh.polygon(wall.shaded(0.6), &board([-0.4, 0.2], [0.02, 0.78], 0.91));
        }
        if piece.is_fine() {
            mesh.polygon(wall.colour(WHITE), &board([-0.5, 0.5], [0.9, 0.96], 1.005));
        }
    }
    mesh
}

/// A box of ribbed steel with doors at one end.
fn container(piece: &Piece, variant: u32) -> Mesh {
    let steel = painted(piece, variant);
    let mut mesh = Mesh::default();
    mesh.cuboid(steel, piece.at(-0.98, -0.98, 0.0), piece.at(0.98, 0.98, 0.97));
    mesh.cuboid(steel.shaded(0.8), piece.at(-1.0, -1.0, 0.95), piece.at(1.0, 1.0, 1.0));
    if piece.is_fine() {
        let count = (piece.size.x / 0.3).clamp(2.0, 12.0) as u32;
        for (k, y) in (0..count).flat_map(|k| [-0.99f32, 0.99].map(|y| (k, y))) {
            let x = -0.94 + 1.88 * (k as f32 + 0.25) / count as f32;
            let wide = 0.94 / count as f32;
            let rib = [(x, 0.05), (x + wide, 0.05), (x + wide, 0.93), (x, 0.93)];
            let mut corners = rib.map(|(x, z)| piece.at(x, y, z));
            if y > 0.0 {
                corners.reverse();
            }
            mesh.polygon(steel.shaded(0.78), &corners);
        }
        let gap = [(-0.02, 0.04), (0.02, 0.04), (0.02, 0.93), (-0.02, 0.93)];
        mesh.polygon(steel.shaded(0.5), &gap.map(|(y, z)| piece.at(0.99, y, z)));
    }
    mesh
}

fn painted(piece: &Piece, variant: u32) -> Paint {
    piece
        .paint(Variety::of(variant).colour(&[[196, 168, 60], [150, 62, 54], [70, 96, 120], [176, 174, 166]]))
        .glossy(20)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::SemanticTag;
    use crate::mesh::model::Detail;

    /// What bundled maps have without a name each looks like something else.
    #[test]
    fn boxes_of_other_shapes_are_other_things() {
        let sizes = [
            [4.5, 4.5, 0.3],
            [3.0, 3.0, 1.1],
            [1.2, 1.2, 2.6],
            [4.2, 1.6, 1.1],
            [4.0, 1.6, 2.3],
            [3.6, 0.8, 2.1],
            [3.6, 2.6, 2.5],
            [2.5, 1.8, 1.4],
        ];
        let make = |size: [f32; 3]| {
            sundry(&Piece { tag: SemanticTag::Other, size: Vec3::from(size), detail: Detail::Fine }, 3)
        };
        // How many triangles and colours each has.
        let looks = sizes.map(|size| {
            let mesh = make(size);
            let colours: BTreeSet<[u8; 3]> = mesh.vertices.iter().map(|v| v.colour).collect();
            (mesh.all_triangles().count(), colours.len())
        });
        for (k, look) in looks.iter().enumerate() {
            assert!(look.0 > 20 && !looks[..k].contains(look), "{looks:?}");
        }
    }

    #[test]
    fn a_boat_is_closed_outside() {
        let piece = Piece { tag: SemanticTag::Other, size: Vec3::new(4.2, 1.6, 1.1), detail: Detail::Fine };
        let mesh = boat(&piece, 1);
        let at = |i: u32| Vec3::from(mesh.vertices[i as usize].position);
        for t in mesh.all_triangles().map(|t| t.map(at)) {
            let normal = (t[1] - t[0]).cross(t[2] - t[0]);
            let middle = (t[0] + t[1] + t[2]) / 3.0;
            let is_hull = middle.y.abs() > 0.3 && normal.z < -1e-3 * normal.length() && t.iter().any(|p| p.z < 0.03);
            assert!(!is_hull || normal.y * middle.y > 0.0, "{middle}");
        }
    }
}
