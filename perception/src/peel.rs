//! Takes the final argmax, softmax and bilinear upsampling out of a foreign network's graph.
//!
//! Exporters leave them in, where they cost more than the network itself; ours are fused
//! ([`crate::decode`]). They are taken out only where nothing else can follow from the graph: the
//! declared output has the input's size, and the upsampling is bilinear.

use crate::onnx::pb;

/// Takes the tail off; gives whether the upsampling that was removed aligned the corners, or
/// `None` when the graph was left as it is.
pub(crate) fn peel(model: &mut pb::ModelProto) -> Option<bool> {
    let graph = model.graph.as_mut()?;
    if graph.output.len() != 1 || !declares_input_size(graph) {
        return None;
    }
    let mut value = graph.output[0].name.clone();
    let mut tail = Vec::new();
    let mut skip = |op: &str, value: &mut String| {
        let at = graph.node.iter().position(|node| node.output.first() == Some(value) && acts_on_channels(node, op));
        if let Some(node) = at {
            value.clone_from(&graph.node[node].input[0]);
            tail.push(node);
        }
    };
    skip("ArgMax", &mut value);
    skip("Softmax", &mut value);
    skip("LogSoftmax", &mut value);
    let resize = graph.node.iter().position(|node| node.output.first() == Some(&value))?;
    let align_corners = bilinear(&graph.node[resize])?;
    let scores = graph.node[resize].input.first()?.clone();
    tail.push(resize);
    tail.sort_unstable();
    for node in tail.into_iter().rev() {
        graph.node.remove(node);
    }
    graph.output[0] = pb::ValueInfoProto { name: scores, ..Default::default() };
    Some(align_corners)
}

/// Whether rows and columns of the output are declared to be those of the input (NCHW).
fn declares_input_size(graph: &pb::GraphProto) -> bool {
    let dims = |value: &pb::ValueInfoProto| -> Option<Vec<_>> {
        let pb::type_proto::Value::TensorType(tensor) = value.r#type.as_ref()?.value.as_ref()?;
        let dims = &tensor.shape.as_ref()?.dim;
        Some(dims[dims.len().checked_sub(2)?..].iter().map(|d| d.value.clone()).collect())
    };
    let declared = graph.output.first().and_then(dims);
    declared.as_ref().is_some_and(|size| size.iter().all(Option::is_some)) && {
        let weights: Vec<&str> = graph.initializer.iter().map(|t| t.name.as_str()).collect();
        let input = graph.input.iter().find(|i| !weights.contains(&i.name.as_str()));
        input.and_then(dims) == declared
    }
}

fn attribute<'a>(node: &'a pb::NodeProto, name: &str) -> Option<&'a pb::AttributeProto> {
    node.attribute.iter().find(|a| a.name == name)
}

fn acts_on_channels(node: &pb::NodeProto, op: &str) -> bool {
    node.op_type == op && !node.input.is_empty() && attribute(node, "axis").is_some_and(|a| [1, -3].contains(&a.i))
}

/// Whether a node is a bilinear resize, and if so, whether it aligns the corners.
fn bilinear(node: &pb::NodeProto) -> Option<bool> {
    let text = |name: &str| attribute(node, name).map(|a| String::from_utf8_lossy(&a.s).into_owned());
    if node.op_type != "Resize" || text("mode").as_deref() != Some("linear") {
        return None;
    }
    match text("coordinate_transformation_mode").as_deref() {
        None | Some("half_pixel" | "pytorch_half_pixel") => Some(false),
        Some("align_corners") => Some(true),
        Some(_) => None,
    }
}
