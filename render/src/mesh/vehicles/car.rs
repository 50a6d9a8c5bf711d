//! Passenger cars of several shapes.

use glam::Vec3;

use super::cabin::{cabin, crew};
use super::car_shape::{SECTION, SHAPES, SUV, Shape};
use super::car_trim::{arcs, lights, trim};
use super::fittings::glass;
use super::lacquer;
use super::loft::{CLEARANCE_M, Loft};
use super::wheel::{Axles, OUTER_M, RUBBER};
use crate::mesh::model::{Detail, Model};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// Tyres stand so far out of flanks without arches, and so far in in arches, metres.
const BEFORE_FLANK_M: f32 = 0.032;
const IN_ARCH_M: f32 = 0.03;

/// How much larger a sport utility vehicle is than a passenger car of that shape.
const LARGE: Vec3 = Vec3::new(1.03, 1.03, 1.03);

/// A car of class Vehicles, at its finest with people in it.
pub fn car(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    Design::passenger(&mut variety).built(Some(&mut variety), detail)
}

/// The same without anybody.
pub fn parked(variant: u32, detail: Detail) -> Model {
    Design::passenger(&mut Variety::of(variant)).built(None, detail)
}

/// The finest of that car, with arches in which its front wheels can be seen to steer.
pub fn steered(variant: u32) -> Model {
    let mut variety = Variety::of(variant);
    let Design { shape, lacquer, .. } = Design::passenger(&mut variety);
    let body = Loft::new(&shape.stations, SECTION).with_arches(&shape.axles, shape.wheel_radius);
    let mut mesh = finished(shape, &body, lacquer, Detail::Fine);
    crew(&mut mesh, &mut variety, shape, &body);
    let y_m = shape.half() - IN_ARCH_M - OUTER_M;
    let axles = Axles { x_m: shape.axles.to_vec(), y_m, radius_m: shape.wheel_radius, covered: false };
    axles.under(mesh, lacquer.tag, Detail::Fine)
}

/// A sport utility vehicle of class Vehicles, a little larger than the cars of that shape, with people in it.
pub fn suv(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let lacquer = lacquer::of_cars(&mut variety);
    Design { shape: &SUV, lacquer, scale: LARGE }.built(Some(&mut variety), detail)
}

/// The open door of a car of that variant, seen from the middle of its footprint; its hinge is behind.
pub fn door(variant: u32) -> Mesh {
    let lacquer = Design::passenger(&mut Variety::of(variant)).lacquer;
    let mut mesh = Mesh::default();
    mesh.cuboid(lacquer, Vec3::new(-0.55, -0.06, 0.28), Vec3::new(0.55, 0.06, 0.92));
    mesh.cuboid(glass(lacquer.tag), Vec3::new(-0.3, -0.02, 0.92), Vec3::new(0.5, 0.02, 1.36));
    mesh.cuboid(lacquer, Vec3::new(0.48, -0.03, 0.92), Vec3::new(0.54, 0.03, 1.4));
    mesh.cuboid(lacquer, Vec3::new(-0.3, -0.03, 1.36), Vec3::new(0.54, 0.03, 1.4));
    mesh
}

/// What a car looks like.
struct Design {
    shape: &'static Shape,
    lacquer: Paint,
    scale: Vec3,
}

impl Design {
    fn passenger(variety: &mut Variety) -> Self {
        let shape = variety.weighted(&SHAPES);
        Self { shape, lacquer: lacquer::of_cars(variety), scale: Vec3::ONE }
    }

    /// The car, with people whom `crewed` chooses.
    fn built(&self, crewed: Option<&mut Variety>, detail: Detail) -> Model {
        let Self { shape, lacquer, scale } = *self;
        let body = Loft::new(&shape.stations, SECTION);
        if detail == Detail::Rough {
            let mut mesh = Mesh::default();
            silhouette(&mut mesh, lacquer, shape, &body);
            mesh.scale(scale);
            return Model::rigid(mesh);
        }
        let mut mesh = finished(shape, &body, lacquer, detail);
        arcs(&mut mesh, shape, &body, detail);
        if let (Some(variety), Detail::Fine) = (crewed, detail) {
            crew(&mut mesh, variety, shape, &body);
        }
        mesh.scale(scale);
        let y_m = (shape.half() + BEFORE_FLANK_M) * scale.y - OUTER_M;
        let (x_m, radius_m) = (shape.axles.map(|x| x * scale.x).to_vec(), shape.wheel_radius * scale.z);
        Axles { x_m, y_m, radius_m, covered: true }.under(mesh, lacquer.tag, detail)
    }
}

/// All of a car but its wheels.
fn finished(shape: &Shape, body: &Loft<'_>, lacquer: Paint, detail: Detail) -> Mesh {
    let mut mesh = Mesh::default();
    body.add_to(&mut mesh, lacquer, detail);
    cabin(&mut mesh, lacquer, shape, body, detail);
    lights(&mut mesh, shape, body, detail);
    trim(&mut mesh, lacquer, shape, body, detail);
    mesh
}

/// Body and cabin as two solids on dark wheels, with both pairs of lamps.
fn silhouette(mesh: &mut Mesh, paint: Paint, shape: &Shape, body: &Loft<'_>) {
    let (w, nose, tail) = (shape.half(), shape.stations[1].x, shape.stations[5].x);
    let ring = |front: f32, rear: f32, half: f32, z: f32| {
        [(rear, -half), (front, -half), (front, half), (rear, half)].map(|(x, y)| Vec3::new(x, y, z))
    };
    let ([foot, rear_foot], [top, rear_top], roof_z) = (shape.cabin.feet, shape.cabin.tops, shape.cabin.roof_z);
    let belt = body.station(foot).top;
    let dark = Paint::plain(paint.tag, RUBBER);
    mesh.walls(dark, &ring(nose - 0.5, tail + 0.4, w - 0.1, 0.0), &ring(nose - 0.5, tail + 0.4, w - 0.1, CLEARANCE_M));
    mesh.frustum(paint, &ring(nose, tail, w - 0.02, CLEARANCE_M), &ring(nose - 0.12, tail, w - 0.06, belt));
    let eaves = ring(top.0 - 0.04, rear_top.0, w - 0.26, roof_z);
    mesh.walls(glass(paint.tag), &ring(foot, rear_foot, w - 0.11, belt), &eaves);
    mesh.polygon(paint, &eaves);
    lights(mesh, shape, body, Detail::Rough);
}
