//! Street lamps and traffic signs on their posts.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};
use kernel::map::{SIGN_LIMIT, SIGN_STOP, SIGN_YIELD};
use kernel::ops;

use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::{CODE_STREET, Mesh, Paint};

const STEEL: Paint = Paint::plain(SemanticTag::Pole, [132, 136, 138]).glossy(30);

/// End of the arm of a street lamp, and the box that hangs on it.
fn lamp_box(height_m: f32) -> [Vec3; 3] {
    let tip = Vec3::new(1.5, 0.0, height_m - 0.05);
    [tip, tip - Vec3::new(0.2, 0.15, 0.07), tip + Vec3::new(0.55, 0.15, 0.07)]
}

/// Middle of the glass of a street lamp.
pub(crate) fn lamp_glass(height_m: f32) -> Vec3 {
    let [_, low, high] = lamp_box(height_m);
    Vec3::new(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z - 0.03)
}

/// A street lamp `height_m` high whose arm reaches along its x axis.
pub fn lamp(height_m: f32, detail: Detail) -> Mesh {
    let sides = if detail == Detail::Fine { 8 } else { 4 };
    let mut mesh = Mesh::default();
    let elbow = Vec3::Z * (height_m - 0.35);
    let [tip, low, high] = lamp_box(height_m);
    mesh.tube(STEEL.shaded(0.85), Vec3::ZERO, Vec3::Z * 0.9, 0.13, 0.13, sides);
    mesh.tube(STEEL, Vec3::Z * 0.9, elbow, 0.085, 0.06, sides);
    mesh.tube(STEEL, elbow, tip, 0.055, 0.045, sides);
    let glass = Paint::plain(SemanticTag::Pole, [226, 224, 206]).glossy(120).coded(CODE_STREET);
    mesh.cuboid(STEEL.shaded(0.8), low, high);
    mesh.cuboid(glass, low + Vec3::new(0.1, 0.03, -0.03), Vec3::new(high.x - 0.1, high.y - 0.03, low.z));
    mesh
}

const RED: [u8; 3] = [196, 28, 32];
const WHITE: [u8; 3] = [236, 236, 232];
const BLACK: [u8; 3] = [22, 22, 24];

/// A sign on its post, `height_m` high, whose face looks along its x axis.
pub fn sign(variant: u32, height_m: f32, detail: Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let sides = if detail == Detail::Fine { 6 } else { 4 };
    mesh.tube(STEEL, Vec3::ZERO, Vec3::Z * height_m, 0.04, 0.04, sides);
    let centre = Vec3::new(0.06, 0.0, height_m - 0.42);
    match variant {
        SIGN_STOP => stop_face(&mut mesh, centre),
        SIGN_YIELD => yield_face(&mut mesh, centre),
        limit if limit >= SIGN_LIMIT => limit_face(&mut mesh, centre, limit - SIGN_LIMIT),
        _ => board(&mut mesh, centre, [40, 84, 160], 4, 0.34, TAU / 8.0),
    }
    mesh
}

fn face(colour: [u8; 3]) -> Paint {
    Paint::plain(SemanticTag::TrafficSign, colour)
}

fn rim(centre: Vec3, sides: u32, radius: f32, turn: f32) -> Vec<Vec3> {
    let corner = |i: u32| {
        let angle = turn + TAU * i as f32 / sides as f32;
        centre + Vec3::new(0.0, radius * ops::cos(angle), radius * ops::sin(angle))
    };
    (0..sides).map(corner).collect()
}

/// A regular plate with a grey back.
fn board(mesh: &mut Mesh, centre: Vec3, colour: [u8; 3], sides: u32, radius: f32, turn: f32) {
    let front = rim(centre, sides, radius, turn);
    let mut back: Vec<Vec3> = front.iter().map(|&p| p - Vec3::X * 0.02).collect();
    mesh.polygon(face(colour), &front);
    back.reverse();
    mesh.polygon(face([120, 122, 124]), &back);
}

/// A layer of paint on a plate.
fn layer(mesh: &mut Mesh, centre: Vec3, colour: [u8; 3], sides: u32, radius: f32, turn: f32, lift: f32) {
    mesh.polygon(face(colour), &rim(centre + Vec3::X * lift, sides, radius, turn));
}

fn stop_face(mesh: &mut Mesh, centre: Vec3) {
    let turn = TAU / 16.0;
    board(mesh, centre, WHITE, 8, 0.42, turn);
    layer(mesh, centre, RED, 8, 0.39, turn, 0.006);
    for (letter, y) in [(LETTER_S, -0.21), (LETTER_T, -0.07), (LETTER_O, 0.07), (LETTER_P, 0.21)] {
        glyph(mesh, WHITE, centre + Vec3::new(0.012, y, 0.0), letter, Vec2::new(0.1, 0.22));
    }
}

fn yield_face(mesh: &mut Mesh, centre: Vec3) {
    let turn = -0.25 * TAU;
    board(mesh, centre, RED, 3, 0.5, turn);
    layer(mesh, centre, WHITE, 3, 0.32, turn, 0.006);
}

fn limit_face(mesh: &mut Mesh, centre: Vec3, limit_kmh: u32) {
    board(mesh, centre, RED, 20, 0.38, 0.0);
    layer(mesh, centre, WHITE, 20, 0.29, 0.0, 0.006);
    let digits: Vec<u32> = limit_kmh.to_string().bytes().map(|b| u32::from(b - b'0')).collect();
    let (width, gap) = if digits.len() > 2 { (0.12, 0.155) } else { (0.16, 0.21) };
    for (i, &digit) in digits.iter().enumerate() {
        let y = (i as f32 - 0.5 * (digits.len() as f32 - 1.0)) * gap;
        glyph(mesh, BLACK, centre + Vec3::new(0.012, y, 0.0), DIGITS[digit as usize], Vec2::new(width, 0.28));
    }
}

/// Segments of a seven-segment glyph: top, upper right, lower right, bottom, lower left, upper left,
/// middle; bit 7 is a stem in the middle.
const DIGITS: [u8; 10] = [0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x07, 0x7f, 0x6f];
const LETTER_S: u8 = 0x6d;
const LETTER_T: u8 = 0x81;
const LETTER_O: u8 = 0x3f;
const LETTER_P: u8 = 0x73;

/// A glyph of strokes in a box of a size, read from positive x: the reader's right is positive y.
fn glyph(mesh: &mut Mesh, colour: [u8; 3], centre: Vec3, segments: u8, size: Vec2) {
    let (w, h, t) = (0.5 * size.x, 0.5 * size.y, 0.11 * size.y);
    // Strokes as (right, up) from the middle, in the reader's directions.
    let strokes = [
        [-w, h - t, w, h],
        [w - t, 0.0, w, h],
        [w - t, -h, w, 0.0],
        [-w, -h, w, -h + t],
        [-w, -h, -w + t, 0.0],
        [-w, 0.0, -w + t, h],
        [-w, -0.5 * t, w, 0.5 * t],
        [-0.5 * t, -h, 0.5 * t, h],
    ];
    for (bit, [x0, z0, x1, z1]) in strokes.into_iter().enumerate() {
        if segments >> bit & 1 == 1 {
            let at = |x: f32, z: f32| centre + Vec3::new(0.0, x, z);
            mesh.polygon(face(colour), &[at(x0, z0), at(x1, z0), at(x1, z1), at(x0, z1)]);
        }
    }
}
