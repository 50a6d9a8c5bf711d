//! ONNX files as messages, decoded only if they do not swell: a message of two bytes takes hundreds in memory.

use prost::Message;
use prost::encoding::{WireType, decode_key, decode_varint};

use super::pb;

/// Most bytes that a decoded model may take in memory besides its texts and data, which are no longer than its file.
const MOST_BYTES: usize = 1 << 29;
/// Deepest nesting of messages that is decoded (prost's own limit).
const DEEPEST: usize = 100;
/// What a field of text or a small message takes besides its bytes.
const SMALL: usize = 160;

/// Decodes an ONNX file; the error is what is wrong with it.
pub fn decode(bytes: &[u8]) -> Result<pb::ModelProto, String> {
    let mut left = MOST_BYTES;
    weigh(Kind::Model, bytes, DEEPEST, &mut left)?;
    let model = pb::ModelProto::decode(bytes).map_err(|e| e.to_string())?;
    match &model.graph {
        Some(graph) if !graph.node.is_empty() => Ok(model),
        _ => Err("it holds no graph".into()),
    }
}

/// The messages that may come in great numbers.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Model,
    Graph,
    Node,
    Attribute,
    Tensor,
    Value,
    Type,
    TensorType,
    Shape,
    /// Numbers of few bytes each, which take 8 in memory.
    Numbers,
    /// Text, data, or a message of nothing but text.
    Small,
    /// Any other message, whose parts are not looked at.
    Other,
}

impl Kind {
    /// What stands at a field of it.
    fn at(self, field: u32) -> Self {
        match (self, field) {
            (Self::Model, 7) | (Self::Attribute, 6 | 11) => Self::Graph,
            (Self::Model, 20 | 25) | (Self::Graph, 14 | 15) | (Self::Attribute, 22 | 23) => Self::Other,
            (Self::Graph, 1) => Self::Node,
            (Self::Graph, 5) | (Self::Attribute, 5 | 10) => Self::Tensor,
            (Self::Graph, 11..=13) => Self::Value,
            (Self::Node, 5) => Self::Attribute,
            (Self::Value, 2) | (Self::Attribute, 14 | 15) => Self::Type,
            (Self::Type, 1) => Self::TensorType,
            (Self::TensorType, 2) => Self::Shape,
            (Self::Tensor, 1 | 5 | 7 | 11) | (Self::Attribute, 8) => Self::Numbers,
            _ => Self::Small,
        }
    }

    /// What one takes in memory besides its parts.
    fn size(self) -> usize {
        match self {
            Self::Model | Self::Graph => size_of::<pb::GraphProto>(),
            Self::Node => size_of::<pb::NodeProto>(),
            Self::Attribute => size_of::<pb::AttributeProto>(),
            Self::Tensor => size_of::<pb::TensorProto>(),
            Self::Value | Self::Type | Self::TensorType | Self::Shape => SMALL,
            Self::Numbers => 0,
            Self::Small | Self::Other => SMALL,
        }
    }
}

/// Takes what a message will need in memory from what is left.
fn weigh(kind: Kind, mut bytes: &[u8], depth: usize, left: &mut usize) -> Result<(), String> {
    let depth = depth.checked_sub(1).ok_or("its messages are nested too deeply")?;
    while !bytes.is_empty() {
        let (field, wire) = decode_key(&mut bytes).map_err(|e| e.to_string())?;
        let cost = match wire {
            WireType::LengthDelimited => {
                let length = decode_varint(&mut bytes).map_err(|e| e.to_string())?;
                let content = usize::try_from(length).ok().and_then(|n| bytes.split_off(..n));
                let content = content.ok_or("it is cut off")?;
                let child = kind.at(field);
                match child {
                    Kind::Small => SMALL,
                    Kind::Numbers => 8 * content.len(),
                    Kind::Other => SMALL * content.len(),
                    message => {
                        weigh(message, content, depth, left)?;
                        message.size()
                    }
                }
            }
            WireType::Varint => decode_varint(&mut bytes).map(|_| 8).map_err(|e| e.to_string())?,
            WireType::ThirtyTwoBit => bytes.split_off(..4).map(|_| 8).ok_or("it is cut off")?,
            WireType::SixtyFourBit => bytes.split_off(..8).map(|_| 8).ok_or("it is cut off")?,
            WireType::StartGroup | WireType::EndGroup => return Err("it holds groups, which ONNX has not".into()),
        };
        let most = MOST_BYTES >> 20;
        *left =
            left.checked_sub(cost).ok_or_else(|| format!("its messages would take more than {most} MiB of memory"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toy::Toy;

    #[test]
    fn a_model_weighs_what_its_messages_take() {
        let bytes = Toy::default().model().encode_to_vec();
        let mut left = MOST_BYTES;
        weigh(Kind::Model, &bytes, DEEPEST, &mut left).unwrap();
        assert!((8 * SMALL..64 << 10).contains(&(MOST_BYTES - left)));
        assert!(decode(&bytes[..bytes.len() - 1]).is_err());
    }

    #[test]
    fn files_that_swell_are_refused_before_they_do() {
        let empty_nodes = |n: usize| [&[0x3a][..], &varint(2 * n), &[0x0a, 0].repeat(n)].concat();
        assert!(decode(&empty_nodes(1000)).is_ok());
        assert!(decode(&empty_nodes(20_000_000)).unwrap_err().contains("MiB of memory"));
    }

    #[test]
    fn graphs_in_graphs_are_followed_so_deep() {
        let mut graph = vec![0x0a, 0];
        for _ in 0..200 {
            // A node with an attribute with a graph.
            for tag in [0x32, 0x2a, 0x0a] {
                graph = [&[tag][..], &varint(graph.len()), &graph].concat();
            }
        }
        let model = [&[0x3a][..], &varint(graph.len()), &graph].concat();
        assert!(decode(&model).unwrap_err().contains("too deeply"));
    }

    fn varint(mut n: usize) -> Vec<u8> {
        let mut out = Vec::new();
        while n >= 0x80 {
            out.push(n as u8 | 0x80);
            n >>= 7;
        }
        out.push(n as u8);
        out
    }
}
