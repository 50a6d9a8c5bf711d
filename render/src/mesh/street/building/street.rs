//! What stands out from the front of a house at the street: balconies, bays, steps, awnings, flower boxes.

use glam::{Vec2, Vec3};

use super::design::{Adornment, Design, Kind, style};
use super::outline::{NO_WINDOWS, TAG};
use crate::mesh::model::Detail;
use crate::mesh::{Mesh, Paint};

/// How far balconies, bays and awnings reach out, metres: less than the width of a sidewalk, and not to its lamps.
const BALCONY_M: f32 = 0.75;
const BAY_M: f32 = 0.55;
const AWNING_M: f32 = 0.7;

/// Window columns and storeys of the front at the street, as places.
#[derive(Clone, Copy, Debug)]
pub(super) struct Front {
    /// Of the wall.
    x_m: f32,
    /// Where the first column begins.
    y_m: f32,
    column_m: f32,
    storey_m: f32,
    columns: f32,
    storeys: f32,
}

impl Front {
    pub(super) fn new(design: &Design, columns: f32) -> Self {
        let Design { size, eaves_m, storeys, .. } = *design;
        Self {
            x_m: 0.5 * size.x,
            y_m: -0.5 * size.y,
            column_m: size.y / columns,
            storey_m: eaves_m / storeys,
            columns,
            storeys,
        }
    }

    /// Columns along, storeys up, metres out.
    fn at(&self, u: f32, v: f32, out_m: f32) -> Vec3 {
        Vec3::new(self.x_m + out_m, self.y_m + u * self.column_m, v * self.storey_m)
    }

    /// A box on the wall between two places of it, without its back; its bottom only where it may be seen.
    fn ledge(&self, mesh: &mut Mesh, paint: Paint, low: Vec3, high: Vec3) {
        let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        let (a, b) = (low, high);
        mesh.polygon(paint, &[p(b.x, a.y, a.z), p(b.x, b.y, a.z), p(b.x, b.y, b.z), p(b.x, a.y, b.z)]);
        mesh.polygon(paint, &[p(a.x, a.y, a.z), p(b.x, a.y, a.z), p(b.x, a.y, b.z), p(a.x, a.y, b.z)]);
        mesh.polygon(paint, &[p(b.x, b.y, a.z), p(a.x, b.y, a.z), p(a.x, b.y, b.z), p(b.x, b.y, b.z)]);
        if b.z < 4.0 || b.z - a.z < 0.5 {
            mesh.polygon(paint, &[p(a.x, a.y, b.z), p(b.x, a.y, b.z), p(b.x, b.y, b.z), p(a.x, b.y, b.z)]);
        }
        if a.z > 1.0 {
            mesh.polygon(paint, &[p(b.x, a.y, a.z), p(a.x, a.y, a.z), p(a.x, b.y, a.z), p(b.x, b.y, a.z)]);
        }
    }
}

pub(super) fn adorn(mesh: &mut Mesh, design: &Design, front: Front, detail: Detail) {
    if matches!(design.kind, Kind::Garage | Kind::Tower) {
        return;
    }
    match design.adornment {
        Adornment::Nothing => {}
        Adornment::Balconies => balconies(mesh, design, front, detail),
        Adornment::Bay => bay(mesh, design, front),
        Adornment::FlowerBoxes if detail != Detail::Rough => flower_boxes(mesh, design, front),
        Adornment::FlowerBoxes => {}
    }
    if design.has_awning {
        awning(mesh, design, front);
    }
    let is_free = !design.has_awning && matches!(design.adornment, Adornment::Nothing | Adornment::FlowerBoxes);
    if design.is_shop() && is_free && detail != Detail::Rough {
        blade_sign(mesh, design, front);
    }
    entrance(mesh, design, front, detail);
    if detail != Detail::Rough && design.wall.code & style::BANDS != 0 {
        let (low, high) = (front.at(0.0, 0.985, 0.0), front.at(front.columns, 1.03, 0.09));
        front.ledge(mesh, design.plain().shaded(1.1), low, high);
    }
}

/// One stack of them, a column or two wide, over the storeys above the ground floor.
fn balconies(mesh: &mut Mesh, design: &Design, front: Front, detail: Detail) {
    let mut variety = design.rest;
    let wide = if front.columns >= 5.0 { 2.0 } else { 1.0 };
    let first = 1.0 + (variety.bits() % (front.columns - wide).max(1.0) as u32) as f32;
    let first = first.min(front.columns - wide);
    let slab = Paint::plain(TAG, [186, 184, 178]);
    // Of steel, or of masonry, which stands on its slab.
    let (rail, gap_m) =
        if variety.one_in(2) { (Paint::plain(TAG, [62, 66, 70]), 0.06) } else { (design.plain().shaded(1.12), 0.0) };
    for storey in 1..(front.storeys as u32).min(6) {
        let v = storey as f32;
        let low = front.at(first + 0.04, v, 0.0);
        let high = front.at(first + wide - 0.04, v, BALCONY_M);
        if detail == Detail::Fine {
            front.ledge(mesh, slab, low - Vec3::Z * 0.16, high);
            railing(mesh, (rail, gap_m), low, high);
        } else {
            front.ledge(mesh, rail, low - Vec3::Z * 0.16, high + Vec3::Z);
        }
    }
}

/// A parapet on three sides of a slab, so far above it, seen from inside too.
fn railing(mesh: &mut Mesh, (paint, gap_m): (Paint, f32), low: Vec3, high: Vec3) {
    let top = high.z + 1.0;
    let corners =
        [Vec2::new(low.x, low.y), Vec2::new(high.x, low.y), Vec2::new(high.x, high.y), Vec2::new(low.x, high.y)];
    for i in 0..3 {
        let (a, b) = (corners[i], corners[i + 1]);
        let (foot, head) = (high.z + gap_m, top);
        mesh.polygon(paint, &[a.extend(foot), b.extend(foot), b.extend(head), a.extend(head)]);
        mesh.polygon(paint.shaded(0.8), &[b.extend(foot), a.extend(foot), a.extend(head), b.extend(head)]);
    }
}

/// A bay of one column, from the first floor to the eaves.
fn bay(mesh: &mut Mesh, design: &Design, front: Front) {
    let mut variety = design.rest;
    let column = (variety.bits() % front.columns as u32) as f32;
    let top = (front.storeys - 0.12).min(4.0 - 0.12);
    let wall = design.wall.coded(design.wall.code & !(style::SHOP | style::DOOR | style::SHUTTERS));
    let (low, high) = (front.at(column + 0.03, 1.0, 0.0), front.at(column + 0.97, top, BAY_M));
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let uv = |u0: f32, u1: f32, v: f32| [(u0, 1.0), (u1, 1.0), (u1, top), (u0, top)].map(|(a, b)| Vec2::new(a, b + v));
    let (a, b) = (low, high);
    let face = [p(b.x, a.y, a.z), p(b.x, b.y, a.z), p(b.x, b.y, b.z), p(b.x, a.y, b.z)];
    mesh.quad_uv(wall, face, uv(column, column + 1.0, 0.0));
    let left = [p(a.x, a.y, a.z), p(b.x, a.y, a.z), p(b.x, a.y, b.z), p(a.x, a.y, b.z)];
    let right = [p(b.x, b.y, a.z), p(a.x, b.y, a.z), p(a.x, b.y, b.z), p(b.x, b.y, b.z)];
    for side in [left, right] {
        mesh.quad_uv(wall, side, uv(0.0, BAY_M / front.column_m, NO_WINDOWS));
    }
    let stone = design.plain().shaded(0.94);
    mesh.polygon(stone, &[p(b.x, a.y, a.z), p(a.x, a.y, a.z), p(a.x, b.y, a.z), p(b.x, b.y, a.z)]);
    let lid = front.storey_m * 0.1;
    let roof = Paint::plain(TAG, [96, 100, 102]);
    mesh.polygon(roof, &[b - Vec3::Y * (b.y - a.y), b, p(a.x, b.y, b.z + lid), p(a.x, a.y, b.z + lid)]);
    mesh.polygon(roof, &[p(a.x, a.y, b.z), p(b.x, a.y, b.z), p(a.x, a.y, b.z + lid)]);
    mesh.polygon(roof, &[p(b.x, b.y, b.z), p(a.x, b.y, b.z), p(a.x, b.y, b.z + lid)]);
}

/// Below a few windows, with what grows in them.
fn flower_boxes(mesh: &mut Mesh, design: &Design, front: Front) {
    let mut variety = design.rest;
    let storey = 1.0 + (variety.bits() % (front.storeys - 1.0).max(1.0) as u32) as f32;
    for column in 0..(front.columns as u32).min(5) {
        let u = column as f32 + 0.5;
        let half = 0.17 + 0.03 * f32::from(design.wall.param & 3);
        let (low, high) = (front.at(u - half, storey + 0.24, 0.0), front.at(u + half, storey + 0.3, 0.22));
        front.ledge(mesh, Paint::plain(TAG, [110, 74, 56]), low, high);
        let blooms = variety.pick(&[[176, 52, 62], [90, 128, 60], [196, 110, 140], [84, 120, 58]]);
        let (low, high) = (low + Vec3::new(0.0, 0.03, front.storey_m * 0.06), high + Vec3::new(0.03, -0.03, 0.2));
        front.ledge(mesh, Paint::plain(TAG, blooms), low, high);
    }
}

/// Cloth over the shop windows beside the door.
fn awning(mesh: &mut Mesh, design: &Design, front: Front) {
    let door = design.door_column();
    let (from, to) = if front.columns - door - 1.0 >= door { (door + 1.0, front.columns) } else { (0.0, door) };
    let cloth =
        Paint::plain(TAG, design.rest.clone().pick(&[[148, 44, 40], [48, 96, 70], [206, 190, 150], [58, 74, 110]]));
    let (low, high) = (front.at(from + 0.05, 0.75, 0.0), front.at(to - 0.05, 0.75, AWNING_M));
    let sag = Vec3::Z * 0.16;
    let p = |x: f32, y: f32| Vec3::new(x, y, low.z);
    let (a, b, c, d) = (p(low.x, low.y), p(high.x, low.y) - sag, p(high.x, high.y) - sag, p(low.x, high.y));
    mesh.polygon(cloth, &[a, b, c, d]);
    mesh.polygon(cloth.shaded(0.7), &[d, c, b, a]);
    let hem = Vec3::Z * 0.1;
    mesh.polygon(cloth, &[b - hem, c - hem, c, b]);
    mesh.polygon(cloth.shaded(0.7), &[c - hem, b - hem, b, c]);
}

/// A sign that stands out from the wall, for those who come along it.
fn blade_sign(mesh: &mut Mesh, design: &Design, front: Front) {
    let mut variety = design.rest;
    let u = variety.pick(&[0.04, front.columns - 0.04]);
    let colour = variety.pick(&[[176, 40, 36], [30, 70, 130], [36, 110, 66], [214, 170, 40], [232, 230, 222]]);
    let low = front.at(u, 1.0, 0.0) + Vec3::new(0.12, -0.05, 0.25);
    front.ledge(mesh, Paint::plain(TAG, colour), low, low + Vec3::new(0.55, 0.1, 0.75));
}

/// How high canopies hang, as a share of a storey: doors below them reach up to 0.77 (`facade.wgsl`), and who looks down on
/// them from a little above still sees those.
const CANOPY: f32 = 0.86;

/// Before the door, and the canopy over it.
fn entrance(mesh: &mut Mesh, design: &Design, front: Front, detail: Detail) {
    let door = design.door_column() + 0.5;
    let stone = Paint::plain(TAG, [168, 164, 156]);
    if !design.is_shop() && design.wall.code & style::BANDS == 0 {
        let (low, high) = (front.at(door - 0.32, CANOPY, 0.0), front.at(door + 0.32, CANOPY + 0.03, AWNING_M));
        front.ledge(mesh, Paint::plain(TAG, [150, 152, 150]), low, high);
    }
    let rise_m = if design.is_shop() { 0.07 } else { 0.16 };
    let low = front.at(door - 0.27, 0.0, 0.0);
    let step = |out_m: f32, rises: f32| front.at(door + 0.27, 0.0, out_m) + Vec3::Z * (rises * rise_m);
    front.ledge(mesh, stone, low, step(0.46, 1.0));
    if detail != Detail::Rough {
        front.ledge(mesh, stone.shaded(0.94), low, step(0.24, 2.0));
    }
}
