//! Cross-entropy at the full resolution of the labels, over bilinearly upsampled logits.

use crate::classes::{IGNORE, TRAIN_CLASSES};
use crate::simd::vectorised;
use crate::taps::Taps;
use crate::training::network::Size;

/// Number of classes; a constant, so that the loops over it unroll.
const CLASSES: usize = TRAIN_CLASSES.len();

/// What the network should have said.
#[derive(Clone, Copy, Debug)]
pub(in crate::training) struct Target<'a> {
    /// Train ids of every pixel; [`IGNORE`] counts nowhere.
    pub(in crate::training) labels: &'a [u8],
    pub(in crate::training) width: usize,
    pub(in crate::training) height: usize,
    /// How much a pixel of each class counts.
    pub(in crate::training) weights: &'a [f32; CLASSES],
}

/// The mean loss over all pixels that count, weighted, and its derivative by the logits, which are
/// maps of `size`.
pub(in crate::training) fn cross_entropy(logits: &[f32], size: Size, target: Target<'_>) -> (f64, Vec<f32>) {
    let total: f64 = target.labels.iter().map(|l| f64::from(weight(target.weights, *l))).sum();
    let inverse = if total > 0.0 { 1.0 / total } else { 0.0 };
    let weights = target.weights.map(|w| (f64::from(w) * inverse) as f32);
    let target = Target { weights: &weights, ..target };
    let mut derivative = vec![0.0; logits.len()];
    let map = size.area() * CLASSES;
    let mut loss = 0.0;
    let images = logits.chunks_exact(map).zip(derivative.chunks_exact_mut(map));
    for ((logits, derivative), labels) in images.zip(target.labels.chunks_exact(target.width * target.height)) {
        loss += image_loss(logits, derivative, size, Target { labels, ..target });
    }
    (loss, derivative)
}

fn weight(weights: &[f32; CLASSES], label: u8) -> f32 {
    if label == IGNORE { 0.0 } else { weights[usize::from(label)] }
}

fn image_loss(logits: &[f32], derivative: &mut [f32], size: Size, target: Target<'_>) -> f64 {
    let line = size.cols * CLASSES;
    let columns = Taps::new(size.cols, target.width, false);
    let rows = Taps::new(size.rows, target.height, false);
    let (mut values, mut slopes) = (vec![0.0; line], vec![0.0; line]);
    let mut loss = 0.0;
    for (y, labels) in target.labels.chunks_exact(target.width).enumerate() {
        let (low, high, share) = (rows.left[y], rows.right(y, size.rows), rows.weight[y]);
        vectorised(
            #[inline(always)]
            || {
                let lines = logits[low * line..][..line].iter().zip(&logits[high * line..][..line]);
                for (value, (low, high)) in values.iter_mut().zip(lines) {
                    *value = low + share * (high - low);
                }
                slopes.fill(0.0);
                loss += f64::from(line_loss(&values, &mut slopes, &columns, labels, target.weights));
                for (at, share) in [(low, 1.0 - share), (high, share)] {
                    for (sum, slope) in derivative[at * line..][..line].iter_mut().zip(&slopes) {
                        *sum += share * slope;
                    }
                }
            },
        );
    }
    loss
}

/// The loss of one line of pixels; adds to `slopes` its derivative by `values`.
#[inline(always)]
fn line_loss(values: &[f32], slopes: &mut [f32], columns: &Taps, labels: &[u8], weights: &[f32; CLASSES]) -> f32 {
    let mut loss = 0.0;
    for (x, label) in labels.iter().enumerate() {
        let weight = weight(weights, *label);
        if weight == 0.0 {
            continue;
        }
        let (low, share) = (columns.left[x] * CLASSES, columns.weight[x]);
        let high = columns.right(x, values.len() / CLASSES) * CLASSES;
        let mut logit = [0.0f32; CLASSES];
        for ((logit, low), high) in logit.iter_mut().zip(&values[low..][..CLASSES]).zip(&values[high..][..CLASSES]) {
            *logit = low + share * (high - low);
        }
        let (mut slope, pixel) = pixel_loss(&logit, usize::from(*label));
        loss += weight * pixel;
        for slope in &mut slope {
            *slope *= weight;
        }
        for (at, share) in [(low, 1.0 - share), (high, share)] {
            for (sum, slope) in slopes[at..][..CLASSES].iter_mut().zip(&slope) {
                *sum += share * slope;
            }
        }
    }
    loss
}

/// Derivative of a pixel's loss by its logits, and the loss.
#[inline(always)]
fn pixel_loss(logit: &[f32; CLASSES], label: usize) -> ([f32; CLASSES], f32) {
    let peak = logit.iter().fold(f32::NEG_INFINITY, |peak, l| peak.max(*l));
    let mut share = [0.0f32; CLASSES];
    for (share, logit) in share.iter_mut().zip(logit) {
        *share = exp(logit - peak);
    }
    let sum: f32 = share.iter().sum();
    let inverse = 1.0 / sum;
    for share in &mut share {
        *share *= inverse;
    }
    share[label] -= 1.0;
    (share, sum.ln() + peak - logit[label])
}

/// `e^x` for `x` of at most 0, within 3e-7 of its value; without branches, so that it vectorises.
#[inline(always)]
fn exp(x: f32) -> f32 {
    /// Adding it rounds to an integer, which then stands in the lowest bits.
    const ROUND: f32 = 12_582_912.0;
    let x = x.max(-87.0);
    let shifted = x * std::f32::consts::LOG2_E + ROUND;
    let power = (shifted.to_bits().wrapping_sub(ROUND.to_bits()).wrapping_add(127)) << 23;
    // What remains, with ln 2 in two parts (Cody and Waite 1980), in [-ln 2 / 2, ln 2 / 2].
    let n = shifted - ROUND;
    let r = x - n * 0.693_359_4 + n * 2.121_944_4e-4;
    let series = 1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r / 720.0)))));
    series * f32::from_bits(power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::training::kernels::worst_derivative;
    use crate::training::network::Resample;
    use crate::training::random::Random;
    use crate::training::resample::matrix;

    #[test]
    fn the_exponential_is_accurate() {
        for i in 0..8700 {
            let x = -(i as f32) / 100.0;
            let expected = f64::from(x).exp();
            assert!((f64::from(exp(x)) / expected - 1.0).abs() < 3e-7, "{x}");
        }
    }

    /// The definition, pixel by pixel in double precision.
    fn oracle(logits: &[f32], size: Size, target: Target<'_>) -> f64 {
        let rows = matrix(Resample::Bilinear, size.rows, target.height);
        let cols = matrix(Resample::Bilinear, size.cols, target.width);
        let (mut loss, mut total) = (0.0, 0.0);
        for (i, label) in target.labels.iter().enumerate().filter(|(_, l)| **l != IGNORE) {
            let image = i / (target.width * target.height);
            let (y, x) = (i / target.width % target.height, i % target.width);
            let logit = |k: usize| -> f64 {
                let at = |r: usize, c: usize| logits[((image * size.rows + r) * size.cols + c) * CLASSES + k];
                let weight = |r, c| f64::from(rows[y * size.rows + r]) * f64::from(cols[x * size.cols + c]);
                let positions = (0..size.rows).flat_map(|r| (0..size.cols).map(move |c| (r, c)));
                positions.map(|(r, c)| weight(r, c) * f64::from(at(r, c))).sum()
            };
            let sum: f64 = (0..CLASSES).map(|k| logit(k).exp()).sum();
            let weight = f64::from(target.weights[usize::from(*label)]);
            loss += weight * (sum.ln() - logit(usize::from(*label)));
            total += weight;
        }
        loss / total
    }

    #[test]
    fn agrees_with_the_definition_and_with_differences() {
        let size = Size { rows: 2, cols: 3, channels: CLASSES };
        let mut random = Random::new(&[5]);
        let logits: Vec<f32> = (0..2 * size.area() * CLASSES).map(|_| 3.0 * random.normal()).collect();
        let label = |random: &mut Random| {
            let id = (random.next_u64() % (CLASSES as u64 + 1)) as u8;
            if usize::from(id) == CLASSES { IGNORE } else { id }
        };
        let labels: Vec<u8> = (0..2 * 8 * 6).map(|_| label(&mut random)).collect();
        let weights: [f32; CLASSES] = std::array::from_fn(|i| 0.5 + i as f32);
        let target = Target { labels: &labels, width: 8, height: 6, weights: &weights };
        let (loss, derivative) = cross_entropy(&logits, size, target);
        assert!((loss - oracle(&logits, size, target)).abs() < 1e-5);
        assert!(worst_derivative(&logits, &derivative, |l| oracle(l, size, target)) < 1e-4);
        assert!(derivative.iter().any(|d| d.abs() > 1e-3));
    }

    #[test]
    fn pixels_that_count_nowhere_give_neither_loss_nor_slope() {
        let size = Size { rows: 1, cols: 1, channels: CLASSES };
        let target = Target { labels: &[IGNORE; 4], width: 2, height: 2, weights: &[1.0; CLASSES] };
        assert_eq!(cross_entropy(&[1.0; CLASSES], size, target), (0.0, vec![0.0; CLASSES]));
    }
}
