//! Passenger cars of several shapes.

use glam::Vec3;

use super::body::{Body, CLEARANCE_M};
use super::model::{Detail, Model};
use super::variety::Variety;
use super::wheel::{Axles, OUTER_M, RUBBER};
use super::{CODE_BRAKE, CODE_HEAD, CODE_LEFT, CODE_RIGHT, Mesh, Paint};
use crate::SemanticTag;

const LACQUERS: [[u8; 3]; 12] = [
    [232, 232, 230],
    [38, 38, 42],
    [128, 132, 138],
    [178, 182, 186],
    [40, 68, 128],
    [150, 28, 30],
    [66, 92, 74],
    [205, 196, 172],
    [24, 46, 72],
    [198, 120, 34],
    [90, 22, 34],
    [110, 160, 190],
];

pub(super) const GLASS: [u8; 3] = [30, 38, 46];
/// Brake lamps and indicators that are off, which also in the sun look darker than those that shine.
pub(super) const BRAKE_LAMP: [u8; 3] = [96, 10, 12];
pub(super) const INDICATOR: [u8; 3] = [132, 70, 18];

/// Side view of a car: points (x, z) in metres, the origin below its middle, all at rest height.
struct Shape {
    half_width: f32,
    /// Upper edge of the body from the front bumper to the rear bumper.
    belt: &'static [(f32, f32)],
    /// Cabin: foot and top of the windscreen, top and foot of the rear window.
    cabin: [(f32, f32); 4],
    /// Axles' x.
    axles: [f32; 2],
    wheel_radius: f32,
}

const SHAPES: [Shape; 4] = [
    // Hatchback.
    Shape {
        half_width: 0.88,
        belt: &[(2.08, 0.48), (2.1, 0.62), (1.9, 0.78), (0.95, 0.95), (-1.7, 1.0), (-2.0, 0.92), (-2.05, 0.5)],
        cabin: [(1.0, 0.94), (0.3, 1.44), (-1.45, 1.46), (-1.92, 0.98)],
        axles: [1.3, -1.28],
        wheel_radius: 0.31,
    },
    // Saloon.
    Shape {
        half_width: 0.9,
        belt: &[
            (2.22, 0.46),
            (2.25, 0.62),
            (2.05, 0.76),
            (0.9, 0.94),
            (-1.35, 0.98),
            (-2.1, 0.95),
            (-2.25, 0.82),
            (-2.24, 0.5),
        ],
        cabin: [(0.95, 0.93), (0.2, 1.4), (-0.95, 1.42), (-1.65, 0.98)],
        axles: [1.38, -1.36],
        wheel_radius: 0.32,
    },
    // Estate.
    Shape {
        half_width: 0.9,
        belt: &[(2.22, 0.46), (2.25, 0.64), (2.05, 0.78), (0.95, 0.96), (-2.0, 1.0), (-2.22, 0.9), (-2.24, 0.5)],
        cabin: [(1.0, 0.95), (0.3, 1.44), (-1.75, 1.46), (-2.12, 1.0)],
        axles: [1.38, -1.36],
        wheel_radius: 0.32,
    },
    // Sport utility.
    Shape {
        half_width: 0.92,
        belt: &[(2.16, 0.52), (2.2, 0.74), (2.05, 0.94), (0.95, 1.06), (-1.95, 1.1), (-2.18, 1.0), (-2.2, 0.56)],
        cabin: [(0.98, 1.05), (0.42, 1.58), (-1.7, 1.6), (-2.05, 1.08)],
        axles: [1.32, -1.32],
        wheel_radius: 0.36,
    },
];

/// A car of class Vehicles.
pub fn car(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let shape = &SHAPES[variety.bits() as usize % SHAPES.len()];
    shaped(&mut variety, shape, Vec3::ONE, detail)
}

/// The finest of that car, with arches in which its front wheels can be seen to steer.
pub fn steered(variant: u32) -> Model {
    let mut variety = Variety::of(variant);
    let shape = &SHAPES[variety.bits() as usize % SHAPES.len()];
    let lacquer = lacquer(&mut variety);
    let body = Body::new(shape.half_width, shape.belt).with_arches(&shape.axles, shape.wheel_radius);
    let Axles { x_m, y_m, radius_m } = shape.axles(Vec3::ONE);
    let axles = Axles { x_m, y_m: y_m - IN_ARCH_M, radius_m };
    axles.under(shape.finished(&body, lacquer, Detail::Fine), lacquer.tag, Detail::Fine)
}

/// Wheels in arches stand so much farther in, metres.
const IN_ARCH_M: f32 = 0.04;

/// A sport utility vehicle of class Vehicles, a little larger than the cars of that shape.
pub fn suv(variant: u32, detail: Detail) -> Model {
    shaped(&mut Variety::of(variant), &SHAPES[3], Vec3::new(1.02, 1.03, 1.03), detail)
}

/// The open door of a car of that variant, seen from the middle of its footprint; its hinge is behind.
pub fn door(variant: u32) -> Mesh {
    let mut variety = Variety::of(variant);
    // The first choice of a car is its shape.
    variety.bits();
    let lacquer = lacquer(&mut variety);
    let glass = Paint::plain(lacquer.tag, GLASS).glossy(230);
    let mut mesh = Mesh::default();
    mesh.cuboid(lacquer, Vec3::new(-0.55, -0.06, 0.28), Vec3::new(0.55, 0.06, 0.92));
    mesh.cuboid(glass, Vec3::new(-0.3, -0.02, 0.92), Vec3::new(0.5, 0.02, 1.36));
    mesh.cuboid(lacquer, Vec3::new(0.48, -0.03, 0.92), Vec3::new(0.54, 0.03, 1.4));
    mesh.cuboid(lacquer, Vec3::new(-0.3, -0.03, 1.36), Vec3::new(0.54, 0.03, 1.4));
    mesh
}

fn lacquer(variety: &mut Variety) -> Paint {
    Paint::plain(SemanticTag::Vehicles, variety.colour(&LACQUERS)).glossy(110)
}

fn shaped(variety: &mut Variety, shape: &Shape, scale: Vec3, detail: Detail) -> Model {
    let lacquer = lacquer(variety);
    if detail == Detail::Rough {
        let mut mesh = Mesh::default();
        silhouette(&mut mesh, lacquer, shape);
        mesh.scale(scale);
        return Model::rigid(mesh);
    }
    let mut mesh = shape.finished(&Body::new(shape.half_width, shape.belt), lacquer, detail);
    mesh.scale(scale);
    shape.axles(scale).under(mesh, lacquer.tag, detail)
}

impl Shape {
    /// All of a car but its wheels.
    fn finished(&self, body: &Body<'_>, lacquer: Paint, detail: Detail) -> Mesh {
        let mut mesh = Mesh::default();
        body.add_to(&mut mesh, lacquer);
        cabin(&mut mesh, lacquer, self, detail);
        lights(&mut mesh, self);
        if detail == Detail::Fine {
            trim(&mut mesh, lacquer, self);
        }
        mesh
    }

    /// The axles of a car made larger; tyres stand out of the flanks a little, as those have no arches.
    fn axles(&self, scale: Vec3) -> Axles {
        Axles {
            x_m: self.axles.map(|x| x * scale.x).to_vec(),
            y_m: (self.half_width + 0.01) * scale.y - OUTER_M,
            radius_m: self.wheel_radius * scale.z,
        }
    }
}

/// Body and cabin as two solids on dark wheels, with both pairs of lamps.
fn silhouette(mesh: &mut Mesh, paint: Paint, shape: &Shape) {
    let (w, nose, tail) = (shape.half_width, shape.belt[1].0, shape.belt[shape.belt.len() - 1].0);
    let ring = |front: f32, rear: f32, half: f32, z: f32| {
        [(rear, -half), (front, -half), (front, half), (rear, half)].map(|(x, y)| Vec3::new(x, y, z))
    };
    let [a, b, c, d] = shape.cabin;
    let dark = Paint::plain(paint.tag, RUBBER);
    mesh.walls(dark, &ring(nose - 0.5, tail + 0.4, w - 0.1, 0.0), &ring(nose - 0.5, tail + 0.4, w - 0.1, CLEARANCE_M));
    mesh.frustum(paint, &ring(nose, tail, w, CLEARANCE_M), &ring(nose - 0.1, tail, w - 0.06, a.1));
    mesh.walls(dark.colour(GLASS).glossy(230), &ring(a.0, d.0, w - 0.1, a.1), &ring(b.0, c.0, w - 0.26, b.1));
    mesh.polygon(paint, &ring(b.0, c.0, w - 0.26, b.1));
    lights(mesh, shape);
}

/// Windows all round, roof, and the pillars between.
fn cabin(mesh: &mut Mesh, paint: Paint, shape: &Shape, detail: Detail) {
    let (foot, top) = (shape.half_width - 0.1, shape.half_width - 0.26);
    let glass = Paint::plain(paint.tag, GLASS).glossy(230);
    let [a, b, c, d] = shape.cabin;
    let low = |(x, z): (f32, f32), side: f32| Vec3::new(x, side * foot, z);
    let high = |(x, z): (f32, f32), side: f32| Vec3::new(x, side * top, z);
    mesh.polygon(glass, &[low(a, -1.0), low(a, 1.0), high(b, 1.0), high(b, -1.0)]);
    mesh.polygon(glass, &[low(d, 1.0), low(d, -1.0), high(c, -1.0), high(c, 1.0)]);
    mesh.polygon(paint, &[high(b, 1.0), high(c, 1.0), high(c, -1.0), high(b, -1.0)]);
    mesh.polygon(glass, &[low(a, 1.0), low(d, 1.0), high(c, 1.0), high(b, 1.0)]);
    mesh.polygon(glass, &[low(d, -1.0), low(a, -1.0), high(b, -1.0), high(c, -1.0)]);
    if detail == Detail::Fine {
        for side in [-1.0, 1.0] {
            pillars(mesh, paint, shape, side);
        }
    }
}

/// Painted strips over the side glass: along the windscreen, behind the doors, along the roof.
fn pillars(mesh: &mut Mesh, paint: Paint, shape: &Shape, side: f32) {
    let (foot, top) = (shape.half_width - 0.1, shape.half_width - 0.26);
    let [a, b, c, d] = shape.cabin;
    let point = |(x, z): (f32, f32), up: f32, (x1, z1): (f32, f32)| {
        Vec3::new(x + (x1 - x) * up, side * (foot + (top - foot) * up + 0.012), z + (z1 - z) * up)
    };
    let shift = |p: (f32, f32), dx: f32| (p.0 + dx, p.1);
    let middle = ((a.0 + d.0) * 0.5 - 0.15, (a.1 + d.1) * 0.5);
    let above = ((b.0 + c.0) * 0.5 - 0.1, (b.1 + c.1) * 0.5);
    let mut strip = |p: (f32, f32), q: (f32, f32), width: f32| {
        let (p1, q1) = (shift(p, -width), shift(q, -width));
        let mut ring = [point(p, 0.0, q), point(p1, 0.0, q1), point(p1, 1.0, q1), point(p, 1.0, q)];
        if side < 0.0 {
            ring.reverse();
        }
        mesh.polygon(paint, &ring);
    };
    strip(shift(a, 0.02), shift(b, 0.02), 0.1);
    strip(middle, above, 0.09);
    strip(shift(d, 0.14), shift(c, 0.14), 0.16);
}

/// Head lamps, brake lamps, indicators and number plates.
fn lights(mesh: &mut Mesh, shape: &Shape) {
    let tag = SemanticTag::Vehicles;
    let (front, rear) = (shape.belt[1], shape.belt[shape.belt.len() - 1]);
    let w = shape.half_width - 0.08;
    let lamp = Paint::plain(tag, [236, 238, 228]).glossy(200).coded(CODE_HEAD);
    let brake = Paint::plain(tag, BRAKE_LAMP).coded(CODE_BRAKE);
    for side in [-1.0f32, 1.0] {
        let (y0, y1) = (side * w, side * (w - 0.36));
        facing(mesh, lamp, front.0 + 0.015, [y0, y1], [front.1 - 0.02, front.1 + 0.13]);
        facing(mesh, brake, -(rear.0.abs() + 0.02), [y0, side * (w - 0.28)], [0.68, 0.86]);
        let amber = Paint::plain(tag, INDICATOR).coded(if side > 0.0 { CODE_LEFT } else { CODE_RIGHT });
        facing(mesh, amber, front.0 + 0.02, [y0, side * (w - 0.12)], [front.1 - 0.09, front.1 - 0.03]);
        facing(mesh, amber, -(rear.0.abs() + 0.02), [y0, side * (w - 0.28)], [0.58, 0.67]);
    }
    let plate = Paint::plain(tag, [226, 226, 220]);
    facing(mesh, plate, shape.belt[0].0 + 0.03, [-0.26, 0.26], [0.38, 0.49]);
    facing(mesh, plate, -(rear.0.abs() + 0.02), [-0.26, 0.26], [0.44, 0.55]);
}

/// A small board across the car that looks forward at positive x and backward at negative x.
pub(super) fn facing(mesh: &mut Mesh, paint: Paint, x: f32, y: [f32; 2], z: [f32; 2]) {
    let (lo, hi) = (y[0].min(y[1]), y[0].max(y[1]));
    let (a, b) = if x > 0.0 { (lo, hi) } else { (hi, lo) };
    mesh.polygon(paint, &[Vec3::new(x, a, z[0]), Vec3::new(x, b, z[0]), Vec3::new(x, b, z[1]), Vec3::new(x, a, z[1])]);
}

/// Mirrors, grille and door lines.
fn trim(mesh: &mut Mesh, paint: Paint, shape: &Shape) {
    let (x, z) = shape.cabin[0];
    let w = shape.half_width;
    for side in [-1.0f32, 1.0] {
        let centre = Vec3::new(x - 0.3, side * (w + 0.07), z + 0.1);
        mesh.cuboid(paint.shaded(0.9), centre - Vec3::new(0.05, 0.1, 0.07), centre + Vec3::new(0.05, 0.1, 0.07));
    }
    let front = shape.belt[0];
    let grille = Paint::plain(paint.tag, [24, 24, 26]);
    facing(mesh, grille, front.0 + 0.012, [-0.5, 0.5], [0.3, front.1 - 0.01]);
}
