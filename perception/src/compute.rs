//! What computes a network, and whether it computes what the CPU does.

use std::str::FromStr;

use crate::onnx::{ONNX_RUNTIME, Output};

/// What computes a network.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Compute {
    /// One core: the same scores every time, so that masks can be made again.
    #[default]
    Cpu,
    /// An NVIDIA GPU, through the driver (API 13.0 or later) and the libraries of CUDA and cuDNN, which
    /// are looked for when it is asked for. Operators without a kernel there are computed on the CPU.
    Cuda,
    /// The library of onnxruntime, which is looked for when it is asked for: on one core, or on an NVIDIA GPU where both the
    /// library and the machine have what that takes.
    OnnxRuntime,
}

impl Compute {
    /// Every one.
    pub const ALL: [Self; 3] = [Self::Cpu, Self::Cuda, Self::OnnxRuntime];

    /// Its name on the command line and in recordings.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Cuda => "cuda",
            Self::OnnxRuntime => ONNX_RUNTIME,
        }
    }
}

impl FromStr for Compute {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|compute| compute.name() == name);
        known.ok_or_else(|| "expected cpu, cuda or ort".into())
    }
}

/// Largest difference of scores, as a share of the largest score: GPUs multiply with 10 bits of
/// mantissa where they are left to, which is a relative error of 2^-11 a product.
const TOLERANCE: f32 = 0.02;
/// Share of class ids that may differ, where scores lie close together.
const TOLERATED_IDS: f64 = 0.01;

/// Whether two devices came to the same, but for rounding; the error says how far apart they are.
pub(crate) fn agree(expected: &Output, found: &Output) -> Result<(), String> {
    match (expected, found) {
        (Output::Scores(a), Output::Scores(b)) if a.len() == b.len() => {
            let largest = a.iter().fold(0.0_f32, |largest, score| largest.max(score.abs()));
            let differs = |(a, b): (&f32, &f32)| if b.is_nan() { f32::INFINITY } else { (a - b).abs() };
            let apart = a.iter().zip(b).map(differs).fold(0.0, f32::max);
            match apart <= TOLERANCE * largest {
                true => Ok(()),
                false => Err(format!("its scores are up to {apart} off those of the CPU, which reach {largest}")),
            }
        }
        (Output::Ids(a), Output::Ids(b)) if a.len() == b.len() => {
            let differ = a.iter().zip(b).filter(|(a, b)| a != b).count();
            match differ as f64 <= TOLERATED_IDS * a.len() as f64 {
                true => Ok(()),
                false => Err(format!("{differ} of {} pixels have another class than on the CPU", a.len())),
            }
        }
        _ => Err("its output has another form than on the CPU".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for compute in Compute::ALL {
            assert_eq!(compute.name().parse(), Ok(compute));
        }
        assert!("gpu".parse::<Compute>().unwrap_err().contains("expected cpu, cuda or ort"));
    }

    #[test]
    fn rounding_agrees_and_anything_else_does_not() {
        let scores = |values: &[f32]| Output::Scores(values.to_vec());
        let expected = scores(&[1.0, -4.0, 0.5]);
        assert!(agree(&expected, &scores(&[1.01, -3.99, 0.5])).is_ok());
        for wrong in [&[1.0, -4.0, 0.6][..], &[1.0, f32::NAN, 0.5], &[1.0, f32::INFINITY, 0.5], &[1.0, -4.0]] {
            assert!(agree(&expected, &scores(wrong)).is_err(), "{wrong:?}");
        }
        let ids = |other: usize| Output::Ids((0..200).map(|i| i64::from(i < other)).collect());
        assert!(agree(&ids(0), &ids(2)).is_ok());
        assert!(agree(&ids(0), &ids(3)).unwrap_err().contains("3 of 200"));
        assert!(agree(&expected, &ids(0)).is_err());
    }
}
