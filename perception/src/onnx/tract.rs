//! Networks run by tract, on the CPU with operators of our own, or on an NVIDIA GPU.

use std::collections::HashMap;
use std::panic::catch_unwind;
use std::sync::{Arc, OnceLock};

// Only looked for by name, among the runtimes that are linked.
#[cfg(feature = "cuda")]
use tract_cuda as _;
use tract_onnx::model::{OnnxOpRegister, ParsingContext};
use tract_onnx::tract_hir::internal::*;

use super::guard::{line, note, note_none};
use super::plan::{Element, Engine, Output, Pixels, Plan};
use super::typed::{Nodes, typed};
use super::{bounds, pb};
use crate::operators;

/// What tract calls a device.
pub type Device = &'static dyn Runtime;

/// A network optimised for one input shape on one device.
struct Optimised {
    plan: Arc<dyn Runnable>,
    /// The operator of every node of the file by its name.
    operators: HashMap<String, String>,
    input_shape: [usize; 4],
}

/// The runtime of a name, if it works here; the error says why not.
pub fn runtime(name: &str) -> Result<Device, String> {
    // Libraries that are found but lack a symbol make their bindings panic.
    let found = catch_unwind(|| runtime_for_name(name)).map_err(|_| "its libraries do not fit".to_owned())?;
    found.map_err(reason)?.ok_or_else(|| format!("this program was built without it (the feature {name})"))
}

/// What the engine says of an error, as one line.
fn reason(error: TractError) -> String {
    line(&error.root_cause().to_string())
}

/// The same of a step that names no node by itself: the engine may have quoted one, of which the operator is looked up.
fn reason_of<'a>(error: TractError, operator: impl Fn(&str) -> Option<&'a str>) -> String {
    let texts: Vec<String> = error.chain().map(ToString::to_string).collect();
    let quoted = texts.iter().flat_map(|text| text.split('"').skip(1).step_by(2));
    // What the engine adds to a node is called after it.
    let known = quoted.flat_map(|name| [name, name.rsplit_once('.').map_or(name, |(node, _)| node)]);
    if let Some((name, operator)) = known.into_iter().find_map(|name| Some((name, operator(name)?))) {
        note(name, operator);
    }
    reason(error)
}

/// The nodes of a model by the names that the engine gives them.
fn nodes(model: &pb::ModelProto) -> Nodes<'_> {
    model.graph.iter().flat_map(|graph| &graph.node).map(|node| (name(node), node)).collect()
}

fn name(node: &pb::NodeProto) -> &str {
    if node.name.is_empty() { node.output.first().unwrap_or(&node.name) } else { &node.name }
}

/// The engine's operators of ONNX.
fn known_operators() -> &'static OnnxOpRegister {
    static KNOWN: OnceLock<OnnxOpRegister> = OnceLock::new();
    KNOWN.get_or_init(|| tract_onnx::onnx().op_register)
}

/// Makes an operator of a node, which is noted.
fn build(context: &ParsingContext, node: &pb::NodeProto) -> TractResult<(Box<dyn InferenceOp>, Vec<String>)> {
    note(name(node), &node.op_type);
    let builder = known_operators().0.get(&node.op_type).context("the operator is not known")?;
    builder(context, node)
}

fn parse(model: &pb::ModelProto) -> TractResult<InferenceModel> {
    // Shapes noted by exporters for dynamic sizes contradict the size that is fixed here.
    let mut parser = tract_onnx::onnx().with_ignore_value_info(true);
    parser.op_register.0.values_mut().for_each(|builder| *builder = build);
    for node in model.graph.iter().flat_map(|graph| &graph.node) {
        note(name(node), &node.op_type);
        ensure!(known_operators().0.contains_key(&node.op_type), "the operator is not supported");
    }
    note_none();
    let parsed = parser.parse(model, None)?;
    note_none();
    if let Some(name) = parsed.unresolved_inputs.first() {
        bail!("value {name:?} is used but never computed");
    }
    Ok(parsed.model)
}

/// Prepares a model for inputs of one shape.
pub fn prepare(
    runtime: Device,
    model: &pb::ModelProto,
    element: Element,
    mut input_shape: [usize; 4],
) -> Result<Engine, String> {
    let kind = match element {
        Element::Float => f32::datum_type(),
        Element::Byte => u8::datum_type(),
    };
    let input = InferenceFact::dt_shape(kind, input_shape);
    let nodes = nodes(model);
    let operator = |name: &str| nodes.get(name).map(|node| node.op_type.as_str());
    let parsed = parse(model).and_then(|model| model.with_input_fact(0, input)).map_err(reason)?;
    let network = typed(parsed, &nodes).map_err(reason)?;
    note_none();
    bounds::check_work(&network).map_err(reason)?;
    network.output_fact(0).map_err(reason)?.shape.as_concrete().ok_or("the output has no fixed shape")?;
    let (mut network, mut takes_last, mut is_moved) = (network, false, false);
    if runtime.name() == "cpu" {
        network = operators::prepare(network).map_err(|error| reason_of(error, operator))?;
        let taken = operators::take_channels_last(&mut network).map_err(reason)?;
        (takes_last, input_shape) = (taken.is_some(), taken.unwrap_or(input_shape));
        is_moved = operators::give_channels_last(&mut network);
    }
    let output = network.output_fact(0).map_err(reason)?;
    let shape = output.shape.as_concrete().ok_or("the output has no fixed shape")?;
    let (output_shape, gives_ids) = (shape.to_vec(), !output.datum_type.is_float());
    let plan = runtime.prepare(network).map_err(|error| reason_of(error, operator))?;
    // A GPU has memory of its own, and what runs there has run here before.
    if let Some(model) = plan.typed_model().filter(|_| runtime.name() == "cpu") {
        bounds::check_alive(model).map_err(|error| reason_of(error, operator))?;
    }
    let operators = nodes.iter().map(|(name, node)| ((*name).to_owned(), node.op_type.clone())).collect();
    let plan = Arc::new(Optimised { plan: plan.into(), operators, input_shape });
    Ok(Engine { plan, takes_last, output_shape, is_moved, gives_ids })
}

impl Plan for Optimised {
    fn run(&self, pixels: Pixels<'_>) -> Result<(Vec<usize>, Output), String> {
        let operator = |name: &str| self.operators.get(name).map(String::as_str);
        self.evaluate(pixels).map_err(|error| reason_of(error, operator))
    }
}

impl Optimised {
    fn evaluate(&self, pixels: Pixels<'_>) -> TractResult<(Vec<usize>, Output)> {
        let input = match pixels {
            Pixels::Float(values) => Tensor::from_shape(&self.input_shape, values)?,
            Pixels::Byte(values) => Tensor::from_shape(&self.input_shape, values)?,
        };
        let outputs = self.plan.run(tvec!(input.into_tvalue()))?;
        let values = &outputs[0];
        let output = match values.datum_type().is_float() {
            true => Output::Scores(values.cast_to::<f32>()?.try_as_plain_ram()?.as_slice::<f32>()?.to_vec()),
            false => Output::Ids(values.cast_to::<i64>()?.try_as_plain_ram()?.as_slice::<i64>()?.to_vec()),
        };
        Ok((values.shape().to_vec(), output))
    }
}

#[cfg(test)]
mod tests {
    use super::super::guard::guarded;
    use super::*;

    #[test]
    fn a_node_that_the_engine_quotes_is_named_with_its_operator() {
        let said = |step: &'static str| {
            let error = format_err!("no room").context(step);
            guarded::<()>(|| Err(reason_of(error, |name| (name == "a").then_some("Gather")))).unwrap_err()
        };
        assert_eq!(said("Evaluating #3 \"a.index\" Op"), "node \"a\" (Gather): no room");
        assert_eq!(said("Evaluating #3 \"b\" Op"), "no room");
    }
}
