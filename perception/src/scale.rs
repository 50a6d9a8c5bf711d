//! Pictures and scores at another size: where there are fewer pixels than before each is the mean of the area that it
//! covers, so that nothing thin is skipped; where there are more, they lie between two (half-pixel centres).

use crate::decode::Grid;
use crate::simd::vectorised;
use crate::taps::Taps;

/// From one size to another.
#[derive(Clone)]
pub(crate) struct Scale {
    columns: Vec<Window>,
    rows: Vec<Window>,
    from: (usize, usize),
}

/// Where a pixel comes from along one axis: neighbours with weights whose sum is 1.
#[derive(Clone, Debug, PartialEq)]
struct Window {
    first: usize,
    weights: Vec<f32>,
}

fn windows(from: usize, to: usize) -> Vec<Window> {
    if to < from {
        return (0..to).map(|i| area(i, from, to)).collect();
    }
    let taps = Taps::new(from, to, false);
    let window = |i: usize| {
        let (first, weight) = (taps.left[i], taps.weight[i]);
        let weights = if taps.right(i, from) > first { vec![1.0 - weight, weight] } else { vec![1.0] };
        Window { first, weights }
    };
    (0..to).map(window).collect()
}

/// What pixel `i` of `to` covers: in parts of which a source pixel has `to`, from `i * from` on, so many.
fn area(i: usize, from: usize, to: usize) -> Window {
    let (start, end) = (i * from, (i + 1) * from);
    let covered = |k: usize| (end.min((k + 1) * to) - start.max(k * to)) as f32 / from as f32;
    Window { first: start / to, weights: (start / to..end.div_ceil(to)).map(covered).collect() }
}

impl Scale {
    /// Between two sizes (width and height), unless they are the same.
    pub fn between(from: (usize, usize), to: (usize, usize)) -> Option<Self> {
        (from != to).then(|| Self { columns: windows(from.0, to.0), rows: windows(from.1, to.1), from })
    }

    /// A picture of three bytes a pixel.
    pub fn picture(&self, rgb: &[u8]) -> Vec<u8> {
        let value = |byte: u8| f32::from(byte);
        vectorised(
            #[inline(always)]
            || self.scaled(rgb, 3, value, |value| (value + 0.5) as u8),
        )
    }

    /// Scores that lie on a grid.
    pub fn scores(&self, scores: &[f32], grid: Grid) -> Vec<f32> {
        let same = |score: f32| score;
        if grid.interleaved {
            return vectorised(
                #[inline(always)]
                || self.scaled(scores, grid.channels, same, same),
            );
        }
        let planes = scores.chunks_exact(grid.width * grid.height);
        vectorised(
            #[inline(always)]
            || planes.flat_map(|plane| self.scaled(plane, 1, same, same)).collect(),
        )
    }

    /// Pixels of so many values each: first the rows that one row comes from are mixed, then its columns.
    #[inline(always)]
    fn scaled<T: Copy, U>(
        &self,
        values: &[T],
        depth: usize,
        take: impl Fn(T) -> f32,
        give: impl Fn(f32) -> U,
    ) -> Vec<U> {
        let length = self.from.0 * depth;
        let mut mixed = vec![0.0; length];
        let mut out = Vec::with_capacity(self.columns.len() * self.rows.len() * depth);
        for row in &self.rows {
            mixed.fill(0.0);
            for (line, weight) in values[row.first * length..].chunks_exact(length).zip(&row.weights) {
                mixed.iter_mut().zip(line).for_each(|(sum, value)| *sum += take(*value) * weight);
            }
            for column in &self.columns {
                let pixels = &mixed[column.first * depth..];
                out.extend((0..depth).map(|k| {
                    let pairs = pixels[k..].iter().step_by(depth).zip(&column.weights);
                    give(pairs.fold(0.0, |sum, (value, weight)| sum + value * weight))
                }));
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(scale: &Scale, values: &[u8]) -> Vec<u8> {
        let rgb: Vec<u8> = values.iter().flat_map(|&v| [v, v / 2, 0]).collect();
        let out = scale.picture(&rgb);
        assert!(out.as_chunks::<3>().0.iter().all(|p| p[2] == 0 && p[1].abs_diff(p[0] / 2) <= 1));
        out.into_iter().step_by(3).collect()
    }

    #[test]
    fn fewer_pixels_are_means_of_areas() {
        let halved = Scale::between((4, 2), (2, 1)).unwrap();
        assert_eq!(grey(&halved, &[0, 100, 200, 100, 40, 60, 0, 0]), [50, 75]);
        // Three pixels to two: each covers one and a half.
        let shares = Scale::between((3, 1), (2, 1)).unwrap();
        assert_eq!(grey(&shares, &[30, 60, 150]), [40, 120]);
        assert_eq!(area(1, 3, 2), Window { first: 1, weights: vec![1.0 / 3.0, 2.0 / 3.0] });
    }

    /// A line one pixel wide is seen wherever it is, and as bright: two neighbours of every sixteen would miss it.
    #[test]
    fn thin_things_are_not_skipped() {
        let scale = Scale::between((64, 1), (4, 1)).unwrap();
        for at in 0..64 {
            let line: Vec<u8> = (0..64).map(|x| if x == at { 240 } else { 0 }).collect();
            let seen: Vec<u8> = (0..4).map(|x| if x == at / 16 { 15 } else { 0 }).collect();
            assert_eq!(grey(&scale, &line), seen);
        }
    }

    #[test]
    fn more_pixels_lie_between_two() {
        let scale = Scale::between((2, 1), (4, 2)).unwrap();
        assert_eq!(grey(&scale, &[0, 100]), [0, 25, 75, 100].repeat(2));
        assert!(Scale::between((5, 4), (5, 4)).is_none());
    }

    #[test]
    fn weights_make_a_whole_and_a_constant_stays() {
        for (from, to) in [(1, 7), (7, 1), (5, 3), (3, 5), (1280, 256), (719, 128), (512, 511)] {
            for Window { first, weights } in windows(from, to) {
                assert!(first + weights.len() <= from && weights.iter().all(|w| *w >= 0.0));
                assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5);
            }
            let scale = Scale::between((from, 2), (to, 3)).unwrap();
            assert!(grey(&scale, &vec![200; 2 * from]).iter().all(|v| *v == 200));
        }
    }

    #[test]
    fn scores_are_scaled_however_they_lie() {
        let scale = Scale::between((4, 2), (2, 1)).unwrap();
        let grid = |interleaved| Grid { channels: 2, width: 4, height: 2, interleaved };
        let planes: Vec<f32> = (0..16).map(|i| i as f32).collect();
        let pixels: Vec<f32> = (0..8).flat_map(|i| [i as f32, i as f32 + 8.0]).collect();
        assert_eq!(scale.scores(&planes, grid(false)), [2.5, 4.5, 10.5, 12.5]);
        assert_eq!(scale.scores(&pixels, grid(true)), [2.5, 10.5, 4.5, 12.5]);
    }
}
