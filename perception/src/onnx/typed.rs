//! From an ONNX graph to one whose types and shapes are known, node by node: the engine's own way ([`into_typed`]
//! of `InferenceModelExt`) computes what follows from weights before anyone can say that it is too much.
//!
//! [`into_typed`]: tract_onnx::prelude::InferenceModelExt::into_typed

use std::collections::{BTreeSet, HashMap};

use tract_onnx::tract_hir::internal::tract_core::model::translator::Translate;
use tract_onnx::tract_hir::internal::*;

use super::bounds::{self, Left};
use super::guard::{note, note_none};
use super::{operands, pb};

/// The nodes of a file by the names that the engine gives them.
pub type Nodes<'a> = HashMap<&'a str, &'a pb::NodeProto>;

/// How often a node's shapes are looked at on average until they are settled.
const MOST_VISITS: usize = 50;

/// The graph with types and shapes, if nothing in it becomes too large; `nodes` are those of the file by name.
pub fn typed(mut model: InferenceModel, nodes: &Nodes<'_>) -> TractResult<TypedModel> {
    analyse(&mut model, nodes)?;
    note_none();
    let model = model.incorporate()?;
    Bounded { nodes, left: Left::default() }.translate_model(&model)
}

fn note_node(node: &InferenceNode, nodes: &Nodes<'_>) {
    match nodes.get(node.name.as_str()) {
        Some(given) => note(&node.name, &given.op_type),
        None => note_none(),
    }
}

/// Settles types and shapes, as `InferenceModelExt::analyse` does.
fn analyse(model: &mut InferenceModel, nodes: &Nodes<'_>) -> TractResult<()> {
    let left = Left::default();
    let mut waiting: BTreeSet<usize> = (0..model.nodes().len()).collect();
    let mut visits = MOST_VISITS * waiting.len();
    while let Some(id) = waiting.pop_first() {
        note_node(model.node(id), nodes);
        visits = visits.checked_sub(1).context("the shapes do not settle")?;
        for outlet in step(model, id, nodes, &left)? {
            waiting.extend(model.node(outlet.node).outputs[outlet.slot].successors.iter().map(|inlet| inlet.node));
            waiting.insert(outlet.node);
        }
        waiting.remove(&id);
    }
    Ok(())
}

/// Settles what one node tells; gives the values of which more is known now.
fn step(model: &mut InferenceModel, id: usize, nodes: &Nodes<'_>, left: &Left) -> TractResult<Vec<OutletId>> {
    let (inputs, outputs) = model.node_facts(id)?;
    let inputs: Vec<InferenceFact> = inputs.into_iter().cloned().collect();
    let outputs: Vec<InferenceFact> = outputs.into_iter().cloned().collect();
    let node = model.node_mut(id);
    nodes.get(node.name.as_str()).map_or(Ok(()), |given| operands::check(given, &inputs))?;
    let expected = node.op.nboutputs()?;
    ensure!(outputs.len() == expected, "it gives {} values, expected {expected}", outputs.len());
    let (shaped_inputs, shaped_outputs, _) =
        node.op.infer_facts(inputs.iter().collect(), outputs.iter().collect(), tvec![])?;
    check_folding(node, &shaped_inputs, &shaped_outputs, left)?;
    let (inputs, outputs, _) = node.op.infer(inputs.iter().collect(), outputs.iter().collect(), tvec![])?;
    let taken = model.node(id).inputs.clone().into_iter().zip(inputs);
    let given = outputs.into_iter().enumerate().map(|(slot, fact)| (OutletId::new(id, slot), fact));
    let mut changed = Vec::new();
    for (outlet, fact) in taken.chain(given) {
        let known = model.outlet_fact(outlet)?;
        let unified = fact.unify(known)?;
        if unified != *known {
            model.set_outlet_fact(outlet, unified)?;
            changed.push(outlet);
        }
    }
    Ok(changed)
}

/// Refuses a node whose values are too large, or which would compute too much from weights alone.
fn check_folding(
    node: &InferenceNode,
    inputs: &[InferenceFact],
    outputs: &[InferenceFact],
    left: &Left,
) -> TractResult<()> {
    let mut grown = 0u64;
    for fact in outputs {
        let size = bounds::bytes(kind(fact), dims(fact).iter().map(Option::as_ref))?;
        grown = grown.saturating_add(size.unwrap_or(0));
    }
    let values: Option<Vec<Arc<Tensor>>> = inputs.iter().map(|fact| fact.value.concretize()).collect();
    let Some(values) = values.filter(|values| !values.is_empty()) else { return Ok(()) };
    // Facts that are settled already were paid for.
    if node.outputs.iter().all(|output| output.fact.value.is_concrete()) {
        return Ok(());
    }
    let given = values.iter().map(|value| (value.len() * value.datum_type().size_of()) as u64).sum();
    left.take_grown(given, grown)?;
    // Operators compute small values while they are wired, but not those of what they do not know.
    match wire(node, &values, false) {
        Some(wired) => left.take_nodes(&wired, 0),
        None if outputs.iter().any(|fact| !fact.shape.is_concrete()) => {
            bail!("how large its value is follows from no shape")
        }
        None => wire(node, &values, true).map_or(Ok(()), |wired| left.take_nodes(&wired, 0)),
    }
}

fn kind(fact: &InferenceFact) -> DatumType {
    fact.datum_type.concretize().unwrap_or(f32::datum_type())
}

fn dims(fact: &InferenceFact) -> Vec<Option<TDim>> {
    fact.shape.dims().map(|dim| dim.concretize()).collect()
}

/// What the operator consists of for these weights, where it can say so; without the numbers of the first, if
/// that must not be known.
fn wire(node: &InferenceNode, values: &[Arc<Tensor>], is_first_known: bool) -> Option<TypedModel> {
    let expansion = node.op_as::<Box<dyn Expansion>>()?;
    let mut model = TypedModel::default();
    let mut sources = Vec::new();
    for (k, value) in values.iter().enumerate() {
        let known = TypedFact::try_from(value.clone()).ok()?;
        let fact = if k > 0 || is_first_known { known } else { known.without_value() };
        sources.push(model.add_source(format!("value-{k}"), fact).ok()?);
    }
    expansion.wire("node", &mut model, &sources).ok()?;
    Some(model)
}

/// The way from settled shapes to operators.
#[derive(Debug)]
struct Bounded<'a> {
    nodes: &'a Nodes<'a>,
    left: Left,
}

impl Translate<InferenceFact, Box<dyn InferenceOp>, TypedFact, Box<dyn TypedOp>> for Bounded<'_> {
    fn translate_node(
        &self,
        source: &InferenceModel,
        node: &InferenceNode,
        target: &mut TypedModel,
        mapping: &HashMap<OutletId, OutletId>,
    ) -> TractResult<TVec<OutletId>> {
        note_node(node, self.nodes);
        let values: Option<Vec<Arc<Tensor>>> =
            node.outputs.iter().map(|output| output.fact.value.concretize()).collect();
        // The picture stays an input even where its value were known, and what has a state keeps it.
        let is_constant = !InferenceModel::is_source(&node.op) && node.op.state(&EvalContext::out_of_plan())?.is_none();
        if let Some(values) = values.filter(|_| is_constant) {
            let constants = values.into_iter().enumerate();
            return constants.map(|(k, value)| target.add_const(format!("{}.{k}", node.name), value)).collect();
        }
        let from = target.nodes().len();
        let outlets = node.op.to_typed(source, node, target, mapping)?;
        self.left.take_nodes(target, from)?;
        outlets.iter().try_for_each(|outlet| target.outlet_fact(*outlet)?.consistent())?;
        Ok(outlets)
    }
}
