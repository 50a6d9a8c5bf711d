//! Stones that roads and pavements are laid with.

use glam::Vec2;

use super::plan::PAVING_M;
use crate::mesh::variety::Variety;
use crate::tile::{CHANNELS, Tile};

/// How stones are laid; the brightness of each bond is a channel, one half is that of all around.
struct Bond {
    /// Stones along a row of a tile, and rows.
    across: u32,
    rows: u32,
    /// How far every other row is moved, as a share of a stone.
    shift: f32,
    /// Width of a joint, metres, and its brightness.
    joint_m: f32,
    joint: f32,
    /// How much stones differ in brightness, and how far joints stray, as a share of a stone.
    contrast: f32,
    stray: f32,
}

/// Setts, small stones, flags in bond and square slabs.
const BONDS: [Bond; CHANNELS] = [
    Bond { across: 26, rows: 34, shift: 0.5, joint_m: 0.022, joint: 0.2, contrast: 0.2, stray: 0.12 },
    Bond { across: 52, rows: 56, shift: 0.35, joint_m: 0.014, joint: 0.28, contrast: 0.2, stray: 0.1 },
    Bond { across: 8, rows: 16, shift: 0.5, joint_m: 0.014, joint: 0.3, contrast: 0.07, stray: 0.0 },
    Bond { across: 10, rows: 10, shift: 0.0, joint_m: 0.016, joint: 0.28, contrast: 0.08, stray: 0.0 },
];

pub(super) fn drawn() -> Tile {
    let mut tile = Tile::new(PAVING_M, [0.5; CHANNELS]);
    for (channel, bond) in BONDS.iter().enumerate() {
        let texel_m = tile.texel_m();
        tile.fill(channel, |place| bond.brightness(place, texel_m));
    }
    tile
}

impl Bond {
    fn brightness(&self, place: Vec2, texel_m: f32) -> f32 {
        let stone_m = PAVING_M / Vec2::new(self.across as f32, self.rows as f32);
        let row = (place.y / stone_m.y) as u32;
        let drawn = |column: u32| Variety::of(row * 613 + column % self.across);
        let along = place.x / stone_m.x + self.shift * (row % 2) as f32;
        let (column, inside) = (along as u32, along.fract());
        let joint_after = |column: u32| self.stray * drawn(column + 900).between(-1.0, 1.0);
        let (start, end) = (joint_after(column), 1.0 + joint_after(column + 1));
        let (column, off) = if inside < start {
            (column + self.across - 1, start - inside)
        } else if inside > end {
            (column + 1, inside - end)
        } else {
            (column, (inside - start).min(end - inside))
        };
        let up = (place.y / stone_m.y).fract();
        let edge_m = (off * stone_m.x).min(up.min(1.0 - up) * stone_m.y);
        let covered = ((edge_m - 0.5 * self.joint_m) / texel_m + 0.5).clamp(0.0, 1.0);
        let stone = 0.5 * (1.0 + self.contrast * drawn(column).between(-1.0, 1.0));
        self.joint + (stone - self.joint) * covered
    }
}
