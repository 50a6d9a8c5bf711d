//! A tileable picture of four channels to draw on, and its mip levels.

use glam::{IVec2, Vec2};

/// Side of a tile in texels.
pub(crate) const SIDE: usize = 512;
/// Channels, a byte each.
pub(crate) const CHANNELS: usize = 4;

/// Texels of four channels from 0 to 1; what leaves it on one side comes in on the other.
pub(crate) struct Tile {
    /// Metres across a texel.
    texel_m: f32,
    texels: Vec<[f32; CHANNELS]>,
}

impl Tile {
    /// All of one value for each channel, so many metres across.
    pub(crate) fn new(side_m: f32, of: [f32; CHANNELS]) -> Self {
        Self { texel_m: side_m / SIDE as f32, texels: vec![of; SIDE * SIDE] }
    }

    /// Metres across a texel.
    pub(crate) fn texel_m(&self) -> f32 {
        self.texel_m
    }

    /// Fills a channel with what a place has, in metres.
    pub(crate) fn fill(&mut self, channel: usize, of: impl Fn(Vec2) -> f32) {
        for (i, texel) in self.texels.iter_mut().enumerate() {
            texel[channel] = of(Vec2::new((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5) * self.texel_m);
        }
    }

    /// Draws a line along some places over a channel, `width_m` wide.
    pub(crate) fn line(&mut self, on: (usize, f32), places: &[Vec2], width_m: f32) {
        for pair in places.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let reach = Vec2::splat(0.5 * width_m);
            self.draw(on, [a.min(b) - reach, a.max(b) + reach], |p| from_segment_m(p, [a, b]) - 0.5 * width_m);
        }
    }

    /// Draws an upright box between two corners over a channel.
    pub(crate) fn rectangle(&mut self, on: (usize, f32), [low, high]: [Vec2; 2]) {
        self.draw(on, [low, high], |p| (low - p).max(p - high).max_element());
    }

    /// Draws a disc over a channel.
    pub(crate) fn disc(&mut self, on: (usize, f32), middle: Vec2, radius_m: f32) {
        let reach = Vec2::splat(radius_m);
        self.draw(on, [middle - reach, middle + reach], |p| p.distance(middle) - radius_m);
    }

    /// Draws what lies in a box over a channel; `beyond_m` is how far a place lies outside of it.
    fn draw(&mut self, (channel, value): (usize, f32), [low, high]: [Vec2; 2], beyond_m: impl Fn(Vec2) -> f32) {
        let side = IVec2::splat(SIDE as i32);
        let (first, end) = ((low / self.texel_m).as_ivec2() - 2, (high / self.texel_m).as_ivec2() + 2);
        for cell in (first.y..end.y).flat_map(|y| (first.x..end.x).map(move |x| IVec2::new(x, y))) {
            let place = (cell.as_vec2() + 0.5) * self.texel_m;
            // Share of the texel that is covered.
            let share = (0.5 - beyond_m(place) / self.texel_m).clamp(0.0, 1.0);
            let at = cell.rem_euclid(side);
            let texel = &mut self.texels[(at.y * side.x + at.x) as usize];
            texel[channel] += (value - texel[channel]) * share;
        }
    }

    /// Bytes of each mip level, from the finest to a single texel.
    pub(crate) fn levels(self) -> Vec<Vec<u8>> {
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        let (mut levels, mut texels, mut side) = (Vec::new(), self.texels, SIDE);
        loop {
            levels.push(texels.iter().flat_map(|texel| texel.map(byte)).collect());
            if side == 1 {
                return levels;
            }
            texels = halved(&texels, side);
            side /= 2;
        }
    }
}

fn halved(texels: &[[f32; CHANNELS]], side: usize) -> Vec<[f32; CHANNELS]> {
    let half = side / 2;
    let mean = |i: usize| {
        let first = 2 * (i / half) * side + 2 * (i % half);
        let four = [first, first + 1, first + side, first + side + 1];
        core::array::from_fn(|channel| 0.25 * four.iter().map(|&at| texels[at][channel]).sum::<f32>())
    };
    (0..half * half).map(mean).collect()
}

/// Distance of a place from a straight line between two.
fn from_segment_m(p: Vec2, [a, b]: [Vec2; 2]) -> f32 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
    p.distance(a + along * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leaves_a_tile_comes_in_on_the_other_side_and_no_level_loses_any() {
        let mut tile = Tile::new(51.2, [0.0, 0.5, 0.0, 0.0]);
        tile.rectangle((2, 1.0), [Vec2::new(-0.4, 10.0), Vec2::new(0.4, 11.2)]);
        let levels = tile.levels();
        let sum = |level: usize, from: usize| {
            levels[level].iter().skip(from).step_by(CHANNELS).map(|&v| u32::from(v)).sum::<u32>()
        };
        assert_eq!(levels[0][(100 * SIDE + SIDE - 1) * CHANNELS + 2], 255);
        assert_eq!([sum(0, 2), 4 * sum(1, 2), 16 * sum(2, 2)], [8 * 12 * 255; 3]);
        assert_eq!(levels.last().map(|last| (last.len(), last[1])), Some((CHANNELS, 128)));
    }
}
