//! Takes the final argmax, softmax and upsampling out of a foreign network's graph.
//!
//! Exporters leave them in, where they cost more than the network itself; ours are fused
//! ([`crate::decode`]). They are taken out only where nothing else can follow from the graph: the
//! declared output has the input's size, and the upsampling is one of ours.

use crate::metadata::Layout;
use crate::onnx::pb;
use crate::taps::Enlarge;

/// Takes the tail off, after which the network gives scores as planes; gives how the scores are to be enlarged instead,
/// or `None` when the graph was left as it is.
pub(crate) fn peel(model: &mut pb::ModelProto, input: Layout) -> Option<Enlarge> {
    let graph = model.graph.as_mut()?;
    if graph.output.len() != 1 || !declares_input_size(graph, input) {
        return None;
    }
    let mut value = graph.output[0].name.clone();
    let mut tail = Vec::new();
    let resize = loop {
        let at = graph.node.iter().position(|node| node.output.first() == Some(&value))?;
        let node = &graph.node[at];
        tail.push(at);
        if node.op_type == "Resize" {
            break node;
        }
        value.clone_from(node.input.first()?);
    };
    let how = upsampling(resize)?;
    if !is_tail(tail.iter().rev().skip(1).map(|at| &graph.node[*at])) || is_seen_elsewhere(graph, &tail) {
        return None;
    }
    let scores = resize.input.first()?.clone();
    tail.sort_unstable();
    for node in tail.into_iter().rev() {
        graph.node.remove(node);
    }
    graph.output[0] = pb::ValueInfoProto { name: scores, ..Default::default() };
    Some(how)
}

/// Whether nodes, in their order, do nothing to the scores but to choose the highest.
fn is_tail<'a>(nodes: impl Iterator<Item = &'a pb::NodeProto>) -> bool {
    // The dimension of the channels, from the start and from the end; none after an argmax.
    let mut channels = Some([1, -3]);
    for node in nodes {
        let acts = channels.is_some_and(|axes| attribute(node, "axis").is_some_and(|a| axes.contains(&a.i)));
        let perm = attribute(node, "perm").map(|perm| perm.ints.as_slice());
        channels = match (node.op_type.as_str(), channels) {
            ("Identity", channels) => channels,
            ("Cast" | "Squeeze" | "Unsqueeze", None) => None,
            ("Softmax" | "LogSoftmax", channels) if acts => channels,
            ("ArgMax", _) if acts => None,
            ("Transpose", Some([1, _])) if perm == Some(&[0, 2, 3, 1][..]) => Some([3, -1]),
            _ => return false,
        };
    }
    true
}

/// Whether a value of these nodes is taken by another one; they run from the output upwards.
fn is_seen_elsewhere(graph: &pb::GraphProto, tail: &[usize]) -> bool {
    let inner = || tail.iter().skip(1).flat_map(|at| &graph.node[*at].output);
    let others = graph.node.iter().enumerate().filter(|(at, _)| !tail.contains(at));
    others.flat_map(|(_, node)| &node.input).any(|input| inner().any(|output| output == input))
}

/// Whether rows and columns of the output are declared to be those of the input.
fn declares_input_size(graph: &pb::GraphProto, input: Layout) -> bool {
    let dims = |value: &pb::ValueInfoProto| -> Option<Vec<_>> {
        let pb::type_proto::Value::TensorType(tensor) = value.r#type.as_ref()?.value.as_ref()?;
        Some(tensor.shape.as_ref()?.dim.iter().map(|d| d.value.clone()).collect())
    };
    let weights: Vec<&str> = graph.initializer.iter().map(|t| t.name.as_str()).collect();
    let image = graph.input.iter().find(|i| !weights.contains(&i.name.as_str())).and_then(dims);
    let Some((image, output)) = image.zip(graph.output.first().and_then(dims)) else { return false };
    let from = if input == Layout::Nhwc { 1 } else { 2 };
    let Some(size) = image.get(from..from + 2).filter(|size| size.iter().all(Option::is_some)) else { return false };
    // Rows and columns come last, or before the scores of a pixel.
    output.ends_with(size) || output.len() == 4 && &output[1..3] == size
}

fn attribute<'a>(node: &'a pb::NodeProto, name: &str) -> Option<&'a pb::AttributeProto> {
    node.attribute.iter().find(|a| a.name == name)
}

/// How a node enlarges, if we can do the same.
fn upsampling(node: &pb::NodeProto) -> Option<Enlarge> {
    let text = |name: &str| attribute(node, name).map(|a| String::from_utf8_lossy(&a.s).into_owned());
    let place = text("coordinate_transformation_mode");
    match (text("mode").as_deref(), place.as_deref()) {
        (Some("linear"), None | Some("half_pixel" | "pytorch_half_pixel")) => Some(Enlarge::HalfPixel),
        (Some("linear"), Some("align_corners")) => Some(Enlarge::AlignCorners),
        (Some("nearest") | None, Some("asymmetric")) if text("nearest_mode").as_deref() == Some("floor") => {
            Some(Enlarge::Nearest)
        }
        _ => None,
    }
}
