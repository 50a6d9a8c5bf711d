//! PReLU, channels last: negative values times the slope of their channel.

use tract_onnx::tract_hir::internal::*;

use crate::simd::vectorised;

/// Takes and gives maps whose last dimension is that of `slopes`.
#[derive(Clone, Debug, PartialEq)]
pub struct Prelu {
    pub slopes: Arc<Tensor>,
}

impl Eq for Prelu {}

impl Op for Prelu {
    fn name(&self) -> StaticName {
        "Prelu".into()
    }

    op_as_typed_op!();
}

impl EvalOp for Prelu {
    op_out_of_plan!();

    fn eval(&self, _context: &EvalContext, inputs: TVec<TValue>) -> TractResult<TVec<TValue>> {
        let mut map = args_1!(inputs).into_tensor();
        ensure!(map.shape().last() == Some(&self.slopes.len()), "a map of {:?}", map.shape());
        let slopes: &[f32] = self.slopes.try_as_plain_ram()?.as_slice()?;
        let mut plain = map.try_as_plain_ram_mut()?;
        let values: &mut [f32] = plain.as_slice_mut()?;
        vectorised(
            #[inline(always)]
            || {
                for pixel in values.chunks_exact_mut(slopes.len()) {
                    for (x, slope) in pixel.iter_mut().zip(slopes) {
                        *x = if *x < 0.0 { *x * slope } else { *x };
                    }
                }
            },
        );
        Ok(tvec!(map.into_tvalue()))
    }
}

impl TypedOp for Prelu {
    fn output_facts(&self, inputs: &[&TypedFact]) -> TractResult<TVec<TypedFact>> {
        Ok(tvec!(inputs[0].without_value()))
    }

    as_op!();
}
