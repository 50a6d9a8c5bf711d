//! Triangles of each material, collected.

use glam::Vec3;

use super::rounding::snap3;
use crate::map_data::{Surface, SurfaceKind};

/// Height of paint above the surface: enough for a depth buffer at 100 m, too little to see.
pub(super) const PAINT_M: f32 = 16.0 / 1024.0;

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
