//! What a checkpoint says about its input and output.
//!
//! It stands in the ONNX model's `metadata_props`, or in a TOML file beside it (`NAME.toml` for
//! `NAME.onnx`, which goes first) with the same keys without their prefix:
//!
//! | key | value | default |
//! |---|---|---|
//! | `aeye.classes` | JSON list of class names in the order of the outputs, or the name of a scheme as a JSON string (see [`ClassMap::named`]) | required |
//! | `aeye.mean`, `aeye.std` | JSON list of three numbers for red, green, blue; the input is `(byte / 255 - mean) / std` | required for a float input |
//! | `aeye.layout` | JSON string `"nchw"` or `"nhwc"` | from the input's shape |
//! | `aeye.align_corners` | JSON bool: whether the upsampling of the logits maps corner pixels onto corner pixels | `false`: edges onto edges (half-pixel centres) |
//!
//! Values of `metadata_props` are JSON texts.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::classes::ClassMap;

/// Prefix of the keys in `metadata_props`.
pub const PREFIX: &str = "aeye.";

/// Order of the dimensions of the network's input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    /// Batch, channel, row, column.
    Nchw,
    /// Batch, row, column, channel.
    Nhwc,
}

/// What a checkpoint says about its input and output.
#[derive(Clone, Debug, PartialEq)]
pub struct Metadata {
    /// What the outputs mean.
    pub classes: ClassMap,
    /// Mean of red, green and blue as fractions of 255, and their standard deviations; absent for
    /// a network that takes bytes.
    pub normalisation: Option<Normalisation>,
    /// Order of the input's dimensions, where its shape does not tell.
    pub layout: Option<Layout>,
    /// Whether upsampling maps corner pixels onto corner pixels.
    pub align_corners: bool,
}

/// How bytes become the network's input: `(byte / 255 - mean) / std`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalisation {
    /// Of red, green and blue, as fractions of 255.
    pub mean: [f32; 3],
    /// Of red, green and blue, as fractions of 255; positive.
    pub std: [f32; 3],
}

impl Metadata {
    /// As pairs for the ONNX model's `metadata_props`.
    pub fn to_props(&self) -> BTreeMap<String, String> {
        todo!()
    }
}
