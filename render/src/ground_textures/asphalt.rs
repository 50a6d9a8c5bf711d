//! What years leave on asphalt.

use glam::{IVec2, Vec2};
use kernel::ops;

use super::plan::{ASPHALT_M, wandering};
use crate::mesh::variety::Variety;
use crate::tile::Tile;

/// Channels: cracks and joints that were sealed, tone (one half is that of the road around), iron of covers, and the net of
/// hairlines where a road is worn out.
const SEALED: usize = 0;
const TONE: usize = 1;
const IRON: usize = 2;
const HAIRLINES: usize = 3;

/// Width of the bitumen over a crack, metres.
const SEAL_M: f32 = 0.055;
/// Meshes of the net of hairlines across a tile.
const MESHES: i32 = 72;

/// Along the road is the first axis, across it the second; the middle of a lane is at 0.
pub(super) fn drawn() -> Tile {
    let mut tile = Tile::new(ASPHALT_M, [0.0, 0.5, 0.0, 0.0]);
    patches(&mut tile);
    cracks(&mut tile, &mut Variety::of(7));
    tile.fill(HAIRLINES, hairline);
    cover(&mut tile, Vec2::new(15.2, 0.45));
    tile
}

/// Patches where the road was opened, with their sealed edges; some of them trenches along it. None lies over the edge of the
/// tile, as not every tile shows them.
fn patches(tile: &mut Tile) {
    for (low, high, tone) in PATCHES {
        let [low, high] = [low, high].map(Vec2::from_array);
        tile.rectangle((TONE, tone), [low, high]);
        let outline = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y), low];
        tile.line((SEALED, 0.55), &outline, 0.04);
    }
}

/// Corners and tone of each patch.
const PATCHES: [([f32; 2], [f32; 2], f32); 7] = [
    ([2.1, 0.2], [4.9, 1.5], 0.30),
    ([9.0, 0.35], [15.5, 1.15], 0.36),
    ([17.3, 2.2], [18.6, 4.6], 0.70),
    ([6.2, 3.9], [10.8, 5.6], 0.34),
    ([12.4, 8.6], [13.3, 12.2], 0.28),
    ([0.5, 7.4], [3.6, 8.6], 0.66),
    ([15.0, 15.2], [19.0, 17.0], 0.33),
];

/// Across the road they run from one side to the other, along it where two lanes were joined.
fn cracks(tile: &mut Tile, variety: &mut Variety) {
    let mut crack = |from: [f32; 2], to: [f32; 2], (pieces, stray_m): (u32, f32)| {
        let line = wandering([from, to].map(Vec2::from_array), (pieces, stray_m), variety);
        tile.line((SEALED, 1.0), &line, SEAL_M);
    };
    for x in [6.3, 11.6, 19.4] {
        crack([x, 0.0], [x, ASPHALT_M], (60, 0.09));
    }
    for y in [1.8, 5.2, 12.3] {
        crack([0.0, y], [ASPHALT_M, y], (70, 0.05));
    }
    for (from, to) in [([0.8, -2.4], [5.6, -0.9]), ([8.0, 1.2], [11.2, 2.9]), ([13.1, 4.2], [17.0, 3.3])] {
        crack(from, to, (26, 0.1));
    }
}

/// A round cover in its frame. The groove between is part of it: where no cover is shown there is none either.
fn cover(tile: &mut Tile, middle: Vec2) {
    const FRAME_M: f32 = 0.4;
    tile.disc((SEALED, 0.0), middle, FRAME_M + 0.1);
    for (iron, radius_m) in [(1.0, FRAME_M), (0.55, 0.34), (0.95, 0.29)] {
        tile.disc((IRON, iron), middle, radius_m);
    }
}

/// Edges between the cells around places that are strewn on a grid (Worley 1996), where the tile is worn.
fn hairline(place: Vec2) -> f32 {
    let at = place * (MESHES as f32 / ASPHALT_M);
    let mut nearest = [f32::MAX; 2];
    for k in 0..9 {
        let cell = at.as_ivec2() + IVec2::new(k % 3 - 1, k / 3 - 1);
        let seed = cell.rem_euclid(IVec2::splat(MESHES)).as_uvec2();
        let mut variety = Variety::of(seed.x * 977 + seed.y);
        let point = cell.as_vec2() + Vec2::new(variety.between(0.0, 1.0), variety.between(0.0, 1.0));
        let distance = point.distance(at);
        nearest = [nearest[0].min(distance), nearest[1].min(nearest[0].max(distance))];
    }
    let turn = place * (core::f32::consts::TAU / ASPHALT_M);
    let waves = [2.0 * turn.x + 1.0, 3.0 * turn.y + 1.6, turn.x + 2.0 * turn.y].map(ops::sin);
    let worn = 0.55 * waves.iter().sum::<f32>();
    (1.0 - (nearest[1] - nearest[0]) / 0.16).clamp(0.0, 1.0) * worn.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_lie_within_the_tile() {
        let is_within = |[x, y]: [f32; 2]| [x, y].into_iter().all(|m| (0.1..ASPHALT_M - 0.1).contains(&m));
        assert!(PATCHES.iter().all(|(low, high, _)| is_within(*low) && is_within(*high)));
    }
}
