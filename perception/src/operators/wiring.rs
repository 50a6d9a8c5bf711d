//! How an operator that has the channels last is put into a graph that has them second.

use tract_onnx::tract_hir::internal::*;

/// Dimension of the channels, before and after a move.
pub const CHANNELS: usize = 1;
pub const LAST: usize = 3;
pub type Rewrite = TractResult<Option<TypedModelPatch>>;

/// Wires an operator that has the channels last.
pub fn wire_last(patch: &mut TypedModelPatch, name: &str, op: impl TypedOp, x: OutletId) -> TractResult<OutletId> {
    let last = patch.wire_node(format!("{name}.last"), AxisOp::Move(CHANNELS, LAST), &[x])?;
    let made = patch.wire_node(name, op, &last)?;
    Ok(patch.wire_node(format!("{name}.first"), AxisOp::Move(LAST, CHANNELS), &made)?[0])
}

/// An operator with the channels last instead of the nodes from one to another.
pub fn replace(model: &TypedModel, from: &TypedNode, to: usize, op: impl TypedOp) -> Rewrite {
    let mut patch = TypedModelPatch::default();
    let x = patch.tap_model(model, from.inputs[0])?;
    let y = wire_last(&mut patch, &from.name, op, x)?;
    patch.shunt_outside(model, to.into(), y)?;
    Ok(Some(patch))
}

/// Shape of a map of floats, batch, channels, rows and columns.
pub fn map(fact: &TypedFact) -> Option<[usize; 4]> {
    let shape = fact.shape.as_concrete().filter(|_| fact.datum_type == f32::datum_type())?;
    shape.try_into().ok().filter(|shape: &[usize; 4]| !shape.contains(&0))
}
