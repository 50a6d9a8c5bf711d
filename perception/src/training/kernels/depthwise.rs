//! Depthwise 3x3 convolution: each channel by itself.

use crate::simd::vectorised;
use crate::training::network::Size;

/// Which inputs meet which taps: padding equals dilation.
#[derive(Clone, Copy, Debug)]
pub(in crate::training) struct Geometry {
    /// Of one input map.
    pub(in crate::training) input: Size,
    pub(in crate::training) stride: usize,
    pub(in crate::training) dilation: usize,
}

impl Geometry {
    /// Of one output map.
    pub(in crate::training) fn output(self) -> Size {
        self.input.strided(self.stride)
    }

    /// Calls back with (tap, start of the input's channels) for each tap of an output position that
    /// lies inside.
    #[inline(always)]
    fn taps(self, row: usize, col: usize, mut visit: impl FnMut(usize, usize)) {
        let Size { rows, cols, channels } = self.input;
        for tap in 0..9 {
            let y = (row * self.stride + tap / 3 * self.dilation).wrapping_sub(self.dilation);
            let x = (col * self.stride + tap % 3 * self.dilation).wrapping_sub(self.dilation);
            if y < rows && x < cols {
                visit(tap, (y * cols + x) * channels);
            }
        }
    }
}

/// Maps of [`Geometry::output`] from maps of the input's size and 9 rows of weights.
pub(in crate::training) fn forward(x: &[f32], weights: &[f32], geometry: Geometry) -> Vec<f32> {
    let (input, output) = (geometry.input, geometry.output());
    let channels = input.channels;
    let images = x.len() / (input.area() * channels);
    let mut y = vec![0.0; images * output.area() * channels];
    vectorised(
        #[inline(always)]
        || {
            let maps = x.chunks_exact(input.area() * channels);
            for (x, y) in maps.zip(y.chunks_exact_mut(output.area() * channels)) {
                for (i, y) in y.chunks_exact_mut(channels).enumerate() {
                    geometry.taps(i / output.cols, i % output.cols, |tap, from| {
                        accumulate(y, &x[from..][..channels], &weights[tap * channels..][..channels]);
                    });
                }
            }
        },
    );
    y
}

/// Derivatives by the input and by the weights from those by the output.
pub(in crate::training) fn backward(
    x: &[f32],
    weights: &[f32],
    dy: &[f32],
    geometry: Geometry,
) -> (Vec<f32>, Vec<f32>) {
    let (input, output) = (geometry.input, geometry.output());
    let channels = input.channels;
    let mut dx = vec![0.0; x.len()];
    let mut dw = vec![0.0; weights.len()];
    vectorised(
        #[inline(always)]
        || {
            let maps = x.chunks_exact(input.area() * channels).zip(dx.chunks_exact_mut(input.area() * channels));
            for ((x, dx), dy) in maps.zip(dy.chunks_exact(output.area() * channels)) {
                for (i, dy) in dy.chunks_exact(channels).enumerate() {
                    geometry.taps(i / output.cols, i % output.cols, |tap, from| {
                        let taps = tap * channels..(tap + 1) * channels;
                        accumulate(&mut dx[from..][..channels], dy, &weights[taps.clone()]);
                        accumulate(&mut dw[taps], dy, &x[from..][..channels]);
                    });
                }
            }
        },
    );
    (dx, dw)
}

#[inline(always)]
fn accumulate(sum: &mut [f32], a: &[f32], b: &[f32]) {
    for ((sum, a), b) in sum.iter_mut().zip(a).zip(b) {
        *sum += a * b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::kernels::worst_derivative;
    use crate::training::random::Random;

    /// The definition, position by position.
    fn oracle(x: &[f32], w: &[f32], g: Geometry) -> Vec<f32> {
        let (Size { rows, cols, channels }, out) = (g.input, g.output());
        let mut y = Vec::new();
        for (n, r, c, k) in (0..x.len() / (rows * cols * channels)).flat_map(|n| {
            (0..out.rows).flat_map(move |r| (0..out.cols).flat_map(move |c| (0..channels).map(move |k| (n, r, c, k))))
        }) {
            let mut sum = 0.0;
            for (i, j) in (0..3i32).flat_map(|i| (0..3i32).map(move |j| (i, j))) {
                let row = (r * g.stride) as i32 + (i - 1) * g.dilation as i32;
                let col = (c * g.stride) as i32 + (j - 1) * g.dilation as i32;
                if (0..rows as i32).contains(&row) && (0..cols as i32).contains(&col) {
                    let at = ((n * rows + row as usize) * cols + col as usize) * channels + k;
                    sum += x[at] * w[(3 * i + j) as usize * channels + k];
                }
            }
            y.push(sum);
        }
        y
    }

    #[test]
    fn agrees_with_the_definition_and_with_differences() {
        for (stride, dilation) in [(1, 1), (2, 1), (1, 4)] {
            let g = Geometry { input: Size { rows: 4, cols: 6, channels: 3 }, stride, dilation };
            let mut random = Random::new(&[stride as u64, dilation as u64]);
            let mut draw = |n: usize| -> Vec<f32> { (0..n).map(|_| random.normal()).collect() };
            let (x, w) = (draw(2 * 72), draw(27));
            let y = forward(&x, &w, g);
            let expected = oracle(&x, &w, g);
            assert_eq!(y.len(), expected.len());
            assert!(y.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-5));
            let dy = draw(y.len());
            let (dx, dw) = backward(&x, &w, &dy, g);
            let dot = |y: &[f32]| y.iter().zip(&dy).map(|(a, b)| f64::from(a * b)).sum::<f64>();
            assert!(worst_derivative(&x, &dx, |x| dot(&oracle(x, &w, g))) < 1e-3);
            assert!(worst_derivative(&w, &dw, |w| dot(&oracle(&x, w, g))) < 1e-3);
        }
    }
}
