//! The only file that names tract.

/// ONNX as protobuf messages.
pub(crate) use tract_onnx::pb;
