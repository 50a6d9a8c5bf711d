//! Trams.

use glam::Vec3;

use super::fittings::{facing, glass, plastic};
use super::heavy::{Lamps, side_boards};
use super::loft::{Loft, Section, Station, at};
use super::occupant::{From, Occupant};
use super::wheel::RUBBER;
use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

const LIVERIES: [[u8; 3]; 4] = [[222, 222, 214], [196, 40, 44], [240, 196, 60], [40, 92, 142]];
const AMBER: [u8; 3] = [250, 170, 40];

/// Front section, middle section, rear section.
const SECTIONS: [&[Station]; 3] = [
    &[at(14.98, 1.25, 0.98), at(14.55, 2.74, 1.09), at(13.7, 3.3, 1.2), at(5.2, 3.3, 1.2)],
    &[at(4.9, 3.3, 1.2), at(-4.9, 3.3, 1.2)],
    &[at(-5.2, 3.3, 1.2), at(-13.7, 3.3, 1.2), at(-14.55, 2.74, 1.09), at(-14.98, 1.25, 0.98)],
];
const SECTION: Section = Section { sill: 0.28, waist: 1.1, lean: 0.015, round: [0.14, 0.14] };

/// Where windows begin and end on each section, how many there are at its finest, and their edges.
const WINDOWS_X: [[f32; 2]; 3] = [[5.5, 13.1], [-4.6, 4.6], [-13.1, -5.5]];
const WINDOWS: u32 = 4;
const WINDOW_Z: [f32; 2] = [1.2, 2.6];
/// Middles of the doors on both sides, and half their width.
const DOORS_X: [f32; 4] = [9.3, 1.84, -1.84, -9.3];
const HALF_DOOR_M: f32 = 0.68;

const SITS_Z: f32 = 1.78;
const STANDS_Z: f32 = 2.15;

/// A low-floor tram of class Train: three sections with bellows between them, 30 m long, at its finest with people in it.
pub fn tram(variant: u32, detail: Detail) -> Mesh {
    let mut variety = Variety::of(variant);
    let tag = SemanticTag::Train;
    let livery = Paint::plain(tag, variety.colour(&LIVERIES)).glossy(80);
    let rubber = Paint::plain(tag, RUBBER);
    let mut mesh = Mesh::default();
    let box_walls = |mesh: &mut Mesh, x: [f32; 2], half: f32, z: [f32; 2]| {
        let ring = |z: f32| [(x[0], -half), (x[1], -half), (x[1], half), (x[0], half)].map(|(x, y)| Vec3::new(x, y, z));
        mesh.walls(rubber, &ring(z[0]), &ring(z[1]));
    };
    for (stations, x) in SECTIONS.into_iter().zip(WINDOWS_X) {
        let body = Loft::new(stations, SECTION);
        body.add_to(&mut mesh, livery, detail);
        body.boards(&mut mesh, livery.shaded(0.5), x, [0.3, 0.62], 0.008);
        windows(&mut mesh, &body, x, detail);
        box_walls(&mut mesh, [x[0] + 1.2, x[1] - 1.2], 0.9, [0.0, 0.3]);
        if detail == Detail::Fine {
            people(&mut mesh, &mut variety, &body, x);
        }
    }
    for x in [-5.05, 5.05] {
        box_walls(&mut mesh, [x - 0.2, x + 0.2], 1.08, [0.35, 3.16]);
    }
    for (stations, end) in [(SECTIONS[0], 1.0), (SECTIONS[2], -1.0)] {
        cockpit(&mut mesh, &Loft::new(stations, SECTION), end, detail);
    }
    pantograph(&mut mesh, Paint::plain(tag, [70, 72, 76]));
    let lamps = Lamps {
        ends: [15.0, 15.0],
        half: [0.9, 0.9],
        width: [0.3, 0.2],
        front_z: [0.72, 0.88],
        rear_z: [0.66, 0.82],
        plate_z: 0.42,
    };
    lamps.add_to(&mut mesh, tag);
    mesh
}

/// Windscreen and display of an end (the sign of x), and at its finest the driver ahead.
fn cockpit(mesh: &mut Mesh, body: &Loft<'_>, end: f32, detail: Detail) {
    let tag = SemanticTag::Train;
    let pane = glass(tag);
    let screen = body.on_top([end * 14.94, end * 14.59], 0.98, 0.012);
    mesh.polygon(pane, &screen);
    let board = body.on_top([end * 14.5, end * 14.22], 0.8, 0.012);
    mesh.polygon(Paint::plain(tag, AMBER), &board);
    if detail == Detail::Fine {
        facing(mesh, plastic(tag), end * 14.99, [-0.85, 0.85], [0.32, 0.6]);
        body.boards(mesh, pane, [end * 13.3, end * 14.2], [1.3, 2.5], 0.012);
        if end > 0.0 {
            let driver = Occupant::of(&mut Variety::of(9), Vec3::new(14.0, 0.0, 1.95));
            driver.show(mesh, pane, &screen, From::Ahead);
        }
    }
}

/// A band of windows with doors in it.
fn windows(mesh: &mut Mesh, body: &Loft<'_>, [from, to]: [f32; 2], detail: Detail) {
    let pane = glass(SemanticTag::Train);
    let count = if detail == Detail::Fine { WINDOWS } else { 1 };
    let pitch = (to - from) / count as f32;
    for i in 0..count {
        let start = from + pitch * i as f32;
        body.boards(mesh, pane, [start, start + pitch - 0.1], WINDOW_Z, 0.01);
    }
    for door in DOORS_X.into_iter().filter(|x| (from..to).contains(x)) {
        let [rear, front] = [door - HALF_DOOR_M, door + HALF_DOOR_M];
        body.boards(mesh, pane.shaded(1.5), [rear, front], [0.36, 2.66], 0.045);
        if detail == Detail::Fine {
            side_boards(mesh, plastic(SemanticTag::Train), [door - 0.03, door + 0.03], 1.25, [0.36, 2.66]);
        }
    }
}

/// Somebody at about half of the windows.
fn people(mesh: &mut Mesh, variety: &mut Variety, body: &Loft<'_>, [from, to]: [f32; 2]) {
    let pitch = (to - from) / WINDOWS as f32;
    for window in 0..WINDOWS {
        let x = from + pitch * (window as f32 + 0.5);
        let side = if variety.one_in(2) { 1.0 } else { -1.0 };
        if DOORS_X.iter().any(|door| (door - x).abs() < HALF_DOOR_M + 0.3) {
            continue;
        }
        let z = if variety.one_in(3) { STANDS_Z } else { SITS_Z };
        let seat = Vec3::new(x + variety.between(-0.3, 0.3), side * 0.8, z);
        let pane = body.on_flank([x - 0.5 * pitch, x + 0.5 * pitch], WINDOW_Z, side, 0.01);
        Occupant::of(variety, seat).show(mesh, glass(SemanticTag::Train), &pane, From::Aside);
    }
}

/// Raised only a little, as no wire hangs over it.
fn pantograph(mesh: &mut Mesh, steel: Paint) {
    for y in [-0.5, 0.5] {
        mesh.tube(steel, Vec3::new(-0.4, y, 3.3), Vec3::new(0.1, y, 3.45), 0.025, 0.025, 3);
    }
    mesh.rod(steel, Vec3::new(0.1, -0.7, 3.46), Vec3::new(0.1, 0.7, 3.46), 0.025, 3);
}
