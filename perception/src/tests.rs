//! Files that were prepared to do harm: each is refused in one sentence before it does.

use std::fs;
use std::path::Path;

use crate::metadata::Layout;
use crate::onnx::pb::{self, tensor_proto::DataType};
use crate::parts::{int, ints, value};
use crate::toy::{self, Toy, floats, node};
use crate::zoo::{network, numbers, weights};
use crate::{Checkpoint, PerceptionError, RgbView, Segmenter};

/// Why a model cannot be run, in one sentence.
fn refused(model: &pb::ModelProto) -> String {
    let dir = tempfile::tempdir().unwrap();
    refused_at(&toy::write(dir.path(), "toy.onnx", model))
}

fn refused_at(path: &Path) -> String {
    let run = || -> Result<(), PerceptionError> {
        let mut segmenter = Segmenter::new(&Checkpoint::load(path)?, 32, 16)?;
        segmenter.run(RgbView::new(32, 16, &toy::picture(32, 16))?).map(drop)
    };
    let text = run().expect_err("it is refused").to_string();
    assert!(text.contains("toy.onnx: ") && !text.contains('\n') && text.len() < 600, "{text}");
    text
}

/// A network that pools its picture and adds a value of these nodes to it.
fn adding(mut nodes: Vec<pb::NodeProto>, initializer: Vec<pb::TensorProto>) -> pb::ModelProto {
    nodes.push(node("Add", &["image", "extra"], "scores", vec![]));
    network(nodes, initializer)
}

#[test]
fn values_that_nobody_computes_are_named() {
    let mut model = Toy::default().model();
    model.graph.as_mut().unwrap().output[0].name = "phantom".into();
    assert!(refused(&model).contains("its output \"phantom\" is computed by no node"));
    let mut model = Toy::default().model();
    model.graph.as_mut().unwrap().node[0].input[1] = "phantom".into();
    assert!(
        refused(&model).contains("node \"Conv_coarse\" (Conv): takes \"phantom\", which nothing before it computes")
    );
}

#[test]
fn numbers_that_no_operator_can_work_with_are_refused() {
    let pool = |name: &str, values: &[i64]| {
        let kernel = ints("kernel_shape", if name == "kernel_shape" { values } else { &[2, 2] });
        let mut attributes = vec![kernel];
        attributes.extend((name != "kernel_shape").then(|| ints(name, values)));
        refused(&network(vec![node("MaxPool", &["image"], "scores", attributes)], vec![]))
    };
    assert!(pool("strides", &[0, 1]).contains("node \"MaxPool_scores\" (MaxPool): strides is 0, expected 1 to"));
    assert!(pool("kernel_shape", &[0, 0]).contains("kernel_shape is 0"));
    assert!(pool("kernel_shape", &[1 << 40, 2]).contains("kernel_shape is"));
    assert!(pool("pads", &[i64::MIN, 0, 0, 0]).contains("pads is"));
    let grouped = vec![node("Conv", &["image", "w"], "scores", vec![int("group", 0)])];
    assert!(refused(&network(grouped, vec![weights("w", &[3, 3, 1, 1])])).contains("group is 0"));
}

#[test]
fn values_that_would_fill_the_memory_are_refused_before_they_are_made() {
    let huge = [
        (node("ConstantOfShape", &["large"], "extra", vec![]), "ConstantOfShape"),
        (node("Expand", &["one", "large"], "extra", vec![]), "Expand"),
        (node("Range", &["start", "limit", "step"], "extra", vec![]), "Range"),
        (node("Tile", &["square", "large"], "extra", vec![]), "Tile"),
        (node("Resize", &["flat", "", "", "wide"], "extra", vec![]), "Resize"),
        (node("Pad", &["square", "border"], "extra", vec![]), "Pad"),
        (node("OneHot", &["large", "limit", "ends"], "extra", vec![]), "OneHot"),
        (node("Add", &["column", "row"], "extra", vec![]), "Add"),
        (node("MatMul", &["column", "row"], "extra", vec![]), "MatMul"),
    ];
    let side = 1 << 17;
    let scalar = |name: &str, number: i64| pb::TensorProto { dims: vec![], ..numbers(name, &[number]) };
    for (node, name) in huge {
        let initializer = vec![
            numbers("large", &[1 << 20, 1 << 20]),
            numbers("wide", &[1, 1, 1 << 20, 1 << 20]),
            numbers("border", &[1 << 40, 0, 0, 0]),
            floats("one", &[1], vec![1.0]),
            floats("square", &[1, 1], vec![1.0]),
            floats("flat", &[1, 1, 1, 1], vec![1.0]),
            floats("ends", &[2], vec![0.0, 1.0]),
            scalar("start", 0),
            scalar("limit", 1 << 40),
            scalar("step", 1),
            floats("column", &[side, 1], vec![1.0; side as usize]),
            floats("row", &[1, side], vec![1.0; side as usize]),
        ];
        let said = refused(&adding(vec![node], initializer));
        assert!(said.contains(&format!("({name})")), "{said}");
    }
}

/// Standard ONNX has the order in which values are computed; the engine reads beyond a shape in a circle.
#[test]
fn values_that_follow_from_themselves_are_refused() {
    let circle = vec![
        node("Relu", &["b"], "a", vec![]),
        node("BatchNormalization", &["a", "w", "w", "w", "w"], "b", vec![]),
        node("Add", &["image", "b"], "scores", vec![]),
    ];
    let said = refused(&network(circle, vec![floats("w", &[1], vec![1.0])]));
    assert!(said.contains("node \"Relu_a\" (Relu): takes \"b\", which nothing before it computes"), "{said}");
}

#[test]
fn windows_and_lists_without_end_are_refused() {
    for operator in ["MaxPool", "AveragePool"] {
        for side in [4000, 1000] {
            let sides = [ints("kernel_shape", &[side; 2]), ints("pads", &[side - 1; 4])];
            let said = refused(&network(vec![node(operator, &["image"], "scores", sides.into())], vec![]));
            let expected = if side == 4000 { "Pool): its window is" } else { "multiplications a picture" };
            assert!(said.contains(expected), "{said}");
        }
    }
    for operator in ["ConstantOfShape", "Expand", "Reshape", "Tile"] {
        let inputs: &[&str] = if operator == "ConstantOfShape" { &["long"] } else { &["one", "long"] };
        let initializer = vec![floats("one", &[1], vec![1.0]), numbers("long", &[1; 100_000])];
        let said = refused(&adding(vec![node(operator, inputs, "extra", vec![])], initializer));
        assert!(said.contains(&format!("({operator}): 100000 numbers")), "{said}");
    }
}

#[test]
fn values_that_double_and_double_are_refused() {
    let double =
        |k: usize| node("Concat", &[&format!("v{k}"), &format!("v{k}")], &format!("v{}", k + 1), vec![int("axis", 0)]);
    let nodes = (0..50).map(double).collect::<Vec<_>>();
    let mut of_weights = nodes.clone();
    of_weights.push(node("ReduceSum", &["v50"], "extra", vec![int("keepdims", 0)]));
    let said = refused(&adding(of_weights, vec![floats("v0", &[1], vec![1.0])]));
    assert!(said.contains("(Concat)") && said.contains("MiB"), "{said}");
    let mut of_picture = vec![node("Relu", &["image"], "v0", vec![])];
    of_picture.extend(nodes);
    of_picture.push(node("ReduceSum", &["v50"], "scores", vec![int("keepdims", 1)]));
    let said = refused(&network(of_picture, vec![]));
    assert!(said.contains("(Concat)") && said.contains("MiB"), "{said}");
}

#[test]
fn work_without_end_is_refused() {
    let sides = ints("kernel_shape", &[8191, 8191]);
    let nodes = vec![
        node("ConstantOfShape", &["shape"], "kernel", vec![]),
        node("Conv", &["image", "kernel"], "scores", vec![sides, ints("pads", &[8190, 8190, 8190, 8190])]),
    ];
    let said = refused(&network(nodes, vec![numbers("shape", &[3, 3, 8191, 8191])]));
    assert!(said.contains("at most"), "{said}");
}

#[test]
fn inputs_that_no_machine_can_hold_are_refused() {
    for (height, width) in [(1 << 62, 1 << 62), (60_000, 60_000), (1, i64::MAX), (1 << 33, 1 << 33)] {
        for layout in [Layout::Nchw, Layout::Nhwc] {
            let said = refused(&Toy { size: Some((height, width)), layout, ..Toy::default() }.model());
            assert!(said.contains("expected at most") && said.contains("pixels"), "{said}");
        }
    }
}

#[test]
fn more_nodes_than_any_network_has_are_refused_and_many_are_made_ready() {
    let chain = |count: usize| {
        let name = |k: usize| {
            if k == 0 {
                "image".into()
            } else if k == count {
                "scores".into()
            } else {
                format!("v{k}")
            }
        };
        network((0..count).map(|k| node("Relu", &[&name(k)], &name(k + 1), vec![])).collect(), vec![])
    };
    assert!(refused(&chain(5001)).contains("more than 5000 nodes"));
    let dir = tempfile::tempdir().unwrap();
    let path = toy::write(dir.path(), "toy.onnx", &chain(1000));
    assert!(Segmenter::new(&Checkpoint::load(path).unwrap(), 32, 16).is_ok());
}

#[test]
fn an_order_of_axes_names_each_once() {
    for perm in [[0, 0, 0, 0], [9, 1, 2, 3], [0, 1, 2, 2]] {
        let said = refused(&network(vec![node("Transpose", &["image"], "scores", vec![ints("perm", &perm)])], vec![]));
        assert!(said.contains("(Transpose): perm is") && said.contains("expected every axis"), "{said}");
    }
}

#[test]
fn operators_that_are_not_known_are_named() {
    let said = refused(&network(vec![node("Frobnicate", &["image"], "scores", vec![])], vec![]));
    assert!(said.contains("node \"Frobnicate_scores\" (Frobnicate): the operator is not supported"), "{said}");
}

#[test]
fn operators_of_other_tasks_are_refused() {
    for operator in ["RandomUniformLike", "TreeEnsembleClassifier", "Scan"] {
        let said = refused(&network(vec![node(operator, &["image"], "scores", vec![])], vec![]));
        assert!(said.contains(&format!("({operator}): the operator is not supported")), "{said}");
    }
}

#[test]
fn values_without_the_dimensions_that_an_operator_counts_on_are_refused() {
    let of_vector = |operator: &str, others: &[&str], attributes| {
        let inputs = [&["vector"], others].concat();
        let weights = vec![weights("vector", &[4]), weights("w", &[4, 4, 3, 3])];
        refused(&adding(vec![node(operator, &inputs, "extra", attributes)], weights))
    };
    assert!(
        of_vector("BatchNormalization", &["vector"; 4], vec![]).contains("(BatchNormalization): its value has 1 dim")
    );
    assert!(of_vector("Conv", &["w"], vec![]).contains("(Conv): it moves a window over a value of 1 dimensions"));
    let pool = vec![ints("kernel_shape", &[2])];
    let said = refused(&network(vec![node("MaxPool", &["image"], "scores", pool)], vec![]));
    assert!(said.contains("(MaxPool): kernel_shape has 1 numbers, expected 2"), "{said}");
    assert!(
        of_vector("LayerNormalization", &["vector"], vec![int("axis", -4)]).contains("axis is -4, but the first of")
    );
}

#[test]
fn what_the_engine_says_comes_with_the_node() {
    let nodes = vec![node("Concat", &["image", "w"], "scores", vec![int("axis", 1)])];
    let said = refused(&network(nodes, vec![weights("w", &[1, 3, 8, 32])]));
    assert!(said.contains("node \"Concat_scores\" (Concat): ") && said.contains("16"), "{said}");
    let nodes = vec![node("Conv", &["image", "w"], "scores", vec![])];
    let said = refused(&network(nodes, vec![weights("w", &[3, 5, 1, 1])]));
    assert!(said.contains("node \"Conv_scores\" (Conv): "), "{said}");
}

#[test]
fn numbers_that_are_none_are_refused() {
    let mut model = Toy::default().model();
    model.graph.as_mut().unwrap().initializer[0].float_data[5] = f32::NAN;
    assert!(refused(&model).contains("weights \"weights\": hold values that are no numbers"));
    let model = network(vec![node("Log", &["image"], "scores", vec![])], vec![]);
    let said = refused(&model);
    assert!(said.contains("inference failed") && said.contains("scores are no finite numbers"), "{said}");
    let nodes = vec![node("Div", &["image", "zero"], "scores", vec![])];
    assert!(refused(&network(nodes, vec![floats("zero", &[1], vec![0.0])])).contains("no finite numbers"));
}

#[test]
fn weights_must_have_the_shape_that_they_say() {
    for (dims, expected) in [
        (vec![3, 3, 4, 5], "hold 144 values"),
        (vec![-1, 4], "which no values can have"),
        (vec![1 << 62, 4], "which no values"),
        (vec![1; 40], "which no values"),
    ] {
        let mut model = Toy::default().model();
        model.graph.as_mut().unwrap().initializer[0].dims = dims;
        let said = refused(&model);
        assert!(said.contains("weights \"weights\": ") && said.contains(expected), "{said}");
    }
}

/// A network whose weights stand in a file beside it.
pub fn with_weights_beside(location: &str, length: Option<u64>) -> pb::ModelProto {
    let mut model = Toy::default().model();
    let tensor = &mut model.graph.as_mut().unwrap().initializer[0];
    tensor.float_data.clear();
    tensor.data_location = Some(pb::tensor_proto::DataLocation::External as i32);
    let entry = |key: &str, value: String| pb::StringStringEntryProto { key: key.into(), value };
    tensor.external_data = vec![entry("location", location.into())];
    tensor.external_data.extend(length.map(|length| entry("length", length.to_string())));
    model
}

/// As many bytes as those weights take, all numbers alike.
fn weight_bytes(number: f32) -> Vec<u8> {
    number.to_le_bytes().repeat(9 * 16)
}

#[test]
fn weights_beside_a_network_are_part_of_it() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("weights.bin");
    let load = |length: Option<u64>| {
        Checkpoint::load(toy::write(dir.path(), "toy.onnx", &with_weights_beside("weights.bin", length)))
    };
    let mut digests = Vec::new();
    for number in [0.25, 0.5] {
        fs::write(&file, weight_bytes(number)).unwrap();
        let checkpoint = load(None).unwrap();
        fs::remove_file(&file).unwrap();
        let mut segmenter = Segmenter::new(&checkpoint, 32, 16).unwrap();
        assert!(
            segmenter.run(RgbView::new(32, 16, &toy::picture(32, 16)).unwrap()).is_ok(),
            "the file was read already"
        );
        digests.push(checkpoint.digest());
    }
    assert_ne!(digests[0], digests[1]);
    fs::write(&file, [weight_bytes(0.5), vec![7; 9]].concat()).unwrap();
    assert_eq!(load(Some(576)).unwrap().metadata(), &toy::metadata());
    assert!(load(None).unwrap_err().to_string().contains("hold 585 bytes, but their shape has 144 values"));
    assert!(load(Some(600)).unwrap_err().to_string().contains("\"weights.bin\" has 585 bytes, expected 600 bytes"));
    assert!(load(Some(u64::MAX)).unwrap_err().to_string().contains("has 585 bytes"));
}

#[test]
fn weights_elsewhere_or_without_end_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("models");
    fs::create_dir_all(folder.join("below")).unwrap();
    fs::write(dir.path().join("outside.bin"), weight_bytes(0.5)).unwrap();
    let said = |location: &str| refused_at(&toy::write(&folder, "toy.onnx", &with_weights_beside(location, None)));
    for elsewhere in ["../outside.bin", "/etc/passwd", "../../etc/passwd", "/dev/zero"] {
        assert!(said(elsewhere).contains("is not in the model's folder"), "{}", said(elsewhere));
    }
    assert!(said("below").contains("\"below\" is no regular file"), "{}", said("below"));
    assert!(said("absent.bin").contains("\"absent.bin\": No such file"), "{}", said("absent.bin"));
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("../outside.bin", folder.join("link.bin")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", folder.join("zero.bin")).unwrap();
        assert!(said("link.bin").contains("is not in the model's folder"));
        assert!(said("zero.bin").contains("is not in the model's folder"));
        let made = std::process::Command::new("mkfifo").arg(folder.join("pipe.bin")).status();
        if made.is_ok_and(|status| status.success()) {
            assert!(said("pipe.bin").contains("is no regular file"));
        }
    }
}

#[test]
fn graphs_in_graphs_stay_small() {
    let body = |op: &str| pb::GraphProto {
        node: vec![node(op, &["image"], "inner", vec![])],
        output: vec![value("inner", DataType::Float, &[1, 3, 16, 32])],
        ..Default::default()
    };
    let branch = |name: &str, graph: pb::GraphProto| pb::AttributeProto {
        name: name.into(),
        r#type: pb::attribute_proto::AttributeType::Graph as i32,
        g: Some(graph),
        ..Default::default()
    };
    let both = |op: &str| vec![branch("then_branch", body(op)), branch("else_branch", body("Identity"))];
    let said = refused(&network(vec![node("If", &["image"], "scores", both("Expand"))], vec![]));
    assert!(said.contains("(Expand): stands in a branch"), "{said}");
    let said = refused(&network(vec![node("Relu", &["image"], "scores", both("Relu"))], vec![]));
    assert!(said.contains("only If may hold graphs"), "{said}");
}

#[test]
fn names_that_would_file_results_elsewhere_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let path = toy::write(dir.path(), "...onnx", &Toy::default().model());
    assert!(Checkpoint::load(path).unwrap_err().to_string().contains("cannot be a file's"));
}
