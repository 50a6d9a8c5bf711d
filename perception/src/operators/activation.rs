//! What becomes of a sum before it is written.

use macerator::{Scalar, Simd, Vector};
use tract_onnx::tract_hir::internal::*;

use crate::simd::load;

/// A function of one value, some with a number for each channel.
#[derive(Clone, Debug, PartialEq)]
pub enum Activation {
    None,
    /// Between two bounds: ReLU and ReLU6.
    Clamp(f32, f32),
    /// Negative values times the slope of their channel; padded with zeros to whole vectors.
    Slopes(Arc<Tensor>),
    /// `x * clamp(x / 6 + 1/2, 0, 1)`.
    HardSwish,
}

impl Activation {
    /// The function, with its numbers at hand.
    pub fn ready(&self) -> TractResult<Ready<'_>> {
        Ok(match self {
            Self::None => Ready::None,
            Self::Clamp(low, high) => Ready::Clamp(*low, *high),
            Self::Slopes(slopes) => Ready::Slopes(slopes.try_as_plain_ram()?.as_slice()?),
            Self::HardSwish => Ready::HardSwish,
        })
    }
}

/// An [`Activation`] that is about to be computed.
#[derive(Clone, Copy)]
pub enum Ready<'a> {
    None,
    Clamp(f32, f32),
    Slopes(&'a [f32]),
    HardSwish,
}

impl Ready<'_> {
    /// Of the values of neighbouring channels, the first of which is given.
    #[inline(always)]
    pub fn apply<S: Simd>(self, x: Vector<S, f32>, channel: usize) -> Vector<S, f32> {
        match self {
            Self::None => x,
            Self::Clamp(low, high) => x.max(low.splat()).min(high.splat()),
            Self::Slopes(slopes) => {
                let zero = 0.0f32.splat::<S>();
                x.min(zero).mul_add(load::<S>(&slopes[channel..]), x.max(zero))
            }
            Self::HardSwish => {
                let share = x.mul_add((1.0f32 / 6.0).splat(), 0.5f32.splat());
                x * share.max(0.0f32.splat()).min(1.0f32.splat())
            }
        }
    }

    /// Of the value of one channel.
    #[inline(always)]
    pub fn apply_one(self, x: f32, channel: usize) -> f32 {
        match self {
            Self::None => x,
            Self::Clamp(low, high) => x.max(low).min(high),
            Self::Slopes(slopes) => x.min(0.0) * slopes[channel] + x.max(0.0),
            Self::HardSwish => x * x.mul_add(1.0 / 6.0, 0.5).clamp(0.0, 1.0),
        }
    }
}
