//! The glow around what shines at night, as sprites that write neither class nor depth.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::mesh::{CODE_LIT, Vertex};
use crate::street_lamps::StreetLamp;
use crate::view::View;

/// Glow around one lamp, as `glow.wgsl` reads it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Glow {
    pub(crate) position: [f32; 3],
    pub(crate) radius_m: f32,
    /// Linear; 1 shines over everything.
    pub(crate) colour: [f32; 3],
}

/// What lies this close together with one colour is one lamp, metres.
const LAMP_M: f32 = 0.5;
/// Radius of the glow of a vehicle's lamps and signals, and of a street lamp's, metres at the lamp itself.
const RADIUS_M: f32 = 0.4;
const STREET_RADIUS_M: f32 = 0.7;
const STREET: Vec3 = Vec3::new(1.0, 0.82, 0.55);
/// A street lamp seen from above its shade shows this share of its glow.
const ABOVE: f32 = 0.15;

/// Glows of the lamps that shine among the vertices of one thing that moves.
pub(crate) fn of_lamps(vertices: &[Vertex], eye: Vec3, shine: f32, glows: &mut Vec<Glow>) {
    let mut lit = vertices.iter().filter(|v| v.code == CODE_LIT).peekable();
    while let Some(first) = lit.next() {
        let start = Vec3::from_array(first.position);
        let (mut sum, mut normals, mut count) = (start, normal(first), 1.0);
        let is_same = |v: &&Vertex| {
            v.colour == first.colour && Vec3::from_array(v.position).distance_squared(start) < LAMP_M * LAMP_M
        };
        while let Some(v) = lit.next_if(is_same) {
            sum += Vec3::from_array(v.position);
            normals += normal(v);
            count += 1.0;
        }
        let position = sum / count;
        let facing = facing(normals / count, eye - position);
        if facing > 0.0 {
            let colour = Vec3::from(first.colour.map(|c| f32::from(c) / 255.0));
            let colour = (colour * colour * (shine * facing)).to_array();
            glows.push(Glow { position: position.to_array(), radius_m: RADIUS_M, colour });
        }
    }
}

fn normal(v: &Vertex) -> Vec3 {
    Vec3::from(v.normal.map(f32::from)) / 127.0
}

/// How much a lamp shines towards an eye: round ones to all sides, flat ones ahead.
fn facing(normal: Vec3, to_eye: Vec3) -> f32 {
    if normal.length() < 0.5 { 1.0 } else { normal.dot(to_eye.normalize_or_zero()).max(0.0) }
}

/// Glows of the street lamps that a view sees.
pub(crate) fn of_street_lamps(lamps: &[StreetLamp], view: &View, shine: f32, glows: &mut Vec<Glow>) {
    for lamp in lamps.iter().filter(|lamp| view.sees(lamp.position, 4.0)) {
        let share = if view.eye.z < lamp.position.z { 1.0 } else { ABOVE };
        let colour = (STREET * (shine * share)).to_array();
        glows.push(Glow { position: lamp.position.to_array(), radius_m: STREET_RADIUS_M, colour });
    }
}
