//! How much of a machine a network may ask for. Every size is known before anything of that size is made.

use std::cell::Cell;
use std::collections::HashMap;

use tract_onnx::tract_core::ops::cnn::{MaxPool, SumPool};
use tract_onnx::tract_hir::internal::*;

use super::guard::{note, note_none};

/// Most bytes of values that are alive at once while a picture is computed, weights aside.
const MOST_ALIVE: u64 = 1 << 30;
/// Most dimensions of a value.
pub const MOST_DIMS: usize = 16;
/// Most bytes that values computed from weights alone take beyond those they are computed from.
const MOST_GROWN: u64 = 1 << 29;
/// Most multiplications for values computed from weights alone.
const MOST_FOLDED: u64 = 1 << 35;
/// Most places that a pooling operator looks at for one output: the engine lists them.
const MOST_WINDOW: u64 = 1 << 21;
/// How many multiplications the engine makes in the time in which a pooling operator looks at one place.
const LOOK_WORK: u64 = 64;
/// Most multiplications for a picture.
const MOST_WORK: u64 = 1 << 43;

/// Bytes that a value of a shape takes; `None` where a dimension is not known yet.
pub fn bytes<'a>(kind: DatumType, dims: impl IntoIterator<Item = Option<&'a TDim>>) -> TractResult<Option<u64>> {
    let (mut bytes, mut is_known, mut rank) = (Some(kind.size_of() as u64), true, 0);
    for dim in dims {
        rank += 1;
        match dim.map(TDim::to_i64) {
            Some(Ok(n)) => {
                let n = u64::try_from(n).map_err(|_| format_err!("a value would have a dimension of {n}"))?;
                // One of 0 holds nothing, and yet the engine counts through the others.
                bytes = bytes.and_then(|bytes| bytes.checked_mul(n.max(1)));
            }
            _ => is_known = false,
        }
    }
    ensure!(rank <= MOST_DIMS, "a value would have {rank} dimensions; at most {MOST_DIMS}");
    // Without the unknown dimensions, which may be 0, nothing can be said.
    if !is_known {
        return Ok(None);
    }
    match bytes.filter(|bytes| *bytes <= MOST_ALIVE) {
        Some(bytes) => Ok(Some(bytes)),
        None => bail!("a value would take {}; at most {}", mib(bytes.unwrap_or(u64::MAX)), mib(MOST_ALIVE)),
    }
}

fn mib(bytes: u64) -> String {
    format!("{} MiB", bytes >> 20)
}

/// Bytes that a typed value takes, packed ones included.
fn fact_bytes(fact: &TypedFact) -> TractResult<Option<u64>> {
    let plain = bytes(fact.datum_type, fact.shape.iter().map(Some))?;
    let packed = fact.exotic_fact().map_or(Some(0), |packed| {
        packed.buffer_sizes().iter().try_fold(0u64, |sum, size| sum.checked_add(size.to_i64().ok()?.try_into().ok()?))
    });
    Ok(plain.zip(packed).map(|(plain, packed)| plain.saturating_add(packed)))
}

/// What is left to be asked for by values that follow from weights alone.
#[derive(Debug)]
pub struct Left {
    grown: Cell<u64>,
    folded: Cell<u64>,
}

impl Default for Left {
    fn default() -> Self {
        Self { grown: Cell::new(MOST_GROWN), folded: Cell::new(MOST_FOLDED) }
    }
}

impl Left {
    /// Takes what a value computed from weights takes beyond them.
    pub fn take_grown(&self, from: u64, to: u64) -> TractResult<()> {
        let left = self.grown.get().checked_sub(to.saturating_sub(from));
        self.grown.set(left.with_context(|| {
            format!("with those before more than {} of values would be computed from weights alone", mib(MOST_GROWN))
        })?);
        Ok(())
    }

    /// Takes what nodes added to a model from a number on ask for; those that depend on the picture only have to be
    /// of a size that is possible.
    pub fn take_nodes(&self, model: &TypedModel, from: usize) -> TractResult<()> {
        for node in &model.nodes()[from..] {
            let mut grown = 0u64;
            for output in &node.outputs {
                grown = grown.saturating_add(fact_bytes(&output.fact)?.unwrap_or(0));
            }
            let inputs = model.node_input_facts(node.id)?;
            if inputs.is_empty() || inputs.iter().any(|fact| fact.konst.is_none()) {
                continue;
            }
            let given: u64 = inputs.iter().filter_map(|fact| fact_bytes(fact).ok().flatten()).sum();
            self.take_grown(given, grown)?;
            let left = self.folded.get().checked_sub(work(node, &inputs)?);
            self.folded.set(left.context("it would compute too much from weights alone")?);
        }
        Ok(())
    }
}

/// Multiplications of a node, or what takes as long.
fn work(node: &TypedNode, inputs: &[&TypedFact]) -> TractResult<u64> {
    let counts = node.op.cost(inputs)?;
    let counted = counts.iter().filter(|(kind, _)| kind.is_compute()).map(|(_, count)| count.to_i64().unwrap_or(0));
    let work = counted.fold(0u64, |sum, count| sum.saturating_add(u64::try_from(count).unwrap_or(u64::MAX)));
    Ok(work.saturating_add(pooling(node)?))
}

/// The work of a pooling operator, which the engine does not count: its whole window for every output.
fn pooling(node: &TypedNode) -> TractResult<u64> {
    let spec = node.op_as::<MaxPool>().map(|pool| &pool.pool_spec);
    let Some(spec) = spec.or_else(|| node.op_as::<SumPool>().map(|pool| &pool.pool_spec)) else { return Ok(0) };
    let window = spec.kernel_shape.iter().fold(1u64, |area, side| area.saturating_mul(*side as u64));
    ensure!(window <= MOST_WINDOW, "its window is {:?}; at most {MOST_WINDOW} places", spec.kernel_shape);
    let outputs = node.outputs[0].fact.shape.as_concrete().map_or(0, |dims| dims.iter().product::<usize>());
    Ok(LOOK_WORK.saturating_mul(window).saturating_mul(outputs as u64))
}

/// Refuses a network that multiplies too much for a picture.
pub fn check_work(model: &TypedModel) -> TractResult<()> {
    let mut sum = 0u64;
    for node in model.nodes() {
        note(&node.name, &node.op.name());
        sum = sum.saturating_add(work(node, &model.node_input_facts(node.id)?)?);
    }
    note_none();
    ensure!(sum <= MOST_WORK, "it takes {sum} multiplications a picture; at most {MOST_WORK}");
    Ok(())
}

/// Refuses a network that is ready to run but would hold too much at once, or values whose size no shape tells.
pub fn check_alive(model: &TypedModel) -> TractResult<()> {
    let order = model.eval_order()?;
    let mut last_use = HashMap::new();
    for (step, &id) in order.iter().enumerate() {
        model.node(id).inputs.iter().for_each(|input| _ = last_use.insert(input.node, step));
    }
    let sizes = |id: usize| -> TractResult<u64> {
        model.node(id).outputs.iter().try_fold(0u64, |sum, output| {
            let size = fact_bytes(&output.fact)?;
            let size =
                size.with_context(|| format!("how large node {:?} is follows from no shape", model.node(id).name))?;
            Ok(sum.saturating_add(size))
        })
    };
    let mut ends: Vec<Vec<usize>> = vec![Vec::new(); order.len()];
    last_use.iter().for_each(|(&id, &step)| ends[step].push(id));
    let mut alive = 0u64;
    for (step, &id) in order.iter().enumerate() {
        if is_weight(model, id) {
            continue;
        }
        alive = alive.saturating_add(sizes(id)?);
        ensure!(alive <= MOST_ALIVE, "values alive at once would take {}; at most {}", mib(alive), mib(MOST_ALIVE));
        for &end in ends[step].iter().filter(|&&end| !is_weight(model, end)) {
            alive = alive.saturating_sub(sizes(end)?);
        }
    }
    Ok(())
}

fn is_weight(model: &TypedModel, id: usize) -> bool {
    model.node(id).outputs.iter().all(|output| output.fact.konst.is_some())
}
