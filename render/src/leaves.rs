//! The textures of leaves: which texels are leaf, in red, and how bright, in green, where 128 is as bright as their paint.

use core::f32::consts::TAU;

use glam::Vec2;
use kernel::ops;

use crate::mesh::foliage::Leaf;
use crate::mesh::variety::Variety;

/// Side of a layer in texels.
pub const SIDE: u32 = 128;

/// What is this or more is leaf, in `leaf.wgsl` too.
pub const THRESHOLD: u8 = 128;

/// One layer for each [`Leaf`]; of each its mip levels, two bytes a texel, from the finest to a single one.
pub fn layers() -> Vec<Vec<Vec<u8>>> {
    Leaf::ALL.into_iter().map(levels).collect()
}

fn levels(leaf: Leaf) -> Vec<Vec<u8>> {
    let mut levels = vec![finest(leaf)];
    let most = share(&levels[0]);
    let mut side = SIDE as usize;
    while side > 1 {
        let halved = halve(&levels[levels.len() - 1], side);
        levels.push(halved);
        side /= 2;
    }
    levels.iter_mut().skip(1).for_each(|level| keep_share(level, most));
    levels
}

/// One blade in its layer, whose side is 1.
struct Blade {
    foot: Vec2,
    /// From its foot to its tip.
    along: Vec2,
    /// Half of its width.
    half: f32,
    /// 1 is as bright as its paint.
    light: f32,
}

fn finest(leaf: Leaf) -> Vec<u8> {
    let mut variety = Variety::of(leaf as u32 + 77);
    let (blades, repeats) = match leaf {
        Leaf::Broad => (cluster(&mut variety, 110, 0.15, 0.42), false),
        Leaf::Small => (cluster(&mut variety, 170, 0.105, 0.42), false),
        Leaf::Needle => (spray(&mut variety), false),
        Leaf::Clipped => (carpet(&mut variety), true),
    };
    let mut texels = [0, 90].repeat((SIDE * SIDE) as usize);
    for blade in &blades {
        draw(&mut texels, blade, repeats);
    }
    texels
}

/// Leaves around the middle of a layer that point away from it.
fn cluster(variety: &mut Variety, count: u32, length: f32, slim: f32) -> Vec<Blade> {
    let blade = |k: u32| {
        // Those on top, in the middle, are drawn last and are the brightest.
        let out = 1.0 - k as f32 / count as f32;
        let angle = variety.between(0.0, TAU);
        let place = Vec2::splat(0.5) + Vec2::new(ops::cos(angle), ops::sin(angle)) * (0.4 * ops::pow(out, 0.6));
        let turn = angle + variety.between(-1.1, 1.1);
        let along = Vec2::new(ops::cos(turn), ops::sin(turn)) * (length * variety.between(0.7, 1.1));
        let light = variety.between(0.72, 1.12) + 0.16 * (1.0 - out);
        Blade { foot: place - 0.35 * along, along, half: slim * 0.5 * length, light }
    };
    (0..count).map(blade).collect()
}

/// A twig along the layer with needles to both sides.
fn spray(variety: &mut Variety) -> Vec<Blade> {
    let twig = |from: Vec2, to: Vec2| Blade { foot: from, along: to - from, half: 0.012, light: 0.6 };
    let mut blades = Vec::new();
    let tip = Vec2::new(0.94, 0.5);
    for (side, reach) in [(0.0, 0.0), (1.0, 0.26), (-1.0, 0.26), (1.0, 0.44), (-1.0, 0.44), (1.0, 0.62), (-1.0, 0.62)] {
        let from = Vec2::new(0.06 + reach, 0.5);
        let to = if side == 0.0 { tip } else { from + Vec2::new(0.26, 0.34 * side) * (1.1 - 0.7 * reach) };
        blades.push(twig(from, to));
        let count = (110.0 * from.distance(to)) as u32;
        for k in 0..count {
            let at = from.lerp(to, k as f32 / count as f32);
            let turn = if k % 2 == 0 { 0.8 } else { -0.8 };
            let turn = turn + variety.between(-0.25, 0.25);
            let turned = Vec2::new(ops::cos(turn), ops::sin(turn)).rotate((to - from).normalize_or(Vec2::X));
            let along = turned * variety.between(0.07, 0.12);
            blades.push(Blade { foot: at, along, half: 0.0085, light: variety.between(0.75, 1.2) });
        }
    }
    blades
}

/// Leaves all over a layer that repeats.
fn carpet(variety: &mut Variety) -> Vec<Blade> {
    let blade = |k: u32| {
        let foot = Vec2::new(variety.between(0.0, 1.0), variety.between(0.0, 1.0));
        let turn = variety.between(0.0, TAU);
        let along = Vec2::new(ops::cos(turn), ops::sin(turn)) * variety.between(0.1, 0.15);
        Blade { foot, along, half: 0.032, light: 0.6 + 0.5 * k as f32 / 280.0 + variety.between(-0.12, 0.12) }
    };
    (0..280).map(blade).collect()
}

/// Draws a blade, pointed at its tip, with a bright vein, over what is there.
fn draw(texels: &mut [u8], blade: &Blade, repeats: bool) {
    let side = SIDE as i32;
    let (low, high) = (blade.foot.min(blade.foot + blade.along), blade.foot.max(blade.foot + blade.along));
    let texel = |share: f32, margin: f32| (share * SIDE as f32 + margin).floor() as i32;
    let margin = blade.half * SIDE as f32 + 2.0;
    let length = blade.along.length();
    let axis = blade.along / length;
    for y in texel(low.y, -margin)..=texel(high.y, margin) {
        for x in texel(low.x, -margin)..=texel(high.x, margin) {
            let inside = |at: i32| (1..side - 1).contains(&at);
            if !(repeats || inside(x) && inside(y)) {
                continue;
            }
            let rel = (Vec2::new(x as f32, y as f32) + 0.5) / SIDE as f32 - blade.foot;
            let (t, off) = (rel.dot(axis) / length, rel.perp_dot(axis).abs());
            let width = blade.half * ops::sin(0.5 * TAU * ops::pow(t.clamp(0.0, 1.0), 0.75));
            let end = (t.min(1.0 - t)) * length;
            let cover = (0.5 + (width - off).min(end) * SIDE as f32 * 0.7).clamp(0.0, 1.0);
            let at = 2 * (y.rem_euclid(side) * side + x.rem_euclid(side)) as usize;
            texels[at] = texels[at].max((255.0 * cover) as u8);
            if cover >= 0.5 {
                let vein = if off < 0.12 * blade.half { 1.12 } else { 1.0 - 0.14 * off / blade.half };
                texels[at + 1] = (128.0 * blade.light * vein).clamp(0.0, 255.0) as u8;
            }
        }
    }
}

/// Means of four texels, of brightness that of what is leaf.
fn halve(texels: &[u8], side: usize) -> Vec<u8> {
    let half = side / 2;
    let mean = |i: usize| {
        let (x, y) = (2 * (i % half), 2 * (i / half));
        let four = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(x, y)| 2 * (y * side + x));
        let cover: u32 = four.iter().map(|at| u32::from(texels[*at])).sum();
        let light: u32 = four.iter().map(|at| (1 + u32::from(texels[*at])) * u32::from(texels[at + 1])).sum();
        [(cover / 4) as u8, (light / (4 + cover)) as u8]
    };
    (0..half * half).flat_map(mean).collect()
}

/// Share of the texels that are leaf.
fn share(texels: &[u8]) -> f32 {
    let count = texels.chunks(2).filter(|texel| texel[0] >= THRESHOLD).count();
    count as f32 / (texels.len() / 2) as f32
}

/// Scales what is leaf so that as much of a coarse level is as of the finest: crowns do not thin out with distance.
fn keep_share(texels: &mut [u8], most: f32) {
    let mut covers: Vec<u8> = texels.chunks(2).map(|texel| texel[0]).collect();
    covers.sort_unstable_by(|a, b| b.cmp(a));
    let last = ((most * covers.len() as f32).round() as usize).clamp(1, covers.len()) - 1;
    let factor = f32::from(THRESHOLD) / f32::from(covers[last].max(1));
    for cover in texels.iter_mut().step_by(2) {
        *cover = (f32::from(*cover) * factor).ceil().min(255.0) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coarse_levels_are_as_leafy_as_fine_ones() {
        for (leaf, levels) in Leaf::ALL.into_iter().zip(layers()) {
            assert_eq!(levels.len(), 8);
            let most = share(&levels[0]);
            assert!((0.25..0.95).contains(&most), "{leaf:?}: {most}");
            for level in &levels[1..5] {
                assert!((share(level) - most).abs() < 0.08, "{leaf:?}: {} and {most}", share(level));
            }
        }
    }

    #[test]
    fn leaves_end_before_the_border_but_for_those_that_repeat() {
        for (leaf, levels) in Leaf::ALL.into_iter().zip(layers()) {
            let side = SIDE as usize;
            let rim = (0..side).flat_map(|k| [k, (side - 1) * side + k, k * side, k * side + side - 1]);
            let is_bare = rim.into_iter().all(|texel| levels[0][2 * texel] == 0);
            assert_eq!(is_bare, leaf != Leaf::Clipped, "{leaf:?}");
        }
    }
}
