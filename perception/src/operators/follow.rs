//! What follows a value in a graph, and may be taken into the operator before it.

use tract_onnx::tract_core::ops::binary::TypedBinOp;
use tract_onnx::tract_core::ops::math::{Max, Min};
use tract_onnx::tract_hir::internal::*;

use super::activation::Activation;

/// The only node that takes a value which nobody else sees.
pub(super) fn successor(model: &TypedModel, id: usize) -> Option<&TypedNode> {
    let outputs = &model.node(id).outputs;
    let is_seen = model.outputs.iter().any(|output| output.node == id);
    let [output] = outputs.as_slice() else { return None };
    let [inlet] = output.successors.as_slice() else { return None };
    (!is_seen).then(|| model.node(inlet.node))
}

/// A clamp with a further bound, the same for all channels.
pub(super) fn bounded(activation: &Activation, op: &TypedBinOp, values: &[f32]) -> Option<Activation> {
    let bound = *values.first()?;
    let (low, high) = match activation {
        Activation::None => (f32::NEG_INFINITY, f32::INFINITY),
        Activation::Clamp(low, high) => (*low, *high),
        _ => return None,
    };
    if values.iter().any(|value| *value != bound) {
        return None;
    }
    match (op.0.is::<Max>(), op.0.is::<Min>()) {
        (true, _) if bound <= high && bound >= low => Some(Activation::Clamp(bound, high)),
        (_, true) if bound >= low && bound <= high => Some(Activation::Clamp(low, bound)),
        _ => None,
    }
}
