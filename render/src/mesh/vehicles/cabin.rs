//! Windows of passenger cars, their roofs, and who sits inside.

use glam::Vec3;

use super::car_shape::{Cabin, Shape};
use super::fittings::{centre_brake_lamp, facing, glass, plastic};
use super::loft::Loft;
use super::occupant::{From, Occupant};
use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::skin::{bowed, strip};
use crate::mesh::variety::Variety;
use crate::mesh::{Mesh, Paint};

/// How far windows lean in from foot to top, and how much narrower the roof's flat part is, metres.
const LEAN_M: f32 = 0.13;
const ROOF_INSET_M: f32 = 0.07;

/// How strongly panes and roofs are bent, radians a metre.
const BOW: f32 = 0.3;

/// How wide the pillars behind the rear doors are, metres.
const REAR_PILLAR_M: f32 = 0.26;

/// Heads are so far below the upper edge of the windows, and so far from the middle, metres.
const HEAD_BELOW_M: f32 = 0.17;
const SEAT_Y_M: f32 = 0.36;

/// The panes of a car, corners counter-clockwise seen from outside, the lower edge first.
struct Panes {
    screen: [Vec3; 4],
    rear: [Vec3; 4],
    /// Left and right.
    sides: [[Vec3; 4]; 2],
}

impl Panes {
    fn of(cabin: &Cabin, body: &Loft<'_>) -> Self {
        let station = |x: f32| body.station(x);
        // Panes stand a little inside the edge of the body, and reach below it.
        let foot = |end: usize, side: f32| {
            let s = station(cabin.feet[end]);
            let half = station(cabin.feet[end].clamp(-1.7, 1.0)).half;
            Vec3::new(cabin.feet[end], side * (half - 0.11), s.top - 0.015)
        };
        let top = |end: usize, side: f32| {
            let (x, z) = cabin.tops[end];
            Vec3::new(x, side * (station(x).half - 0.11 - LEAN_M), z)
        };
        Self {
            screen: [foot(0, -1.0), foot(0, 1.0), top(0, 1.0), top(0, -1.0)],
            rear: [foot(1, 1.0), foot(1, -1.0), top(1, -1.0), top(1, 1.0)],
            sides: [
                [foot(0, 1.0), foot(1, 1.0), top(1, 1.0), top(0, 1.0)],
                [foot(1, -1.0), foot(0, -1.0), top(0, -1.0), top(1, -1.0)],
            ],
        }
    }
}

/// Panes all round under a roof; at its finest with the pillars between them.
pub(super) fn cabin(mesh: &mut Mesh, paint: Paint, shape: &Shape, body: &Loft<'_>, detail: Detail) {
    let (panes, glass) = (Panes::of(&shape.cabin, body), glass(paint.tag));
    for pane in [&panes.screen, &panes.rear, &panes.sides[0], &panes.sides[1]] {
        bowed(mesh, glass, pane, BOW);
    }
    let [[_, _, c, b], [_, _, b_right, c_right]] = panes.sides;
    let eaves = [c_right, b_right, b, c];
    let inside = |p: Vec3| {
        let aside = p.y - ROOF_INSET_M * p.y.signum();
        let along = if p.x > -0.5 { p.x - 0.16 } else { p.x + 0.06 };
        Vec3::new(along, aside, shape.cabin.roof_z)
    };
    let ridge = eaves.map(inside);
    for i in 0..4 {
        let j = (i + 1) % 4;
        bowed(mesh, paint, &[eaves[i], eaves[j], ridge[j], ridge[i]], BOW);
    }
    bowed(mesh, paint, &ridge, 0.2);
    if shape.has_rails && detail != Detail::Rough {
        rails(mesh, plastic(paint.tag), &ridge);
    }
    if detail == Detail::Fine {
        let x = c.x - 0.012;
        facing(mesh, centre_brake_lamp(paint.tag), x, [-0.16, 0.16], [c.z + 0.005, c.z + 0.025]);
        for (side, pane) in [(1.0, &panes.sides[0]), (-1.0, &panes.sides[1])] {
            pillars(mesh, paint, pane, side);
        }
    }
}

/// Rails along the roof's edges.
fn rails(mesh: &mut Mesh, paint: Paint, ridge: &[Vec3; 4]) {
    for (rear, front) in [(ridge[0], ridge[1]), (ridge[3], ridge[2])] {
        let (rear, front) = (rear + Vec3::new(0.15, 0.0, 0.02), front + Vec3::new(-0.2, 0.0, 0.02));
        let out = Vec3::Y * front.y.signum();
        strip(mesh, paint, rear, front, out, 0.03);
        strip(mesh, paint, rear, front, -out, 0.03);
    }
}

/// Painted bands over a side pane, from its lower edge to its upper one: along the windscreen, dark behind the front door,
/// behind the rear door.
fn pillars(mesh: &mut Mesh, paint: Paint, pane: &[Vec3; 4], side: f32) {
    let [mut front, mut rear] = [[pane[0], pane[3]], [pane[1], pane[2]]];
    if side < 0.0 {
        [front, rear] = [[pane[1], pane[2]], [pane[0], pane[3]]];
    }
    let out = (pane[1] - pane[0]).cross(pane[2] - pane[0]).normalize_or_zero();
    let mut band = |paint: Paint, from: [Vec3; 2], shift_m: [f32; 2], width_m: f32| {
        let edge = |i: usize, ahead_m: f32| {
            let back = (rear[i] - front[i]).normalize_or_zero();
            from[i] - back * ahead_m + out * 0.012
        };
        let [ahead, behind] = [0.5 * width_m, -0.5 * width_m].map(|m| [0, 1].map(|i| edge(i, shift_m[i] + m)));
        let mut corners = [ahead[0], behind[0], behind[1], ahead[1]];
        if side < 0.0 {
            corners.reverse();
        }
        mesh.polygon(paint, &corners);
    };
    let middle = [0, 1].map(|i| (front[i] + rear[i]) * 0.5);
    band(paint, front, [-0.05; 2], 0.1);
    band(plastic(paint.tag), middle, [-0.12, -0.08], 0.11);
    band(paint, rear, [REAR_PILLAR_M * 0.5; 2], REAR_PILLAR_M);
}

/// The driver and those who ride along, behind all panes that show them.
pub(super) fn crew(mesh: &mut Mesh, variety: &mut Variety, shape: &Shape, body: &Loft<'_>) {
    let (panes, glass) = (Panes::of(&shape.cabin, body), glass(SemanticTag::Vehicles));
    let head_z = shape.cabin.tops[0].1 - HEAD_BELOW_M;
    let [front_x, rear_x] = [-0.18, -1.02];
    let mut seats = vec![Vec3::new(front_x, SEAT_Y_M, head_z)];
    if variety.one_in(3) {
        seats.push(Vec3::new(front_x, -SEAT_Y_M, head_z));
    }
    if variety.one_in(5) {
        seats.push(Vec3::new(rear_x, -SEAT_Y_M, head_z));
    }
    for seat in seats {
        let occupant = Occupant::of(variety, seat);
        if seat.x == front_x {
            occupant.show(mesh, glass, &panes.screen, From::Ahead);
        }
        occupant.show(mesh, glass, &panes.rear, From::Behind);
        for pane in &panes.sides {
            occupant.show(mesh, glass, pane, From::Aside);
        }
    }
}
