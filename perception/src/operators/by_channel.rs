//! A number for each channel applied to a whole map, channels last: normalisation of a picture, gates of channels.

use tract_onnx::tract_hir::internal::*;

use crate::simd::vectorised;

/// What becomes of a value `x` and the number of its channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Sum,
    /// `x` less the number.
    Difference,
    Product,
}

/// Takes a map and, as its second input, as many numbers as the map's last dimension has; gives a map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ByChannel {
    pub kind: Kind,
}

impl Op for ByChannel {
    fn name(&self) -> StaticName {
        "ByChannel".into()
    }

    op_as_typed_op!();
}

impl EvalOp for ByChannel {
    op_out_of_plan!();

    fn eval(&self, _context: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let (map, numbers) = args_2!(inputs);
        let mut map = map.into_tensor();
        let numbers: &[f32] = numbers.try_as_plain_ram()?.as_slice()?;
        ensure!(map.shape().last() == Some(&numbers.len()), "{} numbers for {:?}", numbers.len(), map.shape());
        let mut plain = map.try_as_plain_ram_mut()?;
        let values: &mut [f32] = plain.as_slice_mut()?;
        match self.kind {
            Kind::Sum => each(values, numbers, |x, number| x + number),
            Kind::Difference => each(values, numbers, |x, number| x - number),
            Kind::Product => each(values, numbers, |x, number| x * number),
        }
        Ok(tvec!(map.into_tvalue()))
    }
}

fn each(values: &mut [f32], numbers: &[f32], make: impl Fn(f32, f32) -> f32) {
    // Few channels are repeated to a line that fills vectors.
    let repeats = (64 / numbers.len()).max(1);
    let line: Vec<f32> = numbers.iter().copied().cycle().take(repeats * numbers.len()).collect();
    vectorised(
        #[inline(always)]
        || {
            for values in values.chunks_mut(line.len()) {
                for (x, number) in values.iter_mut().zip(&line) {
                    *x = make(*x, *number);
                }
            }
        },
    );
}

impl TypedOp for ByChannel {
    fn output_facts(&self, inputs: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        Ok(tvec!(inputs[0].without_value()))
    }

    as_op!();
}
