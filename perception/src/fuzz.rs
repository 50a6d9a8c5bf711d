//! Damaged networks: whatever is changed in a valid one, it runs or is refused in one sentence. The program must
//! not end, so that a panic that is not caught, an abort or a hang fails the test. `tests/fuzz.sh` tries for longer.

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::TestCaseResult;
use prost::Message;

use crate::onnx::pb::{self, tensor_proto::DataType};
use crate::parts::{int, ints};
use crate::tests::with_weights_beside;
use crate::toy;
use crate::zoo::networks;
use crate::{Checkpoint, RgbView, Segmenter};

/// Numbers at which things break.
const ODD: [i64; 20] = [
    0,
    1,
    -1,
    2,
    -2,
    3,
    7,
    16,
    64,
    255,
    1000,
    65_536,
    1 << 20,
    1 << 31,
    (1 << 31) - 1,
    1 << 40,
    1 << 62,
    i64::MAX,
    i64::MIN,
    -60_000,
];
/// How many networks a test run tries.
const CASES: u32 = 256;
/// What nodes are turned into.
const OPERATORS: [&str; 44] = [
    "Add",
    "ArgMax",
    "AveragePool",
    "Cast",
    "Clip",
    "Concat",
    "Constant",
    "ConstantOfShape",
    "Conv",
    "ConvTranspose",
    "CumSum",
    "DepthToSpace",
    "Einsum",
    "Expand",
    "EyeLike",
    "Flatten",
    "GRU",
    "Gather",
    "GatherElements",
    "GatherND",
    "Gemm",
    "GridSample",
    "If",
    "LSTM",
    "Loop",
    "MatMul",
    "MaxPool",
    "NonZero",
    "OneHot",
    "Pad",
    "RandomUniform",
    "Range",
    "ReduceSum",
    "Reshape",
    "Resize",
    "Scan",
    "ScatterND",
    "Slice",
    "Split",
    "Tile",
    "TopK",
    "Transpose",
    "Upsample",
    "Where",
];
/// What attributes are called.
const ATTRIBUTES: [&str; 16] = [
    "axes",
    "axis",
    "blocksize",
    "dilations",
    "group",
    "hidden_size",
    "k",
    "keepdims",
    "kernel_shape",
    "num_outputs",
    "output_shape",
    "pads",
    "perm",
    "shape",
    "strides",
    "to",
];

/// What metadata may say.
const SAID: [&str; 10] = [
    "null",
    "0",
    "\"coarse\"",
    "\"nobody's\"",
    "\"bgr\"",
    "\"nhwc\"",
    "[1e-30, 1e30, 0.5]",
    "{\"0\": \"road\"}",
    "{\"0\": \"tree\", \"1\": \"chair\", \"2\": \"car; auto\"}",
    "[\"road\", \"sky\", \"car\", \"pole\"]",
];

/// A change of a model; the numbers choose what and how.
#[derive(Clone, Copy, Debug)]
struct Change {
    kind: u8,
    at: u16,
    other: u16,
    number: i64,
}

fn change() -> impl Strategy<Value = Change> {
    let number = prop_oneof![3 => prop::sample::select(&ODD[..]), 1 => -20i64..20];
    (any::<u8>(), any::<u16>(), any::<u16>(), number).prop_map(|(kind, at, other, number)| Change {
        kind,
        at,
        other,
        number,
    })
}

/// One of several, if there are any.
fn pick<T>(all: &mut [T], at: u16) -> Option<&mut T> {
    let count = all.len();
    all.get_mut(usize::from(at) % count.max(1))
}

impl Change {
    /// Changes a model, unless there is nothing to change at that place.
    fn apply(self, model: &mut pb::ModelProto) -> Option<()> {
        let Self { kind, at, other, number } = self;
        let names = values(model);
        let graph = model.graph.as_mut()?;
        match kind % 24 {
            0 | 1 => pick(&mut pick(&mut attributes(graph), at)?.ints, other).map(|n| *n = number)?,
            2 => pick(&mut attributes(graph), at)?.i = number,
            3 => pick(&mut attributes(graph), at)?.ints.push(number),
            4 => pick(&mut attributes(graph), at)?.ints.clear(),
            5 => pick(&mut graph.node, at)?.attribute.clear(),
            6 => {
                let name = ATTRIBUTES[usize::from(other) % ATTRIBUTES.len()];
                let new = if number % 2 == 0 { int(name, number) } else { ints(name, &[number, 2]) };
                pick(&mut graph.node, at)?.attribute.push(new);
            }
            7 => pick(&mut graph.node, at)?.op_type = OPERATORS[usize::from(other) % OPERATORS.len()].into(),
            8 | 9 => pick(&mut pick(&mut graph.node, at)?.input, number as u16)?
                .clone_from(&names[usize::from(other) % names.len()]),
            10 => _ = pick(&mut graph.node, at)?.input.pop(),
            11 => pick(&mut graph.node, at)?.input.push(names[usize::from(other) % names.len()].clone()),
            12 if !graph.node.is_empty() => _ = graph.node.remove(usize::from(at) % graph.node.len()),
            13 => pick(&mut pick(&mut graph.initializer, at)?.dims, other).map(|n| *n = number)?,
            14 | 15 => pick(&mut numbers(graph), at)
                .map(|tensor| pick(&mut tensor.int64_data, other).map(|n| *n = number))??,
            16 => pick(&mut pick(&mut graph.initializer, at)?.float_data, other)
                .map(|v| *v = f32::from_bits(number as u32))?,
            17 => pick(&mut graph.initializer, at)?.data_type = i32::from(other % 24),
            18 => graph.output[0].name.clone_from(&names[usize::from(other) % names.len()]),
            19 => model.opset_import[0].version = number.clamp(-1, 25),
            20 => pick(&mut model.metadata_props, at)?.value = SAID[usize::from(other) % SAID.len()].into(),
            21 => toy::set_dim(pick(&mut graph.input, at)?, usize::from(other) % 4, number),
            22 => toy::retype(pick(&mut graph.input, at)?, i32::from(other % 24)),
            _ => graph.output.push(pb::ValueInfoProto {
                name: names[usize::from(other) % names.len()].clone(),
                ..graph.output[0].clone()
            }),
        }
        Some(())
    }
}

/// Names of all values.
fn values(model: &pb::ModelProto) -> Vec<String> {
    let graph = model.graph.as_ref().expect("a valid model");
    let computed = graph.node.iter().flat_map(|node| node.output.iter().cloned());
    let given = graph.initializer.iter().map(|tensor| tensor.name.clone());
    computed.chain(given).chain(["image".into(), String::new(), "nobody's".into()]).collect()
}

fn attributes(graph: &mut pb::GraphProto) -> Vec<&mut pb::AttributeProto> {
    graph.node.iter_mut().flat_map(|node| &mut node.attribute).collect()
}

fn numbers(graph: &mut pb::GraphProto) -> Vec<&mut pb::TensorProto> {
    graph.initializer.iter_mut().filter(|tensor| tensor.data_type == DataType::Int64 as i32).collect()
}

/// Loads a network and looks at a picture with it; an error must be one sentence that names the file.
fn check(files: &[(&str, &[u8])]) -> TestCaseResult {
    let dir = hunt::trying(files);
    let tried = Checkpoint::load(dir.join("case.onnx")).and_then(|checkpoint| {
        let mut segmenter = Segmenter::new(&checkpoint, 32, 16)?;
        let rgb = toy::picture(32, 16);
        segmenter.run_with_certainty(RgbView::new(32, 16, &rgb).expect("a picture")).map(drop)
    });
    if let Err(error) = tried {
        let text = error.to_string();
        prop_assert!(text.contains("case.onnx") && !text.contains('\n') && text.len() < 1000, "{}", text);
    }
    Ok(())
}

/// A network with some changes; what cannot be changed is changed by the others.
fn changed(model: &pb::ModelProto, changes: &[Change]) -> pb::ModelProto {
    changes.iter().fold(model.clone(), |model, change| {
        let mut changed = model.clone();
        change.apply(&mut changed);
        changed
    })
}

#[test]
fn changed_networks_run_or_are_refused() {
    let valid = networks();
    hunt::hunt("network", CASES, (any::<Index>(), vec(change(), 1..6)), |(which, changes)| {
        let model = changed(which.get(&valid), &changes);
        check(&[("case.onnx", &model.encode_to_vec())])
    });
}

#[test]
fn damaged_files_run_or_are_refused() {
    let valid: Vec<_> = networks().iter().map(Message::encode_to_vec).collect();
    let flips = vec((any::<Index>(), any::<u8>()), 0..8);
    hunt::hunt("network-bytes", CASES, (any::<Index>(), flips, 0.0..2.0), |(which, flips, keep)| {
        let mut bytes = which.get(&valid).clone();
        flips.iter().for_each(|(at, byte)| *at.get_mut(&mut bytes) = *byte);
        bytes.truncate((bytes.len() as f64 * keep) as usize);
        check(&[("case.onnx", &bytes)])
    });
}

/// What the entry of a tensor beside its network may say.
const ENTRIES: [&str; 10] =
    ["", "0", "1", "575", "577", "4294967296", "18446744073709551615", "-1", "../weights.bin", "weights.bin"];

#[test]
fn weights_beside_a_network_are_read_or_refused() {
    let strategy = (vec((0..3usize, any::<Index>()), 0..3), 0..1200usize, vec(change(), 0..3));
    hunt::hunt("network-beside", CASES, strategy, |(entries, bytes, changes)| {
        let mut model = with_weights_beside("weights.bin", Some(576));
        let tensor = &mut model.graph.as_mut().expect("a graph").initializer[0];
        for (key, text) in entries {
            let entry = pb::StringStringEntryProto {
                key: ["location", "offset", "length"][key].into(),
                value: (*text.get(&ENTRIES)).into(),
            };
            tensor.external_data.retain(|other| other.key != entry.key);
            tensor.external_data.push(entry);
        }
        let model = changed(&model, &changes);
        check(&[("case.onnx", &model.encode_to_vec()), ("weights.bin", &0.25f32.to_le_bytes().repeat(bytes / 4))])
    });
}

#[test]
fn names_beside_a_network_are_taken_or_refused() {
    let model = toy::Toy { metadata: None, element: DataType::Uint8, ..toy::Toy::default() }.model().encode_to_vec();
    let labels = vec(("[0-9x-]{0,3}", "(car|sky|tree|.{0,9})"), 0..5);
    hunt::hunt("network-names", CASES, (labels, 0.5..1.5), |(labels, keep)| {
        let pairs: std::collections::BTreeMap<String, String> = labels.into_iter().collect();
        let mut text = serde_json::json!({ "id2label": pairs }).to_string().into_bytes();
        text.truncate((text.len() as f64 * keep) as usize);
        check(&[("case.onnx", &model), ("config.json", &text)])
    });
}

/// Files that once panicked, hung or filled the memory.
#[test]
fn what_once_did_harm_runs_or_is_refused() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("regressions");
    let files: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("a file").path()).collect();
    assert!(!files.is_empty());
    for file in files {
        check(&[("case.onnx", &std::fs::read(&file).expect("readable"))])
            .unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    }
}
