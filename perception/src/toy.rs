//! Tiny networks for the tests: class 0 answers to red, 1 to green, 2 to blue, averaged over
//! squares of `stride` pixels.

use std::path::{Path, PathBuf};

use prost::Message;

use crate::metadata::{Channels, Layout, Metadata, Normalisation};
use crate::onnx::pb::{self, tensor_proto::DataType};
pub use crate::parts::node;
use crate::parts::{self, int, ints, text, value};
use crate::{ClassMap, Mask};

pub const CLASSES: [&str; 3] = ["Pedestrian", "Vegetation", "Sky"];

/// What stands behind the scores.
#[derive(Clone, Copy, PartialEq)]
pub enum Tail {
    None,
    /// Bilinear upsampling inside the graph.
    Upsample,
    /// The same, then softmax and argmax.
    Argmax,
    /// Argmax of the coarse scores.
    CoarseArgmax,
}

#[derive(Clone)]
pub struct Toy {
    pub layout: Layout,
    pub element: DataType,
    pub stride: usize,
    /// Rows and columns; open when absent.
    pub size: Option<(i64, i64)>,
    pub tail: Tail,
    pub metadata: Option<Metadata>,
}

impl Default for Toy {
    fn default() -> Self {
        Self {
            layout: Layout::Nchw,
            element: DataType::Float,
            stride: 4,
            size: None,
            tail: Tail::None,
            metadata: Some(metadata()),
        }
    }
}

pub fn metadata() -> Metadata {
    Metadata {
        classes: ClassMap::from_names(&CLASSES).unwrap(),
        output: None,
        channels: Channels::Rgb,
        normalisation: Some(Normalisation { mean: [0.25, 0.5, 0.75], std: [0.5, 0.25, 0.125] }),
        layout: None,
        scores: None,
        align_corners: false,
    }
}

pub fn floats(name: &str, dims: &[i64], values: Vec<f32>) -> pb::TensorProto {
    let data_type = DataType::Float as i32;
    pb::TensorProto { name: name.into(), dims: dims.to_vec(), data_type, float_data: values, ..Default::default() }
}

impl Toy {
    pub fn model(&self) -> pb::ModelProto {
        let s = self.stride as i64;
        let share = 1.0 / (s * s) as f32;
        let square = self.stride * self.stride;
        // From channel i to class c: only the class's own colour counts.
        let weights = (0..9 * square).map(|i| if (i / square).is_multiple_of(4) { share } else { 0.0 }).collect();
        let mut nodes = Vec::new();
        let mut image = "image";
        if self.element != DataType::Float {
            nodes.push(node("Cast", &[image], "float", vec![int("to", DataType::Float as i64)]));
            image = "float";
        }
        if self.layout == Layout::Nhwc {
            nodes.push(node("Transpose", &[image], "planes", vec![ints("perm", &[0, 3, 1, 2])]));
            image = "planes";
        }
        let conv = vec![ints("kernel_shape", &[s, s]), ints("strides", &[s, s])];
        nodes.push(node("Conv", &[image, "weights"], "coarse", conv));
        let (output, element) = self.add_tail(&mut nodes);
        let (h, w) = self.size.unwrap_or((-1, -2));
        let full = matches!(self.tail, Tail::Upsample | Tail::Argmax);
        let (oh, ow) = if full { (h, w) } else { (-3, -4) };
        let out_dims = if element == DataType::Int64 { vec![1, oh, ow] } else { vec![1, 3, oh, ow] };
        let in_dims = if self.layout == Layout::Nchw { [1, 3, h, w] } else { [1, h, w, 3] };
        let up = [1.0, 1.0, s as f32, s as f32];
        finish(
            pb::GraphProto {
                node: nodes,
                initializer: vec![floats("weights", &[3, 3, s, s], weights), floats("scales", &[4], up.to_vec())],
                input: vec![value("image", self.element, &in_dims)],
                output: vec![value(output, element, &out_dims)],
                ..Default::default()
            },
            self.metadata.as_ref(),
        )
    }

    fn add_tail(&self, nodes: &mut Vec<pb::NodeProto>) -> (&'static str, DataType) {
        if matches!(self.tail, Tail::Upsample | Tail::Argmax) {
            let how = vec![text("mode", "linear"), text("coordinate_transformation_mode", "half_pixel")];
            nodes.push(node("Resize", &["coarse", "", "scales"], "fine", how));
        }
        let argmax = || vec![int("axis", 1), int("keepdims", 0)];
        match self.tail {
            Tail::None => ("coarse", DataType::Float),
            Tail::Upsample => ("fine", DataType::Float),
            Tail::Argmax => {
                nodes.push(node("Softmax", &["fine"], "shares", vec![int("axis", 1)]));
                nodes.push(node("ArgMax", &["shares"], "ids", argmax()));
                ("ids", DataType::Int64)
            }
            Tail::CoarseArgmax => {
                nodes.push(node("ArgMax", &["coarse"], "ids", argmax()));
                ("ids", DataType::Int64)
            }
        }
    }

    pub fn write(&self, dir: &Path) -> PathBuf {
        write(dir, "toy.onnx", &self.model())
    }
}

fn tensor_mut(value: &mut pb::ValueInfoProto) -> Option<&mut pb::type_proto::Tensor> {
    let pb::type_proto::Value::TensorType(tensor) = value.r#type.as_mut()?.value.as_mut()?;
    Some(tensor)
}

/// Fixes a dimension of a value, if it has it.
pub fn set_dim(value: &mut pb::ValueInfoProto, at: usize, size: i64) {
    let dims = tensor_mut(value).and_then(|tensor| tensor.shape.as_mut());
    if let Some(dim) = dims.and_then(|shape| shape.dim.get_mut(at)) {
        dim.value = Some(pb::tensor_shape_proto::dimension::Value::DimValue(size));
    }
}

/// Changes the type of a value.
pub fn retype(value: &mut pb::ValueInfoProto, kind: i32) {
    tensor_mut(value).into_iter().for_each(|tensor| tensor.elem_type = kind);
}

pub fn finish(graph: pb::GraphProto, metadata: Option<&Metadata>) -> pb::ModelProto {
    parts::model(graph, metadata.map(Metadata::to_props).unwrap_or_default())
}

/// A network that gives one score for each of three classes to the whole picture.
pub fn classifier() -> pb::ModelProto {
    let nodes = vec![
        node("GlobalAveragePool", &["image"], "mean", vec![]),
        node("Flatten", &["mean"], "scores", vec![int("axis", 1)]),
    ];
    let graph = pb::GraphProto {
        node: nodes,
        input: vec![value("image", DataType::Float, &[1, 3, 32, 32])],
        output: vec![value("scores", DataType::Float, &[1, 3])],
        ..Default::default()
    };
    finish(graph, None)
}

pub fn write(dir: &Path, name: &str, model: &pb::ModelProto) -> PathBuf {
    let path = dir.join(name);
    std::fs::write(&path, model.encode_to_vec()).unwrap();
    path
}

/// A picture with areas of the three colours and soft borders.
pub fn picture(width: usize, height: usize) -> Vec<u8> {
    let wave = |x: usize, y: usize, c: usize| {
        let phase = c as f32 * 2.1;
        128.0 + 100.0 * ((x as f32 / 7.0 + phase).sin() * (y as f32 / 5.0 + phase).cos())
    };
    let pixel = |i: usize| (0..3).map(move |c| wave(i % width, i / width, c) as u8);
    (0..width * height).flat_map(pixel).collect()
}

/// The mask that a toy must give, by its definition: means over squares, upsampled, highest wins.
/// Returns the scores of every pixel, so that near-ties can be told.
pub fn scores(
    rgb: &[u8],
    width: usize,
    height: usize,
    stride: usize,
    value: impl Fn(usize, u8) -> f32,
) -> Vec<[f32; 3]> {
    let (w, h) = (width / stride, height / stride);
    let coarse = |x: usize, y: usize, c: usize| {
        let pixels = (0..stride * stride).map(|i| (y * stride + i / stride) * width + x * stride + i % stride);
        pixels.map(|p| value(c, rgb[3 * p + c])).sum::<f32>() / (stride * stride) as f32
    };
    let place = |i: usize, n: usize| ((i as f32 + 0.5) / stride as f32 - 0.5).clamp(0.0, (n - 1) as f32);
    let pixel = |i: usize| {
        let (sx, sy) = (place(i % width, w), place(i / width, h));
        let (x, y) = (sx as usize, sy as usize);
        let (dx, dy) = (sx - x as f32, sy - y as f32);
        let (x1, y1) = ((x + 1).min(w - 1), (y + 1).min(h - 1));
        std::array::from_fn(|c| {
            (coarse(x, y, c) * (1.0 - dx) + coarse(x1, y, c) * dx) * (1.0 - dy)
                + (coarse(x, y1, c) * (1.0 - dx) + coarse(x1, y1, c) * dx) * dy
        })
    };
    (0..width * height).map(pixel).collect()
}

/// Asserts that every pixel has the class of the highest score, near-ties aside.
pub fn assert_highest(mask: &Mask, scores: &[[f32; 3]]) {
    let tags = ClassMap::from_names(&CLASSES).unwrap().tags().to_vec();
    for (i, (tag, scores)) in mask.ids.iter().zip(scores).enumerate() {
        let class = tags.iter().position(|t| t == tag).expect("one of the three classes");
        let highest = scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        assert!(highest - scores[class] < 1e-4, "pixel {i}: class {class} of {scores:?}");
    }
    assert!(tags.iter().all(|tag| mask.ids.contains(tag)), "all three classes must appear");
}
