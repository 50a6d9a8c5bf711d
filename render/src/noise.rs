//! One tileable texture of noise: grain in red, clouds in green.

use crate::mesh::variety::Variety;

/// Side of the texture in texels.
pub(crate) const SIDE: u32 = 256;

/// Texels of each mip level, two bytes a texel, from the finest to a single one.
pub(crate) fn levels() -> Vec<Vec<u8>> {
    let mut levels = vec![finest()];
    let mut side = SIDE as usize;
    while side > 1 {
        let halved = halve(&levels[levels.len() - 1], side);
        levels.push(halved);
        side /= 2;
    }
    levels
}

fn finest() -> Vec<u8> {
    let grain = octaves(&[(256, 0.5), (128, 0.5), (64, 0.35), (32, 0.2)], 1);
    let clouds = octaves(&[(4, 1.0), (8, 0.6), (16, 0.36), (32, 0.22), (64, 0.13), (128, 0.07)], 2);
    grain.iter().zip(&clouds).flat_map(|(&g, &c)| [g, c]).collect()
}

/// A sum of lattices with (cells, weight), stretched to the range of a byte.
fn octaves(parts: &[(u32, f32)], seed: u32) -> Vec<u8> {
    let mut sum = vec![0.0f32; (SIDE * SIDE) as usize];
    for &(cells, weight) in parts {
        let lattice = lattice(cells, seed * 1000 + cells);
        for (i, value) in sum.iter_mut().enumerate() {
            let (x, y) = (i as u32 % SIDE, i as u32 / SIDE);
            *value += weight * between(&lattice, cells, x, y);
        }
    }
    let (low, high) = sum.iter().fold((f32::MAX, f32::MIN), |(l, h), &v| (l.min(v), h.max(v)));
    sum.iter().map(|v| ((v - low) / (high - low) * 255.0) as u8).collect()
}

fn lattice(cells: u32, seed: u32) -> Vec<f32> {
    let mut variety = Variety::of(seed);
    (0..cells * cells).map(|_| variety.between(0.0, 1.0)).collect()
}

/// Smooth interpolation in a lattice that repeats.
fn between(lattice: &[f32], cells: u32, x: u32, y: u32) -> f32 {
    let split = |p: u32| {
        let at = (p * cells) as f32 / SIDE as f32;
        let t = at - at.floor();
        (at as u32, t * t * (3.0 - 2.0 * t))
    };
    let ((cx, tx), (cy, ty)) = (split(x), split(y));
    let at = |x: u32, y: u32| lattice[((y % cells) * cells + x % cells) as usize];
    let row = |y: u32| at(cx, y) + (at(cx + 1, y) - at(cx, y)) * tx;
    row(cy) + (row(cy + 1) - row(cy)) * ty
}

fn halve(texels: &[u8], side: usize) -> Vec<u8> {
    let at = |x: usize, y: usize, c: usize| u32::from(texels[2 * (y * side + x) + c]);
    let half = side / 2;
    let mean = |i: usize| {
        let (c, x, y) = (i % 2, 2 * (i / 2 % half), 2 * (i / 2 / half));
        ((at(x, y, c) + at(x + 1, y, c) + at(x, y + 1, c) + at(x + 1, y + 1, c) + 2) / 4) as u8
    };
    (0..2 * half * half).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_shrink_to_one_grey_texel() {
        let levels = levels();
        assert_eq!(levels.len(), 9);
        assert!(levels.iter().enumerate().all(|(i, l)| l.len() == 2 << (2 * (8 - i))));
        assert!(levels[8].iter().all(|&v| (90..165).contains(&v)), "{:?}", levels[8]);
    }
}
