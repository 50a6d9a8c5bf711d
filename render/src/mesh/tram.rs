//! Trams.

use glam::Vec3;

use super::car::{GLASS, facing};
use super::heavy::{hull, lamps, side_windows};
use super::model::Detail;
use super::variety::Variety;
use super::wheel::RUBBER;
use super::{Mesh, Paint};
use crate::SemanticTag;

const LIVERIES: [[u8; 3]; 4] = [[222, 222, 214], [196, 40, 44], [240, 196, 60], [40, 92, 142]];
/// From the middle of the tram to that of each section, and half of a section's length, metres.
const SECTIONS_M: [f32; 3] = [-10.1, 0.0, 10.1];
const HALF_SECTION_M: f32 = 4.9;
const HALF_WIDTH_M: f32 = 1.2;

/// A low-floor tram of class Train: three sections with bellows between them, 30 m long.
pub fn tram(variant: u32, detail: Detail) -> Mesh {
    let tag = SemanticTag::Train;
    let livery = Paint::plain(tag, Variety::of(variant).colour(&LIVERIES)).glossy(80);
    let glass = Paint::plain(tag, GLASS).glossy(230);
    let rubber = Paint::plain(tag, RUBBER);
    let mut mesh = Mesh::default();
    for x in SECTIONS_M {
        let [low, high] = [-1.0, 1.0].map(|side| Vec3::new(x + side * HALF_SECTION_M, side * HALF_WIDTH_M, 0.0));
        hull(&mut mesh, livery, low + Vec3::Z * 0.3, high + Vec3::Z * 3.3, 0.16);
        hull(&mut mesh, rubber, low * Vec3::new(1.0, 0.7, 0.0), high * Vec3::new(1.0, 0.7, 0.0) + Vec3::Z * 0.3, 0.02);
        windows(&mut mesh, glass, x, detail);
        side_windows(&mut mesh, livery.shaded(0.55), [low.x + 0.1, high.x - 0.1], HALF_WIDTH_M, [0.32, 0.7]);
    }
    let joint = 0.5 * (SECTIONS_M[1] + SECTIONS_M[2]);
    for x in [-joint, joint] {
        mesh.cuboid(rubber, Vec3::new(x - 0.25, -1.05, 0.35), Vec3::new(x + 0.25, 1.05, 3.1));
    }
    for end in [-1.0f32, 1.0] {
        let front = end * 15.012;
        facing(&mut mesh, glass, front, [-1.05, 1.05], [1.3, 2.7]);
        facing(&mut mesh, Paint::plain(tag, [250, 170, 40]), front, [-0.6, 0.6], [2.82, 3.0]);
    }
    if detail == Detail::Fine {
        pantograph(&mut mesh, Paint::plain(tag, [70, 72, 76]));
    }
    lamps(&mut mesh, tag, 30.0, HALF_WIDTH_M);
    mesh
}

fn windows(mesh: &mut Mesh, glass: Paint, x: f32, detail: Detail) {
    let (from, to) = (x - HALF_SECTION_M + 0.3, x + HALF_SECTION_M - 0.3);
    let count = if detail == Detail::Fine { 5 } else { 1 };
    let pitch = (to - from) / count as f32;
    for i in 0..count {
        let start = from + pitch * i as f32;
        side_windows(mesh, glass, [start, start + pitch - 0.12], HALF_WIDTH_M, [1.2, 2.6]);
    }
}

fn pantograph(mesh: &mut Mesh, steel: Paint) {
    for y in [-0.5, 0.5] {
        mesh.tube(steel, Vec3::new(-0.4, y, 3.3), Vec3::new(0.1, y, 3.45), 0.025, 0.025, 5);
    }
    mesh.rod(steel, Vec3::new(0.1, -0.7, 3.46), Vec3::new(0.1, 0.7, 3.46), 0.025, 5);
}
