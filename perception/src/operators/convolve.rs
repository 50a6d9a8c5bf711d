//! Convolution, channels last.
//!
//! No matrix of patches is made: for each output pixel the inputs of its window lie in runs (with a dilation of 1 a
//! whole row of the window), and the tile multiplies them where they are. What padding needs is copied band by band.

use macerator::{Scalar, Simd, WithSimd};
use tract_onnx::tract_hir::internal::*;

use super::activation::{Activation, Ready};
use super::tile::{PANEL, Tile};
use super::window::Window;
use crate::simd::{dispatch, lanes};

/// Takes maps of `window.input` and gives maps of `window.output`, both channels last; a second input of the
/// output's shape is added before the activation.
#[derive(Clone, Debug, PartialEq)]
pub struct Convolve {
    pub window: Window,
    pub inputs: usize,
    pub outputs: usize,
    pub groups: usize,
    pub activation: Activation,
    /// For each group and panel a row as wide as the panel for each input of the window.
    weights: Arc<Tensor>,
    /// For each group and panel; padded as the panels are.
    bias: Arc<Tensor>,
    /// Output channels of a wide panel.
    wide: usize,
}

impl Eq for Convolve {}

/// Output channels of a wide panel on this machine: two vectors.
fn wide() -> usize {
    (2 * lanes()).max(PANEL)
}

/// First output channel and width of each panel of a group.
fn panels(outputs: usize, wide: usize) -> impl Iterator<Item = (usize, usize)> {
    let mut from = 0;
    std::iter::from_fn(move || {
        let width = if outputs.saturating_sub(from) > PANEL { wide } else { PANEL };
        let panel = (from < outputs).then_some((from, width));
        from += width;
        panel
    })
}

impl Convolve {
    /// Of weights `OIHW` (output channel, input channel of the group, row, column).
    pub fn new(
        window: Window,
        groups: usize,
        weights: &Tensor,
        bias: &[f32],
        activation: Activation,
    ) -> TractResult<Self> {
        let &[outputs, inputs, rows, cols] = weights.shape() else { bail!("weights of {:?}", weights.shape()) };
        let (values, wide) = (weights.try_as_plain_ram()?.as_slice::<f32>()?, wide());
        let (taps, of_group) = (rows * cols, outputs / groups);
        let (mut packed, mut padded) = (Vec::new(), Vec::new());
        for group in 0..groups {
            for (from, width) in panels(of_group, wide) {
                let channels = (from..from + width).map(|o| (o < of_group).then_some(group * of_group + o));
                padded.extend(channels.clone().map(|o| o.map_or(0.0, |o| bias[o])));
                for (tap, input) in (0..taps).flat_map(|tap| (0..inputs).map(move |input| (tap, input))) {
                    packed
                        .extend(channels.clone().map(|o| o.map_or(0.0, |o| values[(o * inputs + input) * taps + tap])));
                }
            }
        }
        let weights = Tensor::from_shape(&[packed.len()], &packed)?.into_arc_tensor();
        let bias = Tensor::from_shape(&[padded.len()], &padded)?.into_arc_tensor();
        Ok(Self { window, inputs: inputs * groups, outputs, groups, activation, weights, bias, wide })
    }

    fn shapes(&self, batch: usize) -> [[usize; 4]; 2] {
        let [[rows, cols], [out_rows, out_cols]] = [self.window.input, self.window.output];
        [[batch, rows, cols, self.inputs], [batch, out_rows, out_cols, self.outputs]]
    }

    fn images(&self, x: &[f32], y: &mut [f32], more: Option<&[f32]>) -> TractResult<()> {
        let [taken, given] = self.shapes(1).map(|shape| shape.iter().product::<usize>());
        let (weights, bias) = (self.weights.try_as_plain_ram()?.as_slice()?, self.bias.try_as_plain_ram()?.as_slice()?);
        let (activation, (runs, length)) = (self.activation.ready()?, self.runs());
        let line = self.window.output[1] * self.outputs;
        for (image, (x, y)) in x.chunks_exact(taken).zip(y.chunks_exact_mut(given)).enumerate() {
            self.window.bands(x, self.inputs, 0.0, |x, rows| {
                let starts = &self.window.starts(rows.len(), self.inputs);
                let part = rows.start * line..rows.end * line;
                let more = more.map(|more| &more[image * given..][part.clone()]);
                let (y, runs) = (&mut y[part], &runs);
                dispatch(Band { op: self, x, y, more, weights, bias, activation, runs, length, starts });
            });
        }
        Ok(())
    }

    /// Where the runs lie, and how long they are.
    fn runs(&self) -> (Vec<usize>, usize) {
        let taps = self.window.taps(self.inputs);
        let cols = self.window.kernel[1];
        match self.groups == 1 && (self.window.dilation[1] == 1 || cols == 1) {
            true => (taps.step_by(cols).collect(), cols * self.inputs),
            false => (taps.collect(), self.inputs / self.groups),
        }
    }
}

impl Op for Convolve {
    fn name(&self) -> StaticName {
        "Convolve".into()
    }

    fn info(&self) -> TractResult<Vec<String>> {
        Ok(vec![format!("{:?}", self.window)])
    }

    op_as_typed_op!();
}

impl EvalOp for Convolve {
    op_out_of_plan!();

    fn eval(&self, _context: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let batch = inputs[0].shape().first().copied().unwrap_or(0);
        let [taken, given] = self.shapes(batch);
        ensure!(inputs[0].shape() == taken, "a map of {:?}, expected {taken:?}", inputs[0].shape());
        let more = match inputs.get(1) {
            Some(more) if more.shape() == given => Some(more.try_as_plain_ram()?.as_slice::<f32>()?),
            Some(more) => bail!("a map of {:?} to add, expected {given:?}", more.shape()),
            None => None,
        };
        let mut output = Tensor::zero::<f32>(&given)?;
        let mut plain = output.try_as_plain_ram_mut()?;
        let x: &[f32] = inputs[0].try_as_plain_ram()?.as_slice()?;
        self.images(x, plain.as_slice_mut()?, more)?;
        Ok(tvec!(output.into_tvalue()))
    }
}

impl TypedOp for Convolve {
    fn output_facts(&self, inputs: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        let [batch, rows, cols, channels] = self.shapes(1)[1].map(|n| n.to_dim());
        Ok(tvec!(f32::fact([batch * &inputs[0].shape[0], rows, cols, channels])))
    }

    fn cost(&self, inputs: &[&TypedFact]) -> TractResult<TVec<(Cost, TDim)>> {
        let [rows, cols] = self.window.output;
        let count =
            rows * cols * self.outputs * self.window.kernel[0] * self.window.kernel[1] * self.inputs / self.groups;
        Ok(tvec!((Cost::FMA(f32::datum_type()), inputs[0].shape[0].clone() * count)))
    }

    as_op!();
}

/// Some rows of an image.
struct Band<'a> {
    op: &'a Convolve,
    x: &'a [f32],
    y: &'a mut [f32],
    more: Option<&'a [f32]>,
    weights: &'a [f32],
    bias: &'a [f32],
    activation: Ready<'a>,
    runs: &'a [usize],
    length: usize,
    /// Of the windows of the output pixels.
    starts: &'a [usize],
}

impl WithSimd for Band<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self) {
        match f32::lanes::<S>() {
            16 => self.run::<S, 8, 2, 14, 1>(),
            8 => self.run::<S, 6, 2, 6, 2>(),
            4 => self.run::<S, 2, 4, 2, 4>(),
            _ => self.run::<S, 1, 8, 1, 8>(),
        }
    }
}

impl Band<'_> {
    /// Pixels of a tile and vectors of a panel, of wide panels and of narrow ones.
    #[inline(always)]
    fn run<S: Simd, const PIXELS: usize, const WIDE: usize, const MORE: usize, const NARROW: usize>(self) {
        let op = self.op;
        let (inputs, outputs) = (op.inputs / op.groups, op.outputs / op.groups);
        let (mut weights, mut bias) = (self.weights, self.bias);
        for group in 0..op.groups {
            for (from, width) in panels(outputs, op.wide) {
                let (of_panel, rest) = weights.split_at(self.runs.len() * self.length * width);
                let tile = Tile {
                    x: &self.x[group * inputs..],
                    runs: self.runs,
                    length: self.length,
                    weights: of_panel,
                    bias: &bias[..width],
                    activation: self.activation,
                    channel: group * outputs + from,
                    channels: width.min(outputs - from),
                    stride: op.outputs,
                };
                (weights, bias) = (rest, &bias[width..]);
                if WIDE == NARROW || width == NARROW * f32::lanes::<S>() {
                    panel::<S, MORE, NARROW>(&tile, self.starts, self.y, self.more);
                } else {
                    panel::<S, PIXELS, WIDE>(&tile, self.starts, self.y, self.more);
                }
            }
        }
    }
}

/// All pixels of a band, tile by tile; the last tiles are small ones or compute their last pixel more than once.
#[inline(always)]
fn panel<S: Simd, const PIXELS: usize, const VECTORS: usize>(
    tile: &Tile<'_>,
    starts: &[usize],
    y: &mut [f32],
    more: Option<&[f32]>,
) {
    let mut from = 0;
    while from < starts.len() {
        let left = starts.len() - from;
        let y = &mut y[from * tile.stride..];
        let more = more.map(|more| &more[from * tile.stride..]);
        if left == 1 {
            tile.run::<S, 1, VECTORS>(&[starts[from]], y, more);
        } else {
            let starts: [usize; PIXELS] = std::array::from_fn(|i| starts[from + i.min(left - 1)]);
            tile.run::<S, PIXELS, VECTORS>(&starts, y, more);
        }
        from += PIXELS;
    }
}
