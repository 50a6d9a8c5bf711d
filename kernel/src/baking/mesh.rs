//! Triangles of each material, collected.

use glam::Vec3;

use super::rounding::snap3;
use crate::map_data::{Surface, SurfaceKind};

/// Height of paint above the surface: enough for a depth buffer at 100 m, too little to see.
pub(super) const PAINT_M: f32 = 16.0 / 1024.0;

/// A strip of surface is cut at least this often, metres.
const MAX_QUAD_M: f32 = 24.0;
/// A strip of this many ribs is cut, however short it is.
const MAX_RIBS: usize = 256;
/// An edge that strays less than this from a line is straight, metres.
const STRAIGHT_M: f32 = 0.003;

/// A surface for each material.
pub(super) struct Meshes(Vec<Surface>);

impl Meshes {
    pub fn new() -> Self {
        let empty = |&kind| Surface { kind, positions: Vec::new(), triangles: Vec::new() };
        Self(SurfaceKind::ALL.iter().map(empty).collect())
    }

    pub fn of(&mut self, kind: SurfaceKind) -> &mut Surface {
        &mut self.0[kind as usize]
    }

    pub fn finish(self) -> impl Iterator<Item = Surface> {
        self.0.into_iter().filter(|s| !s.triangles.is_empty())
    }
}

impl Surface {
    /// Adds corners in counter-clockwise order as a fan; slivers are left out.
    pub(super) fn fan(&mut self, corners: &[Vec3]) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners.iter().map(|&c| snap3(c)));
        for k in 1..corners.len().saturating_sub(1) as u32 {
            self.triangle([first, first + k, first + k + 1]);
        }
    }

    /// Adds a strip of (left, right) ribs; where it folds in a tight bend, without the fold.
    pub(super) fn strip(&mut self, ribs: &[[Vec3; 2]]) {
        for pair in ribs.windows(2) {
            let quad = [pair[0][1], pair[1][1], pair[1][0], pair[0][0]];
            let faces_up = |a: usize, b: usize, c: usize| (quad[b] - quad[a]).cross(quad[c] - quad[a]).z > 0.0;
            match (faces_up(0, 1, 2), faces_up(0, 2, 3)) {
                (true, true) => self.fan(&quad),
                (true, false) => self.fan(&quad[..3]),
                (false, true) => self.fan(&[quad[0], quad[2], quad[3]]),
                (false, false) => {}
            }
        }
    }

    fn triangle(&mut self, t: [u32; 3]) {
        let [a, b, c] = t.map(|v| self.positions[v as usize]);
        if (b - a).cross(c - a).length_squared() > 1e-8 {
            self.triangles.push(t);
        }
    }
}

/// Leaves out ribs between which a strip is straight.
pub(super) fn thinned(ribs: &[[Vec3; 2]]) -> Vec<[Vec3; 2]> {
    let mut kept: Vec<[Vec3; 2]> = Vec::new();
    let mut from = 0;
    for k in 0..ribs.len() {
        let is_end = k == 0 || k + 1 == ribs.len();
        if is_end || !is_straight(&ribs[from..=k + 1]) {
            kept.push(ribs[k]);
            from = k;
        }
    }
    kept
}

/// Whether a strip without its inner ribs keeps its shape, and is not too long for its light and fog.
fn is_straight(ribs: &[[Vec3; 2]]) -> bool {
    let (first, last) = (ribs[0], ribs[ribs.len() - 1]);
    let edge = |side: usize| {
        let along = last[side] - first[side];
        let squared = along.length_squared().max(1e-6);
        squared < MAX_QUAD_M * MAX_QUAD_M
            && ribs.iter().all(|rib| {
                let off = rib[side] - first[side];
                (off - along * (off.dot(along) / squared)).length_squared() < STRAIGHT_M * STRAIGHT_M
            })
    };
    ribs.len() < MAX_RIBS && edge(0) && edge(1)
}
