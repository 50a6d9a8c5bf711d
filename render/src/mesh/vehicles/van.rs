//! Vans, also the large ones among lorries, and those that help in emergencies.

use glam::Vec3;

use super::fittings::{facing, glass, mirrors, plastic};
use super::heavy::Lamps;
use super::lacquer;
use super::loft::{Loft, Section, Station, at};
use super::occupant::{From, Occupant};
use super::wheel::{Axles, OUTER_M};
use crate::SemanticTag;
use crate::mesh::model::{Detail, Model};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// A van of 4.9 m: bonnet, windscreen, roof.
const STATIONS: [Station; 7] = [
    at(2.43, 0.56, 0.78),
    at(2.38, 0.94, 0.85),
    at(2.08, 1.08, 0.9),
    at(1.76, 1.15, 0.92),
    at(0.92, 1.93, 0.92),
    at(-2.34, 1.96, 0.92),
    at(-2.44, 1.84, 0.9),
];
const SECTION: Section = Section { sill: 0.24, waist: 0.8, lean: 0.07, round: [0.08, 0.08] };
const AXLES: [f32; 2] = [1.5, -1.45];
const WHEEL_RADIUS_M: f32 = 0.345;
const BEFORE_FLANK_M: f32 = 0.015;

/// How much larger a van of 7 m is.
const LARGE: Vec3 = Vec3::new(1.42, 1.2, 1.37);

/// A pane beside the front seats, in side view, and the panes behind it.
const DOOR_PANE: [(f32, f32); 4] = [(1.5, 1.14), (0.42, 1.14), (0.42, 1.72), (1.02, 1.72)];
const REAR_PANES: [[f32; 2]; 2] = [[0.3, -0.9], [-1.0, -2.2]];
const PANE_Z: [f32; 2] = [1.14, 1.72];

/// Heads: x, y, z.
const DRIVER: Vec3 = Vec3::new(0.78, 0.42, 1.5);
const PASSENGERS: [Vec3; 2] = [Vec3::new(-0.35, 0.4, 1.5), Vec3::new(-0.35, -0.4, 1.5)];

/// A van or people carrier of class Vehicles, at its finest with people in it.
pub fn van(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let design = Design::of(&mut variety);
    design.built(Some(&mut variety), detail)
}

/// The same without anybody.
pub fn parked(variant: u32, detail: Detail) -> Model {
    Design::of(&mut Variety::of(variant)).built(None, detail)
}

/// A van of 7 m of a lorry's class.
pub(super) fn large(variety: &mut Variety, tag: SemanticTag, detail: Detail) -> Model {
    let paint = lacquer::of_goods(variety, tag);
    Design { paint, has_panes: false }.scaled(Some(variety), LARGE, detail)
}

/// What a van looks like.
pub(super) struct Design {
    pub(super) paint: Paint,
    /// Whether it carries people rather than goods.
    pub(super) has_panes: bool,
}

impl Design {
    fn of(variety: &mut Variety) -> Self {
        let has_panes = variety.one_in(3);
        let tag = SemanticTag::Vehicles;
        let paint = if has_panes { lacquer::of_cars(variety) } else { lacquer::of_goods(variety, tag) };
        Self { paint, has_panes }
    }

    fn built(&self, crewed: Option<&mut Variety>, detail: Detail) -> Model {
        self.scaled(crewed, Vec3::ONE, detail)
    }

    fn scaled(&self, crewed: Option<&mut Variety>, scale: Vec3, detail: Detail) -> Model {
        let mut mesh = self.body(crewed, detail);
        mesh.scale(scale);
        axles(scale).under(mesh, self.paint.tag, detail)
    }

    /// All of a van but its wheels, with people whom `crewed` chooses.
    pub(super) fn body(&self, crewed: Option<&mut Variety>, detail: Detail) -> Mesh {
        let (paint, tag, body) = (self.paint, self.paint.tag, loft());
        let mut mesh = Mesh::default();
        body.add_to(&mut mesh, paint, detail);
        let pane = glass(tag);
        let screen = body.on_top([1.73, 1.0], 0.94, 0.012);
        mesh.polygon(pane, &screen);
        for side in [-1.0, 1.0] {
            body.pane(&mut mesh, pane, &DOOR_PANE, side, 0.01);
        }
        if self.has_panes && detail != Detail::Fine {
            body.boards(&mut mesh, pane, [0.3, -2.2], PANE_Z, 0.01);
        } else if self.has_panes {
            REAR_PANES.iter().for_each(|&x| body.boards(&mut mesh, pane, x, PANE_Z, 0.01));
        }
        facing(&mut mesh, pane, -2.455, [-0.7, 0.7], [1.16, 1.7]);
        let lamps = Lamps {
            ends: [2.445, 2.455],
            half: [0.76, 0.87],
            width: [0.3, 0.14],
            front_z: [0.64, 0.78],
            rear_z: [0.72, 1.0],
            plate_z: 0.42,
        };
        lamps.add_to(&mut mesh, tag);
        mirrors(&mut mesh, plastic(tag), Vec3::new(1.3, 1.0, 1.25), Vec3::new(0.05, 0.1, 0.13), detail == Detail::Fine);
        if detail == Detail::Fine {
            self.trim(&mut mesh, &body);
            if let Some(variety) = crewed {
                self.crew(&mut mesh, variety, &body, &screen);
            }
        }
        mesh
    }

    /// Grille, bumpers, and the lines of doors.
    fn trim(&self, mesh: &mut Mesh, body: &Loft<'_>) {
        let (dark, line) = (plastic(self.paint.tag), self.paint.shaded(0.4).glossy(0));
        facing(mesh, dark, 2.437, [-0.42, 0.42], [0.6, 0.78]);
        facing(mesh, dark, 2.434, [-0.72, 0.72], [0.26, 0.42]);
        facing(mesh, dark, -2.445, [-0.86, 0.86], [0.26, 0.44]);
        facing(mesh, line, -2.448, [-0.01, 0.01], [0.5, 1.8]);
        for x in [1.62, 0.36, -0.92] {
            body.boards(mesh, line, [x, x + 0.018], [0.4, 0.79], 0.006);
            body.boards(mesh, line, [x, x + 0.018], [0.81, if x > 1.0 { 1.1 } else { 1.8 }], 0.006);
        }
        body.boards(mesh, dark, [-0.95, 0.98], [0.25, 0.4], 0.008);
        for axle in AXLES {
            body.arc(mesh, dark.glossy(0), (axle, WHEEL_RADIUS_M), 6, 0.011);
        }
    }

    fn crew(&self, mesh: &mut Mesh, variety: &mut Variety, body: &Loft<'_>, screen: &[Vec3; 4]) {
        let pane = glass(self.paint.tag);
        let driver = Occupant::of(variety, DRIVER);
        driver.show(mesh, pane, screen, From::Ahead);
        let doors = [1.0, -1.0].map(|side| body.on_flank([1.0, 0.42], PANE_Z, side, 0.01));
        doors.iter().for_each(|door| driver.show(mesh, pane, door, From::Aside));
        if variety.one_in(3) {
            let mate = Occupant::of(variety, DRIVER * Vec3::new(1.0, -1.0, 1.0));
            mate.show(mesh, pane, screen, From::Ahead);
            mate.show(mesh, pane, &doors[1], From::Aside);
        }
        for seat in PASSENGERS {
            if self.has_panes && variety.one_in(2) {
                let side = body.on_flank(REAR_PANES[0], PANE_Z, seat.y.signum(), 0.01);
                Occupant::of(variety, seat).show(mesh, pane, &side, From::Aside);
            }
        }
    }
}

pub(super) fn loft() -> Loft<'static> {
    Loft::new(&STATIONS, SECTION)
}

pub(super) fn axles(scale: Vec3) -> Axles {
    let y_m = (0.92 + BEFORE_FLANK_M) * scale.y - OUTER_M;
    Axles { x_m: AXLES.map(|x| x * scale.x).to_vec(), y_m, radius_m: WHEEL_RADIUS_M * scale.z, covered: true }
}
