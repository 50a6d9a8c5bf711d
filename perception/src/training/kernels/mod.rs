//! The loops that training spends its time in and that burn's own operations are slow at: depthwise
//! convolution, batch normalisation and the loss, with their derivatives, over maps whose channels
//! lie next to each other. Single-threaded; replicas use the cores.

pub(super) mod depthwise;
pub(super) mod loss;
pub(super) mod norm;
pub(super) mod patches;

/// Deviation of derivatives from differences, for tests.
#[cfg(test)]
pub(super) fn worst_derivative(x: &[f32], derivative: &[f32], mut f: impl FnMut(&[f32]) -> f64) -> f64 {
    const STEP: f32 = 1e-2;
    let mut difference = |i: usize| {
        let mut moved = x.to_vec();
        moved[i] = x[i] + STEP;
        let up = f(&moved);
        moved[i] = x[i] - STEP;
        (up - f(&moved)) / f64::from(2.0 * STEP)
    };
    (0..x.len()).map(|i| (difference(i) - f64::from(derivative[i])).abs()).fold(0.0, f64::max)
}
