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
//! | `aeye.scores` | JSON string `"logits"` (or logarithms of probabilities), or `"probabilities"` for a network that ends in a softmax or a sigmoid | probabilities where the graph ends in Softmax or Sigmoid |
//! | `aeye.align_corners` | JSON bool: whether the upsampling of the logits maps corner pixels onto corner pixels | `false`: edges onto edges (half-pixel centres) |
//!
//! Values of `metadata_props` are JSON texts.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::PerceptionError;
use crate::classes::ClassMap;

/// Prefix of the keys in `metadata_props`.
const PREFIX: &str = "aeye.";
const KEYS: [&str; 6] = ["classes", "mean", "std", "layout", "scores", "align_corners"];

/// Order of the dimensions of the network's input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    /// Batch, channel, row, column.
    Nchw,
    /// Batch, row, column, channel.
    Nhwc,
}

/// What a network's scores are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ScoreKind {
    /// Their softmax is what the network believes.
    Logits,
    /// They are what it believes, but for their sum.
    Probabilities,
}

/// What a checkpoint says about its input and output.
#[derive(Clone, Debug, PartialEq)]
pub struct Metadata {
    /// What the outputs mean.
    pub classes: ClassMap,
    /// How bytes become the input; absent for a network that takes bytes.
    pub normalisation: Option<Normalisation>,
    /// Order of the input's dimensions, where its shape does not tell.
    pub layout: Option<Layout>,
    /// What its scores are, where its last node does not tell; the class is that of the highest score either way.
    pub scores: Option<ScoreKind>,
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

impl Normalisation {
    /// The input value of every byte, for red, green and blue.
    pub fn table(&self) -> [[f32; 256]; 3] {
        let value = |c: usize, byte: usize| (byte as f32 / 255.0 - self.mean[c]) / self.std[c];
        std::array::from_fn(|c| std::array::from_fn(|byte| value(c, byte)))
    }
}

/// The keys as they are written, in TOML as well as in JSON.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    classes: Classes,
    mean: Option<[f32; 3]>,
    std: Option<[f32; 3]>,
    layout: Option<Layout>,
    scores: Option<ScoreKind>,
    #[serde(default)]
    align_corners: bool,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "a list of class names or the name of a scheme")]
enum Classes {
    Scheme(String),
    Names(Vec<String>),
}

impl Metadata {
    /// As pairs for the ONNX model's `metadata_props`.
    pub fn to_props(&self) -> BTreeMap<String, String> {
        let written = Written {
            classes: Classes::Names(self.classes.names().to_vec()),
            mean: self.normalisation.map(|n| n.mean),
            std: self.normalisation.map(|n| n.std),
            layout: self.layout,
            scores: self.scores,
            align_corners: self.align_corners,
        };
        let json = serde_json::to_value(written).unwrap_or_default();
        let pairs = KEYS.iter().map(|key| (format!("{PREFIX}{key}"), json[key].clone()));
        pairs.filter(|(_, value)| !value.is_null()).map(|(key, value)| (key, value.to_string())).collect()
    }

    /// From pairs of the ONNX model's `metadata_props`; `None` when none of the keys is there. The
    /// error is a sentence without the file's name.
    pub fn from_props<'a>(props: impl IntoIterator<Item = (&'a str, &'a str)>) -> Option<Result<Self, String>> {
        let mut object = serde_json::Map::new();
        for (key, text) in props {
            let Some(key) = key.strip_prefix(PREFIX).filter(|key| KEYS.contains(key)) else { continue };
            match serde_json::from_str(text) {
                Ok(value) => object.insert(key.to_owned(), value),
                Err(e) => return Some(Err(format!("metadata {PREFIX}{key} is not JSON: {e}"))),
            };
        }
        if object.is_empty() {
            return None;
        }
        let written: Result<Written, _> = serde_json::from_value(object.into());
        Some(written.map_err(|e| format!("metadata {PREFIX}*: {e}")).and_then(Self::checked))
    }

    /// From the text of a sidecar. The error is a sentence without the file's name.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        let written: Written = toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1);
            format!("line {line}: {}", e.message().replace('\n', ", "))
        })?;
        Self::checked(written)
    }

    fn checked(written: Written) -> Result<Self, String> {
        let classes = match &written.classes {
            Classes::Scheme(name) => ClassMap::named(name),
            Classes::Names(names) => ClassMap::from_names(names),
        };
        Ok(Self {
            classes: classes.map_err(|e: PerceptionError| format!("key classes: {e}"))?,
            normalisation: normalisation(written.mean, written.std)?,
            layout: written.layout,
            scores: written.scores,
            align_corners: written.align_corners,
        })
    }
}

fn normalisation(mean: Option<[f32; 3]>, std: Option<[f32; 3]>) -> Result<Option<Normalisation>, String> {
    match (mean, std) {
        (None, None) => Ok(None),
        (Some(mean), Some(std)) => {
            if !std.iter().all(|v| *v > 0.0) {
                return Err(format!("key std: expected three positive numbers, got {std:?}"));
            }
            let normalisation = Normalisation { mean, std };
            let finite = mean.iter().chain(&std).chain(normalisation.table().as_flattened()).all(|v| v.is_finite());
            match finite {
                true => Ok(Some(normalisation)),
                false => Err(format!(
                    "keys mean and std: expected finite numbers that make finite inputs, got {mean:?} and {std:?}"
                )),
            }
        }
        _ => Err("keys mean and std must stand together".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Metadata {
        Metadata {
            classes: ClassMap::named("aeye").unwrap(),
            normalisation: Some(Normalisation { mean: [0.5, 0.25, 0.125], std: [0.2, 0.3, 0.4] }),
            layout: Some(Layout::Nchw),
            scores: Some(ScoreKind::Probabilities),
            align_corners: false,
        }
    }

    #[test]
    fn props_read_back_as_written() {
        let props = example().to_props();
        let pairs = props.iter().map(|(k, v)| (k.as_str(), v.as_str()));
        assert_eq!(Metadata::from_props(pairs), Some(Ok(example())));
        assert_eq!(Metadata::from_props([("producer", "someone")]), None);
    }

    #[test]
    fn sidecar_speaks_the_same_keys() {
        let text = "classes = \"aeye\"\nmean = [0.5, 0.25, 0.125]\nstd = [0.2, 0.3, 0.4]\nlayout = \"nchw\"\nscores = \"probabilities\"\n";
        assert_eq!(Metadata::from_toml(text), Ok(example()));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let said = |text: &str| Metadata::from_toml(text).unwrap_err();
        assert!(said("classes = [\"Road\", \"Zebra\"]").contains("Zebra"));
        assert!(said("classes = \"aeye\"\n\nmeen = [0, 0, 0]").starts_with("line 3: unknown field `meen`"));
        assert!(said("classes = \"aeye\"\nmean = [0.0, 0.0, 0.0]").contains("together"));
        assert!(said("classes = \"aeye\"\nmean = [0.0, 0.0, 0.0]\nstd = [1.0, 0.0, 1.0]").contains("positive"));
        assert!(said("mean = [0.0, 0.0, 0.0]\nstd = [1.0, 1.0, 1.0]").contains("classes"));
        for odd in ["nan", "inf", "-inf", "1e39", "1e-45"] {
            let text = format!("classes = \"aeye\"\nmean = [0.0, 0.0, 0.0]\nstd = [1.0, {odd}, 1.0]");
            assert!(Metadata::from_toml(&text).is_err(), "{odd}");
        }
        assert!(said("classes = \"aeye\"\nmean = [0.0, nan, 0.0]\nstd = [1.0, 1.0, 1.0]").contains("finite"));
        let broken = Metadata::from_props([("aeye.classes", "Road, Sky")]).unwrap().unwrap_err();
        assert!(broken.contains("aeye.classes is not JSON"), "{broken}");
    }
}
