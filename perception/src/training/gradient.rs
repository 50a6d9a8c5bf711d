//! The derivatives of the whole network against differences.
//!
//! The network is told once ([`super::network`]), so it can be run by a second, slow reader that knows nothing of
//! tapes, vectors or single precision: [`Double`]. Its loss is differenced centrally in double precision, with steps
//! so short that hardly a rectifier is crossed and nearly dead channels, whose normalisation bends the most, are
//! straight along them. What remains between it and the tape is the tape's single precision.

use burn_flex::{Flex, FlexDevice};
use rayon::prelude::*;

use super::kernels::loss::Target;
use super::network::{Graph, Kernel, LOGIT_STRIDE, Resample, Size, fast_scnn};
use super::random::Random;
use super::resample::matrix;
use super::tape::learn;
use super::weights::{EPSILON, Weights};
use crate::classes::{IGNORE, TRAIN_CLASSES};

const CLASSES: usize = TRAIN_CLASSES.len();
const SIDE: usize = 64;
const IMAGES: usize = 3;
/// Least share of the whole derivative's length with which a parameter's is compared: that of a shift right before
/// another normalisation is 0, and no more than rounding is there.
const FLOOR: f64 = 1e-3;
/// Length of a step along a direction. Ten times as long, the nearly dead channels of the first layer miss by a
/// hundredth; rounding of the loss leaves 1e-9 of this one.
const STEP: f64 = 1e-6;

/// Runs the network in double precision, definition by definition.
struct Double<'a> {
    parameters: &'a [Vec<f64>],
    used: usize,
}

#[derive(Clone)]
struct Map {
    values: Vec<f64>,
    size: Size,
}

impl Map {
    fn images(&self) -> usize {
        self.values.len() / (self.size.area() * self.size.channels)
    }

    /// The channels at a position, unless it lies outside.
    fn at(&self, image: usize, row: isize, col: isize) -> Option<&[f64]> {
        let Size { rows, cols, channels } = self.size;
        let is_inside = (0..rows as isize).contains(&row) && (0..cols as isize).contains(&col);
        let position = (image * rows + row as usize) * cols + col as usize;
        is_inside.then(|| &self.values[position * channels..][..channels])
    }

    /// A map of another size, whose channels at each image, row and column are what `give` adds up.
    fn mapped(&self, size: Size, give: impl Fn(usize, usize, usize, &mut [f64])) -> Self {
        let mut values = vec![0.0; self.images() * size.area() * size.channels];
        for (i, sum) in values.chunks_exact_mut(size.channels).enumerate() {
            give(i / size.area(), i / size.cols % size.rows, i % size.cols, sum);
        }
        Self { values, size }
    }
}

impl Double<'_> {
    fn parameter(&mut self) -> Vec<f64> {
        self.used += 1;
        self.parameters[self.used - 1].clone()
    }
}

/// A 3x3 convolution padded by its dilation: calls back with tap and input channels.
fn taps(x: &Map, image: usize, (row, col): (usize, usize), dilation: isize, mut visit: impl FnMut(usize, &[f64])) {
    for tap in 0..9 {
        let (dy, dx) = (tap as isize / 3 - 1, tap as isize % 3 - 1);
        if let Some(from) = x.at(image, row as isize + dy * dilation, col as isize + dx * dilation) {
            visit(tap, from);
        }
    }
}

/// Adds the product of a row vector and a matrix.
fn product(sum: &mut [f64], row: &[f64], matrix: &[f64]) {
    for (value, weights) in row.iter().zip(matrix.chunks_exact(sum.len())) {
        sum.iter_mut().zip(weights).for_each(|(sum, w)| *sum += value * w);
    }
}

fn convolve(x: &Map, kernel: Kernel, w: &[f64]) -> Map {
    let size = kernel.output(x.size);
    x.mapped(size, |image, row, col, sum| match kernel {
        Kernel::Pointwise { .. } => {
            product(sum, x.at(image, row as isize, col as isize).unwrap(), w);
        }
        Kernel::Stem { .. } => taps(x, image, (2 * row, 2 * col), 1, |tap, from| {
            product(sum, from, &w[tap * from.len() * size.channels..]);
        }),
        Kernel::Depthwise { stride, dilation } => {
            taps(x, image, (stride * row, stride * col), dilation as isize, |tap, from| {
                let weights = &w[tap * size.channels..];
                sum.iter_mut().zip(from).zip(weights).for_each(|((sum, x), w)| *sum += x * w);
            });
        }
    })
}

fn normalise(x: &mut Map, scale: &[f64], shift: &[f64], relu: bool) {
    let channels = x.size.channels;
    let count = (x.values.len() / channels) as f64;
    for c in 0..channels {
        let mean = x.values.iter().skip(c).step_by(channels).sum::<f64>() / count;
        let variance = x.values.iter().skip(c).step_by(channels).map(|v| (v - mean).powi(2)).sum::<f64>() / count;
        let factor = scale[c] / (variance + f64::from(EPSILON)).sqrt();
        for v in x.values.iter_mut().skip(c).step_by(channels) {
            *v = (*v - mean) * factor + shift[c];
            *v = if relu { v.max(0.0) } else { *v };
        }
    }
}

impl Graph for Double<'_> {
    type Node = Map;

    fn size(&self, x: &Map) -> Size {
        x.size
    }

    fn layer(&mut self, x: &Map, kernel: Kernel, relu: bool) -> Map {
        let [weights, scale, shift] = std::array::from_fn(|_| self.parameter());
        let mut y = convolve(x, kernel, &weights);
        normalise(&mut y, &scale, &shift, relu);
        y
    }

    fn logits(&mut self, x: &Map, out: usize) -> Map {
        let [weights, bias] = std::array::from_fn(|_| self.parameter());
        let mut y = convolve(x, Kernel::Pointwise { out }, &weights);
        y.values.chunks_exact_mut(out).for_each(|row| row.iter_mut().zip(&bias).for_each(|(v, b)| *v += b));
        y
    }

    fn resample(&mut self, x: &Map, rows: usize, cols: usize, how: Resample) -> Map {
        let (down, across) = (matrix(how, x.size.rows, rows), matrix(how, x.size.cols, cols));
        x.mapped(Size { rows, cols, ..x.size }, |image, row, col, sum| {
            for (r, c) in (0..x.size.rows).flat_map(|r| (0..x.size.cols).map(move |c| (r, c))) {
                let share = f64::from(down[row * x.size.rows + r]) * f64::from(across[col * x.size.cols + c]);
                let from = x.at(image, r as isize, c as isize).unwrap();
                sum.iter_mut().zip(from).for_each(|(sum, v)| *sum += share * v);
            }
        })
    }

    fn add(&mut self, a: &Map, b: &Map) -> Map {
        Map { values: a.values.iter().zip(&b.values).map(|(a, b)| a + b).collect(), size: a.size }
    }

    fn relu(&mut self, x: &Map) -> Map {
        Map { values: x.values.iter().map(|v| v.max(0.0)).collect(), size: x.size }
    }

    fn spread(&mut self, x: &Map, side: usize) -> Map {
        let size = x.size.spread(side);
        x.mapped(size, |image, row, col, sum| {
            let from = x.at(image, (row / side) as isize, (col / side) as isize).unwrap();
            sum.copy_from_slice(&from[(row % side * side + col % side) * size.channels..][..size.channels]);
        })
    }

    fn concat(&mut self, parts: &[Map]) -> Map {
        let size = Size { channels: parts.iter().map(|p| p.size.channels).sum(), ..parts[0].size };
        parts[0].mapped(size, |image, row, col, sum| {
            let rows: Vec<&[f64]> = parts.iter().map(|p| p.at(image, row as isize, col as isize).unwrap()).collect();
            sum.copy_from_slice(&rows.concat());
        })
    }
}

/// The loss by its definition: weighted cross-entropy of bilinearly enlarged logits.
fn loss(parameters: &[Vec<f64>], pictures: &[f32], target: Target<'_>) -> f64 {
    let mut double = Double { parameters, used: 0 };
    let size = Size { rows: target.height, cols: target.width, channels: 3 };
    let image = Map { values: pictures.iter().map(|v| f64::from(*v)).collect(), size };
    let logits = fast_scnn(&mut double, &image, CLASSES);
    assert_eq!((double.used, logits.size.rows * LOGIT_STRIDE), (parameters.len(), target.height));
    let whole = double.resample(&logits, target.height, target.width, Resample::Bilinear);
    let (mut sum, mut total) = (0.0, 0.0);
    for (label, logits) in target.labels.iter().zip(whole.values.chunks_exact(CLASSES)).filter(|(l, _)| **l != IGNORE) {
        let weight = f64::from(target.weights[usize::from(*label)]);
        let peak = logits.iter().fold(f64::NEG_INFINITY, |peak, l| peak.max(*l));
        let rest: f64 = logits.iter().map(|l| (l - peak).exp()).sum();
        sum += weight * (rest.ln() + peak - logits[usize::from(*label)]);
        total += weight;
    }
    sum / total
}

/// Pictures and labels of squares, a tenth of which counts nowhere.
fn lesson(random: &mut Random) -> (Vec<f32>, Vec<u8>) {
    let (mut pictures, mut labels) = (Vec::new(), Vec::new());
    for _ in 0..IMAGES {
        let whole: [f32; 3] = std::array::from_fn(|_| random.normal());
        let squares: Vec<u64> = (0..SIDE * SIDE / 64).map(|_| random.next_u64()).collect();
        for (y, x) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (y, x))) {
            let square = squares[y / 8 * (SIDE / 8) + x / 8];
            let label = if square.is_multiple_of(10) { IGNORE } else { (square >> 8) as u8 % CLASSES as u8 };
            let colour = |c: usize| whole[c] + (square >> (16 + 8 * c) & 0xff) as f32 / 64.0 - 2.0;
            pictures.extend((0..3).map(|c| colour(c) + 0.3 * random.normal()));
            labels.push(label);
        }
    }
    (pictures, labels)
}

/// Weights of a network on its way: scales, shifts and bias that differ from channel to channel.
fn weights(random: &mut Random) -> Weights {
    let mut weights = Weights::new(3);
    for parameter in weights.parameters.iter_mut().filter(|p| p.rows == 1) {
        parameter.values.iter_mut().for_each(|v| *v += 0.3 * random.normal());
    }
    weights
}

fn dot(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum()
}

/// By how much a directional derivative misses the difference, as a share of the longer one of the difference and of
/// a derivative's usual size along such a direction.
fn miss(loss: &(impl Fn(&[Vec<f64>]) -> f64 + Sync), at: &[Vec<f64>], slope: &[Vec<f64>], along: &[Vec<f64>]) -> f64 {
    let step = STEP / dot(along, along).sqrt();
    let moved = |step: f64| -> Vec<Vec<f64>> {
        let row = |(at, along): (&Vec<f64>, &Vec<f64>)| at.iter().zip(along).map(|(a, d)| a + step * d).collect();
        at.iter().zip(along).map(row).collect()
    };
    let difference = (loss(&moved(step)) - loss(&moved(-step))) / (2.0 * step);
    let usual: f64 = slope.iter().zip(along).filter(|(_, d)| d.iter().any(|d| *d != 0.0)).map(|(s, _)| square(s)).sum();
    let usual = usual.sqrt().max(FLOOR * dot(slope, slope).sqrt());
    (dot(slope, along) - difference).abs() / difference.abs().max(usual)
}

fn square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum()
}

/// Single precision leaves up to some ten thousandths of a derivative, along all weights and along each parameter by
/// itself. A kernel whose derivative is wrong by a hundredth leaves ten times as much as this.
const TOLERANCE: f64 = 1e-3;

#[test]
fn the_derivatives_of_the_whole_network_are_its_differences() {
    let mut random = Random::new(&[11]);
    let (weights, (pictures, labels)) = (weights(&mut random), lesson(&mut random));
    let class_weights: [f32; CLASSES] = std::array::from_fn(|i| 1.0 + i as f32 / 4.0);
    let target = Target { labels: &labels, width: SIDE, height: SIDE, weights: &class_weights };
    let learned = learn::<Flex>(&weights, pictures.clone(), target, &FlexDevice);
    let double = |values: &[f32]| -> Vec<f64> { values.iter().map(|v| f64::from(*v)).collect() };
    let at: Vec<Vec<f64>> = weights.parameters.iter().map(|p| double(&p.values)).collect();
    let slope: Vec<Vec<f64>> = learned.gradients.iter().map(|g| double(g)).collect();
    let loss = |parameters: &[Vec<f64>]| loss(parameters, &pictures, target);
    assert!((learned.loss - loss(&at)).abs() < 1e-4, "{} and {}", learned.loss, loss(&at));

    let mut draw = |values: &Vec<f64>| -> Vec<f64> { values.iter().map(|_| f64::from(random.normal())).collect() };
    let zeros: Vec<Vec<f64>> = at.iter().map(|values| vec![0.0; values.len()]).collect();
    let mut directions: Vec<(String, Vec<Vec<f64>>)> =
        (0..4).map(|i| (format!("all, {i}"), at.iter().map(&mut draw).collect())).collect();
    let whole = dot(&slope, &slope).sqrt();
    for (i, slope) in slope.iter().enumerate() {
        // Along the derivative, where a wrong factor shows in full, and half as much in any direction.
        let length = square(slope).sqrt().max(FLOOR * whole);
        let along = slope.iter().zip(draw(slope)).map(|(s, r)| s / length + 0.5 * r).collect();
        let mut direction = zeros.clone();
        direction[i] = along;
        directions.push((format!("parameter {i} ({:.1e} of all)", length / whole), direction));
    }
    let misses: Vec<f64> = directions.par_iter().map(|(_, along)| miss(&loss, &at, &slope, along)).collect();
    let told: Vec<String> =
        directions.iter().zip(&misses).map(|((name, _), miss)| format!("{name}: {miss:.1e}")).collect();
    assert!(misses.iter().all(|miss| *miss < TOLERANCE), "{}", told.join("\n"));
}
