//! The inference engines: tract, which only this folder and [`crate::operators`] name, and onnxruntime where it is at hand. A
//! model may be anything: it is decoded, looked at, typed and run within stated limits, and whatever goes wrong is an error.

mod bounds;
mod check;
mod decode;
mod engine;
mod guard;
mod onnxruntime;
mod operands;
mod plan;
mod tract;
mod typed;

/// ONNX as protobuf messages.
pub(crate) use tract_onnx::pb;

/// Half precision.
pub(crate) use tract_onnx::prelude::f16;

pub(crate) use check::check;
pub(crate) use decode::decode;
pub(crate) use engine::runtime;
pub(crate) use guard::shown;
pub(crate) use onnxruntime::NAME as ONNX_RUNTIME;
pub use onnxruntime::environment;
pub(crate) use plan::{Element, Engine, Output, Pixels};
