//! Networks in the many forms that exporters give them: each sees what the plain one sees, or is refused in one
//! sentence.

use std::path::Path;

use crate::metadata::{Channels, Layout, Metadata, Normalisation};
use crate::onnx::pb::{self, tensor_proto::DataType};
use crate::parts::{int, numbers, value};
use crate::toy::{self, Tail, Toy, floats, node, picture};
use crate::{Checkpoint, Mask, PerceptionError, RgbView, Segmenter};

const SIZE: (usize, usize) = (32, 16);

fn look_from(path: &Path) -> Result<Mask, PerceptionError> {
    let mut segmenter = Segmenter::new(&Checkpoint::load(path)?, SIZE.0, SIZE.1)?;
    segmenter.run(RgbView::new(SIZE.0, SIZE.1, &picture(SIZE.0, SIZE.1))?)
}

fn look(model: &pb::ModelProto) -> Result<Mask, PerceptionError> {
    let dir = tempfile::tempdir().unwrap();
    look_from(&toy::write(dir.path(), "toy.onnx", model))
}

fn refused(model: &pb::ModelProto) -> String {
    let text = look(model).expect_err("it is refused").to_string();
    assert!(text.contains("toy.onnx") && !text.contains('\n') && text.len() < 600, "{text}");
    text
}

fn graph(model: &mut pb::ModelProto) -> &mut pb::GraphProto {
    model.graph.as_mut().unwrap()
}

/// Scores of every pixel, without any tail.
fn fine() -> Toy {
    Toy { stride: 1, ..Toy::default() }
}

/// A network with nodes behind its scores, of which the last gives the output.
fn ending(toy: &Toy, nodes: Vec<pb::NodeProto>) -> pb::ModelProto {
    let mut model = toy.model();
    let graph = graph(&mut model);
    graph.node.extend(nodes);
    let last = graph.node.last().unwrap().output[0].clone();
    graph.output = vec![pb::ValueInfoProto { name: last, ..Default::default() }];
    graph.initializer.push(numbers("none", &[0]));
    model
}

/// A network for several pictures at a time; whether one also does is up to `baked`, a node behind its scores.
pub fn several(toy: &Toy, pictures: i64, baked: bool) -> pb::ModelProto {
    let reshape = node("Reshape", &["coarse", "shape"], "scores", vec![]);
    let mut model = if baked { ending(toy, vec![reshape]) } else { toy.model() };
    toy::set_dim(&mut graph(&mut model).input[0], 0, pictures);
    graph(&mut model).initializer.push(numbers("shape", &[4, 3, 16, 32]));
    model
}

/// A network that cannot but take so many pictures at a time.
pub fn baked(pictures: i64) -> pb::ModelProto {
    several(&Toy { size: Some((16, 32)), ..fine() }, pictures, true)
}

/// A network that gives a class map of floats without a batch.
pub fn squeezed() -> pb::ModelProto {
    let nodes = vec![
        node("ArgMax", &["coarse"], "ids", vec![int("axis", 1), int("keepdims", 0)]),
        node("Squeeze", &["ids", "none"], "squeezed", vec![]),
        node("Cast", &["squeezed"], "floats", vec![int("to", DataType::Float as i64)]),
    ];
    ending(&fine(), nodes)
}

/// A network with an auxiliary head before the main one, which sees something else.
pub fn heads(metadata: Metadata) -> pb::ModelProto {
    let mut model = Toy { metadata: Some(metadata), ..fine() }.model();
    let graph = graph(&mut model);
    graph.node.push(node("Neg", &["coarse"], "auxiliary", vec![]));
    graph.output.insert(0, value("auxiliary", DataType::Float, &[1, 3, -1, -2]));
    model
}

#[test]
fn which_of_several_heads_is_looked_at_is_said() {
    let with = |output: Option<&str>| heads(Metadata { output: output.map(Into::into), ..toy::metadata() });
    let plain = look(&fine().model()).unwrap();
    assert_eq!(look(&with(Some("coarse"))).unwrap(), plain);
    assert_ne!(look(&with(Some("auxiliary"))).unwrap(), plain);
    let said = refused(&with(None));
    let all = "\"auxiliary\" (1x3x?x?), \"coarse\" (1x3x?x?)";
    assert!(said.ends_with(&format!("the key output must say which it is of {all}")), "{said}");
    let said = refused(&with(Some("main")));
    assert!(said.ends_with(&format!("it has no output \"main\", but {all}")), "{said}");
}

#[test]
fn an_output_that_alone_can_be_scores_need_not_be_named() {
    let mut model = fine().model();
    let open = graph(&mut model);
    open.node.push(node("Frobnicate", &["coarse"], "vector", vec![]));
    open.node.push(node("Concat", &["coarse", "coarse"], "features", vec![int("axis", 1)]));
    open.output.insert(0, value("vector", DataType::Float, &[1, 3]));
    open.output.insert(0, value("features", DataType::Float, &[1, 6, -1, -2]));
    assert_eq!(look(&model).unwrap(), look(&fine().model()).unwrap(), "what leads to the others is left out");
    graph(&mut model).output.pop();
    assert!(refused(&model).contains("none of its outputs can be of 3 classes: \"features\" (1x6x?x?), \"vector\""));
    let mut model = toy::classifier();
    let output = graph(&mut model).output[0].clone();
    graph(&mut model).output.push(output);
    assert!(refused(&model).contains("none of its outputs can be scores or a class map: \"scores\" (1x3)"));
}

#[test]
fn the_colours_come_in_the_order_that_is_said() {
    let normalisation = Some(Normalisation { mean: [0.25, 0.5, 0.75], std: [0.5, 0.25, 0.125] });
    for layout in [Layout::Nchw, Layout::Nhwc] {
        for element in [DataType::Float, DataType::Uint8] {
            let with = |channels| {
                let metadata = Metadata { channels, normalisation, ..toy::metadata() };
                look(&Toy { layout, element, metadata: Some(metadata), ..fine() }.model()).unwrap()
            };
            // The network calls its first channel a pedestrian, and its last one sky.
            let swapped = |tag: &u8| match tag {
                4 => 13,
                13 => 4,
                other => *other,
            };
            let (rgb, bgr) = (with(Channels::Rgb), with(Channels::Bgr));
            let differ = bgr.ids.iter().zip(rgb.ids.iter().map(swapped)).filter(|(bgr, rgb)| *bgr != rgb).count();
            assert!(differ < 4 && bgr != rgb, "{differ} pixels, but for ties");
        }
    }
}

#[test]
fn bytes_come_in_any_whole_numbers() {
    let with = |element| Toy { element, tail: Tail::Argmax, ..Toy::default() }.model();
    let expected = look(&with(DataType::Uint8)).unwrap();
    for element in [DataType::Int32, DataType::Int64] {
        assert_eq!(look(&with(element)).unwrap(), expected);
    }
    assert!(refused(&with(DataType::Int8)).contains("its input is neither float nor of bytes (uint8, int32 or int64)"));
}

#[test]
fn a_network_for_several_pictures_gets_one() {
    for element in [DataType::Float, DataType::Int32] {
        for layout in [Layout::Nchw, Layout::Nhwc] {
            let toy = Toy { element, layout, size: Some((16, 32)), ..fine() };
            let plain = look(&toy.model()).unwrap();
            assert_eq!(look(&several(&toy, 4, false)).unwrap(), plain, "the graph takes one as well");
            assert_eq!(look(&several(&toy, 4, true)).unwrap(), plain, "it gets four times the same");
            assert!(refused(&several(&toy, 5, true)).contains("node \"Reshape_scores\" (Reshape)"));
            assert!(refused(&several(&toy, 65, false)).contains("pixels of 64 pictures"));
        }
    }
}

#[test]
fn class_maps_and_scores_come_with_and_without_a_batch() {
    let plain = look(&fine().model()).unwrap();
    let argmax = |keep: i64| node("ArgMax", &["coarse"], "ids", vec![int("axis", 1), int("keepdims", keep)]);
    let squeeze = |from: &str| node("Squeeze", &[from, "none"], "squeezed", vec![]);
    let float = |from: &str| node("Cast", &[from], "floats", vec![int("to", DataType::Float as i64)]);
    let half = |from: &str| node("Mul", &[from, "half"], "halves", vec![]);
    for keep in [0, 1] {
        for nodes in [vec![argmax(keep)], vec![argmax(keep), float("ids")], vec![argmax(keep), squeeze("ids")]] {
            let names: Vec<_> = nodes.iter().map(|node| node.name.clone()).collect();
            assert_eq!(look(&ending(&fine(), nodes)).unwrap(), plain, "{names:?}");
        }
    }
    assert_eq!(look(&squeezed()).unwrap(), plain);
    assert_eq!(look(&ending(&fine(), vec![squeeze("coarse")])).unwrap(), plain);
    let last = node("Transpose", &["squeezed"], "last", vec![crate::parts::ints("perm", &[1, 2, 0])]);
    assert_eq!(look(&ending(&fine(), vec![squeeze("coarse"), last])).unwrap(), plain);
    let mut odd = ending(&fine(), vec![argmax(0), float("ids"), half("floats")]);
    graph(&mut odd).initializer.push(floats("half", &[], vec![0.5]));
    assert!(refused(&odd).contains("its class map holds 0.5, which is no whole number"));
}

#[test]
fn names_come_from_the_configuration_beside_it() {
    let dir = tempfile::tempdir().unwrap();
    let path = Toy { metadata: None, element: DataType::Uint8, ..fine() }.write(dir.path());
    let config = dir.path().join("config.json");
    let labels = r#"{"architectures": ["X"], "id2label": {"0": "person", "2": "sky", "1": "tree"}}"#;
    std::fs::write(&config, labels).unwrap();
    let checkpoint = Checkpoint::load(&path).unwrap();
    assert_eq!((checkpoint.classes().tags(), look_from(&path).is_ok()), (&[4, 9, 13][..], true));
    std::fs::write(&config, labels.replace("person", "rider")).unwrap();
    assert_ne!(Checkpoint::load(&path).unwrap().digest(), checkpoint.digest(), "the names are part of it");
    std::fs::write(dir.path().join("toy.toml"), "channels = \"bgr\"").unwrap();
    assert_eq!(Checkpoint::load(&path).unwrap().metadata().channels, Channels::Bgr);
    std::fs::write(dir.path().join("toy.toml"), "classes = [\"Car\", \"Sky\", \"Road\"]").unwrap();
    assert_eq!(Checkpoint::load(&path).unwrap().classes().tags(), [10, 13, 7], "what is said goes first");
    std::fs::remove_file(dir.path().join("toy.toml")).unwrap();
    for (text, expected) in [
        ("{}", "no class names"),
        ("[1", "config.json beside it has none"),
        (r#"{"id2label": {"0": "LABEL_0"}}"#, "unknown class name \"LABEL_0\""),
        (r#"{"id2label": {"1": "person"}}"#, "key id2label: expected the ids 0 to 0, got \"1\""),
    ] {
        std::fs::write(&config, text).unwrap();
        let said = Checkpoint::load(&path).unwrap_err().to_string();
        assert!(said.contains("toy.onnx") && said.contains(expected) && !said.contains('\n'), "{said}");
    }
}

/// A network finer than the pictures: a line of pixels in it shows in the mask of every second.
#[test]
fn what_is_finer_than_the_picture_is_not_skipped() {
    let toy = Toy { size: Some((16, 128)), ..fine() };
    let mut model = toy.model();
    let columns = (0..128).map(|x| if x % 4 == 1 { 1000.0 } else { 0.0 });
    let lines: Vec<f32> =
        [0.0, 1.0, 0.0].into_iter().flat_map(|share| columns.clone().map(move |v| share * v)).collect();
    graph(&mut model).initializer.push(floats("lines", &[1, 3, 1, 128], lines));
    graph(&mut model).node.push(node("Add", &["coarse", "lines"], "lined", vec![]));
    graph(&mut model).output = vec![pb::ValueInfoProto { name: "lined".into(), ..Default::default() }];
    assert!(look(&model).unwrap().ids.iter().all(|tag| *tag == 9));
}
