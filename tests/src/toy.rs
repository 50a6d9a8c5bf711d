//! A network that sees nothing but road, written by hand.

use std::fs;
use std::path::{Path, PathBuf};

/// Writes `road.onnx`, which takes 64x32 pixels and calls all of them road, with its sidecar.
pub fn all_road(folder: &Path) -> PathBuf {
    let path = folder.join("road.onnx");
    fs::write(&path, model()).expect("writable");
    let sidecar = "classes = [\"Road\", \"Pedestrian\"]\nmean = [0, 0, 0]\nstd = [1, 1, 1]\n";
    fs::write(folder.join("road.toml"), sidecar).expect("writable");
    path
}

/// An ONNX `ModelProto`: a convolution whose weights are 0, so that its biases decide.
fn model() -> Vec<u8> {
    let inputs = ["image", "weights", "biases"].map(|name| field(1, name.as_bytes()));
    let node = [inputs.concat(), field(2, b"scores"), field(3, b"conv"), field(4, b"Conv")].concat();
    let graph = [
        field(1, &node),
        field(2, b"road"),
        field(5, &tensor("weights", &[2, 3, 1, 1], &[0.0; 6])),
        field(5, &tensor("biases", &[2], &[1.0, 0.0])),
        field(11, &value("image", &[1, 3, 32, 64])),
        field(12, &value("scores", &[1, 2, 32, 64])),
    ];
    let opset = [field(1, b""), number(2, 13)].concat();
    [number(1, 8), field(7, &graph.concat()), field(8, &opset)].concat()
}

/// A `TensorProto` of floats.
fn tensor(name: &str, dims: &[u64], values: &[f32]) -> Vec<u8> {
    let dims: Vec<u8> = dims.iter().flat_map(|n| number(1, *n)).collect();
    let raw: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    [dims, number(2, FLOAT), field(8, name.as_bytes()), field(9, &raw)].concat()
}

/// A `ValueInfoProto` of floats.
fn value(name: &str, dims: &[u64]) -> Vec<u8> {
    let shape: Vec<u8> = dims.iter().flat_map(|n| field(1, &number(1, *n))).collect();
    let kind = field(1, &[number(1, FLOAT), field(2, &shape)].concat());
    [field(1, name.as_bytes()), field(2, &kind)].concat()
}

/// `TensorProto.DataType.FLOAT`.
const FLOAT: u64 = 1;

/// A protobuf field of bytes.
fn field(tag: u64, bytes: &[u8]) -> Vec<u8> {
    [varint(tag << 3 | 2), varint(bytes.len() as u64), bytes.to_vec()].concat()
}

/// A protobuf field that is a number.
fn number(tag: u64, value: u64) -> Vec<u8> {
    [varint(tag << 3), varint(value)].concat()
}

fn varint(mut value: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}
