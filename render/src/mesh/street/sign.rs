//! Traffic signs on their posts.

use core::f32::consts::TAU;

use glam::{Vec2, Vec3};
use kernel::map::{SIGN_BUS_STOP, SIGN_LIMIT, SIGN_STOP, SIGN_YIELD};
use kernel::ops;

use super::glyphs;
use crate::SemanticTag;
use crate::mesh::model::Detail;
use crate::mesh::{CODE_RETRO, Mesh, Paint};

const STEEL: Paint = Paint::plain(SemanticTag::Pole, [132, 136, 138]).glossy(30);
const RED: [u8; 3] = [196, 28, 32];
const WHITE: [u8; 3] = [236, 236, 232];
const BLACK: [u8; 3] = [22, 22, 24];
const BLUE: [u8; 3] = [28, 78, 160];
const YELLOW: [u8; 3] = [244, 204, 32];
const GREEN: [u8; 3] = [22, 112, 62];
const BACK: [u8; 3] = [120, 122, 124];

/// One layer of paint lies so far above the other, metres.
const LIFT_M: f32 = 0.006;

/// A sign on its post, `height_m` high, whose face looks along its x axis.
pub fn sign(variant: u32, height_m: f32, detail: Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let sides = if detail == Detail::Fine { 8 } else { 4 };
    mesh.tube(STEEL, Vec3::ZERO, Vec3::Z * height_m, 0.038, 0.038, sides);
    mesh.disc(STEEL.shaded(0.7), Vec3::Z * height_m, Vec3::Z, 0.038, sides);
    let mut face = Face { mesh: &mut mesh, centre: Vec3::new(0.06, 0.0, height_m - 0.42), detail };
    match variant {
        SIGN_STOP => face.stop(),
        SIGN_YIELD => face.give_way(),
        SIGN_BUS_STOP => face.bus_stop(),
        limit if limit >= SIGN_LIMIT => face.limit(limit - SIGN_LIMIT),
        _ => face.board(BLUE, 4, 0.4, TAU / 8.0),
    }
    mesh
}

/// What faces traffic, of a sheet that sends light back to where it came from.
fn sheet(colour: [u8; 3]) -> Paint {
    Paint::plain(SemanticTag::TrafficSign, colour).coded(CODE_RETRO)
}

/// The board of a sign in the making.
struct Face<'a> {
    mesh: &'a mut Mesh,
    centre: Vec3,
    detail: Detail,
}

impl Face<'_> {
    /// Corners around a circle.
    fn round(&self) -> u32 {
        match self.detail {
            Detail::Fine => 28,
            Detail::Coarse => 14,
            Detail::Rough => 8,
        }
    }

    /// A regular plate with a grey back, held by two clamps.
    fn board(&mut self, colour: [u8; 3], sides: u32, radius: f32, turn: f32) {
        let front = rim(self.centre, sides, radius, turn);
        let mut back: Vec<Vec3> = front.iter().map(|&p| p - Vec3::X * 0.02).collect();
        self.mesh.polygon(sheet(colour), &front);
        back.reverse();
        let grey = Paint::plain(SemanticTag::TrafficSign, BACK);
        self.mesh.polygon(grey, &back);
        if self.detail == Detail::Fine {
            for z in [-0.45 * radius, 0.45 * radius] {
                let low = Vec3::new(-0.05, -0.07, self.centre.z + z - 0.02);
                self.mesh.cuboid(grey.shaded(0.8), low, Vec3::new(self.centre.x - 0.02, 0.07, low.z + 0.04));
            }
        }
    }

    /// A layer of paint on the plate, the first or a later one.
    fn layer(&mut self, colour: [u8; 3], sides: u32, radius: f32, turn: f32, above: u32) {
        let centre = self.centre + Vec3::X * (LIFT_M * above as f32);
        self.mesh.polygon(sheet(colour), &rim(centre, sides, radius, turn));
    }

    fn write(&mut self, colour: [u8; 3], word: &str, size: Vec2, gap_m: f32, above: u32) {
        // Far away it would be smaller than a pixel.
        if self.detail != Detail::Rough {
            let centre = self.centre + Vec3::X * (LIFT_M * above as f32);
            glyphs::write(self.mesh, sheet(colour), word, centre, size, gap_m, self.detail);
        }
    }

    fn stop(&mut self) {
        let turn = TAU / 16.0;
        self.board(WHITE, 8, 0.42, turn);
        self.layer(RED, 8, 0.39, turn, 1);
        self.write(WHITE, "STOP", Vec2::new(0.125, 0.26), 0.035, 2);
    }

    fn give_way(&mut self) {
        let turn = -0.25 * TAU;
        self.board(RED, 3, 0.52, turn);
        self.layer(WHITE, 3, 0.35, turn, 1);
    }

    /// A yellow disc with a green H, and the times of departure below.
    fn bus_stop(&mut self) {
        let sides = self.round();
        self.board(GREEN, sides, 0.36, 0.0);
        self.layer(YELLOW, sides, 0.31, 0.0, 1);
        if self.detail == Detail::Fine {
            self.layer(GREEN, sides, 0.285, 0.0, 2);
            self.layer(YELLOW, sides, 0.255, 0.0, 3);
        }
        self.write(GREEN, "H", Vec2::new(0.2, 0.28), 0.0, 4);
        if self.detail != Detail::Rough {
            let low = Vec3::new(0.04, -0.17, self.centre.z - 1.0);
            self.mesh.cuboid(STEEL.shaded(0.7), low, low + Vec3::new(0.05, 0.34, 0.46));
            let at = |y: f32, z: f32| Vec3::new(0.094, y, low.z + z);
            let paper = [at(-0.14, 0.03), at(0.14, 0.03), at(0.14, 0.43), at(-0.14, 0.43)];
            self.mesh.polygon(STEEL.colour([222, 220, 206]), &paper);
        }
    }

    fn limit(&mut self, limit_kmh: u32) {
        let sides = self.round();
        self.board(RED, sides, 0.38, 0.0);
        self.layer(WHITE, sides, 0.295, 0.0, 1);
        let digits = limit_kmh.to_string();
        let width = if digits.len() > 2 { 0.128 } else { 0.175 };
        self.write(BLACK, &digits, Vec2::new(width, 0.29), 0.04, 2);
    }
}

fn rim(centre: Vec3, sides: u32, radius: f32, turn: f32) -> Vec<Vec3> {
    let corner = |i: u32| {
        let angle = turn + TAU * i as f32 / sides as f32;
        centre + Vec3::new(0.0, radius * ops::cos(angle), radius * ops::sin(angle))
    };
    (0..sides).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_reads_otherwise_and_has_a_grey_back() {
        let variants = [SIGN_STOP, SIGN_YIELD, SIGN_BUS_STOP, SIGN_LIMIT + 30, SIGN_LIMIT + 50, SIGN_LIMIT + 120, 7];
        let signs = variants.map(|variant| sign(variant, 2.6, Detail::Fine));
        for (k, mesh) in signs.iter().enumerate() {
            assert!(signs[..k].iter().all(|other| other != mesh), "{}", variants[k]);
            let sheets: Vec<i8> = mesh.vertices.iter().filter(|v| v.code == CODE_RETRO).map(|v| v.normal[0]).collect();
            assert!(!sheets.is_empty() && sheets.iter().all(|x| *x == 127), "{}", variants[k]);
            let is_back = |v: &&crate::mesh::Vertex| v.tag == SemanticTag::TrafficSign as u8 && v.normal[0] == -127;
            assert!(mesh.vertices.iter().filter(is_back).any(|v| v.colour == BACK), "{}", variants[k]);
        }
    }

    /// Digits lie on the white of the board, however many there are.
    #[test]
    fn numbers_fit_their_board() {
        for limit in [5, 30, 50, 100, 120] {
            let mesh = sign(SIGN_LIMIT + limit, 2.6, Detail::Fine);
            let ink = mesh.vertices.iter().filter(|v| v.colour == BLACK).map(|v| Vec3::from(v.position));
            let reach = ink.map(|p| Vec2::new(p.y, p.z - 2.18).length()).fold(0.0, f32::max);
            assert!((0.1..0.3).contains(&reach), "{limit}: {reach}");
        }
    }
}
