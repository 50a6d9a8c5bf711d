//! Puts our resizing in place of the engine's, and of products with matrices that resize.

use tract_onnx::tract_core::ops::einsum::EinSum;
use tract_onnx::tract_core::ops::nn::resize;
use tract_onnx::tract_hir::internal::*;

use super::resize::{Resize, Taps};
use super::wiring::{CHANNELS, Rewrite, map, replace, wire_last};

/// The engine's plan for each axis of a map, and the shape of what comes of it.
pub fn resized(_: &(), model: &TypedModel, node: &TypedNode, _: &str, op: &resize::Resize) -> Rewrite {
    rule_if_some!([batch, channels, rows, cols] = map(model.outlet_fact(node.inputs[0])?));
    rule_if_some!([out_batch, out_channels, out_rows, out_cols] = map(&node.outputs[0].fact));
    let scales =
        op.optional_scales_input.and_then(|slot| model.outlet_fact(*node.inputs.get(slot)?).ok()?.konst.clone());
    let scales = match &scales {
        Some(scales) if scales.len() == 4 => {
            Some(scales.cast_to::<f32>()?.try_as_plain_ram()?.as_slice::<f32>()?.to_vec())
        }
        _ => None,
    };
    // Either the batch and the channels stay, or, where the graph has the channels last already, they are at the ends.
    rule_if!(batch == out_batch);
    let plan = |axis: usize, input: usize, output: usize| {
        let scale = scales.as_ref().map_or(output as f32 / input as f32, |scales| scales[axis]);
        Taps::new(input, op.plan_axis(scale, input, output))
    };
    if channels == out_channels {
        rule_if_some!((rows, cols) = plan(2, rows, out_rows).zip(plan(3, cols, out_cols)));
        return replace(model, node, node.id, Resize { rows, cols, channels });
    }
    rule_if!(cols == out_cols);
    rule_if_some!((rows, cols_taps) = plan(1, channels, out_channels).zip(plan(2, rows, out_rows)));
    let op = Resize { rows, cols: cols_taps, channels: cols };
    TypedModelPatch::replace_single_op(model, node, &node.inputs[..1], op).map(Some)
}

/// Every pixel repeated.
pub fn nearest(_: &(), model: &TypedModel, node: &TypedNode, _: &str, op: &resize::NearestUpsample) -> Rewrite {
    rule_if_some!([_, channels, rows, cols] = map(model.outlet_fact(node.inputs[0])?));
    rule_if!(op.scales.len() == 4 && op.scales[0] == 1 && op.scales[CHANNELS] == 1);
    let taps = |input: usize, scale: usize| {
        let indices = (0..input * scale).map(|i| i / scale).collect::<Vec<_>>();
        let plan = resize::AxisPlan {
            window: 1,
            weights: vec![1.0; indices.len()],
            extrapolated: vec![false; indices.len()],
            indices,
        };
        Taps::new(input, plan)
    };
    rule_if_some!((rows, cols) = taps(rows, op.scales[2]).zip(taps(cols, op.scales[3])));
    replace(model, node, node.id, Resize { rows, cols, channels })
}

/// A product with a constant matrix along the rows or the columns, each of whose values goes into few others: how
/// exporters write pools and resizing as well.
pub fn product(_: &(), model: &TypedModel, node: &TypedNode, _: &str, op: &EinSum) -> Rewrite {
    rule_if!(op.q_params.is_none() && node.inputs.len() == 2 && op.operating_dt == f32::datum_type());
    let facts = model.node_input_facts(node.id)?;
    rule_if_some!(slot = facts.iter().position(|fact| fact.konst.is_none()));
    rule_if_some!([_, channels, rows, cols] = map(facts[slot]));
    rule_if_some!(matrix = &facts[1 - slot].konst);
    rule_if!(map(&node.outputs[0].fact).is_some() && matrix.datum_type() == f32::datum_type());
    let (rank, sides) = (matrix.rank(), matrix.shape());
    rule_if!(rank >= 2 && sides[..rank - 2].iter().all(|n| *n == 1));
    let axis = |k: usize| op.axes.axis((InOut::In(slot), k));
    let mut along = None;
    for k in 0..4 {
        let found = axis(k)?;
        let (there, here) = (found.outputs[0].as_slice(), found.inputs[1 - slot].as_slice());
        match (there, here) {
            ([], &[from]) if along.is_none() && from + 2 >= rank => along = Some((k, from)),
            // What the matrix has no part in, or has only because it was given as many dimensions.
            (&[same], []) if same == k => {}
            (&[same], &[padding]) if same == k && padding + 2 < rank => {}
            _ => return Ok(None),
        }
    }
    rule_if_some!((along, from) = along.filter(|(along, _)| *along >= 2));
    let to = op.axes.axis((InOut::In(1 - slot), 2 * rank - 3 - from))?;
    rule_if!(to.outputs[0].as_slice() == [along] && to.inputs[slot].is_empty());
    rule_if_some!(taps = dense(matrix, from)?);
    let (rows, cols) = match along {
        2 => (taps, Taps::same(cols)),
        _ => (Taps::same(rows), taps),
    };
    let from = model.node(node.inputs[slot].node);
    let mut patch = TypedModelPatch::default();
    let x = patch.tap_model(model, OutletId::new(from.id, node.inputs[slot].slot))?;
    let y = wire_last(&mut patch, &node.name, Resize { rows, cols, channels }, x)?;
    patch.shunt_outside(model, node.id.into(), y)?;
    Ok(Some(patch))
}

/// What a matrix, the last two dimensions of a tensor, does; the dimension of the sources is given. Nothing if it mixes
/// everything.
fn dense(matrix: &Tensor, from: usize) -> TractResult<Option<Taps>> {
    let values: &[f32] = matrix.try_as_plain_ram()?.as_slice()?;
    let rank = matrix.rank();
    let (inputs, outputs) = (matrix.shape()[from], matrix.shape()[2 * rank - 3 - from]);
    let at =
        |input: usize, output: usize| if from + 2 == rank { input * outputs + output } else { output * inputs + input };
    let taken = |output: usize| (0..inputs).filter(move |input| values[at(*input, output)] != 0.0);
    let window = (0..outputs).map(|output| taken(output).count()).max().unwrap_or(0).max(1);
    if window * outputs > 2 * inputs.max(outputs) + 2 * window {
        return Ok(None);
    }
    let (mut indices, mut weights) = (Vec::new(), Vec::new());
    for output in 0..outputs {
        let sources: Vec<usize> = taken(output).collect();
        let filled = sources.iter().copied().chain(std::iter::repeat(0)).take(window);
        indices.extend(filled);
        let of_sources = sources.iter().map(|input| values[at(*input, output)]);
        weights.extend(of_sources.chain(std::iter::repeat(0.0)).take(window));
    }
    Ok(Taps::new(inputs, resize::AxisPlan { window, indices, weights, extrapolated: vec![false; outputs] }))
}
