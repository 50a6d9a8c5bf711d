//! What is looked at in a graph before the engine sees it: how much there is, whether every value is computed
//! before it is taken, and numbers that no operator can work with.

use std::collections::HashSet;

use super::guard::{self, shown};
use super::pb;

/// Most nodes of a model, those of branches included.
const MOST_NODES: usize = 5000;
/// Most values that a node takes or gives, and most attributes.
const MOST_ENDS: usize = 1024;
/// Most weights and constants.
const MOST_TENSORS: usize = 20_000;

/// Attributes whose numbers must lie in a range.
const RANGES: [(&[&str], i64, i64); 3] = [
    (&["kernel_shape", "strides", "dilations", "group", "num_groups", "blocksize", "block_size", "size"], 1, 1 << 16),
    (&["pads", "output_padding", "padding"], -(1 << 16), 1 << 16),
    (&["axis", "axes", "perm"], -64, 64),
];

/// Operators that a branch of `If` may hold: they make nothing larger than what they get.
const IN_BRANCHES: [&str; 20] = [
    "Add",
    "Cast",
    "Constant",
    "Div",
    "Equal",
    "Flatten",
    "Gather",
    "Greater",
    "Identity",
    "Less",
    "Mul",
    "Not",
    "Relu",
    "Reshape",
    "Shape",
    "Slice",
    "Squeeze",
    "Sub",
    "Transpose",
    "Unsqueeze",
];

/// Operators of other tasks, and those that give something else every time.
const UNSUITED: [&str; 18] = [
    "Bernoulli",
    "CategoryMapper",
    "Compress",
    "LinearClassifier",
    "LinearRegressor",
    "Loop",
    "Multinomial",
    "NonMaxSuppression",
    "Normalizer",
    "RandomNormal",
    "RandomNormalLike",
    "RandomUniform",
    "RandomUniformLike",
    "STFT",
    "DFT",
    "Scan",
    "TreeEnsembleClassifier",
    "TreeEnsembleRegressor",
];

/// Refuses a graph that the engine cannot work with, or only with too much of this machine.
pub fn check(model: &pb::ModelProto) -> Result<(), String> {
    let graph = model.graph.as_ref().ok_or("it holds no graph")?;
    let mut left = Left { nodes: MOST_NODES, tensors: MOST_TENSORS };
    left.take(graph, false)?;
    check_order(graph, HashSet::new())
}

/// Every value is computed once, and before it is taken, as the format demands: so nothing goes round in circles.
/// A branch may take what is `known` around it.
fn check_order<'a>(graph: &'a pb::GraphProto, mut known: HashSet<&'a str>) -> Result<(), String> {
    known.extend(graph.initializer.iter().map(|tensor| tensor.name.as_str()));
    known.extend(graph.input.iter().map(|input| input.name.as_str()));
    for node in &graph.node {
        if let Some(input) = node.input.iter().find(|input| !input.is_empty() && !known.contains(input.as_str())) {
            return Err(format!("{}: takes {}, which nothing before it computes", place(node), shown(input)));
        }
        for branch in node.attribute.iter().flat_map(|attribute| attribute.g.iter().chain(&attribute.graphs)) {
            check_order(branch, known.clone())?;
        }
        for output in node.output.iter().filter(|output| !output.is_empty()) {
            if !known.insert(output) {
                return Err(format!("{}: computes {} a second time", place(node), shown(output)));
            }
        }
    }
    match graph.output.iter().find(|output| !known.contains(output.name.as_str())) {
        Some(output) => Err(format!("its output {} is computed by no node", shown(&output.name))),
        None => Ok(()),
    }
}

/// A node in words.
fn place(node: &pb::NodeProto) -> String {
    let name = if node.name.is_empty() { node.output.first().unwrap_or(&node.name) } else { &node.name };
    guard::node(name, &node.op_type)
}

/// How much more there may be.
struct Left {
    nodes: usize,
    tensors: usize,
}

impl Left {
    fn take(&mut self, graph: &pb::GraphProto, in_branch: bool) -> Result<(), String> {
        let too_many = |most: usize, what: &str| format!("it has more than {most} {what}");
        let left = self.nodes.checked_sub(graph.node.len());
        self.nodes = left.ok_or_else(|| too_many(MOST_NODES, "nodes"))?;
        let constants = graph.node.iter().flat_map(|node| &node.attribute).filter(|a| a.t.is_some()).count();
        let left = self.tensors.checked_sub(graph.initializer.len() + constants);
        self.tensors = left.ok_or_else(|| too_many(MOST_TENSORS, "weights"))?;
        graph.node.iter().try_for_each(|node| self.take_node(node, in_branch))
    }

    fn take_node(&mut self, node: &pb::NodeProto, in_branch: bool) -> Result<(), String> {
        let refuse = |reason: String| Err(format!("{}: {reason}", place(node)));
        if node.input.len().max(node.output.len()).max(node.attribute.len()) > MOST_ENDS {
            return refuse(format!("more than {MOST_ENDS} inputs, outputs or attributes"));
        }
        if UNSUITED.contains(&node.op_type.as_str()) {
            return refuse(
                "the operator is not supported: it does not map a picture to the same classes every time".into(),
            );
        }
        if in_branch && !IN_BRANCHES.contains(&node.op_type.as_str()) {
            return refuse(format!("stands in a branch, which may hold {} only", IN_BRANCHES.join(", ")));
        }
        for attribute in &node.attribute {
            if let Err(reason) = check_range(attribute) {
                return refuse(reason);
            }
            for graph in attribute.g.iter().chain(&attribute.graphs) {
                if node.op_type != "If" {
                    return refuse("only If may hold graphs".into());
                }
                self.take(graph, true)?;
            }
        }
        Ok(())
    }
}

fn check_range(attribute: &pb::AttributeProto) -> Result<(), String> {
    let name = attribute.name.as_str();
    let Some((_, least, most)) = RANGES.iter().find(|(names, ..)| names.contains(&name)) else { return Ok(()) };
    let given = attribute.ints.iter().chain((attribute.i != 0).then_some(&attribute.i));
    let is_bare_zero = attribute.ints.is_empty() && attribute.i == 0 && is_number(attribute);
    let odd = given.into_iter().find(|n| !(least..=most).contains(n)).or((is_bare_zero && *least > 0).then_some(&0));
    match odd {
        Some(n) => Err(format!("{name} is {n}, expected {least} to {most}")),
        None => Ok(()),
    }
}

fn is_number(attribute: &pb::AttributeProto) -> bool {
    attribute.r#type == pb::attribute_proto::AttributeType::Int as i32
}
