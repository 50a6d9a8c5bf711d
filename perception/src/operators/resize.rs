//! Resizing of rows and columns, channels last: first the rows, then the columns, each output pixel a sum of source
//! pixels with weights that the engine's own operator plans.

use tract_onnx::tract_core::ops::nn::resize::AxisPlan;
use tract_onnx::tract_hir::internal::*;

use crate::simd::vectorised;

/// Source pixels and their weights for every output pixel along one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Taps {
    input: usize,
    window: usize,
    indices: Vec<usize>,
    weights: Vec<f32>,
}

impl Taps {
    /// Of a plan for an axis of so many pixels, unless it reaches for what lies outside.
    pub fn new(input: usize, plan: AxisPlan) -> Option<Self> {
        let is_inside = !plan.extrapolated.contains(&true);
        is_inside.then_some(Self { input, window: plan.window, indices: plan.indices, weights: plan.weights })
    }

    /// Every pixel as it is.
    pub fn same(pixels: usize) -> Self {
        Self { input: pixels, window: 1, indices: (0..pixels).collect(), weights: vec![1.0; pixels] }
    }

    fn output(&self) -> usize {
        self.indices.len() / self.window
    }

    /// Every output pixel that is one source pixel, or a sum of two or more.
    fn iter(&self) -> impl Iterator<Item = (&[usize], &[f32])> {
        self.indices.chunks_exact(self.window).zip(self.weights.chunks_exact(self.window))
    }
}

/// Takes maps of `rows.input` by `cols.input` pixels and gives resized ones, both channels last.
#[derive(Clone, Debug, PartialEq)]
pub struct Resize {
    pub rows: Taps,
    pub cols: Taps,
    pub channels: usize,
}

impl Eq for Resize {}

impl Op for Resize {
    fn name(&self) -> StaticName {
        "ResizeRowsAndColumns".into()
    }

    op_as_typed_op!();
}

impl EvalOp for Resize {
    op_out_of_plan!();

    fn eval(&self, _context: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let input = args_1!(inputs);
        let (batch, channels) = (input.shape().first().copied().unwrap_or(0), self.channels);
        let taken = [batch, self.rows.input, self.cols.input, channels];
        ensure!(input.shape() == taken, "a map of {:?}, expected {taken:?}", input.shape());
        let mut output = Tensor::zero::<f32>(&[batch, self.rows.output(), self.cols.output(), channels])?;
        let x: &[f32] = input.try_as_plain_ram()?.as_slice()?;
        let mut plain = output.try_as_plain_ram_mut()?;
        let y: &mut [f32] = plain.as_slice_mut()?;
        let of_output = self.rows.output() * self.cols.output() * channels;
        let images = x.chunks_exact(self.rows.input * self.cols.input * channels).zip(y.chunks_exact_mut(of_output));
        for (x, y) in images {
            vectorised(
                #[inline(always)]
                || self.image(x, y),
            );
        }
        Ok(tvec!(output.into_tvalue()))
    }
}

impl Resize {
    #[inline(always)]
    fn image(&self, x: &[f32], y: &mut [f32]) {
        let channels = self.channels;
        let mut mixed = vec![0.0; self.cols.input * channels];
        let mut made = None;
        let lines = y.chunks_exact_mut(self.cols.output() * channels);
        for ((rows, weights), line) in self.rows.iter().zip(lines) {
            // Rows that are repeated, as nearest neighbours are, need not be mixed again.
            if made != Some((rows, weights)) {
                mix(x, mixed.len(), rows, weights, &mut mixed);
                made = Some((rows, weights));
            }
            for ((cols, weights), pixel) in self.cols.iter().zip(line.chunks_exact_mut(channels)) {
                mix(&mixed, channels, cols, weights, pixel);
            }
        }
    }
}

/// The weighted sum of some pieces of a length.
#[inline(always)]
fn mix(from: &[f32], length: usize, pieces: &[usize], weights: &[f32], to: &mut [f32]) {
    if let (&[a, b], &[left, right]) = (pieces, weights) {
        let (a, b) = (&from[a * length..][..length], &from[b * length..][..length]);
        match (left == 0.0, right == 0.0) {
            (true, false) if right == 1.0 => to.copy_from_slice(b),
            (false, true) if left == 1.0 => to.copy_from_slice(a),
            _ => to.iter_mut().zip(a).zip(b).for_each(|((to, a), b)| *to = left * a + right * b),
        }
        return;
    }
    if let (&[a], &[1.0]) = (pieces, weights) {
        return to.copy_from_slice(&from[a * length..][..length]);
    }
    to.fill(0.0);
    for (piece, weight) in pieces.iter().zip(weights) {
        to.iter_mut().zip(&from[piece * length..]).for_each(|(to, from)| *to += weight * from);
    }
}

impl TypedOp for Resize {
    fn output_facts(&self, inputs: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        let [rows, cols] = [&self.rows, &self.cols].map(|taps| taps.output().to_dim());
        Ok(tvec!(f32::fact([inputs[0].shape[0].clone(), rows, cols, self.channels.to_dim()])))
    }

    as_op!();
}
