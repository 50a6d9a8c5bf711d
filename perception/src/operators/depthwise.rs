//! Depthwise convolution, channels last: every channel by itself, so that a vector holds different sums.

use macerator::{Scalar, Simd, Vector, WithSimd};
use tract_onnx::tract_hir::internal::*;

use super::activation::{Activation, Ready};
use super::window::Window;
use crate::simd::{dispatch, load, store};

/// Takes maps of `window.input` and gives maps of `window.output`, both channels last.
#[derive(Clone, Debug, PartialEq)]
pub struct Depthwise {
    pub window: Window,
    pub channels: usize,
    pub activation: Activation,
    /// For each tap the weights of all channels.
    weights: Arc<Tensor>,
    bias: Arc<Tensor>,
}

impl Eq for Depthwise {}

impl Depthwise {
    /// Of weights `OIHW` (channel, 1, row, column).
    pub fn new(window: Window, weights: &Tensor, bias: &[f32], activation: Activation) -> TractResult<Self> {
        let &[channels, 1, rows, cols] = weights.shape() else { bail!("weights of {:?}", weights.shape()) };
        let (values, taps) = (weights.try_as_plain_ram()?.as_slice::<f32>()?, rows * cols);
        let by_tap: Vec<f32> = (0..taps * channels).map(|i| values[i % channels * taps + i / channels]).collect();
        let weights = Tensor::from_shape(&[taps, channels], &by_tap)?.into_arc_tensor();
        let bias = Tensor::from_shape(&[channels], bias)?.into_arc_tensor();
        Ok(Self { window, channels, activation, weights, bias })
    }
}

impl Op for Depthwise {
    fn name(&self) -> StaticName {
        "Depthwise".into()
    }

    fn info(&self) -> TractResult<Vec<String>> {
        Ok(vec![format!("{:?}", self.window)])
    }

    op_as_typed_op!();
}

impl EvalOp for Depthwise {
    op_out_of_plan!();

    fn eval(&self, _context: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let input = args_1!(inputs);
        let ([rows, cols], [out_rows, out_cols]) = (self.window.input, self.window.output);
        let batch = input.shape().first().copied().unwrap_or(0);
        let taken = [batch, rows, cols, self.channels];
        ensure!(input.shape() == taken, "a map of {:?}, expected {taken:?}", input.shape());
        let mut output = Tensor::zero::<f32>(&[batch, out_rows, out_cols, self.channels])?;
        let offsets: Vec<usize> = self.window.taps(self.channels).collect();
        let x: &[f32] = input.try_as_plain_ram()?.as_slice()?;
        let mut plain = output.try_as_plain_ram_mut()?;
        let y: &mut [f32] = plain.as_slice_mut()?;
        let weights = self.weights.try_as_plain_ram()?.as_slice()?;
        let bias = self.bias.try_as_plain_ram()?.as_slice()?;
        let activation = self.activation.ready()?;
        let line = out_cols * self.channels;
        let images = x.chunks_exact(rows * cols * self.channels).zip(y.chunks_exact_mut(out_rows * line));
        for (x, y) in images {
            self.window.bands(x, self.channels, 0.0, |x, rows| {
                let y = &mut y[rows.start * line..rows.end * line];
                let offsets = &offsets;
                dispatch(Band { op: self, x, y, weights, bias, activation, offsets });
            });
        }
        Ok(tvec!(output.into_tvalue()))
    }
}

impl TypedOp for Depthwise {
    fn output_facts(&self, inputs: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        let [rows, cols] = self.window.output;
        Ok(tvec!(f32::fact([inputs[0].shape[0].clone(), rows.to_dim(), cols.to_dim(), self.channels.to_dim()])))
    }

    fn cost(&self, inputs: &[&TypedFact]) -> TractResult<TVec<(Cost, TDim)>> {
        let ([rows, cols], [down, along]) = (self.window.output, self.window.kernel);
        let count = rows * cols * self.channels * down * along;
        Ok(tvec!((Cost::FMA(f32::datum_type()), inputs[0].shape[0].clone() * count)))
    }

    as_op!();
}

/// Some rows of an image.
struct Band<'a> {
    op: &'a Depthwise,
    x: &'a [f32],
    y: &'a mut [f32],
    weights: &'a [f32],
    bias: &'a [f32],
    activation: Ready<'a>,
    /// Of the taps, in floats.
    offsets: &'a [usize],
}

impl WithSimd for Band<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self) {
        let (channels, lanes) = (self.op.channels, f32::lanes::<S>());
        if channels < lanes {
            return self.few();
        }
        let pitch = self.op.window.pitch() * channels * self.op.window.stride[0];
        for row in 0..self.y.len() / (self.op.window.output[1] * channels) {
            for channel in (0..channels).step_by(lanes) {
                // The last vector overlaps the one before: the same sums again.
                let channel = channel.min(channels - lanes);
                match <&[usize; 9]>::try_from(self.offsets) {
                    Ok(offsets) => self.nine::<S>(row, pitch, channel, offsets),
                    Err(_) => self.any::<S>(row, pitch, channel),
                }
            }
        }
    }
}

impl Band<'_> {
    /// A row of some channels under nine taps, whose weights stay in registers.
    #[inline(always)]
    fn nine<S: Simd>(&mut self, row: usize, pitch: usize, channel: usize, offsets: &[usize; 9]) {
        let (channels, along) = (self.op.channels, self.op.window.stride[1]);
        let weights: [Vector<S, f32>; 9] =
            std::array::from_fn(|tap| load::<S>(&self.weights[tap * channels + channel..]));
        let bias = load::<S>(&self.bias[channel..]);
        let inputs = offsets.map(|offset| &self.x[row * pitch + channel + offset..]);
        let line = self.op.window.output[1] * channels;
        for (col, y) in self.y[row * line..][..line].chunks_exact_mut(channels).enumerate() {
            let at = col * along * channels;
            let mut sum = bias;
            for (input, weight) in inputs.iter().zip(weights) {
                sum = load::<S>(&input[at..]).mul_add(weight, sum);
            }
            store(self.activation.apply(sum, channel), &mut y[channel..]);
        }
    }

    /// A row of some channels under any number of taps, four pixels at a time.
    #[inline(always)]
    fn any<S: Simd>(&mut self, row: usize, pitch: usize, channel: usize) {
        const PIXELS: usize = 4;
        let (channels, along) = (self.op.channels, self.op.window.stride[1]);
        let bias = load::<S>(&self.bias[channel..]);
        let cols = self.op.window.output[1];
        let line = cols * channels;
        for (k, y) in self.y[row * line..][..line].chunks_mut(PIXELS * channels).enumerate() {
            let starts: [usize; PIXELS] =
                std::array::from_fn(|i| row * pitch + channel + (k * PIXELS + i).min(cols - 1) * along * channels);
            let mut sums = [bias; PIXELS];
            for (offset, weights) in self.offsets.iter().zip(self.weights.chunks_exact(channels)) {
                let weight = load::<S>(&weights[channel..]);
                for (sum, start) in sums.iter_mut().zip(starts) {
                    *sum = load::<S>(&self.x[start + offset..]).mul_add(weight, *sum);
                }
            }
            for (sum, y) in sums.into_iter().zip(y.chunks_exact_mut(channels)) {
                store(self.activation.apply(sum, channel), &mut y[channel..]);
            }
        }
    }

    /// Fewer channels than a vector holds.
    #[inline(always)]
    fn few(self) {
        let (channels, window) = (self.op.channels, &self.op.window);
        let rows = self.y.len() / (window.output[1] * channels);
        for (start, y) in window.starts(rows, channels).into_iter().zip(self.y.chunks_exact_mut(channels)) {
            y.copy_from_slice(self.bias);
            for (offset, weights) in self.offsets.iter().zip(self.weights.chunks_exact(channels)) {
                let inputs = &self.x[start + offset..][..channels];
                for ((y, input), weight) in y.iter_mut().zip(inputs).zip(weights) {
                    *y = input.mul_add(*weight, *y);
                }
            }
            y.iter_mut().enumerate().for_each(|(channel, y)| *y = self.activation.apply_one(*y, channel));
        }
    }
}
