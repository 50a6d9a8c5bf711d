//! The engines there are, by name.

use super::guard::guarded_thread;
use super::onnxruntime::{self, Environment};
use super::plan::{Element, Engine};
use super::{pb, tract};

/// What prepares networks and runs them.
#[derive(Clone)]
pub(crate) enum Runtime {
    Tract(tract::Device),
    OnnxRuntime(Environment),
}

/// The runtime of a name, if it works here; the error says why not.
pub(crate) fn runtime(name: &str) -> Result<Runtime, String> {
    match name {
        onnxruntime::NAME => onnxruntime::environment().map(Runtime::OnnxRuntime),
        _ => tract::runtime(name).map(Runtime::Tract),
    }
}

impl Engine {
    /// Prepares a model for inputs of one shape.
    pub fn new(
        runtime: Runtime,
        model: &pb::ModelProto,
        element: Element,
        input_shape: [usize; 4],
    ) -> Result<Self, String> {
        guarded_thread(|| match &runtime {
            Runtime::Tract(runtime) => tract::prepare(*runtime, model, element, input_shape),
            Runtime::OnnxRuntime(environment) => onnxruntime::prepare(environment, model, element, input_shape),
        })
    }
}
