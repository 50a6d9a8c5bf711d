//! How large the tiles are, and lines on them.

use glam::Vec2;

use crate::mesh::variety::Variety;

/// Metres across the tile of asphalt and that of paving, as `asphalt.wgsl` and `paving.wgsl` have them.
pub(crate) const ASPHALT_M: f32 = 20.48;
pub(crate) const PAVING_M: f32 = 5.12;

/// A line of so many straight ones between two places, each of which strays by up to `stray_m`. What goes round a tile closes.
pub(super) fn wandering([from, to]: [Vec2; 2], (pieces, stray_m): (u32, f32), variety: &mut Variety) -> Vec<Vec2> {
    let mut off = Vec2::ZERO;
    let place = |i: u32| {
        let share = i as f32 / pieces as f32;
        off = 0.8 * off + Vec2::new(variety.between(-stray_m, stray_m), variety.between(-stray_m, stray_m));
        from.lerp(to, share) + off * (8.0 * share * (1.0 - share)).min(1.0)
    };
    (0..=pieces).map(place).collect()
}
