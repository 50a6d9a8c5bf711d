//! The inference engine. This is the only file that names tract.

use std::panic::catch_unwind;
use std::path::Path;
use std::sync::Arc;

use prost::Message;
// Only looked for by name, among the runtimes that are linked.
#[cfg(feature = "cuda")]
use tract_cuda as _;
use tract_onnx::prelude::*;

/// ONNX as protobuf messages.
pub(crate) use tract_onnx::pb;

/// What the network takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    Float,
    Byte,
}

/// One picture in the network's own form.
pub(crate) enum Pixels<'a> {
    Float(&'a [f32]),
    Byte(&'a [u8]),
}

/// What the network gives.
pub(crate) enum Output {
    Scores(Vec<f32>),
    Ids(Vec<i64>),
}

/// A network optimised for one input shape on one device; clones share the weights.
#[derive(Clone)]
pub(crate) struct Engine {
    plan: Arc<dyn Runnable>,
    input_shape: [usize; 4],
    /// Shape of the first output.
    pub output_shape: Vec<usize>,
    /// Whether the first output holds class ids instead of scores.
    pub gives_ids: bool,
}

/// Decodes an ONNX file; the error is what is wrong with it.
pub(crate) fn decode(bytes: &[u8]) -> Result<pb::ModelProto, String> {
    let model = pb::ModelProto::decode(bytes).map_err(|e| e.to_string())?;
    match &model.graph {
        Some(graph) if !graph.node.is_empty() => Ok(model),
        _ => Err("it holds no graph".into()),
    }
}

/// The runtime of a name, if it works here; the error says why not.
pub(crate) fn runtime(name: &str) -> Result<&'static dyn Runtime, String> {
    // Libraries that are found but lack a symbol make their bindings panic.
    let found = catch_unwind(|| runtime_for_name(name)).map_err(|_| "its libraries do not fit".to_owned())?;
    found.map_err(reason)?.ok_or_else(|| format!("this program was built without it (the feature {name})"))
}

fn reason(error: TractError) -> String {
    error.root_cause().to_string().replace('\n', " ")
}

impl Engine {
    /// Prepares a model for inputs of one shape; external weights are looked for in `dir`.
    pub fn new(
        runtime: &dyn Runtime,
        model: &pb::ModelProto,
        dir: Option<&Path>,
        element: Element,
        input_shape: [usize; 4],
    ) -> Result<Self, String> {
        let kind = match element {
            Element::Float => f32::datum_type(),
            Element::Byte => u8::datum_type(),
        };
        Self::prepare(runtime, model, dir, InferenceFact::dt_shape(kind, input_shape), input_shape).map_err(reason)
    }

    fn prepare(
        runtime: &dyn Runtime,
        model: &pb::ModelProto,
        dir: Option<&Path>,
        input: InferenceFact,
        input_shape: [usize; 4],
    ) -> TractResult<Self> {
        // Shapes noted by exporters for dynamic sizes contradict the size that is fixed here.
        let parser = tract_onnx::onnx().with_ignore_value_info(true);
        let parsed = parser.parse(model, dir.and_then(Path::to_str))?;
        if let Some(name) = parsed.unresolved_inputs.first() {
            return Err(TractError::msg(format!("value {name} is used but never computed")));
        }
        let network = parsed.model.with_input_fact(0, input)?.into_typed()?;
        let output = network.output_fact(0)?;
        let shape = output.shape.as_concrete().ok_or_else(|| TractError::msg("the output has no fixed shape"))?;
        Ok(Self {
            output_shape: shape.to_vec(),
            gives_ids: !output.datum_type.is_float(),
            input_shape,
            plan: runtime.prepare(network)?.into(),
        })
    }

    /// Runs the network on one picture.
    pub fn run(&self, pixels: Pixels<'_>) -> Result<Output, String> {
        self.evaluate(pixels).map_err(reason)
    }

    fn evaluate(&self, pixels: Pixels<'_>) -> TractResult<Output> {
        let input = match pixels {
            Pixels::Float(values) => Tensor::from_shape(&self.input_shape, values)?,
            Pixels::Byte(values) => Tensor::from_shape(&self.input_shape, values)?,
        };
        let outputs = self.plan.run(tvec!(input.into_tvalue()))?;
        let values = &outputs[0];
        Ok(if self.gives_ids {
            Output::Ids(values.cast_to::<i64>()?.try_as_plain_ram()?.as_slice::<i64>()?.to_vec())
        } else {
            Output::Scores(values.cast_to::<f32>()?.try_as_plain_ram()?.as_slice::<f32>()?.to_vec())
        })
    }
}
