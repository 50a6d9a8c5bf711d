//! Batch normalisation (Ioffe and Szegedy 2015) with an optional rectifier behind it.

use crate::simd::vectorised;
use crate::training::weights::{EPSILON, Moments};

/// Rows that are summed in single precision before the sum goes on in double precision.
const BLOCK: usize = 128;

/// Mean and (biased) variance of every channel.
pub(in crate::training) fn moments(x: &[f32], channels: usize) -> Moments {
    let rows = (x.len() / channels) as f64;
    let (sum, squares) = pair_sums(x, x, channels);
    let mean: Vec<f64> = sum.iter().map(|s| s / rows).collect();
    let variance = squares.iter().zip(&mean).map(|(s, m)| (s / rows - m * m).max(0.0) as f32).collect();
    Moments { mean: mean.iter().map(|m| *m as f32).collect(), variance }
}

/// Factor and summand of every channel that normalise, scale and shift at once.
pub(in crate::training) fn affine(moments: &Moments, scale: &[f32], shift: &[f32]) -> (Vec<f32>, Vec<f32>) {
    let factor: Vec<f32> = moments.variance.iter().zip(scale).map(|(v, s)| s / (v + EPSILON).sqrt()).collect();
    let summand = shift.iter().zip(&moments.mean).zip(&factor).map(|((b, m), f)| b - m * f).collect();
    (factor, summand)
}

/// `x * factor + summand`, rectified if asked for.
pub(in crate::training) fn apply(x: &[f32], factor: &[f32], summand: &[f32], relu: bool) -> Vec<f32> {
    let floor = if relu { 0.0 } else { f32::NEG_INFINITY };
    let mut y = vec![0.0; x.len()];
    vectorised(
        #[inline(always)]
        || {
            for (x, y) in x.chunks_exact(factor.len()).zip(y.chunks_exact_mut(factor.len())) {
                for (((y, x), f), s) in y.iter_mut().zip(x).zip(factor).zip(summand) {
                    *y = (x * f + s).max(floor);
                }
            }
        },
    );
    y
}

/// Derivatives by scale and shift.
pub(in crate::training) struct Derivatives {
    pub(in crate::training) scale: Vec<f32>,
    pub(in crate::training) shift: Vec<f32>,
}

/// Derivatives through normalisation and rectifier, the moments included: that by the output becomes that by the input
/// where it stands, as fresh memory for every map would take a tenth of a step.
pub(in crate::training) fn backward(
    x: &[f32],
    moments: &Moments,
    scale: &[f32],
    shift: &[f32],
    dy: &mut [f32],
    relu: bool,
) -> Derivatives {
    let channels = scale.len();
    let (factor, summand) = affine(moments, scale, shift);
    let floor = if relu { 0.0 } else { f32::NEG_INFINITY };
    let (sum_dy, sum_dy_x) = passed_sums(dy, x, &factor, &summand, floor);

    // With n = (x - mean) / deviation: dx = factor * (dy - mean(dy) - n * mean(dy * n)).
    let rows = (x.len() / channels) as f64;
    let mut derivatives = Derivatives { scale: Vec::new(), shift: Vec::new() };
    let (mut slope, mut offset) = (Vec::new(), Vec::new());
    for c in 0..channels {
        let mean = f64::from(moments.mean[c]);
        let inverse = 1.0 / f64::from(moments.variance[c] + EPSILON).sqrt();
        let d_scale = (sum_dy_x[c] - mean * sum_dy[c]) * inverse;
        let along = d_scale / rows * inverse;
        slope.push(along as f32);
        offset.push((sum_dy[c] / rows - mean * along) as f32);
        derivatives.scale.push(d_scale as f32);
        derivatives.shift.push(sum_dy[c] as f32);
    }
    vectorised(
        #[inline(always)]
        || {
            for (x, dy) in x.chunks_exact(channels).zip(dy.chunks_exact_mut(channels)) {
                let constants = factor.iter().zip(&summand).zip(&slope).zip(&offset);
                for ((dy, x), (((f, b), s), o)) in dy.iter_mut().zip(x).zip(constants) {
                    *dy = f * (passed(*dy, *x, (*f, *b), floor) - o - x * s);
                }
            }
        },
    );
    derivatives
}

/// The derivative of what a rectifier let through. Without one the floor is so low that all goes through.
#[inline(always)]
fn passed(dy: f32, x: f32, (factor, summand): (f32, f32), floor: f32) -> f32 {
    if x * factor + summand > floor { dy } else { 0.0 }
}

/// For every channel the sum of the derivatives that a rectifier let through, and of their products with `x`.
fn passed_sums(dy: &[f32], x: &[f32], factor: &[f32], summand: &[f32], floor: f32) -> (Vec<f64>, Vec<f64>) {
    block_sums(
        dy,
        x,
        factor.len(),
        #[inline(always)]
        |dy, x, sum, product| {
            let constants = factor.iter().zip(summand);
            for ((((sum, product), dy), x), (f, s)) in sum.iter_mut().zip(product).zip(dy).zip(x).zip(constants) {
                let dy = passed(*dy, *x, (*f, *s), floor);
                *sum += dy;
                *product += dy * x;
            }
        },
    )
}

/// For every channel the sum of `a` and the sum of `a * b`.
fn pair_sums(a: &[f32], b: &[f32], channels: usize) -> (Vec<f64>, Vec<f64>) {
    block_sums(
        a,
        b,
        channels,
        #[inline(always)]
        |a, b, sum, product| {
            for (((sum, product), a), b) in sum.iter_mut().zip(product).zip(a).zip(b) {
                *sum += a;
                *product += a * b;
            }
        },
    )
}

/// Two sums for every channel of what `add` makes of each pair of rows.
fn block_sums(
    a: &[f32],
    b: &[f32],
    channels: usize,
    add: impl Fn(&[f32], &[f32], &mut [f32], &mut [f32]),
) -> (Vec<f64>, Vec<f64>) {
    let (mut sums, mut products) = (vec![0.0; channels], vec![0.0; channels]);
    let (mut sum, mut product) = (vec![0.0; channels], vec![0.0; channels]);
    for (a, b) in a.chunks(BLOCK * channels).zip(b.chunks(BLOCK * channels)) {
        sum.fill(0.0);
        product.fill(0.0);
        vectorised(
            #[inline(always)]
            || {
                for (a, b) in a.chunks_exact(channels).zip(b.chunks_exact(channels)) {
                    add(a, b, &mut sum, &mut product);
                }
            },
        );
        for (total, block) in sums.iter_mut().chain(&mut products).zip(sum.iter().chain(&product)) {
            *total += f64::from(*block);
        }
    }
    (sums, products)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::kernels::worst_derivative;
    use crate::training::random::Random;

    const CHANNELS: usize = 3;

    /// The definition in double precision, weighted by `dy` and summed.
    fn oracle(x: &[f32], scale: &[f32], shift: &[f32], dy: &[f32], relu: bool) -> f64 {
        (0..CHANNELS)
            .map(|c| {
                let of = |v: &[f32]| v.iter().skip(c).step_by(CHANNELS).map(|v| f64::from(*v)).collect::<Vec<_>>();
                let (x, dy) = (of(x), of(dy));
                let n = x.len() as f64;
                let mean = x.iter().sum::<f64>() / n;
                let variance = x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n + f64::from(EPSILON);
                let y = x.iter().map(|x| f64::from(scale[c]) * (x - mean) / variance.sqrt() + f64::from(shift[c]));
                y.zip(dy).map(|(y, dy)| if relu { y.max(0.0) * dy } else { y * dy }).sum::<f64>()
            })
            .sum()
    }

    #[test]
    fn agrees_with_the_definition_and_with_differences() {
        let mut random = Random::new(&[3]);
        let mut draw = |n: usize, at: f32| -> Vec<f32> { (0..n).map(|_| at + random.normal()).collect() };
        let (x, dy) = (draw(40 * CHANNELS, 2.0), draw(40 * CHANNELS, 0.0));
        // The rectifier's bend is kept away from: differences would straddle it.
        for (relu, at) in [(false, 0.0), (true, 9.0), (true, -9.0)] {
            let (scale, shift) = (draw(CHANNELS, 0.0), vec![at; CHANNELS]);
            let moments = moments(&x, CHANNELS);
            let (factor, summand) = affine(&moments, &scale, &shift);
            let y = apply(&x, &factor, &summand, relu);
            let value: f64 = y.iter().zip(&dy).map(|(y, dy)| f64::from(y * dy)).sum();
            assert!((value - oracle(&x, &scale, &shift, &dy, relu)).abs() < 1e-3);
            let mut dx = dy.clone();
            let d = backward(&x, &moments, &scale, &shift, &mut dx, relu);
            assert!(worst_derivative(&x, &dx, |x| oracle(x, &scale, &shift, &dy, relu)) < 1e-3);
            assert!(worst_derivative(&scale, &d.scale, |s| oracle(&x, s, &shift, &dy, relu)) < 1e-3);
            assert!(worst_derivative(&shift, &d.shift, |s| oracle(&x, &scale, s, &dy, relu)) < 1e-3);
        }
    }
}
