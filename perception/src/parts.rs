//! Parts of ONNX models, as they are written here.

use std::collections::BTreeMap;

use crate::onnx::pb::{self, tensor_proto::DataType};

const OPSET: i64 = 13;
const IR_VERSION: i64 = 8;

/// A model of a graph, with metadata.
pub fn model(graph: pb::GraphProto, props: BTreeMap<String, String>) -> pb::ModelProto {
    let entry = |(key, value)| pb::StringStringEntryProto { key, value };
    pb::ModelProto {
        ir_version: IR_VERSION,
        opset_import: vec![pb::OperatorSetIdProto { version: OPSET, ..Default::default() }],
        graph: Some(graph),
        metadata_props: props.into_iter().map(entry).collect(),
        ..Default::default()
    }
}

/// A node with one output, after which it is called.
pub fn node(op: &str, inputs: &[&str], output: &str, attribute: Vec<pb::AttributeProto>) -> pb::NodeProto {
    pb::NodeProto {
        op_type: op.into(),
        name: format!("{op}_{output}"),
        input: inputs.iter().map(|s| s.to_string()).collect(),
        output: vec![output.into()],
        attribute,
        ..Default::default()
    }
}

/// A list of whole numbers as a constant.
pub fn numbers(name: &str, values: &[i64]) -> pb::TensorProto {
    let dims = vec![values.len() as i64];
    let data_type = DataType::Int64 as i32;
    pb::TensorProto { name: name.into(), dims, data_type, int64_data: values.to_vec(), ..Default::default() }
}

/// Whole numbers of an operator.
pub fn ints(name: &str, values: &[i64]) -> pb::AttributeProto {
    let kind = pb::attribute_proto::AttributeType::Ints as i32;
    pb::AttributeProto { name: name.into(), r#type: kind, ints: values.to_vec(), ..Default::default() }
}

/// A whole number of an operator.
pub fn int(name: &str, value: i64) -> pb::AttributeProto {
    let kind = pb::attribute_proto::AttributeType::Int as i32;
    pb::AttributeProto { name: name.into(), r#type: kind, i: value, ..Default::default() }
}

/// A word of an operator.
#[cfg(test)]
pub fn text(name: &str, value: &str) -> pb::AttributeProto {
    let kind = pb::attribute_proto::AttributeType::String as i32;
    pb::AttributeProto { name: name.into(), r#type: kind, s: value.into(), ..Default::default() }
}

/// A value of the graph with its type and shape; negative dimensions are open and named.
pub fn value(name: &str, element: DataType, dims: &[i64]) -> pb::ValueInfoProto {
    use pb::tensor_shape_proto::{Dimension, dimension::Value};
    let dimension = |&n: &i64| {
        let value = if n < 0 { Value::DimParam(format!("d{}", -n)) } else { Value::DimValue(n) };
        Dimension { value: Some(value), ..Default::default() }
    };
    let shape = pb::TensorShapeProto { dim: dims.iter().map(dimension).collect() };
    let tensor = pb::type_proto::Tensor { elem_type: element as i32, shape: Some(shape) };
    let value = pb::type_proto::Value::TensorType(tensor);
    let r#type = Some(pb::TypeProto { value: Some(value), ..Default::default() });
    pb::ValueInfoProto { name: name.into(), r#type, ..Default::default() }
}
