//! The picture and the scores of a graph whose inner values have the channels last: moves at its ends are left to who
//! writes the one and reads the other, and who can do either in any order.

use tract_onnx::tract_core::ops::identity::Identity;
use tract_onnx::tract_core::ops::source::TypedSource;
use tract_onnx::tract_hir::internal::*;

/// Where the first thing that happens to the only input is that its channels move to the end, has it come so; gives
/// its new shape.
pub(crate) fn take_channels_last(model: &mut TypedModel) -> TractResult<Option<[usize; 4]>> {
    let &[input] = model.inputs.as_slice() else { return Ok(None) };
    let [inlet] = model.node(input.node).outputs[0].successors.as_slice() else { return Ok(None) };
    let next = inlet.node;
    let is_move = model.node(next).op_as::<AxisOp>().is_some_and(|op| *op == AxisOp::Move(1, 3));
    let moved = model.node(next).outputs[0].fact.clone();
    let shape = moved.shape.as_concrete().and_then(|shape| <[usize; 4]>::try_from(shape).ok());
    let Some(shape) = shape.filter(|_| is_move) else { return Ok(None) };
    let fact = moved.datum_type.fact(shape);
    let source = model.node_mut(input.node);
    source.op = Box::new(TypedSource::new(fact.clone()));
    source.outputs[0].fact = fact;
    model.node_mut(next).op = Box::new(Identity);
    Ok(Some(shape))
}

/// Where the last thing that happens to the only output is that its channels move to the front, leaves that out; tells
/// whether it did.
pub(crate) fn give_channels_last(model: &mut TypedModel) -> bool {
    let &[output] = model.outputs.as_slice() else { return false };
    let node = model.node(output.node);
    let is_move = node.op_as::<AxisOp>().is_some_and(|op| *op == AxisOp::Move(3, 1));
    if is_move && node.outputs[0].fact.rank() == 4 {
        model.outputs[0] = node.inputs[0];
        return true;
    }
    false
}
