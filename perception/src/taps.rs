//! Where a resampled pixel comes from: two neighbours and a weight (bilinear), or one of them (nearest).

/// How coarse scores are enlarged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Enlarge {
    /// Bilinear; the outermost edges coincide.
    HalfPixel,
    /// Bilinear; the outermost pixel centres coincide.
    AlignCorners,
    /// Every pixel is the source pixel that its upper left corner lies in.
    Nearest,
}

/// For each output pixel along one axis: the left one of its two source pixels, and the weight of
/// the right one.
pub(crate) struct Taps {
    /// Index of the left source pixel, non-decreasing; the right one is the next.
    pub left: Vec<usize>,
    /// Weight of the right source pixel, [0, 1].
    pub weight: Vec<f32>,
}

impl Taps {
    /// From `from` to `to` pixels. With `align_corners` the outermost pixel centres coincide,
    /// else the outermost edges do (half-pixel centres, clamped at the border).
    pub fn new(from: usize, to: usize, align_corners: bool) -> Self {
        let last = (from - 1) as f64;
        let place = |i: usize| match align_corners {
            true if to == 1 => 0.0,
            true => i as f64 * last / (to - 1) as f64,
            false => ((i as f64 + 0.5) * from as f64 / to as f64 - 0.5).clamp(0.0, last),
        };
        // The last source pixel is never a left one, so that its right neighbour exists.
        let left = |i: usize| (place(i) as usize).min(from.saturating_sub(2));
        Self {
            left: (0..to).map(left).collect(),
            weight: (0..to).map(|i| (place(i) - left(i) as f64) as f32).collect(),
        }
    }

    /// The same for a way of enlarging.
    pub fn enlarging(from: usize, to: usize, how: Enlarge) -> Self {
        match how {
            Enlarge::HalfPixel => Self::new(from, to, false),
            Enlarge::AlignCorners => Self::new(from, to, true),
            Enlarge::Nearest => {
                let source = |i: usize| i * from / to;
                let left = |i: usize| source(i).min(from.saturating_sub(2));
                Self {
                    left: (0..to).map(left).collect(),
                    weight: (0..to).map(|i| (source(i) - left(i)) as f32).collect(),
                }
            }
        }
    }

    /// Index of the right source pixel of output pixel `i`, where the axis has `from` pixels.
    pub fn right(&self, i: usize, from: usize) -> usize {
        (self.left[i] + 1).min(from - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_pixel_centres_as_in_pytorch() {
        // torch.nn.functional.interpolate([0, 1, 2], size=6, mode="linear"): 0, .25, .75, 1.25, 1.75, 2
        let taps = Taps::new(3, 6, false);
        let places: Vec<f32> = taps.left.iter().zip(&taps.weight).map(|(&l, w)| l as f32 + w).collect();
        assert_eq!(places, [0.0, 0.25, 0.75, 1.25, 1.75, 2.0]);
    }

    #[test]
    fn aligned_corners_as_in_pytorch() {
        let taps = Taps::new(3, 5, true);
        let places: Vec<f32> = taps.left.iter().zip(&taps.weight).map(|(&l, w)| l as f32 + w).collect();
        assert_eq!(places, [0.0, 0.5, 1.0, 1.5, 2.0]);
    }

    #[test]
    fn nearest_as_in_pytorch() {
        // torch.nn.functional.interpolate([0, 1, 2], size=7, mode="nearest"): 0, 0, 0, 1, 1, 2, 2
        let taps = Taps::enlarging(3, 7, Enlarge::Nearest);
        let places: Vec<f32> = taps.left.iter().zip(&taps.weight).map(|(&l, w)| l as f32 + w).collect();
        assert_eq!(places, [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0]);
        assert!((0..7).all(|i| taps.right(i, 3) < 3));
    }

    #[test]
    fn neighbours_exist_for_every_pair_of_sizes() {
        for (from, to) in [(1, 1), (1, 8), (2, 3), (5, 5), (7, 2), (16, 128)] {
            for align in [false, true] {
                let taps = Taps::new(from, to, align);
                assert!((0..to).all(|i| taps.right(i, from) < from && (0.0..=1.0).contains(&taps.weight[i])));
            }
        }
    }
}
