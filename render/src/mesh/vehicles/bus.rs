//! City buses.

use glam::Vec3;

use super::fittings::{facing, glass, mirrors, plastic};
use super::heavy::Lamps;
use super::loft::{Loft, Section, Station, at};
use super::occupant::{From, Occupant};
use super::wheel::{Axles, OUTER_M};
use crate::SemanticTag;
use crate::mesh::model::{Detail, Model};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const LIVERIES: [[u8; 3]; 5] = [[206, 48, 40], [226, 182, 44], [48, 112, 170], [66, 132, 84], [228, 226, 218]];
const AMBER: [u8; 3] = [250, 170, 40];

const STATIONS: [Station; 5] =
    [at(5.49, 1.02, 1.17), at(5.4, 2.82, 1.21), at(5.2, 3.04, 1.23), at(-5.36, 3.04, 1.23), at(-5.49, 2.86, 1.2)];
const SECTION: Section = Section { sill: 0.3, waist: 1.05, lean: 0.02, round: [0.12, 0.12] };

/// Windows: first x, pitch and length, lower and upper edge.
const WINDOWS: u32 = 6;
const FIRST_X: f32 = -5.15;
const PITCH_M: f32 = 1.7;
const WINDOW_M: f32 = 1.58;
const WINDOW_Z: [f32; 2] = [1.22, 2.48];
/// Rear edges of the doors, which are on the right, their width and their lower and upper edges.
const DOORS_X: [f32; 2] = [3.98, -0.62];
const DOOR_M: f32 = 1.24;
const DOOR_Z: [f32; 2] = [0.4, 2.52];

/// Heads of those who sit and of those who stand, and of the driver.
const SITS_Z: f32 = 1.82;
const STANDS_Z: f32 = 2.2;
const DRIVER: Vec3 = Vec3::new(4.75, 0.62, 1.9);

/// A city bus of class Bus, 11 m long, at its finest with people in it.
pub fn bus(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let tag = SemanticTag::Bus;
    let livery = Paint::plain(tag, variety.colour(&LIVERIES)).glossy(80);
    let (pane, dark) = (glass(tag), plastic(tag));
    let body = Loft::new(&STATIONS, SECTION);
    let mut mesh = Mesh::default();
    body.add_to(&mut mesh, livery, detail);
    let screen = body.on_top([5.485, 5.425], 1.0, 0.012);
    mesh.polygon(pane, &screen);
    display(&mut mesh, detail);
    facing(&mut mesh, pane, -5.505, [-1.0, 1.0], [1.7, 2.6]);
    body.boards(&mut mesh, livery.shaded(0.5), [-5.3, 5.3], [0.31, 0.56], 0.008);
    mirrors(&mut mesh, dark, Vec3::new(5.45, 1.27, 2.1), Vec3::new(0.05, 0.09, 0.22), detail == Detail::Fine);
    let lamps = Lamps {
        ends: [5.505, 5.505],
        half: [1.1, 1.1],
        width: [0.34, 0.2],
        front_z: [0.62, 0.8],
        rear_z: [0.7, 0.98],
        plate_z: 0.42,
    };
    lamps.add_to(&mut mesh, tag);
    if detail == Detail::Fine {
        windows(&mut mesh, &body);
        mesh.cuboid(livery.shaded(0.9), Vec3::new(-3.2, -0.85, 2.98), Vec3::new(-0.8, 0.85, 3.1));
        facing(&mut mesh, dark, -5.5, [-0.95, 0.95], [0.62, 1.4]);
        people(&mut mesh, &mut variety, &body, &screen);
    } else {
        body.boards(&mut mesh, pane, [FIRST_X, 5.1], WINDOW_Z, 0.01);
        for x in DOORS_X {
            body.board(&mut mesh, pane.shaded(1.4), ([x, x + DOOR_M], DOOR_Z), -1.0, 0.05);
        }
    }
    let axles = Axles { x_m: vec![2.9, -3.0], y_m: 1.25 - OUTER_M, radius_m: 0.48, covered: true };
    axles.under(mesh, tag, detail)
}

/// Number and destination over the windscreen; at its finest in words.
fn display(mesh: &mut Mesh, detail: Detail) {
    let (dark, amber) = (Paint::plain(SemanticTag::Bus, [16, 16, 18]), Paint::plain(SemanticTag::Bus, AMBER));
    facing(mesh, dark, 5.47, [-0.95, 0.95], [2.5, 2.82]);
    if detail != Detail::Fine {
        return facing(mesh, amber, 5.475, [-0.8, 0.8], [2.6, 2.72]);
    }
    for y in [[-0.84f32, -0.56], [-0.4, -0.06], [0.0, 0.42], [0.48, 0.8]] {
        // Seen from ahead the text begins on the left side of the reader, which is the bus's right.
        facing(mesh, amber, 5.475, y, [2.6, 2.73]);
    }
}

/// Windows with posts between them, doors with two leaves, and arches.
fn windows(mesh: &mut Mesh, body: &Loft<'_>) {
    let (pane, dark) = (glass(SemanticTag::Bus), plastic(SemanticTag::Bus));
    for window in 0..WINDOWS {
        let x = FIRST_X + PITCH_M * window as f32;
        body.boards(mesh, pane, [x, x + WINDOW_M], WINDOW_Z, 0.01);
    }
    for x in DOORS_X {
        body.board(mesh, dark, ([x - 0.05, x + DOOR_M + 0.05], DOOR_Z), -1.0, 0.05);
        let leaf = 0.5 * DOOR_M - 0.05;
        for at in [x + 0.02, x + 0.5 * DOOR_M + 0.03] {
            let z = [DOOR_Z[0] + 0.14, DOOR_Z[1] - 0.06];
            body.board(mesh, pane.shaded(1.3), ([at, at + leaf], z), -1.0, 0.058);
        }
    }
    for axle in [2.9, -3.0] {
        body.arc(mesh, dark.glossy(0), (axle, 0.48), 6, 0.015);
    }
}

/// The driver, and somebody at about half of the windows.
fn people(mesh: &mut Mesh, variety: &mut Variety, body: &Loft<'_>, screen: &[Vec3; 4]) {
    let pane = glass(SemanticTag::Bus);
    let driver = Occupant::of(variety, DRIVER);
    driver.show(mesh, pane, screen, From::Ahead);
    driver.show(mesh, pane, &body.on_flank([4.3, 5.1], WINDOW_Z, 1.0, 0.01), From::Aside);
    for window in 0..WINDOWS - 1 {
        let x = FIRST_X + PITCH_M * window as f32;
        let behind_a_door = |side: f32| side < 0.0 && (x - DOORS_X[1]).abs() < PITCH_M;
        for side in [-1.0, 1.0] {
            if variety.one_in(2) || behind_a_door(side) {
                continue;
            }
            let z = if variety.one_in(4) { STANDS_Z } else { SITS_Z };
            let seat = Vec3::new(x + variety.between(0.3, WINDOW_M - 0.3), side * 0.9, z);
            let window = body.on_flank([x, x + WINDOW_M], WINDOW_Z, side, 0.01);
            Occupant::of(variety, seat).show(mesh, pane, &window, From::Aside);
        }
    }
}
