//! What operators take for granted: axes that their values have, and windows that fit them. The engine counts and
//! reaches beyond its values where it is not so.

use std::ops::Range;

use tract_onnx::tract_hir::internal::*;

use super::bounds::MOST_DIMS;
use super::pb;

/// Operators that move a window over rows and columns, and how many of their values share its rank.
const SLIDING: [(&str, usize); 7] = [
    ("AveragePool", 1),
    ("Conv", 2),
    ("ConvInteger", 2),
    ("ConvTranspose", 2),
    ("LpPool", 1),
    ("MaxPool", 1),
    ("QLinearConv", 1),
];

/// Operators that want batch and channels.
const OF_CHANNELS: [&str; 8] = [
    "BatchNormalization",
    "DepthToSpace",
    "GlobalAveragePool",
    "GlobalMaxPool",
    "GroupNormalization",
    "InstanceNormalization",
    "LRN",
    "SpaceToDepth",
];

/// Operators whose inputs list dimensions or axes, and which inputs do.
const LISTS: [(&str, Range<usize>); 9] = [
    ("ConstantOfShape", 0..1),
    ("Expand", 1..2),
    ("Pad", 1..2),
    ("Reshape", 1..2),
    ("Resize", 1..4),
    ("Slice", 1..5),
    ("Squeeze", 1..2),
    ("Tile", 1..2),
    ("Unsqueeze", 1..2),
];

/// Refuses a node whose attributes do not fit its values, as far as these are known.
pub fn check(node: &pb::NodeProto, inputs: &[InferenceFact]) -> TractResult<()> {
    check_lists(node, inputs)?;
    let Some(rank) = inputs.first().and_then(rank) else { return Ok(()) };
    check_axes(node, rank)?;
    match node.op_type.as_str() {
        "Range" => check_range(inputs)?,
        "Tile" => check_tiles(inputs)?,
        "Transpose" => check_order(node, rank)?,
        _ => {}
    }
    let wants_channels = OF_CHANNELS.contains(&node.op_type.as_str());
    ensure!(rank > 1 || !wants_channels, "its value has {rank} dimensions, expected at least batch and channels");
    match SLIDING.iter().find(|(operator, _)| *operator == node.op_type) {
        Some((_, count)) => check_window(node, rank, &inputs[..inputs.len().min(*count)]),
        None => Ok(()),
    }
}

/// Lists about dimensions are as long as values have dimensions, or twice that.
fn check_lists(node: &pb::NodeProto, inputs: &[InferenceFact]) -> TractResult<()> {
    let Some((_, lists)) = LISTS.iter().find(|(operator, _)| *operator == node.op_type) else { return Ok(()) };
    for list in inputs.get(lists.clone()).or(inputs.get(lists.start..)).unwrap_or_default() {
        let count = list.shape.concretize().and_then(|dims| dims.iter().product::<TDim>().to_usize().ok());
        let most = 2 * MOST_DIMS;
        ensure!(
            count.is_none_or(|count| count <= most),
            "{} numbers say what to do with dimensions; at most {most}",
            count.unwrap_or_default()
        );
    }
    Ok(())
}

fn rank(fact: &InferenceFact) -> Option<i64> {
    fact.shape.rank().concretize()
}

/// A range counts in numbers whose differences are exact, and not for ever.
fn check_range(inputs: &[InferenceFact]) -> TractResult<()> {
    let number = |fact: &InferenceFact| fact.value.concretize()?.cast_to_scalar::<f64>().ok();
    let numbers: Option<Vec<f64>> = inputs.iter().map(number).collect();
    let Some([start, limit, step]) = numbers.as_deref() else { return Ok(()) };
    let count = (limit - start) / step;
    let is_exact = [start, limit, step].into_iter().all(|number| number.abs() < (1u64 << 53) as f64);
    ensure!(is_exact && count.abs() < (1 << 28) as f64, "it counts from {start} to {limit} in steps of {step}");
    Ok(())
}

/// Tiles are laid one by one, even those of nothing.
fn check_tiles(inputs: &[InferenceFact]) -> TractResult<()> {
    let Some(repeats) = inputs.get(1).and_then(|fact| fact.value.concretize()) else { return Ok(()) };
    let repeats = repeats.cast_to::<i64>()?;
    let repeats = repeats.try_as_plain_ram()?.as_slice::<i64>()?;
    let count = repeats.iter().try_fold(1u64, |count, n| count.checked_mul(u64::try_from(*n).ok()?.max(1)));
    ensure!(count.is_some_and(|count| count < 1 << 28), "it repeats its value {repeats:?} times");
    Ok(())
}

/// An order names every axis once.
fn check_order(node: &pb::NodeProto, rank: i64) -> TractResult<()> {
    let Some(order) = node.attribute.iter().find(|attribute| attribute.name == "perm") else { return Ok(()) };
    let mut axes = order.ints.clone();
    axes.sort_unstable();
    ensure!(
        axes.iter().copied().eq(0..rank),
        "perm is {:?}, expected every axis from 0 to {} once",
        order.ints,
        rank - 1
    );
    Ok(())
}

/// Axes are those of the first value.
fn check_axes(node: &pb::NodeProto, rank: i64) -> TractResult<()> {
    for attribute in node.attribute.iter().filter(|attribute| ["axis", "axes"].contains(&attribute.name.as_str())) {
        let added = match node.op_type.as_str() {
            "Unsqueeze" => attribute.ints.len() as i64,
            "OneHot" => 1,
            _ => 0,
        };
        let mut given = attribute.ints.iter().copied().chain([attribute.i]);
        if let Some(odd) = given.find(|axis| !(-rank - added..=rank + added).contains(axis)) {
            bail!("{} is {odd}, but the first of its values has {rank} dimensions", attribute.name);
        }
    }
    Ok(())
}

/// A window has as many sides as its values have dimensions after batch and channels.
fn check_window(node: &pb::NodeProto, expected: i64, inputs: &[InferenceFact]) -> TractResult<()> {
    ensure!(expected > 2, "it moves a window over a value of {expected} dimensions, expected at least 3");
    if let Some(odd) = inputs.iter().filter_map(rank).find(|rank| *rank != expected) {
        bail!("its values have {expected} and {odd} dimensions, expected as many of each");
    }
    let sides = (expected - 2) as usize;
    for attribute in &node.attribute {
        let wanted = match attribute.name.as_str() {
            "kernel_shape" | "strides" | "dilations" | "output_padding" => sides,
            "pads" => 2 * sides,
            _ => continue,
        };
        let found = attribute.ints.len();
        ensure!(found == wanted, "{} has {found} numbers, expected {wanted}", attribute.name);
    }
    Ok(())
}
