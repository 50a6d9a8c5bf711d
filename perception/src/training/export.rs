//! Writes a trained network as ONNX in the form that runs fast: batch normalisation folded into the
//! convolutions, pooling and resizing as products with constant matrices, logits at the network's
//! stride (upsampling and argmax are left to [`crate::Segmenter`]). The same weights give the same
//! bytes.

use std::collections::BTreeMap;

use prost::Message;

use super::network::{Graph, Kernel, Resample, Size, fast_scnn};
use super::resample;
use super::weights::{Parameter, Weights};
use super::{kernels::norm, light};
use crate::checkpoint::RECIPE_KEY;
use crate::classes::TRAIN_CLASSES;
use crate::metadata::{Channels, Layout, Metadata};
use crate::onnx::pb::{self, tensor_proto::DataType};
use crate::parts::{self, int, ints};
use crate::{ClassMap, PerceptionError};

/// The model's bytes, for pictures of `width` x `height` pixels. `recipe` is a JSON text that goes
/// into the metadata.
pub(super) fn onnx(weights: &Weights, width: usize, height: usize, recipe: &str) -> Result<Vec<u8>, PerceptionError> {
    let image = Size { rows: height, cols: width, channels: 3 };
    let mut writer = Writer { weights, parameter: 0, layer: 0, graph: pb::GraphProto::default() };
    let input = Value { name: "image".into(), size: image };
    let output = fast_scnn(&mut writer, &input, TRAIN_CLASSES.len());
    writer.graph.name = "fast-scnn".into();
    writer.graph.input = vec![value_info(&input)];
    writer.graph.output = vec![value_info(&output)];
    Ok(pb::ModelProto { producer_name: "aeye".into(), ..parts::model(writer.graph, props(recipe)?) }.encode_to_vec())
}

fn props(recipe: &str) -> Result<BTreeMap<String, String>, PerceptionError> {
    let metadata = Metadata {
        classes: ClassMap::from_names(&TRAIN_CLASSES.map(|c| c.name))?,
        output: None,
        channels: Channels::Rgb,
        normalisation: Some(light::NORMALISATION),
        layout: Some(Layout::Nchw),
        scores: None,
        align_corners: false,
    };
    let mut pairs = metadata.to_props();
    pairs.insert(RECIPE_KEY.into(), recipe.into());
    Ok(pairs)
}

/// A feature map by the name it has in the graph.
#[derive(Clone)]
struct Value {
    name: String,
    size: Size,
}

fn value_info(Value { name, size }: &Value) -> pb::ValueInfoProto {
    let Size { rows, cols, channels } = *size;
    parts::value(name, DataType::Float, &[1, channels as i64, rows as i64, cols as i64])
}

/// Writes nodes on a walk over the network.
struct Writer<'a> {
    weights: &'a Weights,
    /// Parameters and layers that the walk has passed.
    parameter: usize,
    layer: usize,
    graph: pb::GraphProto,
}

impl<'a> Writer<'a> {
    fn parameter(&mut self) -> &'a Parameter {
        self.parameter += 1;
        &self.weights.parameters[self.parameter - 1]
    }

    fn constant(&mut self, name: String, dims: &[usize], values: &[f32]) -> String {
        self.graph.initializer.push(pb::TensorProto {
            name: name.clone(),
            dims: dims.iter().map(|d| *d as i64).collect(),
            data_type: DataType::Float as i32,
            raw_data: values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            ..Default::default()
        });
        name
    }

    fn node(&mut self, op: &str, inputs: &[&str], attribute: Vec<pb::AttributeProto>, size: Size) -> Value {
        let name = format!("{}{}", op.to_lowercase(), self.graph.node.len());
        self.graph.node.push(pb::NodeProto {
            op_type: op.into(),
            name: name.clone(),
            input: inputs.iter().map(|i| (*i).to_owned()).collect(),
            output: vec![name.clone()],
            attribute,
            ..Default::default()
        });
        Value { name, size }
    }

    /// A convolution with the weights as [`Kernel::weights`] lays them out.
    fn convolution(&mut self, x: &Value, kernel: Kernel, weights: &[f32], bias: &[f32]) -> Value {
        let (inputs, side, group, stride, dilation) = match kernel {
            Kernel::Stem { .. } => (x.size.channels, 3, 1, 2, 1),
            Kernel::Pointwise { .. } => (x.size.channels, 1, 1, 1, 1),
            Kernel::Depthwise { stride, dilation } => (1, 3, x.size.channels, stride, dilation),
        };
        let at = self.graph.node.len();
        let outputs = bias.len();
        let dims = [outputs, inputs, side, side];
        let weights = self.constant(format!("weights{at}"), &dims, &channels_first(weights, inputs, outputs));
        let bias = self.constant(format!("bias{at}"), &[outputs], bias);
        let padding = if side == 3 { dilation } else { 0 };
        let attributes = vec![
            ints("dilations", &[dilation as i64; 2]),
            int("group", group as i64),
            ints("kernel_shape", &[side as i64; 2]),
            ints("pads", &[padding as i64; 4]),
            ints("strides", &[stride as i64; 2]),
        ];
        self.node("Conv", &[&x.name, &weights, &bias], attributes, kernel.output(x.size))
    }
}

/// Weights of (tap, input, output) in ONNX's order (output, input, tap).
fn channels_first(weights: &[f32], inputs: usize, outputs: usize) -> Vec<f32> {
    let taps = weights.len() / (inputs * outputs);
    let order = (0..outputs).flat_map(|o| (0..inputs).flat_map(move |i| (0..taps).map(move |t| (t, i, o))));
    order.map(|(t, i, o)| weights[(t * inputs + i) * outputs + o]).collect()
}

impl Graph for Writer<'_> {
    type Node = Value;

    fn size(&self, x: &Value) -> Size {
        x.size
    }

    fn layer(&mut self, x: &Value, kernel: Kernel, relu: bool) -> Value {
        let (weights, scale, shift) = (self.parameter(), self.parameter(), self.parameter());
        let (factor, summand) = norm::affine(&self.weights.moments[self.layer], &scale.values, &shift.values);
        self.layer += 1;
        let rows = weights.values.chunks_exact(weights.cols);
        let folded: Vec<f32> = rows.flat_map(|row| row.iter().zip(&factor).map(|(w, f)| w * f)).collect();
        let y = self.convolution(x, kernel, &folded, &summand);
        if relu { self.relu(&y) } else { y }
    }

    fn logits(&mut self, x: &Value, out: usize) -> Value {
        let (weights, bias) = (self.parameter(), self.parameter());
        self.convolution(x, Kernel::Pointwise { out }, &weights.values, &bias.values)
    }

    fn resample(&mut self, x: &Value, rows: usize, cols: usize, how: Resample) -> Value {
        let at = self.graph.node.len();
        let from = x.size;
        // The columns' matrix stands on the right, hence transposed.
        let transposed = transpose(&resample::matrix(how, from.cols, cols), from.cols);
        let across = self.constant(format!("columns{at}"), &[1, 1, from.cols, cols], &transposed);
        let down =
            self.constant(format!("rows{at}"), &[1, 1, rows, from.rows], &resample::matrix(how, from.rows, rows));
        let wide = self.node("MatMul", &[&x.name, &across], Vec::new(), Size { cols, ..from });
        self.node("MatMul", &[&down, &wide.name], Vec::new(), Size { rows, cols, ..from })
    }

    fn add(&mut self, a: &Value, b: &Value) -> Value {
        self.node("Add", &[&a.name, &b.name], Vec::new(), a.size)
    }

    fn relu(&mut self, x: &Value) -> Value {
        self.node("Relu", &[&x.name], Vec::new(), x.size)
    }

    fn spread(&mut self, x: &Value, side: usize) -> Value {
        self.node("DepthToSpace", &[&x.name], vec![int("blocksize", side as i64)], x.size.spread(side))
    }

    fn concat(&mut self, parts: &[Value]) -> Value {
        let channels = parts.iter().map(|p| p.size.channels).sum();
        let names: Vec<&str> = parts.iter().map(|p| p.name.as_str()).collect();
        self.node("Concat", &names, vec![int("axis", 1)], Size { channels, ..parts[0].size })
    }
}

fn transpose(matrix: &[f32], cols: usize) -> Vec<f32> {
    (0..cols).flat_map(|c| matrix.iter().skip(c).step_by(cols).copied()).collect()
}
