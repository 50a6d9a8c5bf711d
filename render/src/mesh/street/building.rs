//! Houses: walls with windows and doors, shop fronts, roofs of several shapes.

use glam::{Vec2, Vec3};

use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::variety::Variety;
use crate::mesh::{Finish, Mesh, Paint};

const TAG: SemanticTag = SemanticTag::Building;
const RENDERS: [[u8; 3]; 11] = [
    [214, 198, 168],
    [196, 176, 148],
    [222, 214, 198],
    [178, 150, 128],
    [202, 168, 126],
    [168, 172, 176],
    [186, 140, 116],
    [226, 220, 210],
    [154, 120, 100],
    [170, 178, 164],
    [206, 186, 178],
];
const BRICKS: [[u8; 3]; 4] = [[150, 82, 62], [134, 72, 58], [166, 104, 78], [120, 84, 72]];
const TILES: [[u8; 3]; 5] = [[152, 82, 60], [126, 70, 56], [92, 84, 80], [110, 62, 52], [78, 80, 86]];

/// Height of a storey, metres.
const STOREY_M: f32 = 3.0;

/// Bits of the style of a front, as `facade.wgsl` reads them.
pub mod style {
    /// Width of the windows: 0 narrow to 3 wide.
    pub const WIDTH: u8 = 0b0000_0011;
    /// Height of the windows: 0 low to 3 high.
    pub const HEIGHT: u8 = 0b0000_1100;
    /// Shop windows on the ground floor.
    pub const SHOP: u8 = 0b0001_0000;
    /// Courses of bricks.
    pub const BRICK: u8 = 0b0010_0000;
    /// Light bands between the storeys.
    pub const BANDS: u8 = 0b0100_0000;
    /// A door on the ground floor, in one of the first [`DOOR_COLUMNS`] columns.
    pub const DOOR: u8 = 0b1000_0000;
    /// Columns that a front with a door has at least.
    pub const DOOR_COLUMNS: f32 = 3.0;
}

/// A house that fills a box of `size` metres.
pub fn building(variant: u32, size: Vec3, detail: Detail) -> Mesh {
    let mut variety = Variety::of(variant);
    let brick = variety.one_in(4);
    let colour = variety.colour(if brick { &BRICKS } else { &RENDERS });
    let storeys = (size.z / STOREY_M).round().max(1.0);
    let mut code = variety.bits() as u8 & (style::WIDTH | style::HEIGHT | style::BANDS);
    code |= if brick { style::BRICK } else { 0 };
    code |= if storeys >= 3.0 && !variety.one_in(3) { style::SHOP } else { 0 };
    let pitched = storeys <= 5.0 && size.x.min(size.y) < 16.0 && !variety.one_in(4);
    let rise = if pitched { (0.34 * size.x.min(size.y)).min(0.4 * size.z).min(4.5) } else { 0.9 };
    let eaves = size.z - rise;
    let floors = (eaves / STOREY_M).round().max(1.0);
    let front = Paint { tag: TAG, colour, finish: Finish::Facade, param: variety.bits() as u8, code };
    let mut mesh = Mesh::default();
    fronts(&mut mesh, front, size, eaves, floors);
    if detail != Detail::Rough {
        plinth(&mut mesh, front, size);
    }
    let tiles = Paint::plain(TAG, variety.colour(&TILES)).grainy(120);
    match (pitched, variety.one_in(3)) {
        (false, _) => flat_roof(&mut mesh, front, size, eaves, &mut variety),
        (true, true) => hipped_roof(&mut mesh, tiles, size, eaves),
        (true, false) => gabled_roof(&mut mesh, tiles, front, size, eaves),
    }
    if pitched {
        chimney(&mut mesh, size, &mut variety);
    }
    mesh
}

fn corners(size: Vec3, grow: f32, z: f32) -> [Vec3; 4] {
    let (x, y) = (0.5 * size.x + grow, 0.5 * size.y + grow);
    [Vec3::new(-x, -y, z), Vec3::new(x, -y, z), Vec3::new(x, y, z), Vec3::new(-x, y, z)]
}

/// The wall that looks at the street, along the x axis.
const STREET_FRONT: usize = 1;

/// The four walls; u counts window columns, v storeys. Doors and shops are on the side of the street.
fn fronts(mesh: &mut Mesh, front: Paint, size: Vec3, eaves: f32, floors: f32) {
    let (floor, roof) = (corners(size, 0.0, 0.0), corners(size, 0.0, eaves));
    for i in 0..4 {
        let j = (i + 1) % 4;
        let (least, code) = match i {
            STREET_FRONT => (style::DOOR_COLUMNS, front.code | style::DOOR),
            _ => (1.0, front.code & !style::SHOP),
        };
        let columns = ((floor[j] - floor[i]).length() / 2.7).floor().max(least);
        let uv = [(0.0, 0.0), (columns, 0.0), (columns, floors), (0.0, floors)].map(|(u, v)| Vec2::new(u, v));
        mesh.quad_uv(front.coded(code), [floor[i], floor[j], roof[j], roof[i]], uv);
    }
}

/// The dark foot of the walls.
fn plinth(mesh: &mut Mesh, front: Paint, size: Vec3) {
    let stone = Paint::plain(TAG, front.colour).shaded(0.62);
    let top = 0.32;
    mesh.walls(stone, &corners(size, 0.05, 0.0), &corners(size, 0.05, top));
    rim(mesh, stone, size, [0.05, 0.0], top);
}

/// A flat ring between two outlines of the house at a height, seen from above.
fn rim(mesh: &mut Mesh, paint: Paint, size: Vec3, grow: [f32; 2], z: f32) {
    let (outer, inner) = (corners(size, grow[0], z), corners(size, grow[1], z));
    for i in 0..4 {
        let j = (i + 1) % 4;
        mesh.polygon(paint, &[outer[i], outer[j], inner[j], inner[i]]);
    }
}

/// A parapet with a cornice around gravel, and a lift house.
fn flat_roof(mesh: &mut Mesh, front: Paint, size: Vec3, eaves: f32, variety: &mut Variety) {
    let stone = Paint::plain(TAG, front.colour).shaded(1.12);
    mesh.walls(stone, &corners(size, 0.22, eaves), &corners(size, 0.22, eaves + 0.3));
    let under = corners(size, 0.22, eaves);
    mesh.polygon(stone, &[under[3], under[2], under[1], under[0]]);
    rim(mesh, stone, size, [0.22, 0.0], eaves + 0.3);
    let wall = Paint::plain(TAG, front.colour);
    mesh.walls(wall, &corners(size, 0.0, eaves + 0.3), &corners(size, 0.0, size.z));
    mesh.polygon(Paint::plain(TAG, [128, 126, 122]).grainy(120), &corners(size, 0.0, size.z));
    if size.x.min(size.y) > 9.0 && variety.one_in(2) {
        let at = Vec3::new(variety.between(-0.2, 0.2) * size.x, variety.between(-0.2, 0.2) * size.y, size.z);
        mesh.cuboid(Paint::plain(TAG, [150, 150, 150]), at - Vec3::new(1.6, 1.3, 0.0), at + Vec3::new(1.6, 1.3, 2.0));
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

const OVERHANG_M: f32 = 0.45;

fn gabled_roof(mesh: &mut Mesh, tiles: Paint, front: Paint, size: Vec3, eaves: f32) {
    let at = along(size);
    let (a, b) = halves(size);
    let drop = OVERHANG_M * (size.z - eaves) / b;
    let (x, y, z) = (a + OVERHANG_M, b + OVERHANG_M, eaves - drop);
    let (ridge, thick) = (size.z, 0.18);
    // Painted boards, which only the ground lights.
    let under = Paint::plain(TAG, [232, 228, 218]);
    for side in [-1.0f32, 1.0] {
        let slope = |up: f32| {
            let mut s = [
                at(-side * -x, side * y, z + up),
                at(-side * x, side * y, z + up),
                at(-side * x, 0.0, ridge + up),
                at(-side * -x, 0.0, ridge + up),
            ];
            if up == 0.0 {
                s.reverse();
            }
            s
        };
        mesh.polygon(tiles, &slope(thick));
        mesh.polygon(under, &slope(0.0));
        let board = Paint::plain(TAG, [222, 218, 208]);
        let fascia = [
            at(side * x, side * y, z),
            at(-side * x, side * y, z),
            at(-side * x, side * y, z + thick),
            at(side * x, side * y, z + thick),
        ];
        mesh.polygon(board, &fascia);
        let wall = Paint::plain(TAG, front.colour);
        mesh.polygon(wall, &[at(side * a, -side * b, eaves), at(side * a, side * b, eaves), at(side * a, 0.0, ridge)]);
        for half in [-1.0f32, 1.0] {
            let edge = [
                at(side * x, half * y, z),
                at(side * x, half * y, z + thick),
                at(side * x, 0.0, ridge + thick),
                at(side * x, 0.0, ridge),
            ];
            let edge = if side * half > 0.0 { edge } else { [edge[3], edge[2], edge[1], edge[0]] };
            mesh.polygon(board, &edge);
        }
    }
}

fn hipped_roof(mesh: &mut Mesh, tiles: Paint, size: Vec3, eaves: f32) {
    let at = along(size);
    let (a, b) = halves(size);
    let (x, y) = (a + OVERHANG_M, b + OVERHANG_M);
    let ridge = (a - b).max(0.0);
    for side in [-1.0f32, 1.0] {
        mesh.polygon(
            tiles,
            &[
                at(side * x, side * y, eaves),
                at(-side * x, side * y, eaves),
                at(-side * ridge, 0.0, size.z),
                at(side * ridge + side * 0.01, 0.0, size.z),
            ],
        );
        mesh.polygon(
            tiles,
            &[at(side * x, -side * y, eaves), at(side * x, side * y, eaves), at(side * ridge, 0.0, size.z)],
        );
    }
    mesh.polygon(
        Paint::plain(TAG, [232, 228, 218]),
        &[at(-x, y, eaves), at(x, y, eaves), at(x, -y, eaves), at(-x, -y, eaves)],
    );
}

fn chimney(mesh: &mut Mesh, size: Vec3, variety: &mut Variety) {
    let at = along(size);
    let (a, b) = halves(size);
    let foot = at(variety.between(-0.5, 0.5) * a, 0.35 * b, 0.0);
    let z = size.z;
    let half = Vec3::new(0.35, 0.35, 0.0);
    mesh.cuboid(Paint::plain(TAG, [126, 78, 64]), foot - half + Vec3::Z * (z - 1.8), foot + half + Vec3::Z * (z + 0.5));
}
