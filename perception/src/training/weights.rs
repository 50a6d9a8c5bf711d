//! What is learned, and how it starts.

use super::network::{Graph, Kernel, Resample, Size, fast_scnn};
use super::random::Random;
use crate::classes::TRAIN_CLASSES;

/// Added to variances before their root is taken.
pub(super) const EPSILON: f32 = 1e-5;
/// Share of a step's moments in the running moments.
const MOMENTUM: f32 = 0.1;

/// A matrix of learned numbers, row by row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parameter {
    pub(super) rows: usize,
    pub(super) cols: usize,
    pub(super) values: Vec<f32>,
}

/// Mean and variance of every channel before normalisation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Moments {
    pub(super) mean: Vec<f32>,
    pub(super) variance: Vec<f32>,
}

/// Everything that a trained network consists of. Layer `i` owns the parameters `3 i` (weights),
/// `3 i + 1` (scale), `3 i + 2` (shift) and the moments `i`; the last two parameters are the
/// logits' weights and bias.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Weights {
    pub(super) parameters: Vec<Parameter>,
    /// Running means of what training saw, for use outside of training.
    pub(super) moments: Vec<Moments>,
}

impl Weights {
    /// First weights: normal with the variance of He et al. 2015, scales 1, shifts 0. The size of
    /// the pictures does not matter.
    pub(super) fn new(seed: u64) -> Self {
        let weights = Self { parameters: Vec::new(), moments: Vec::new() };
        let mut draw = Draw { random: Random::new(&[seed, 0]), weights };
        let image = Size { rows: 64, cols: 64, channels: 3 };
        fast_scnn(&mut draw, &image, TRAIN_CLASSES.len());
        draw.weights
    }

    /// Number of learned numbers.
    pub(super) fn count(&self) -> usize {
        self.parameters.iter().map(|p| p.values.len()).sum()
    }

    /// Every number, in a fixed order.
    pub(super) fn vectors(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        let moments = self.moments.iter_mut().flat_map(|m| [&mut m.mean, &mut m.variance]);
        self.parameters.iter_mut().map(|p| &mut p.values).chain(moments)
    }

    /// Moves the running moments towards those of one step.
    pub(super) fn follow(&mut self, step: &[Moments]) {
        let blend = |running: &mut [f32], new: &[f32]| {
            for (running, new) in running.iter_mut().zip(new) {
                *running += MOMENTUM * (new - *running);
            }
        };
        for (running, new) in self.moments.iter_mut().zip(step) {
            blend(&mut running.mean, &new.mean);
            blend(&mut running.variance, &new.variance);
        }
    }
}

/// Draws first weights on a walk over the network.
struct Draw {
    random: Random,
    weights: Weights,
}

impl Draw {
    fn matrix(&mut self, rows: usize, cols: usize) {
        let deviation = (2.0 / rows as f32).sqrt();
        let values = (0..rows * cols).map(|_| deviation * self.random.normal()).collect();
        self.weights.parameters.push(Parameter { rows, cols, values });
    }

    fn row(&mut self, cols: usize, value: f32) {
        self.weights.parameters.push(Parameter { rows: 1, cols, values: vec![value; cols] });
    }
}

impl Graph for Draw {
    type Node = Size;

    fn size(&self, x: &Size) -> Size {
        *x
    }

    fn layer(&mut self, x: &Size, kernel: Kernel, _relu: bool) -> Size {
        let (rows, cols) = kernel.weights(*x);
        self.matrix(rows, cols);
        self.row(cols, 1.0);
        self.row(cols, 0.0);
        self.weights.moments.push(Moments { mean: vec![0.0; cols], variance: vec![1.0; cols] });
        kernel.output(*x)
    }

    fn logits(&mut self, x: &Size, out: usize) -> Size {
        self.matrix(x.channels, out);
        self.row(out, 0.0);
        Size { channels: out, ..*x }
    }

    fn resample(&mut self, x: &Size, rows: usize, cols: usize, _how: Resample) -> Size {
        Size { rows, cols, ..*x }
    }

    fn add(&mut self, a: &Size, _b: &Size) -> Size {
        *a
    }

    fn relu(&mut self, x: &Size) -> Size {
        *x
    }

    fn spread(&mut self, x: &Size, side: usize) -> Size {
        x.spread(side)
    }

    fn concat(&mut self, parts: &[Size]) -> Size {
        Size { channels: parts.iter().map(|p| p.channels).sum(), ..parts[0] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_network_has_the_size_of_the_paper_and_follows_from_its_seed() {
        let weights = Weights::new(1);
        let count = weights.count();
        assert!((1_000_000..1_200_000).contains(&count), "{count} parameters; the paper has 1.11 million");
        assert_eq!(weights, Weights::new(1));
        assert_ne!(weights, Weights::new(2));
    }
}
