//! Fractions in a foreign network become f32, whatever its file has them in: half precision is slow on a CPU, and of
//! double precision, which exporters leave in constants and casts, the engine has few operators. A number beyond the
//! range of f32 becomes the last one within it.

use crate::onnx::{
    f16,
    pb::{self, tensor_proto::DataType},
};
use crate::tensors;

/// Widths of fractions other than f32.
const OTHERS: [DataType; 3] = [DataType::Double, DataType::Float16, DataType::Bfloat16];
/// Attributes that name a type.
const NAMES_TYPE: [&str; 2] = ["to", "dtype"];

/// Makes every fraction of a checked model one of f32, its input's and outputs' included.
pub(crate) fn to_single(model: &mut pb::ModelProto) {
    tensors::for_each(model, &mut |tensor| {
        narrow(tensor);
        Ok(())
    })
    .unwrap_or_else(|never: String| debug_assert!(false, "{never}"));
    let Some(graph) = &mut model.graph else { return };
    let ends = graph.input.iter_mut().chain(&mut graph.output);
    for value in ends.filter_map(|value| value.r#type.as_mut()?.value.as_mut()) {
        let pb::type_proto::Value::TensorType(tensor) = value;
        tensor.elem_type = single(tensor.elem_type);
    }
    retype(graph);
}

/// The type that stands in for another one.
fn single(kind: i32) -> i32 {
    if OTHERS.iter().any(|other| *other as i32 == kind) { DataType::Float as i32 } else { kind }
}

/// What nodes cast to.
fn retype(graph: &mut pb::GraphProto) {
    for attribute in graph.node.iter_mut().flat_map(|node| &mut node.attribute) {
        if NAMES_TYPE.contains(&attribute.name.as_str()) {
            attribute.i = i32::try_from(attribute.i).map_or(attribute.i, |kind| single(kind).into());
        }
        attribute.g.iter_mut().chain(&mut attribute.graphs).for_each(retype);
    }
}

fn narrow(tensor: &mut pb::TensorProto) {
    let raw = std::mem::take(&mut tensor.raw_data);
    let halves = |listed: &[i32]| -> Vec<u16> {
        match raw.is_empty() {
            true => listed.iter().map(|&bits| bits as u16).collect(),
            false => raw.as_chunks().0.iter().map(|&bytes| u16::from_le_bytes(bytes)).collect(),
        }
    };
    let values: Vec<f32> = match DataType::try_from(tensor.data_type) {
        Ok(DataType::Double) if raw.is_empty() => tensor.double_data.iter().map(|&v| nearest(v)).collect(),
        Ok(DataType::Double) => raw.as_chunks().0.iter().map(|&bytes| nearest(f64::from_le_bytes(bytes))).collect(),
        Ok(DataType::Float16) => halves(&tensor.int32_data).into_iter().map(|v| f16::from_bits(v).to_f32()).collect(),
        Ok(DataType::Bfloat16) => {
            halves(&tensor.int32_data).into_iter().map(|v| f32::from_bits(u32::from(v) << 16)).collect()
        }
        _ => {
            tensor.raw_data = raw;
            return;
        }
    };
    (tensor.double_data, tensor.int32_data) = (Vec::new(), Vec::new());
    (tensor.data_type, tensor.float_data) = (DataType::Float as i32, values);
}

fn nearest(value: f64) -> f32 {
    let bound = if value.is_finite() { f64::from(f32::MAX) } else { f64::INFINITY };
    value.clamp(-bound, bound) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::int;
    use crate::toy::{self, Toy, node, picture};
    use crate::{Checkpoint, RgbView, Segmenter};

    /// The numbers of a tensor in another width, listed or raw.
    fn widened(tensor: &pb::TensorProto, kind: DataType, is_raw: bool) -> pb::TensorProto {
        let values = tensor.float_data.iter().copied();
        let mut wide = pb::TensorProto { float_data: vec![], data_type: kind as i32, ..tensor.clone() };
        let halves =
            |v: f32| if kind == DataType::Float16 { f16::from_f32(v).to_bits() } else { (v.to_bits() >> 16) as u16 };
        match (kind, is_raw) {
            (DataType::Double, false) => wide.double_data = values.map(f64::from).collect(),
            (DataType::Double, true) => wide.raw_data = values.flat_map(|v| f64::from(v).to_le_bytes()).collect(),
            (_, false) => wide.int32_data = values.map(|v| halves(v).into()).collect(),
            (_, true) => wide.raw_data = values.flat_map(|v| halves(v).to_le_bytes()).collect(),
        }
        wide
    }

    fn mask(model: &pb::ModelProto) -> Vec<u8> {
        let dir = tempfile::tempdir().unwrap();
        let checkpoint = Checkpoint::load(toy::write(dir.path(), "toy.onnx", model)).unwrap();
        let mut segmenter = Segmenter::new(&checkpoint, 32, 16).unwrap();
        segmenter.run(RgbView::new(32, 16, &picture(32, 16)).unwrap()).unwrap().ids
    }

    /// Weights of a toy are powers of two, which every width has.
    #[test]
    fn networks_of_every_width_give_the_same() {
        let expected = mask(&Toy::default().model());
        for kind in OTHERS {
            for is_raw in [false, true] {
                let mut model = Toy { element: kind, ..Toy::default() }.model();
                let weights = &mut model.graph.as_mut().unwrap().initializer[0];
                *weights = widened(weights, kind, is_raw);
                assert_eq!(mask(&model), expected, "{kind:?} {is_raw}");
            }
        }
    }

    /// As PyTorch's exporter decomposes a PReLU: the comparison is made in double precision.
    #[test]
    fn doubles_amid_a_network_are_computed() {
        let mut model = Toy { stride: 1, ..Toy::default() }.model();
        let graph = model.graph.as_mut().unwrap();
        graph.initializer.push(widened(&toy::floats("zero", &[], vec![0.0]), DataType::Double, false));
        let huge = pb::TensorProto { double_data: vec![1e300], ..graph.initializer.last().unwrap().clone() };
        graph.initializer.push(pb::TensorProto { name: "huge".into(), ..huge });
        let to = |kind: DataType| vec![int("to", kind as i64)];
        graph.node.extend([
            node("Cast", &["coarse"], "wide", to(DataType::Double)),
            node("Greater", &["wide", "zero"], "positive", vec![]),
            node("Min", &["wide", "huge"], "least", vec![]),
            node("LeakyRelu", &["least"], "leaky", vec![]),
            node("Where", &["positive", "wide", "leaky"], "chosen", vec![]),
            node("Cast", &["chosen"], "scores", to(DataType::Float)),
        ]);
        graph.output[0].name = "scores".into();
        assert_eq!(mask(&model), mask(&Toy { stride: 1, ..Toy::default() }.model()));
    }

    #[test]
    fn numbers_beyond_the_range_become_the_last_within() {
        assert_eq!([1e300, -1e300, 0.5].map(nearest), [f32::MAX, f32::MIN, 0.5]);
        assert_eq!([f64::INFINITY, f64::NEG_INFINITY].map(nearest), [f32::INFINITY, f32::NEG_INFINITY]);
    }
}
