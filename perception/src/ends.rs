//! The two ends of a foreign network's graph: the picture that it takes, and the one of its outputs that is looked at.

use std::collections::HashSet;

use crate::metadata::Layout;
use crate::onnx::pb::{self, tensor_proto::DataType};
use crate::onnx::{Element, shown};
use crate::parts;

/// Most pictures that a network may take at a time.
const MOST_PICTURES: usize = 64;
/// Most outputs that a sentence lists.
const MOST_LISTED: usize = 6;

/// The network's input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Input {
    pub element: Element,
    pub layout: Layout,
    /// Pictures that it takes at a time, where the model fixes that; else 1.
    pub pictures: usize,
    /// Pixels, where the model fixes them.
    pub width: Option<usize>,
    pub height: Option<usize>,
}

/// Refuses a model without one input that can be a picture, or without an output that can be a segmentation.
pub(crate) fn check(model: &pb::ModelProto) -> Result<(), String> {
    let graph = model.graph.as_ref().ok_or("it holds no graph")?;
    let inputs: Vec<_> = pictures(graph).collect();
    let [input] = inputs[..] else {
        return Err(format!("it has {} inputs, expected one image", inputs.len()));
    };
    let taken = shape_of(&graph.input[input]);
    if taken.len() != 4 {
        return Err(format!("its input has the shape {}, expected 1x3xHxW or 1xHxWx3", shape_text(&taken)));
    }
    match &graph.output[..] {
        [] => Err("it has no output".into()),
        [output] => check_form(output),
        outputs if outputs.iter().all(|output| check_form(output).is_err()) => {
            Err(format!("none of its outputs can be scores or a class map: {}", listed(outputs)))
        }
        _ => Ok(()),
    }
}

/// Inputs that are no weights, by number.
fn pictures(graph: &pb::GraphProto) -> impl Iterator<Item = usize> {
    let weights: HashSet<&str> = graph.initializer.iter().map(|t| t.name.as_str()).collect();
    (0..graph.input.len()).filter(move |&i| !weights.contains(graph.input[i].name.as_str()))
}

/// Whether an output can be a segmentation by its dimensions.
fn check_form(output: &pb::ValueInfoProto) -> Result<(), String> {
    let shape = shape_of(output);
    let can_be = match shape[..] {
        // Exporters may leave the shape out; the engine finds it later.
        [] => true,
        [rows, cols] => rows != Some(1) && cols != Some(1),
        _ => matches!(shape.len(), 3 | 4),
    };
    match can_be {
        true => Ok(()),
        false => Err(format!(
            "its output has the shape {}, expected scores 1xCxHxW or 1xHxWxC, or a class map 1xHxW",
            shape_text(&shape)
        )),
    }
}

/// Whether an output can be scores of so many classes, or a class map.
fn check_classes(output: &pb::ValueInfoProto, classes: usize) -> Result<(), String> {
    let shape = shape_of(output);
    let fits = |n: Option<usize>| n.is_some_and(|n| n == classes || n == 1);
    match shape[..] {
        [_, second, _, fourth] if second.is_some() && !fits(second) && !fits(fourth) => {
            Err(format!("its output has the shape {}, but the metadata names {classes} classes", shape_text(&shape)))
        }
        _ => Ok(()),
    }
}

/// Leaves the output of this name, or the only one that can be it. Several heads may all have scores of all classes: which
/// one is the main one follows neither from their order nor from their names, so that it must be said.
pub(crate) fn choose(model: &mut pb::ModelProto, wanted: Option<&str>, classes: usize) -> Result<(), String> {
    let graph = model.graph.as_mut().ok_or("it holds no graph")?;
    let outputs = &graph.output[..];
    let fit = |at: &usize| check_form(&outputs[*at]).is_ok() && check_classes(&outputs[*at], classes).is_ok();
    let named = wanted.map(|name| outputs.iter().position(|output| output.name == name));
    let at = match named {
        Some(at) => at.ok_or_else(|| {
            format!("it has no output {}, but {}", shown(wanted.unwrap_or_default()), listed(outputs))
        })?,
        None if outputs.len() == 1 => 0,
        None => match (0..outputs.len()).filter(fit).collect::<Vec<_>>()[..] {
            [at] => at,
            [] => return Err(format!("none of its outputs can be of {classes} classes: {}", listed(outputs))),
            [..] => return Err(format!("the key output must say which it is of {}", listed(outputs))),
        },
    };
    check_form(&outputs[at]).and_then(|()| check_classes(&outputs[at], classes))?;
    if outputs.len() > 1 {
        graph.output = vec![graph.output.swap_remove(at)];
        prune(graph);
    }
    Ok(())
}

fn listed(outputs: &[pb::ValueInfoProto]) -> String {
    let one = |output: &pb::ValueInfoProto| {
        let shape = shape_of(output);
        let shape = if shape.is_empty() { String::new() } else { format!(" ({})", shape_text(&shape)) };
        shown(&output.name) + &shape
    };
    let all: Vec<_> = outputs.iter().take(MOST_LISTED).map(one).collect();
    let more = outputs.len().saturating_sub(MOST_LISTED);
    if more > 0 { format!("{} and {more} more", all.join(", ")) } else { all.join(", ") }
}

/// Leaves out what no output needs: nodes stand before those that take from them.
fn prune(graph: &mut pb::GraphProto) {
    let mut needed: HashSet<String> = graph.output.iter().map(|output| output.name.clone()).collect();
    let mut kept = Vec::new();
    for node in std::mem::take(&mut graph.node).into_iter().rev() {
        if node.output.iter().any(|output| !output.is_empty() && needed.contains(output)) {
            need(&node, &mut needed);
            kept.push(node);
        }
    }
    kept.reverse();
    graph.node = kept;
}

/// Adds what a node takes, and its branches from around them.
fn need(node: &pb::NodeProto, needed: &mut HashSet<String>) {
    needed.extend(node.input.iter().cloned());
    for branch in branches(node) {
        needed.extend(branch.output.iter().map(|output| output.name.clone()));
        branch.node.iter().for_each(|node| need(node, needed));
    }
}

fn branches(node: &pb::NodeProto) -> impl Iterator<Item = &pb::GraphProto> {
    node.attribute.iter().flat_map(|attribute| attribute.g.iter().chain(&attribute.graphs))
}

/// What the model takes; one of whole numbers other than bytes takes bytes from here on.
pub(crate) fn take(model: &mut pb::ModelProto, declared: Option<Layout>) -> Result<Input, String> {
    let graph = model.graph.as_mut().ok_or("it holds no graph")?;
    let at = pictures(graph).next().ok_or("it has no input")?;
    let shape = shape_of(&graph.input[at]);
    let layout = layout_of(&shape, declared)
        .ok_or_else(|| format!("its input has the shape {}, expected 1x3xHxW or 1xHxWx3", shape_text(&shape)))?;
    let (height, width) = match layout {
        Layout::Nchw => (shape[2], shape[3]),
        Layout::Nhwc => (shape[1], shape[2]),
    };
    let pictures = shape[0].unwrap_or(1);
    let pixels = width.unwrap_or(1).checked_mul(height.unwrap_or(1)).and_then(|pixels| pixels.checked_mul(pictures));
    if pixels.is_none_or(|pixels| pixels as u64 > intake::most::PIXELS) || pictures > MOST_PICTURES {
        let most = intake::most::PIXELS;
        let text = shape_text(&shape);
        return Err(format!(
            "its input has the shape {text}, expected at most {most} pixels of {MOST_PICTURES} pictures"
        ));
    }
    let kind = tensor_of(&graph.input[at]).map(|tensor| tensor.elem_type);
    let element = match DataType::try_from(kind.ok_or("its input has no type")?) {
        Ok(DataType::Float) => Element::Float,
        Ok(DataType::Uint8) => Element::Byte,
        Ok(kind @ (DataType::Int32 | DataType::Int64)) => {
            put_before(graph, at, "Cast", 1, parts::int("to", kind as i64));
            retype(&mut graph.input[at], DataType::Uint8);
            Element::Byte
        }
        _ => return Err("its input is neither float nor of bytes (uint8, int32 or int64)".into()),
    };
    Ok(Input { element, layout, pictures, width, height })
}

/// A model that gets one picture for a model that takes so many at a time: all of them are that one, and what comes of
/// the first is given.
pub(crate) fn repeated(model: &pb::ModelProto, pictures: usize) -> pb::ModelProto {
    let mut model = model.clone();
    let Some(graph) = &mut model.graph else { return model };
    let Some(at) = self::pictures(graph).next() else { return model };
    put_before(graph, at, "Concat", pictures, parts::int("axis", 0));
    let (index, first) = (unused(graph, "aeye.index"), unused(graph, "aeye.first"));
    let all = graph.output[0].name.clone();
    graph.node.push(parts::node("Gather", &[&all, &index], &first, vec![parts::int("axis", 0)]));
    graph.initializer.push(parts::numbers(&index, &[0]));
    graph.output[0] = pb::ValueInfoProto { name: first, ..Default::default() };
    model
}

/// Puts a node between an input, so often, and what takes it.
fn put_before(graph: &mut pb::GraphProto, at: usize, operator: &str, times: usize, attribute: pb::AttributeProto) {
    let name = unused(graph, "aeye.picture");
    let taken = std::mem::replace(&mut graph.input[at].name, name.clone());
    graph.node.insert(0, parts::node(operator, &vec![name.as_str(); times], &taken, vec![attribute]));
}

/// A name that stands for nothing yet.
fn unused(graph: &pb::GraphProto, like: &str) -> String {
    let mut used = HashSet::new();
    names(graph, &mut used);
    let mut name = like.to_owned();
    while used.contains(name.as_str()) {
        name.push('_');
    }
    name
}

fn names<'a>(graph: &'a pb::GraphProto, used: &mut HashSet<&'a str>) {
    used.extend(graph.input.iter().map(|input| input.name.as_str()));
    used.extend(graph.initializer.iter().map(|tensor| tensor.name.as_str()));
    for node in &graph.node {
        used.extend(node.output.iter().map(String::as_str));
        branches(node).for_each(|branch| names(branch, used));
    }
}

fn tensor_of(value: &pb::ValueInfoProto) -> Option<&pb::type_proto::Tensor> {
    let pb::type_proto::Value::TensorType(tensor) = value.r#type.as_ref()?.value.as_ref()?;
    Some(tensor)
}

fn retype(value: &mut pb::ValueInfoProto, kind: DataType) {
    let tensor = value.r#type.as_mut().and_then(|kind| kind.value.as_mut());
    tensor.into_iter().for_each(|pb::type_proto::Value::TensorType(tensor)| tensor.elem_type = kind as i32);
}

/// The declared dimensions; `None` for those that are open.
fn shape_of(value: &pb::ValueInfoProto) -> Vec<Option<usize>> {
    use pb::tensor_shape_proto::dimension::Value;
    let dims = tensor_of(value).and_then(|t| t.shape.as_ref()).map_or(&[][..], |s| &s.dim);
    let fixed = |value: &Option<Value>| match value {
        Some(Value::DimValue(n)) => usize::try_from(*n).ok().filter(|n| *n > 0),
        _ => None,
    };
    dims.iter().map(|d| fixed(&d.value)).collect()
}

fn shape_text(shape: &[Option<usize>]) -> String {
    let dims: Vec<String> = shape.iter().map(|d| d.map_or("?".into(), |n| n.to_string())).collect();
    if dims.is_empty() { "()".into() } else { dims.join("x") }
}

/// The order of the dimensions, if the shape can be that of pictures.
fn layout_of(shape: &[Option<usize>], declared: Option<Layout>) -> Option<Layout> {
    let &[_, second, _, fourth] = shape else { return None };
    let colours = |n: Option<usize>| n.is_none_or(|n| n == 3);
    let guess = if second != Some(3) && fourth == Some(3) { Layout::Nhwc } else { Layout::Nchw };
    let layout = declared.unwrap_or(guess);
    let channels = if layout == Layout::Nchw { second } else { fourth };
    colours(channels).then_some(layout)
}
