//! What a checkpoint says about its input and output.
//!
//! It stands in the ONNX model's `metadata_props`, or in a TOML file beside it (`NAME.toml` for
//! `NAME.onnx`, which goes first) with the same keys without their prefix:
//!
//! | key | value | default |
//! |---|---|---|
//! | `aeye.classes` | JSON list of class names in the order of the outputs, or the name of a scheme as a JSON string (see [`ClassMap::named`]) | `aeye.id2label` |
//! | `aeye.id2label` | JSON object of a name for every id, as in the `config.json` of Hugging Face's networks (see [`ClassMap::from_labels`]) | that of a `config.json` in the network's folder |
//! | `aeye.output` | JSON string: the output that gives the scores or the class map | the one that can |
//! | `aeye.channels` | JSON string `"rgb"` or `"bgr"`: the order in which the input has the colours | `"rgb"` |
//! | `aeye.mean`, `aeye.std` | JSON list of three numbers for red, green, blue, whatever the order of the channels; the input is `(byte / 255 - mean) / std` | required for a float input |
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
const KEYS: [&str; 9] =
    ["classes", "id2label", "output", "channels", "mean", "std", "layout", "scores", "align_corners"];

/// Order of the dimensions of the network's input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    /// Batch, channel, row, column.
    Nchw,
    /// Batch, row, column, channel.
    Nhwc,
}

/// Order of the colours in the network's input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Channels {
    /// Red, green, blue.
    #[default]
    Rgb,
    /// Blue, green, red.
    Bgr,
}

impl Channels {
    /// Which of red, green and blue each channel is.
    pub(crate) fn order(self) -> [usize; 3] {
        match self {
            Self::Rgb => [0, 1, 2],
            Self::Bgr => [2, 1, 0],
        }
    }
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
    /// Name of the output that is looked at, where several could be.
    pub output: Option<String>,
    /// Order of the colours in the input.
    pub channels: Channels,
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
#[derive(Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Written {
    classes: Option<Classes>,
    id2label: Option<BTreeMap<String, String>>,
    output: Option<String>,
    channels: Option<Channels>,
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

/// What is read of a `config.json`.
#[derive(Deserialize)]
struct Config {
    id2label: Option<BTreeMap<String, String>>,
}

impl Written {
    /// From pairs of the ONNX model's `metadata_props`. The error, as of the others, is a sentence without the file's
    /// name.
    pub fn from_props<'a>(props: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Self, String> {
        let mut object = serde_json::Map::new();
        for (key, text) in props {
            let Some(key) = key.strip_prefix(PREFIX).filter(|key| KEYS.contains(key)) else { continue };
            let value = serde_json::from_str(text).map_err(|e| format!("metadata {PREFIX}{key} is not JSON: {e}"))?;
            object.insert(key.to_owned(), value);
        }
        serde_json::from_value(object.into()).map_err(|e| format!("metadata {PREFIX}*: {e}"))
    }

    /// From the text of a sidecar.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1);
            format!("line {line}: {}", e.message().replace('\n', ", "))
        })
    }

    /// Whether the classes are named.
    pub fn names_classes(&self) -> bool {
        self.classes.is_some() || self.id2label.is_some()
    }

    /// Takes the names of the classes from the text of a `config.json`, if it has any; tells whether it did.
    pub fn take_labels(&mut self, config: &str) -> Result<bool, String> {
        let config: Config = serde_json::from_str(config).map_err(|e| {
            let reason: String = e.to_string().chars().take(200).collect();
            format!("no class names, and config.json beside it has none: {reason}")
        })?;
        self.id2label = config.id2label;
        Ok(self.id2label.is_some())
    }

    /// What it says, if that makes sense.
    pub fn checked(self) -> Result<Metadata, String> {
        let refuse = |e: PerceptionError| format!("key classes: {e}");
        let classes = match (&self.classes, &self.id2label) {
            (Some(_), Some(_)) => return Err("keys classes and id2label: expected one of them".into()),
            (Some(Classes::Scheme(name)), None) => ClassMap::named(name).map_err(refuse)?,
            (Some(Classes::Names(names)), None) => ClassMap::from_names(names).map_err(refuse)?,
            (None, Some(labels)) => of_labels(labels)?,
            (None, None) => return Err("key classes (or id2label) is missing, which names the classes".into()),
        };
        Ok(Metadata {
            classes,
            output: self.output,
            channels: self.channels.unwrap_or_default(),
            normalisation: normalisation(self.mean, self.std)?,
            layout: self.layout,
            scores: self.scores,
            align_corners: self.align_corners,
        })
    }
}

/// The classes of a table of ids and names.
fn of_labels(labels: &BTreeMap<String, String>) -> Result<ClassMap, String> {
    let mut names = vec![None; labels.len()];
    for (id, name) in labels {
        let place = id.parse().ok().and_then(|id: usize| names.get_mut(id)).filter(|place| place.is_none());
        let short: String = id.chars().take(20).collect();
        *place.ok_or_else(|| format!("key id2label: expected the ids 0 to {}, got {short:?}", labels.len() - 1))? =
            Some(name.as_str());
    }
    let names: Vec<&str> = names.into_iter().flatten().collect();
    ClassMap::from_labels(&names).map_err(|e| format!("key id2label: {e}"))
}

impl Metadata {
    /// From the text of a sidecar that names the classes. The error is a sentence without the file's name.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        Written::from_toml(text)?.checked()
    }

    /// As pairs for the ONNX model's `metadata_props`.
    pub fn to_props(&self) -> BTreeMap<String, String> {
        let written = Written {
            classes: Some(Classes::Names(self.classes.names().to_vec())),
            id2label: None,
            output: self.output.clone(),
            channels: Some(self.channels).filter(|channels| *channels != Channels::default()),
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
            output: Some("scores".into()),
            channels: Channels::Bgr,
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
        assert_eq!(Written::from_props(pairs).and_then(Written::checked), Ok(example()));
        assert!(!Written::from_props([("producer", "someone")]).unwrap().names_classes());
    }

    #[test]
    fn sidecar_speaks_the_same_keys() {
        let text = "classes = \"aeye\"\noutput = \"scores\"\nchannels = \"bgr\"\nmean = [0.5, 0.25, 0.125]\nstd = [0.2, 0.3, 0.4]\nlayout = \"nchw\"\nscores = \"probabilities\"\n";
        assert_eq!(Metadata::from_toml(text), Ok(example()));
    }

    #[test]
    fn a_table_of_ids_names_the_classes() {
        let classes = |text: &str| Metadata::from_toml(text).map(|metadata| metadata.classes.tags().to_vec());
        let in_order = |text: &str| format!("[id2label]\n{text}");
        assert_eq!(classes(&in_order("0 = \"road\"\n1 = \"car\"")), Ok(vec![7, 10]));
        let many: String = (0..12).map(|id| format!("{id} = \"{}\"\n", ["tree", "ceiling"][id % 2])).collect();
        assert_eq!(classes(&in_order(&many)), Ok([9, 3].repeat(6)), "10 comes after 9");
        for odd in
            ["1 = \"road\"", "0 = \"road\"\n00 = \"car\"", "0 = \"road\"\n-1 = \"car\"", "0 = \"road\"\nx = \"car\""]
        {
            assert!(classes(&in_order(odd)).unwrap_err().contains("key id2label: expected the ids 0 to"), "{odd}");
        }
        assert!(classes(&in_order("")).unwrap_err().contains("0 classes"));
        let both = "classes = \"aeye\"\n[id2label]\n0 = \"road\"";
        assert!(classes(both).unwrap_err().contains("expected one of them"));
        let props = [("aeye.id2label", "{\"0\": \"road\", \"1\": \"car\"}")];
        assert_eq!(Written::from_props(props).and_then(Written::checked).unwrap().classes.tags(), [7, 10]);
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
        assert!(said("classes = \"aeye\"\nchannels = \"grey\"").starts_with("line 2: unknown variant `grey`"));
        let broken = Written::from_props([("aeye.classes", "Road, Sky")]).err().unwrap();
        assert!(broken.contains("aeye.classes is not JSON"), "{broken}");
    }
}
