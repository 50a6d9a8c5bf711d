//! The innermost loop of convolutions: a tile of output pixels times a panel of output channels, held in registers.

use macerator::{Scalar, Simd, Vector};

use super::activation::Ready;
use crate::simd::{load, store};

/// Output channels that a panel is padded to.
pub const PANEL: usize = 16;

/// What a tile is made of. Offsets and lengths are in floats.
#[derive(Clone, Copy)]
pub struct Tile<'a> {
    /// Input pixels, channels last.
    pub x: &'a [f32],
    /// Where the runs lie from the start of a pixel's window.
    pub runs: &'a [usize],
    /// Length of a run: neighbouring inputs that belong to neighbouring weights.
    pub length: usize,
    /// Weights of the panel: for each input a row as wide as the panel.
    pub weights: &'a [f32],
    pub bias: &'a [f32],
    pub activation: Ready<'a>,
    /// The panel's first output channel.
    pub channel: usize,
    /// Output channels of the panel without its padding.
    pub channels: usize,
    /// Output channels of a pixel.
    pub stride: usize,
}

impl Tile<'_> {
    /// Computes `PIXELS` output pixels whose windows begin at `starts`, in a panel of `VECTORS` vectors. `y` and `more`, which
    /// is added, begin with the first pixel; as many pixels are written as they hold.
    #[inline(always)]
    pub fn run<S: Simd, const PIXELS: usize, const VECTORS: usize>(
        &self,
        starts: &[usize; PIXELS],
        y: &mut [f32],
        more: Option<&[f32]>,
    ) {
        let width = VECTORS * f32::lanes::<S>();
        let bias: [Vector<S, f32>; VECTORS] = vectors(self.bias);
        let mut sums = [bias; PIXELS];
        for (run, weights) in self.runs.iter().zip(self.weights.chunks_exact(self.length * width)) {
            let inputs: [&[f32]; PIXELS] = std::array::from_fn(|pixel| &self.x[starts[pixel] + run..][..self.length]);
            for (k, weights) in weights.chunks_exact(width).enumerate() {
                let weights: [Vector<S, f32>; VECTORS] = vectors(weights);
                for (sums, inputs) in sums.iter_mut().zip(&inputs) {
                    let input = inputs[k].splat::<S>();
                    for (sum, weight) in sums.iter_mut().zip(weights) {
                        *sum = input.mul_add(weight, *sum);
                    }
                }
            }
        }
        for (pixel, (sums, y)) in sums.into_iter().zip(y.chunks_exact_mut(self.stride)).enumerate() {
            let more = more.map(|more| &more[pixel * self.stride + self.channel..]);
            self.finish(sums, &mut y[self.channel..], more);
        }
    }

    /// Writes the sums of one pixel.
    #[inline(always)]
    fn finish<S: Simd, const VECTORS: usize>(
        &self,
        sums: [Vector<S, f32>; VECTORS],
        y: &mut [f32],
        more: Option<&[f32]>,
    ) {
        let lanes = f32::lanes::<S>();
        for (v, sum) in sums.into_iter().enumerate() {
            let from = v * lanes;
            let count = self.channels.saturating_sub(from).min(lanes);
            if count == lanes {
                let sum = match more {
                    Some(more) => sum + load::<S>(&more[from..]),
                    None => sum,
                };
                store(self.activation.apply(sum, self.channel + from), &mut y[from..]);
            } else if count > 0 {
                let mut values = [0.0; PANEL];
                if let Some(more) = more {
                    values[..count].copy_from_slice(&more[from..][..count]);
                }
                // Without one, zeros are added.
                let sum = sum + load::<S>(&values);
                store(self.activation.apply(sum, self.channel + from), &mut values);
                y[from..][..count].copy_from_slice(&values[..count]);
            }
        }
    }
}

#[inline(always)]
fn vectors<S: Simd, const N: usize>(values: &[f32]) -> [Vector<S, f32>; N] {
    std::array::from_fn(|v| load::<S>(&values[v * f32::lanes::<S>()..]))
}
