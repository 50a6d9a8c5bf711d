//! Lorries: a cab before a box, a tarpaulin or a tank.

use glam::Vec3;

use super::fittings::{facing, glass, mirrors, plastic};
use super::heavy::{Lamps, hull, side_boards};
use super::loft::{Loft, Section, Station, at};
use super::occupant::{From, Occupant};
use super::wheel::{Axles, OUTER_M};
use super::{lacquer, van};
use crate::SemanticTag;
use crate::mesh::model::{Detail, Model};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const BOXES: [[u8; 3]; 4] = [[228, 228, 224], [202, 206, 210], [228, 228, 224], [214, 206, 186]];
const SHEETS: [[u8; 3]; 5] = [[52, 92, 150], [158, 52, 44], [58, 104, 76], [196, 198, 200], [206, 150, 44]];
const STEEL: [u8; 3] = [196, 200, 204];

/// Cab: bumper and radiator, windscreen, roof.
const CAB: [Station; 4] = [at(3.48, 1.32, 1.12), at(3.38, 2.42, 1.15), at(3.15, 2.6, 1.17), at(1.74, 2.64, 1.17)];
const SECTION: Section = Section { sill: 0.46, waist: 1.25, lean: 0.03, round: [0.09, 0.1] };
const DOOR_PANE: [(f32, f32); 4] = [(3.22, 1.42), (2.3, 1.42), (2.3, 2.26), (3.12, 2.26)];
const DRIVER: Vec3 = Vec3::new(2.62, 0.55, 1.98);

const AXLES_M: [f32; 3] = [2.5, -1.6, -2.7];
const WHEEL_RADIUS_M: f32 = 0.48;

/// Where the load begins and ends, and the height of its floor.
const LOAD_X: [f32; 2] = [1.5, -3.48];
const LOAD_Z: f32 = 0.98;

/// A lorry or a large van of class Truck, 7 m long, at its finest with its driver.
pub fn truck(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let tag = SemanticTag::Truck;
    if variety.one_in(3) {
        return van::large(&mut variety, tag, detail);
    }
    let mut mesh = Mesh::default();
    let paint = lacquer::of_goods(&mut variety, tag);
    let frame = Paint::plain(tag, [40, 40, 42]);
    hull(&mut mesh, frame, Vec3::new(-3.45, -0.98, 0.5), Vec3::new(1.8, 0.98, LOAD_Z), 0.02);
    match variety.bits() % 5 {
        0 | 1 => cargo_box(&mut mesh, &mut variety, detail),
        2 | 3 => tarpaulin(&mut mesh, &mut variety, detail),
        _ => tank(&mut mesh, detail),
    }
    cab(&mut mesh, &mut variety, paint, detail);
    side_boards(&mut mesh, frame.colour([150, 152, 156]), [-1.0, 1.6], 1.14, [0.5, 0.86]);
    let lamps = Lamps {
        ends: [3.495, 3.5],
        half: [1.06, 1.12],
        width: [0.3, 0.36],
        front_z: [0.64, 0.82],
        rear_z: [0.62, 0.8],
        plate_z: 0.5,
    };
    facing(&mut mesh, frame, -3.49, [-1.16, 1.16], [0.54, 0.95]);
    lamps.add_to(&mut mesh, tag);
    let axles = Axles { x_m: AXLES_M.to_vec(), y_m: 1.2 - OUTER_M, radius_m: WHEEL_RADIUS_M, covered: true };
    axles.under(mesh, tag, detail)
}

/// The cab with its driver.
fn cab(mesh: &mut Mesh, variety: &mut Variety, paint: Paint, detail: Detail) {
    let (body, pane, dark) = (Loft::new(&CAB, SECTION), glass(paint.tag), plastic(paint.tag));
    body.add_to(mesh, paint, detail);
    let screen = body.on_top([3.472, 3.395], 0.96, 0.012);
    mesh.polygon(pane, &screen);
    facing(mesh, dark, 3.488, [-0.72, 0.72], [0.86, 1.24]);
    for side in [-1.0, 1.0] {
        body.pane(mesh, pane, &DOOR_PANE, side, 0.01);
    }
    mirrors(mesh, dark, Vec3::new(3.3, 1.27, 1.85), Vec3::new(0.06, 0.09, 0.3), detail == Detail::Fine);
    if detail != Detail::Fine {
        return;
    }
    let line = paint.shaded(0.4).glossy(0);
    for x in [3.28, 2.2] {
        body.boards(mesh, line, [x, x + 0.02], [0.95, 1.24], 0.006);
        body.boards(mesh, line, [x, x + 0.02], [1.26, 2.3], 0.006);
    }
    facing(mesh, dark, 3.486, [-1.1, 1.1], [0.47, 0.56]);
    // A visor over the windscreen, and the arches of the front wheels.
    facing(mesh, paint.shaded(0.5), 3.405, [-1.0, 1.0], [2.34, 2.44]);
    body.arc(mesh, dark.glossy(0), (AXLES_M[0], WHEEL_RADIUS_M), 6, 0.015);
    let driver = Occupant::of(variety, DRIVER);
    driver.show(mesh, pane, &screen, From::Ahead);
    for side in [-1.0, 1.0] {
        driver.show(mesh, pane, &body.on_flank([3.12, 2.3], [1.42, 2.26], side, 0.01), From::Aside);
    }
}

/// A stiff box with doors behind, often with a cooling unit over the cab.
fn cargo_box(mesh: &mut Mesh, variety: &mut Variety, detail: Detail) {
    let paint = Paint::plain(SemanticTag::Truck, variety.colour(&BOXES)).glossy(40);
    let [front, rear] = LOAD_X;
    hull(mesh, paint, Vec3::new(rear, -1.2, LOAD_Z), Vec3::new(front, 1.2, 3.0), 0.03);
    let cools = variety.one_in(3);
    let stripe = variety.colour(&SHEETS);
    if variety.one_in(2) {
        side_boards(mesh, paint.colour(stripe), [rear + 0.3, front - 0.3], 1.21, [1.6, 2.2]);
    }
    if cools {
        let unit = paint.shaded(0.8);
        mesh.cuboid(unit, Vec3::new(front, -0.8, 2.66), Vec3::new(front + 0.3, 0.8, 2.97));
    }
    if detail == Detail::Fine {
        let line = paint.shaded(0.6);
        facing(mesh, line, rear - 0.01, [-0.02, 0.02], [1.0, 2.92]);
        for y in [-0.6, 0.6] {
            facing(mesh, line.shaded(0.7), rear - 0.012, [y - 0.02, y + 0.02], [1.02, 2.9]);
        }
        side_boards(mesh, line, [rear + 0.02, front - 0.02], 1.205, [LOAD_Z, LOAD_Z + 0.08]);
    }
}

/// A sheet over bows, held by straps.
fn tarpaulin(mesh: &mut Mesh, variety: &mut Variety, detail: Detail) {
    let paint = Paint::plain(SemanticTag::Truck, variety.colour(&SHEETS)).glossy(15);
    let [front, rear] = LOAD_X;
    hull(mesh, paint, Vec3::new(rear, -1.18, LOAD_Z), Vec3::new(front, 1.18, 2.96), 0.14);
    let board = Paint::plain(SemanticTag::Truck, [120, 122, 126]);
    side_boards(mesh, board, [rear, front], 1.195, [LOAD_Z, LOAD_Z + 0.22]);
    if detail == Detail::Fine {
        for strap in 0..7 {
            let x = rear + 0.4 + 0.7 * strap as f32;
            side_boards(mesh, paint.shaded(0.66), [x, x + 0.05], 1.19, [LOAD_Z + 0.22, 2.8]);
        }
        facing(mesh, board, rear - 0.01, [-1.18, 1.18], [LOAD_Z, LOAD_Z + 0.3]);
    }
}

/// A tank of steel with a walkway on it.
fn tank(mesh: &mut Mesh, detail: Detail) {
    let steel = Paint::plain(SemanticTag::Truck, STEEL).glossy(130);
    let sides = if detail == Detail::Fine { 16 } else { 10 };
    let [front, rear] = LOAD_X.map(|x| Vec3::new(x, 0.0, 1.95));
    let (front, rear) = (front - Vec3::X * 0.1, rear + Vec3::X * 0.06);
    mesh.rod(steel, rear, front, 0.98, sides);
    mesh.cuboid(steel.shaded(0.7), Vec3::new(-2.6, -0.25, 2.86), Vec3::new(0.6, 0.25, 3.0));
    if detail == Detail::Fine {
        for share in [0.12, 0.5, 0.88] {
            let at = rear.lerp(front, share);
            mesh.tube(steel.shaded(0.6), at, at + Vec3::X * 0.06, 0.992, 0.992, 16);
        }
        let sign = Paint::plain(SemanticTag::Truck, [236, 140, 30]);
        facing(mesh, sign, rear.x - 0.012, [-0.7, -0.3], [1.2, 1.5]);
    }
}
