//! Adam (Kingma and Ba 2015) with a polynomially decaying rate.

use super::weights::Weights;
use crate::simd::vectorised;

const BETA_1: f32 = 0.9;
const BETA_2: f32 = 0.999;
const EPSILON: f32 = 1e-8;
/// Power of the decay, as in the paper's training.
const DECAY_POWER: f64 = 0.9;

/// The optimiser's memory: of every parameter, running means of the gradient and of its square.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Adam {
    pub(super) steps: u64,
    pub(super) means: Vec<Vec<f32>>,
    pub(super) squares: Vec<Vec<f32>>,
}

impl Adam {
    pub(super) fn new(weights: &Weights) -> Self {
        let zeros = || weights.parameters.iter().map(|p| vec![0.0; p.values.len()]).collect();
        Self { steps: 0, means: zeros(), squares: zeros() }
    }

    /// One step against the gradients.
    pub(super) fn step(&mut self, weights: &mut Weights, gradients: &[Vec<f32>], rate: f32) {
        self.steps += 1;
        // Beyond this many steps the corrections are 1 in single precision.
        let steps = self.steps.min(100_000) as i32;
        let rate = rate * (1.0 - BETA_2.powi(steps)).sqrt() / (1.0 - BETA_1.powi(steps));
        let memory = self.means.iter_mut().zip(&mut self.squares);
        for ((parameter, gradient), (mean, square)) in weights.parameters.iter_mut().zip(gradients).zip(memory) {
            vectorised(
                #[inline(always)]
                || {
                    let memory = mean.iter_mut().zip(square);
                    for ((value, g), (mean, square)) in parameter.values.iter_mut().zip(gradient).zip(memory) {
                        *mean += (1.0 - BETA_1) * (g - *mean);
                        *square += (1.0 - BETA_2) * (g * g - *square);
                        *value -= rate * *mean / (square.sqrt() + EPSILON);
                    }
                },
            );
        }
    }
}

/// The rate at `step` of `horizon`, from `first` down to 0.
pub(super) fn rate(first: f32, step: u64, horizon: u64) -> f32 {
    let left = 1.0 - step as f64 / horizon as f64;
    first * left.max(0.0).powf(DECAY_POWER) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_falls_to_zero() {
        assert_eq!(rate(1e-3, 0, 100), 1e-3);
        assert!((rate(1e-3, 50, 100) - 1e-3 * 0.5f32.powf(0.9)).abs() < 1e-9);
        assert_eq!(rate(1e-3, 100, 100), 0.0);
    }

    #[test]
    fn the_first_step_has_the_length_of_the_rate() {
        let mut weights = Weights::new(1);
        let before = weights.parameters[0].values[0];
        let gradients: Vec<Vec<f32>> = weights.parameters.iter().map(|p| vec![3.0; p.values.len()]).collect();
        Adam::new(&weights).step(&mut weights, &gradients, 0.01);
        assert!((before - weights.parameters[0].values[0] - 0.01).abs() < 1e-6);
    }
}
