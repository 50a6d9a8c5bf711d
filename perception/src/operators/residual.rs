//! Sums of two branches: where one of them ends in a convolution, it adds the other one itself.

use tract_onnx::tract_core::ops::binary::TypedBinOp;
use tract_onnx::tract_core::ops::math::Add;
use tract_onnx::tract_hir::internal::*;

use super::activation::Activation;
use super::convolve::Convolve;
use super::follow::{bounded, successor};

/// Puts sums, and the clamps behind them, into the convolutions before them.
pub fn absorb(model: &mut TypedModel) -> TractResult<()> {
    while let Some(patch) = find(model)? {
        patch.apply(model)?;
        model.compact()?;
    }
    Ok(())
}

fn find(model: &TypedModel) -> TractResult<Option<TypedModelPatch>> {
    for id in model.eval_order()? {
        if let Some(patch) = sum(model, model.node(id))? {
            return Ok(Some(patch));
        }
    }
    Ok(None)
}

/// A convolution without an activation whose value goes only into a sum with another map of its shape, or into a
/// bound for all channels.
fn sum(model: &TypedModel, node: &TypedNode) -> TractResult<Option<TypedModelPatch>> {
    rule_if_some!(op = node.op_as::<Convolve>());
    rule_if_some!(next = successor(model, node.id));
    rule_if_some!(binary = next.op_as::<TypedBinOp>());
    rule_if!(next.inputs.len() == 2 && next.inputs[0] != next.inputs[1]);
    rule_if!(next.outputs[0].fact.shape == node.outputs[0].fact.shape);
    rule_if_some!(other = next.inputs.iter().find(|input| input.node != node.id));
    let fact = model.outlet_fact(*other)?;
    let mut op = op.clone();
    let mut patch = TypedModelPatch::default();
    let mut inputs = patch.taps(model, &node.inputs)?;
    if let Some(bound) = fact.konst.as_ref().filter(|konst| konst.len() == 1 && konst.datum_type() == f32::datum_type())
    {
        let value: &[f32] = bound.try_as_plain_ram()?.as_slice()?;
        rule_if_some!(activation = bounded(&op.activation, binary, value));
        op.activation = activation;
    } else {
        rule_if!(binary.0.is::<Add>() && op.activation == Activation::None && inputs.len() == 1);
        rule_if!(fact.shape == node.outputs[0].fact.shape && fact.datum_type == f32::datum_type());
        inputs.push(patch.tap_model(model, *other)?);
    }
    let y = patch.wire_node(&node.name, op, &inputs)?[0];
    patch.shunt_outside(model, next.id.into(), y)?;
    Ok(Some(patch))
}
