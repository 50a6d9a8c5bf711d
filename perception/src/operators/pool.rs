//! Pooling, channels last: the highest value or the mean of each channel in a window.

use tract_onnx::tract_hir::internal::*;

use super::window::Window;
use crate::simd::vectorised;

/// What a window is turned into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Highest,
    /// The mean over what of the window lies in the input.
    Mean,
    /// The mean over the whole window, padding being 0.
    MeanOfWindow,
}

/// Takes maps of `window.input` and gives maps of `window.output`, both channels last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pool {
    pub window: Window,
    pub channels: usize,
    pub kind: Kind,
}

impl Op for Pool {
    fn name(&self) -> StaticName {
        "Pool".into()
    }

    fn info(&self) -> TractResult<Vec<String>> {
        Ok(vec![format!("{:?}", self.window)])
    }

    op_as_typed_op!();
}

impl EvalOp for Pool {
    op_out_of_plan!();

    fn eval(&self, _context: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let input = args_1!(inputs);
        let ([rows, cols], [out_rows, out_cols]) = (self.window.input, self.window.output);
        let batch = input.shape().first().copied().unwrap_or(0);
        let taken = [batch, rows, cols, self.channels];
        ensure!(input.shape() == taken, "a map of {:?}, expected {taken:?}", input.shape());
        let mut output = Tensor::zero::<f32>(&[batch, out_rows, out_cols, self.channels])?;
        let x: &[f32] = input.try_as_plain_ram()?.as_slice()?;
        let mut plain = output.try_as_plain_ram_mut()?;
        let y: &mut [f32] = plain.as_slice_mut()?;
        let of_image = out_rows * out_cols * self.channels;
        for (x, y) in x.chunks_exact(rows * cols * self.channels).zip(y.chunks_exact_mut(of_image)) {
            self.image(x, y);
        }
        Ok(tvec!(output.into_tvalue()))
    }
}

impl Pool {
    fn image(&self, x: &[f32], y: &mut [f32]) {
        let (fill, channels) = (if self.kind == Kind::Highest { f32::NEG_INFINITY } else { 0.0 }, self.channels);
        let taps: Vec<usize> = self.window.taps(channels).collect();
        let line = self.window.output[1] * channels;
        self.window.bands(x, channels, fill, |x, rows| {
            let starts = self.window.starts(rows.len(), channels);
            let y = &mut y[rows.start * line..rows.end * line];
            vectorised(
                #[inline(always)]
                || {
                    for (start, y) in starts.iter().zip(y.chunks_exact_mut(channels)) {
                        match self.kind {
                            Kind::Highest => gather(x, *start, &taps, y, |y, x| if x > y { x } else { y }),
                            _ => gather(x, *start, &taps, y, |y, x| y + x),
                        }
                    }
                },
            );
        });
        if self.kind != Kind::Highest {
            for (pixel, y) in y.chunks_exact_mut(channels).enumerate() {
                let share = 1.0 / self.count(pixel / self.window.output[1], pixel % self.window.output[1]) as f32;
                y.iter_mut().for_each(|y| *y *= share);
            }
        }
    }

    /// Over how many values the mean of an output pixel goes.
    fn count(&self, row: usize, col: usize) -> usize {
        let window = &self.window;
        if self.kind == Kind::MeanOfWindow {
            return window.kernel[0] * window.kernel[1];
        }
        let inside = |axis: usize, output: usize| {
            let places = (0..window.kernel[axis]).map(|k| output * window.stride[axis] + k * window.dilation[axis]);
            let (before, input) = (window.before[axis], window.input[axis]);
            places.filter(|place| (before..before + input).contains(place)).count()
        };
        inside(0, row) * inside(1, col)
    }
}

/// Joins the values of all taps, channel by channel.
#[inline(always)]
fn gather(x: &[f32], start: usize, taps: &[usize], y: &mut [f32], join: impl Fn(f32, f32) -> f32) {
    let Some((first, rest)) = taps.split_first() else { return };
    y.copy_from_slice(&x[start + first..][..y.len()]);
    for tap in rest {
        for (y, x) in y.iter_mut().zip(&x[start + tap..]) {
            *y = join(*y, *x);
        }
    }
}

impl TypedOp for Pool {
    fn output_facts(&self, inputs: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        let [rows, cols] = self.window.output;
        Ok(tvec!(f32::fact([inputs[0].shape[0].clone(), rows.to_dim(), cols.to_dim(), self.channels.to_dim()])))
    }

    as_op!();
}
