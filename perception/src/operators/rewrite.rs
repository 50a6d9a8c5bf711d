//! Puts our operators in place of the engine's.
//!
//! Each is wired between two moves of the channels, to the end and back. The engine's own rules then cancel moves that
//! meet, and carry others through what does not care, so that whole stretches stay channels last.

use tract_onnx::tract_core::model::Rewriter;
use tract_onnx::tract_core::ops::binary::TypedBinOp;
use tract_onnx::tract_core::ops::cnn::{Conv, KernelFormat, MaxPool, PaddingSpec, SumPool};
use tract_onnx::tract_core::ops::element_wise::ElementWiseOp;
use tract_onnx::tract_core::ops::logic::{Iff, comp_gt};
use tract_onnx::tract_core::ops::math::{Add, Mul, Sub};
use tract_onnx::tract_core::ops::nn::{DataFormat, HardSwish, LeakyRelu};
use tract_onnx::tract_hir::internal::*;

use super::activation::Activation;
use super::by_channel::{self, ByChannel};
use super::convolve::Convolve;
use super::depthwise::Depthwise;
use super::follow::{bounded, successor};
use super::pool::{Kind, Pool};
use super::prelu::Prelu;
use super::tile::PANEL;
use super::window::Window;
use super::wiring::{CHANNELS, LAST, Rewrite, map, replace, wire_last};
use super::{residual, resizing};

/// Most floats of an input with its padding, beyond one that is small, for one of the input or of the output: padding
/// that dwarfs both is left to the engine, which makes nothing of it.
const MOST_PADDING: usize = 4;
const SMALL: usize = 1 << 20;

/// The same graph with our operators in it.
pub(crate) fn prepare(mut model: TypedModel) -> TractResult<TypedModel> {
    model.prop_consts()?;
    Rewriter::<()>::default().with_rule_for("prelu", prelu).rewrite(&(), &mut model)?;
    let windows = Rewriter::<()>::default().with_rule_for("convolve", convolve);
    let windows = windows.with_rule_for("highest", highest).with_rule_for("mean", mean);
    let windows = windows.with_rule_for("product", resizing::product);
    windows.rewrite(&(), &mut model)?;
    // The ONNX form of a resize becomes one that can be looked at.
    model.declutter()?;
    let resizes = Rewriter::<()>::default().with_rule_for("resize", resizing::resized);
    resizes.with_rule_for("nearest", resizing::nearest).rewrite(&(), &mut model)?;
    model.declutter()?;
    residual::absorb(&mut model)?;
    Rewriter::<()>::default().with_rule_for("by-channel", by_channel).rewrite(&(), &mut model)?;
    Ok(model)
}

/// The value of a constant for each channel of a map, if it has no more to it.
fn of_channels(fact: &TypedFact, channels: usize) -> Option<Vec<f32>> {
    let values = fact.konst.as_ref().filter(|konst| konst.datum_type() == f32::datum_type())?;
    let shape = values.shape();
    let is_channels = shape.len() == 4 && shape[CHANNELS] == channels || shape.len() == 1;
    let all: &[f32] = values.try_as_plain_ram().ok()?.as_slice().ok()?;
    match all.len() {
        1 => Some(vec![all[0]; channels]),
        n if n == channels && is_channels => Some(all.to_vec()),
        _ => None,
    }
}

/// What a node computes from another one and a constant: its operator and the constant for each channel.
fn with_constant<'a>(
    model: &'a TypedModel,
    node: &'a TypedNode,
    of: usize,
    channels: usize,
) -> Option<(&'a TypedBinOp, Vec<f32>)> {
    let op = node.op_as::<TypedBinOp>()?;
    let slot = node.inputs.iter().position(|input| input.node != of)?;
    let is_alone = node.outputs[0].fact.shape == model.node(of).outputs[0].fact.shape;
    let fact = model.outlet_fact(node.inputs[slot]).ok().filter(|_| is_alone && node.inputs.len() == 2)?;
    Some((op, of_channels(fact, channels)?))
}

/// `Iff(0 > x, x * slopes, x)`.
fn prelu(_: &(), model: &TypedModel, node: &TypedNode, name: &str, _: &Iff) -> Rewrite {
    let x = node.inputs[2];
    let (test, product) = (model.node(node.inputs[0].node), model.node(node.inputs[1].node));
    rule_if_some!([_, channels, ..] = map(model.outlet_fact(x)?));
    rule_if!(test.op_as::<TypedBinOp>().is_some_and(|op| op.0 == comp_gt()) && test.inputs[1] == x);
    rule_if!(of_channels(model.outlet_fact(test.inputs[0])?, 1).is_some_and(|zero| zero == [0.0]));
    rule_if!(product.inputs.contains(&x));
    rule_if_some!((op, slopes) = with_constant(model, product, x.node, channels));
    rule_if!(op.0.is::<Mul>());
    let mut patch = TypedModelPatch::default();
    let tap = patch.tap_model(model, x)?;
    let y = wire_last(&mut patch, name, Prelu { slopes: rctensor1(&slopes) }, tap)?;
    patch.shunt_outside(model, node.id.into(), y)?;
    Ok(Some(patch))
}

/// Whether the padding of a window is no more than what it is good for.
fn is_fit(window: &Window, inputs: usize, outputs: usize) -> bool {
    let [taken, given] = [(window.input, inputs), (window.output, outputs)].map(|([rows, cols], n)| rows * cols * n);
    inputs.saturating_mul(window.padded_area()) <= (MOST_PADDING * taken.max(given)).max(SMALL)
}

/// A convolution with what follows it: factors and summands for each channel, and an activation.
fn convolve(_: &(), model: &TypedModel, node: &TypedNode, _: &str, op: &Conv) -> Rewrite {
    let facts = model.node_input_facts(node.id)?;
    rule_if!(op.q_params.is_none() && op.kernel_fmt == KernelFormat::OIHW && facts.len() == 3);
    rule_if!(op.pool_spec.data_format == DataFormat::NCHW);
    rule_if_some!([_, inputs, rows, cols] = map(facts[0]));
    rule_if_some!(window = Window::new(&op.pool_spec, [rows, cols]));
    let outputs = op.output_channels();
    rule_if!(is_fit(&window, inputs, outputs));
    rule_if_some!(weights = facts[1].konst.as_ref().filter(|weights| weights.datum_type() == f32::datum_type()));
    rule_if_some!(bias = of_channels(facts[2], outputs));
    let mut weights = weights.clone().into_tensor();
    let mut bias = bias;
    let (end, activation) = follow(model, node.id, &mut weights, &mut bias)?;
    if op.group == inputs && op.group == outputs && op.group > 1 {
        return replace(model, node, end, Depthwise::new(window, &weights, &bias, activation)?);
    }
    // Narrow groups would leave most of a panel empty.
    rule_if!(op.group == 1 || 2 * (outputs / op.group) >= PANEL);
    replace(model, node, end, Convolve::new(window, op.group, &weights, &bias, activation)?)
}

/// Takes what follows a convolution into its weights, as far as that goes; gives the last node and the activation.
fn follow(model: &TypedModel, from: usize, weights: &mut Tensor, bias: &mut [f32]) -> TractResult<(usize, Activation)> {
    let mut at = from;
    let mut activation = Activation::None;
    while let Some(next) = successor(model, at) {
        if let Some((op, values)) = with_constant(model, next, at, bias.len()) {
            let is_linear = activation == Activation::None;
            if op.0.is::<Mul>() && is_linear {
                let per_output = weights.len() / bias.len();
                let mut plain = weights.try_as_plain_ram_mut()?;
                for (weights, factor) in plain.as_slice_mut::<f32>()?.chunks_exact_mut(per_output).zip(&values) {
                    weights.iter_mut().for_each(|weight| *weight *= factor);
                }
                bias.iter_mut().zip(&values).for_each(|(bias, factor)| *bias *= factor);
            } else if op.0.is::<Add>() && is_linear {
                bias.iter_mut().zip(&values).for_each(|(bias, summand)| *bias += summand);
            } else if let Some(bounded) = bounded(&activation, op, &values) {
                activation = bounded;
            } else {
                break;
            }
        } else if let Some(curve) = curve(next, bias.len()).filter(|_| activation == Activation::None) {
            activation = curve;
        } else if let Some(after) = moved_prelu(model, next).filter(|_| activation == Activation::None) {
            let (end, slopes) = after;
            return Ok((end, slopes));
        } else {
            break;
        }
        at = next.id;
    }
    Ok((at, activation))
}

/// An activation of the engine's that is one of ours.
fn curve(node: &TypedNode, channels: usize) -> Option<Activation> {
    let op = &node.op_as::<ElementWiseOp>()?.0;
    if op.is::<HardSwish>() {
        return Some(Activation::HardSwish);
    }
    let slope = op.downcast_ref::<LeakyRelu>()?.alpha;
    Some(slopes(&vec![slope; channels]))
}

fn slopes(values: &[f32]) -> Activation {
    let mut padded = values.to_vec();
    padded.resize(values.len().next_multiple_of(PANEL) + PANEL, 0.0);
    Activation::Slopes(rctensor1(&padded))
}

/// A PReLU between its moves: its last node, and what it is.
fn moved_prelu(model: &TypedModel, node: &TypedNode) -> Option<(usize, Activation)> {
    node.op_as::<AxisOp>().filter(|op| **op == AxisOp::Move(CHANNELS, LAST))?;
    let prelu = successor(model, node.id)?;
    let op = prelu.op_as::<Prelu>()?;
    let back = successor(model, prelu.id)?;
    back.op_as::<AxisOp>().filter(|op| **op == AxisOp::Move(LAST, CHANNELS))?;
    Some((back.id, slopes(op.slopes.try_as_plain_ram().ok()?.as_slice().ok()?)))
}

fn highest(_: &(), model: &TypedModel, node: &TypedNode, _: &str, op: &MaxPool) -> Rewrite {
    rule_if!(op.with_index_outputs.is_none());
    pool(model, node, &op.pool_spec, Kind::Highest)
}

fn mean(_: &(), model: &TypedModel, node: &TypedNode, _: &str, op: &SumPool) -> Rewrite {
    // With rounding up a window may overhang the padding, which the engine alone counts right.
    let is_plain = !matches!(op.pool_spec.padding, PaddingSpec::ExplicitOnnxPool(_, _, true));
    rule_if!(op.normalize && is_plain);
    pool(model, node, &op.pool_spec, if op.count_include_pad { Kind::MeanOfWindow } else { Kind::Mean })
}

fn pool(
    model: &TypedModel,
    node: &TypedNode,
    spec: &tract_onnx::tract_core::ops::cnn::PoolSpec,
    kind: Kind,
) -> Rewrite {
    rule_if!(spec.data_format == DataFormat::NCHW);
    rule_if_some!([_, channels, rows, cols] = map(model.outlet_fact(node.inputs[0])?));
    rule_if_some!(window = Window::new(spec, [rows, cols]));
    rule_if!(is_fit(&window, channels, channels));
    // A window that meets nothing of the input has no mean.
    let reaches = |axis: usize| window.before[axis] < window.kernel[axis] * window.dilation[axis];
    rule_if!(window.kernel.iter().chain(&window.dilation).all(|n| *n > 0) && reaches(0) && reaches(1));
    replace(model, node, node.id, Pool { window, channels, kind })
}

/// A map with its channels last, and a number for each of them.
fn by_channel(_: &(), model: &TypedModel, node: &TypedNode, _: &str, op: &TypedBinOp) -> Rewrite {
    let facts = model.node_input_facts(node.id)?;
    let is_product = op.0.is::<Mul>();
    let kind = match (op.0.is::<Add>(), op.0.is::<Sub>()) {
        (true, _) => by_channel::Kind::Sum,
        (_, true) => by_channel::Kind::Difference,
        _ => by_channel::Kind::Product,
    };
    rule_if!(is_product || kind != by_channel::Kind::Product);
    let is_map = |fact: &TypedFact| map(fact).is_some_and(|[_, rows, cols, channels]| rows * cols > 1 && channels > 1);
    let slot = usize::from(kind != by_channel::Kind::Difference && !is_map(facts[0]));
    let (taken, numbers) = (facts[slot], facts[1 - slot]);
    rule_if!(is_map(taken) && map(numbers).is_some() && taken.shape == node.outputs[0].fact.shape);
    let (shape, channels) = (&numbers.shape, &taken.shape[LAST]);
    rule_if!(shape[LAST] == *channels && (0..LAST).all(|axis| shape[axis].is_one()));
    let inputs = [node.inputs[slot], node.inputs[1 - slot]];
    TypedModelPatch::replace_single_op(model, node, &inputs, ByChannel { kind }).map(Some)
}
