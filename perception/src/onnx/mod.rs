//! The inference engine. Only this folder and [`crate::operators`] name tract. A model may be anything: it is decoded, looked
//! at, typed and run within stated limits, and whatever goes wrong is an error.

mod bounds;
mod check;
mod decode;
mod engine;
mod guard;
mod operands;
mod typed;

/// ONNX as protobuf messages.
pub(crate) use tract_onnx::pb;

/// Half precision.
pub(crate) use tract_onnx::prelude::f16;

pub(crate) use check::check;
pub(crate) use decode::decode;
pub(crate) use engine::{Element, Engine, Output, Pixels, runtime};
pub(crate) use guard::shown;
