//! Lorries, vans and buses.

use glam::Vec3;

use super::car::{BRAKE_LAMP, GLASS, INDICATOR, facing};
use super::model::{Detail, Model};
use super::variety::Variety;
use super::wheel::{Axles, OUTER_M};
use super::{CODE_BRAKE, CODE_HEAD, CODE_LEFT, CODE_RIGHT, Mesh, Paint};
use crate::SemanticTag;

const CABS: [[u8; 3]; 6] = [[224, 224, 220], [170, 36, 32], [36, 74, 138], [214, 150, 32], [58, 98, 66], [70, 74, 80]];
const BOXES: [[u8; 3]; 5] = [[226, 226, 222], [196, 200, 204], [52, 92, 150], [214, 206, 186], [150, 58, 44]];
const LIVERIES: [[u8; 3]; 5] = [[206, 48, 40], [226, 182, 44], [48, 112, 170], [66, 132, 84], [228, 226, 218]];

/// A solid of class `paint.tag` whose upper edges are rounded off by `bevel` metres.
pub(super) fn hull(mesh: &mut Mesh, paint: Paint, low: Vec3, high: Vec3, bevel: f32) {
    let ring = |inset: f32, z: f32| {
        let (a, b) = (low + Vec3::splat(inset), high - Vec3::splat(inset));
        [Vec3::new(a.x, a.y, z), Vec3::new(b.x, a.y, z), Vec3::new(b.x, b.y, z), Vec3::new(a.x, b.y, z)]
    };
    mesh.walls(paint, &ring(0.0, low.z), &ring(0.0, high.z - bevel));
    mesh.frustum(paint, &ring(0.0, high.z - bevel), &ring(bevel, high.z));
    let [a, b, c, d] = ring(0.0, low.z);
    mesh.polygon(paint.shaded(0.3), &[d, c, b, a]);
}

/// A window band on both flanks from `x[0]` to `x[1]`.
pub(super) fn side_windows(mesh: &mut Mesh, glass: Paint, x: [f32; 2], half_width: f32, z: [f32; 2]) {
    let y = half_width + 0.01;
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    mesh.polygon(glass, &[at(x[1], y, z[0]), at(x[0], y, z[0]), at(x[0], y, z[1]), at(x[1], y, z[1])]);
    mesh.polygon(glass, &[at(x[0], -y, z[0]), at(x[1], -y, z[0]), at(x[1], -y, z[1]), at(x[0], -y, z[1])]);
}

/// Lamps at both ends of a vehicle that reaches from `-length / 2` to `length / 2`.
pub(super) fn lamps(mesh: &mut Mesh, tag: SemanticTag, length: f32, half_width: f32) {
    let head = Paint::plain(tag, [236, 238, 228]).glossy(200).coded(CODE_HEAD);
    let brake = Paint::plain(tag, BRAKE_LAMP).coded(CODE_BRAKE);
    let plate = Paint::plain(tag, [226, 226, 220]);
    let end = 0.5 * length + 0.015;
    for side in [-1.0f32, 1.0] {
        let y = [side * (half_width - 0.08), side * (half_width - 0.42)];
        facing(mesh, head, end, y, [0.6, 0.8]);
        facing(mesh, brake, -end, y, [0.7, 0.92]);
        let amber = Paint::plain(tag, INDICATOR).coded(if side > 0.0 { CODE_LEFT } else { CODE_RIGHT });
        facing(mesh, amber, end, y, [0.48, 0.58]);
        facing(mesh, amber, -end, y, [0.57, 0.68]);
    }
    facing(mesh, plate, -end, [-0.26, 0.26], [0.5, 0.62]);
}

/// Axles of a vehicle whose wheels stand out of its flanks a little, as those have no arches.
fn axles(x_m: &[f32], half_width: f32) -> Axles {
    Axles { x_m: x_m.to_vec(), y_m: half_width + 0.02 - OUTER_M, radius_m: 0.48 }
}

/// A lorry or a van of class Truck, 7 m long.
pub fn truck(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let tag = SemanticTag::Truck;
    let cab = Paint::plain(tag, variety.colour(&CABS)).glossy(90);
    let cargo = Paint::plain(tag, variety.colour(&BOXES)).glossy(30);
    let mut mesh = Mesh::default();
    let axles = if variety.one_in(3) {
        van_body(&mut mesh, cab);
        axles(&[2.1, -1.9], 1.1)
    } else {
        lorry(&mut mesh, cab, cargo);
        axles(&[2.5, -1.6, -2.7], 1.18)
    };
    lamps(&mut mesh, tag, 7.0, 1.1);
    axles.under(mesh, tag, detail)
}

fn lorry(mesh: &mut Mesh, cab: Paint, cargo: Paint) {
    let glass = Paint::plain(cab.tag, GLASS).glossy(230);
    hull(mesh, Paint::plain(cab.tag, [40, 40, 42]), Vec3::new(-3.5, -0.9, 0.45), Vec3::new(3.3, 0.9, 0.95), 0.02);
    hull(mesh, cab, Vec3::new(1.6, -1.18, 0.5), Vec3::new(3.5, 1.18, 2.6), 0.16);
    facing(mesh, glass, 3.512, [-1.02, 1.02], [1.5, 2.35]);
    facing(mesh, glass.colour([24, 24, 26]).glossy(40), 3.512, [-0.7, 0.7], [0.85, 1.3]);
    side_windows(mesh, glass, [2.3, 3.3], 1.18, [1.5, 2.25]);
    hull(mesh, cargo, Vec3::new(-3.5, -1.2, 0.95), Vec3::new(1.45, 1.2, 3.0), 0.03);
    facing(mesh, cargo.shaded(0.7), -3.512, [-0.02, 0.02], [1.0, 2.95]);
}

/// A van of class Vehicles, 4.9 m long.
pub fn van(variant: u32, detail: Detail) -> Model {
    let paint = Paint::plain(SemanticTag::Vehicles, Variety::of(variant).colour(&CABS)).glossy(90);
    small_van_axles().under(small_van_body(paint), paint.tag, detail)
}

/// A patrol car or ambulance of class Vehicles: a white van with a red band, and a blue bar on its roof.
pub fn emergency(detail: Detail) -> Model {
    let tag = SemanticTag::Vehicles;
    let mut mesh = small_van_body(Paint::plain(tag, [236, 236, 232]).glossy(90));
    side_windows(&mut mesh, Paint::plain(tag, [196, 30, 34]), [-2.3, 2.3], 0.955, [0.62, 0.82]);
    mesh.cuboid(Paint::plain(tag, [60, 60, 64]), Vec3::new(0.75, -0.6, 1.98), Vec3::new(1.05, 0.6, 2.06));
    mesh.cuboid(
        Paint::plain(tag, [24, 70, 210]).glossy(160),
        Vec3::new(0.72, -0.62, 2.06),
        Vec3::new(1.08, 0.62, 2.22),
    );
    small_van_axles().under(mesh, tag, detail)
}

/// How much smaller the small van is than the large one.
const SMALL: Vec3 = Vec3::new(0.695, 0.855, 0.735);

fn small_van_body(paint: Paint) -> Mesh {
    let mut mesh = Mesh::default();
    van_body(&mut mesh, paint);
    lamps(&mut mesh, paint.tag, 7.0, 1.1);
    mesh.scale(SMALL);
    mesh
}

fn small_van_axles() -> Axles {
    let [front, rear] = [2.1, -1.9].map(|x| x * SMALL.x);
    Axles { radius_m: 0.48 * SMALL.z, ..axles(&[front, rear], 1.12 * SMALL.y - 0.02) }
}

fn van_body(mesh: &mut Mesh, paint: Paint) {
    let glass = Paint::plain(paint.tag, GLASS).glossy(230);
    hull(mesh, paint, Vec3::new(-3.5, -1.1, 0.35), Vec3::new(3.5, 1.1, 1.3), 0.12);
    let floor = [(-3.45, -1.08), (2.9, -1.08), (2.9, 1.08), (-3.45, 1.08)].map(|(x, y)| Vec3::new(x, y, 1.25));
    let roof = [(-3.35, -0.95), (1.9, -0.95), (1.9, 0.95), (-3.35, 0.95)].map(|(x, y)| Vec3::new(x, y, 2.7));
    mesh.frustum(paint, &floor, &roof);
    let up = |t: f32, y: f32| Vec3::new(2.9 - t + 0.015, y * (1.08 - 0.13 * t), 1.25 + 1.45 * t + 0.01);
    mesh.polygon(glass, &[up(0.1, -0.9), up(0.1, 0.9), up(0.85, 0.9), up(0.85, -0.9)]);
    side_windows(mesh, glass, [1.2, 2.2], 1.05, [1.4, 2.1]);
    facing(mesh, glass, -3.46, [-0.8, 0.8], [1.6, 2.2]);
}

/// A city bus of class Bus, 11 m long.
pub fn bus(variant: u32, detail: Detail) -> Model {
    let mut variety = Variety::of(variant);
    let tag = SemanticTag::Bus;
    let livery = Paint::plain(tag, variety.colour(&LIVERIES)).glossy(80);
    let glass = Paint::plain(tag, GLASS).glossy(230);
    let mut mesh = Mesh::default();
    hull(&mut mesh, livery, Vec3::new(-5.5, -1.25, 0.32), Vec3::new(5.5, 1.25, 3.1), 0.14);
    facing(&mut mesh, glass, 5.512, [-1.12, 1.12], [1.05, 2.5]);
    facing(&mut mesh, Paint::plain(tag, [20, 20, 20]), 5.512, [-0.9, 0.9], [2.58, 2.88]);
    facing(&mut mesh, Paint::plain(tag, [250, 170, 40]), 5.52, [-0.6, 0.6], [2.66, 2.8]);
    facing(&mut mesh, glass, -5.512, [-1.05, 1.05], [1.6, 2.6]);
    bus_windows(&mut mesh, glass, detail);
    let skirt = livery.shaded(0.55);
    side_windows(&mut mesh, skirt, [-5.4, 5.4], 1.25, [0.34, 0.62]);
    lamps(&mut mesh, tag, 11.0, 1.2);
    axles(&[2.9, -3.0], 1.25).under(mesh, tag, detail)
}

fn bus_windows(mesh: &mut Mesh, glass: Paint, detail: Detail) {
    if detail != Detail::Fine {
        return side_windows(mesh, glass, [-5.1, 5.2], 1.25, [1.2, 2.5]);
    }
    for i in 0..6 {
        let x = -5.1 + 1.74 * i as f32;
        side_windows(mesh, glass, [x, x + 1.6], 1.25, [1.2, 2.5]);
    }
    // Doors, on the right.
    for x in [3.95f32, -0.6] {
        let at = |dx: f32, z: f32| Vec3::new(x + dx, -1.268, z);
        mesh.polygon(glass.colour([44, 52, 58]), &[at(0.0, 0.42), at(1.2, 0.42), at(1.2, 2.55), at(0.0, 2.55)]);
    }
}
