//! Small networks with many kinds of operators, for tests that damage them.

use crate::Metadata;
use crate::forms;
use crate::metadata::Normalisation;
use crate::onnx::pb::{self, tensor_proto::DataType};
pub use crate::parts::numbers;
use crate::parts::{int, ints, text, value};
use crate::toy::{self, Tail, Toy, finish, floats, node};

/// Every network; each takes pictures of 32 x 16 pixels or any, and gives scores of three classes.
pub fn networks() -> Vec<pb::ModelProto> {
    let tails = [Tail::None, Tail::Upsample, Tail::Argmax, Tail::CoarseArgmax];
    let mut all: Vec<_> = tails.into_iter().map(|tail| Toy { tail, ..Toy::default() }.model()).collect();
    all.extend([encoder(), shapes(), products(), pads()]);
    all.extend([DataType::Float16, DataType::Int32].map(|element| Toy { element, ..Toy::default() }.model()));
    all.extend([
        forms::heads(Metadata { output: Some("coarse".into()), ..metadata() }),
        forms::baked(4),
        forms::squeezed(),
    ]);
    all
}

fn metadata() -> Metadata {
    Metadata { normalisation: Some(Normalisation { mean: [0.5; 3], std: [0.25; 3] }), ..toy::metadata() }
}

/// Weights without any order.
pub fn weights(name: &str, dims: &[i64]) -> pb::TensorProto {
    let count: i64 = dims.iter().product();
    floats(name, dims, (0..count).map(|i| (i * 37 % 17) as f32 / 17.0 - 0.5).collect())
}

pub fn network(nodes: Vec<pb::NodeProto>, initializer: Vec<pb::TensorProto>) -> pb::ModelProto {
    let graph = pb::GraphProto {
        node: nodes,
        initializer,
        input: vec![value("image", DataType::Float, &[1, 3, 16, 32])],
        output: vec![value("scores", DataType::Float, &[1, 3, -1, -2])],
        ..Default::default()
    };
    finish(graph, Some(&metadata()))
}

/// Convolutions, pools and what stands between them.
fn encoder() -> pb::ModelProto {
    let strided = || vec![ints("kernel_shape", &[3, 3]), ints("strides", &[2, 2]), ints("pads", &[1, 1, 1, 1])];
    let pool = || vec![ints("kernel_shape", &[2, 2]), ints("strides", &[2, 2])];
    let nodes = vec![
        node("Conv", &["image", "w1", "b1"], "a", strided()),
        node("BatchNormalization", &["a", "b1", "b1", "b1", "v1"], "b", vec![]),
        node("Relu", &["b"], "c", vec![]),
        node(
            "Conv",
            &["c", "w2"],
            "d",
            vec![int("group", 4), ints("kernel_shape", &[3, 3]), ints("pads", &[1, 1, 1, 1])],
        ),
        node("MaxPool", &["d"], "e", pool()),
        node("AveragePool", &["d"], "f", pool()),
        node("Concat", &["e", "f"], "g", vec![int("axis", 1)]),
        node("GlobalAveragePool", &["g"], "h", vec![]),
        node("Sigmoid", &["h"], "i", vec![]),
        node("Mul", &["g", "i"], "j", vec![]),
        node("ConvTranspose", &["j", "w3"], "k", pool()),
        node("LeakyRelu", &["k"], "scores", vec![]),
    ];
    let initializer = vec![
        weights("w1", &[4, 3, 3, 3]),
        weights("b1", &[4]),
        floats("v1", &[4], vec![1.0; 4]),
        weights("w2", &[4, 1, 3, 3]),
        weights("w3", &[8, 3, 2, 2]),
    ];
    network(nodes, initializer)
}

/// Shapes computed from shapes, as exporters write them for open sizes.
fn shapes() -> pb::ModelProto {
    let nodes = vec![
        node("Shape", &["image"], "shape", vec![]),
        node("Slice", &["shape", "two", "four", "zero"], "size", vec![]),
        node("Div", &["size", "two"], "half", vec![]),
        node("Concat", &["batch", "half"], "wanted", vec![int("axis", 0)]),
        node("Resize", &["image", "", "", "wanted"], "small", vec![text("mode", "linear")]),
        node("ConstantOfShape", &["half"], "nothing", vec![]),
        node("Expand", &["nothing", "wanted"], "blank", vec![]),
        node("Add", &["small", "blank"], "sum", vec![]),
        node("Range", &["start", "limit", "step"], "range", vec![]),
        node("Cast", &["range"], "column", vec![int("to", DataType::Float as i64)]),
        node("Unsqueeze", &["column", "zero"], "row", vec![]),
        node("Tile", &["row", "tiles"], "plane", vec![]),
        node("Add", &["sum", "plane"], "more", vec![]),
        node("Reshape", &["more", "flat"], "flattened", vec![]),
        node("Reshape", &["flattened", "wanted"], "scores", vec![]),
    ];
    let scalar = |name: &str, number: i64| pb::TensorProto { dims: vec![], ..numbers(name, &[number]) };
    let initializer = vec![
        numbers("zero", &[0]),
        numbers("two", &[2]),
        numbers("four", &[4]),
        numbers("batch", &[1, 3]),
        numbers("tiles", &[8, 1]),
        numbers("flat", &[1, 3, -1]),
        scalar("start", 0),
        scalar("limit", 16),
        scalar("step", 1),
    ];
    network(nodes, initializer)
}

/// Products and attention, as transformers have them.
fn products() -> pb::ModelProto {
    let nodes = vec![
        node("AveragePool", &["image"], "small", vec![ints("kernel_shape", &[4, 4]), ints("strides", &[4, 4])]),
        node("Reshape", &["small", "tokens"], "a", vec![]),
        node("Transpose", &["a"], "b", vec![ints("perm", &[0, 2, 1])]),
        node("MatMul", &["b", "w"], "c", vec![]),
        node("MatMul", &["c", "a"], "d", vec![]),
        node("Softmax", &["d"], "e", vec![int("axis", -1)]),
        node("MatMul", &["e", "c"], "f", vec![]),
        node("LayerNormalization", &["f", "scale"], "g", vec![int("axis", -1)]),
        node("Gemm", &["w", "w"], "h", vec![int("transB", 1)]),
        node("MatMul", &["g", "h"], "i", vec![]),
        node("Gather", &["i", "order"], "j", vec![int("axis", 2)]),
        node("Split", &["j"], "k", vec![int("axis", 2)]),
        node("Where", &["mask", "k", "scale"], "l", vec![]),
        node("Transpose", &["l"], "m", vec![ints("perm", &[0, 2, 1])]),
        node("Reshape", &["m", "planes"], "scores", vec![]),
    ];
    let mask = pb::TensorProto {
        name: "mask".into(),
        dims: vec![3],
        data_type: DataType::Bool as i32,
        int32_data: vec![1, 0, 1],
        ..Default::default()
    };
    let initializer = vec![
        numbers("tokens", &[1, 3, -1]),
        numbers("planes", &[1, 3, 4, 8]),
        numbers("order", &[2, 1, 0]),
        weights("w", &[3, 3]),
        floats("scale", &[3], vec![1.0, 0.5, 2.0]),
        mask,
    ];
    network(nodes, initializer)
}

/// Borders, picks and other movements of values.
fn pads() -> pb::ModelProto {
    let nodes = vec![
        node("Pad", &["image", "border"], "a", vec![text("mode", "reflect")]),
        node("SpaceToDepth", &["a"], "b", vec![int("blocksize", 2)]),
        node("DepthToSpace", &["b"], "c", vec![int("blocksize", 2)]),
        node("Slice", &["c", "from", "to", "axes"], "d", vec![]),
        node("ReduceMean", &["d"], "e", vec![ints("axes", &[1]), int("keepdims", 1)]),
        node("Sub", &["d", "e"], "f", vec![]),
        node("Clip", &["f", "low", "high"], "g", vec![]),
        node("Resize", &["g", "", "scales"], "h", vec![text("mode", "nearest")]),
        node("Squeeze", &["h", "axis"], "i", vec![]),
        node("Unsqueeze", &["i", "axis"], "j", vec![]),
        node("InstanceNormalization", &["j", "one", "one"], "scores", vec![]),
    ];
    let initializer = vec![
        numbers("border", &[0, 0, 1, 1, 0, 0, 1, 1]),
        numbers("from", &[1, 1]),
        numbers("to", &[17, 33]),
        numbers("axes", &[2, 3]),
        numbers("axis", &[0]),
        floats("low", &[], vec![-1.0]),
        floats("high", &[], vec![1.0]),
        floats("scales", &[4], vec![1.0, 1.0, 2.0, 2.0]),
        floats("one", &[3], vec![1.0; 3]),
    ];
    network(nodes, initializer)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Checkpoint, RgbView, Segmenter};

    #[test]
    fn every_network_runs() {
        let dir = tempfile::tempdir().unwrap();
        for (k, model) in networks().iter().enumerate() {
            let path = toy::write(dir.path(), &format!("network-{k}.onnx"), model);
            let mut segmenter = Segmenter::new(&Checkpoint::load(&path).unwrap(), 32, 16).unwrap();
            let rgb = toy::picture(32, 16);
            let mask = segmenter.run(RgbView::new(32, 16, &rgb).unwrap()).unwrap();
            assert_eq!(mask.ids.len(), 32 * 16);
        }
    }
}
