//! A segmentation network in a file.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::ends::{self, Input};
use crate::metadata::{Layout, Metadata, ScoreKind, Written};
use crate::onnx::{self, Element, pb};
use crate::peel::peel;
use crate::single::to_single;
use crate::taps::Enlarge;
use crate::tensors;
use crate::{ClassMap, PerceptionError};

/// Where a model's metadata tells how it was trained.
pub(crate) const RECIPE_KEY: &str = "aeye.recipe";

/// An ONNX segmentation network with one image as input and logits or a class map as output, and
/// what it says about itself.
#[derive(Clone)]
pub struct Checkpoint {
    path: PathBuf,
    name: String,
    digest: blake3::Hash,
    metadata: Metadata,
    pub(crate) model: Arc<pb::ModelProto>,
    pub(crate) input: Input,
    pub(crate) enlarge: Enlarge,
    /// Order of the dimensions that scores are most likely to have.
    pub(crate) scores: Layout,
    pub(crate) score_kind: ScoreKind,
}

/// Without the weights.
impl std::fmt::Debug for Checkpoint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Checkpoint").field("path", &self.path).field("digest", &self.digest).finish_non_exhaustive()
    }
}

impl Checkpoint {
    /// Reads a model with its metadata or sidecar (see [`crate::Metadata`]), and `config.json` beside it where these name
    /// no classes.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, PerceptionError> {
        let path = path.as_ref();
        let bytes = intake::read(path, intake::most::NETWORK);
        let bytes = bytes.map_err(|source| PerceptionError::Io { path: path.into(), source })?;
        Self::new(path, &bytes, read_beside(&path.with_extension("toml"))?.as_deref(), path.parent())
    }

    /// A model at hand as bytes, with its metadata; errors call it by its name.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, PerceptionError> {
        Self::new(Path::new(name), bytes, None, None)
    }

    /// Weights may stand in files of the folder, if there is one.
    fn new(path: &Path, bytes: &[u8], sidecar: Option<&str>, folder: Option<&Path>) -> Result<Self, PerceptionError> {
        let mut model = onnx::decode(bytes).map_err(|reason| PerceptionError::NotOnnx { path: path.into(), reason })?;
        let refuse = |reason| PerceptionError::NotSegmentation { path: path.into(), reason };
        let weights_beside = tensors::gather(&mut model, folder).map_err(refuse)?;
        onnx::check(&model).map_err(refuse)?;
        ends::check(&model).map_err(refuse)?;
        let (metadata, config) = metadata_of(path, &model, sidecar, folder)?;
        ends::choose(&mut model, metadata.output.as_deref(), metadata.classes.count()).map_err(refuse)?;
        to_single(&mut model);
        let input = ends::take(&mut model, metadata.layout).map_err(refuse)?;
        if input.element == Element::Float && metadata.normalisation.is_none() {
            let reason = "mean and std are missing, which a network with a float input needs".into();
            return Err(PerceptionError::Metadata { path: path.into(), reason });
        }
        let peeled = peel(&mut model, input.layout);
        let enlarge = if metadata.align_corners { Enlarge::AlignCorners } else { Enlarge::HalfPixel };
        let (enlarge, scores) = peeled.map_or((enlarge, input.layout), |enlarge| (enlarge, Layout::Nchw));
        let score_kind = metadata.scores.unwrap_or_else(|| kind_of_scores(&model));
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        // What is made with it is filed under its name, be it a hidden one.
        intake::check_name(name.trim_start_matches('.')).map_err(refuse)?;
        let mut hasher = blake3::Hasher::new();
        hasher.update(bytes).update(sidecar.unwrap_or_default().as_bytes());
        hasher.update(config.unwrap_or_default().as_bytes());
        weights_beside.iter().for_each(|weights| _ = hasher.update(weights.as_bytes()));
        let digest = hasher.finalize();
        let model = Arc::new(model);
        Ok(Self { path: path.into(), name, digest, metadata, model, input, enlarge, scores, score_kind })
    }

    /// Where it was read, or the name of a bundled one.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Stem of the file's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// BLAKE3 over the model, its sidecar, its `config.json` if its classes are named there, and its weights in other files.
    pub fn digest(&self) -> blake3::Hash {
        self.digest
    }

    /// What it says about its input and output.
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// How it was made: the JSON text that [`crate::training::train`] wrote, if it did.
    pub fn recipe(&self) -> Option<&str> {
        self.model.metadata_props.iter().find(|p| p.key == RECIPE_KEY).map(|p| p.value.as_str())
    }

    /// What the outputs mean.
    pub fn classes(&self) -> &ClassMap {
        &self.metadata.classes
    }

    /// Width and height in pixels that the network takes, unless it takes any.
    pub fn input_size(&self) -> Option<(usize, usize)> {
        Some((self.input.width?, self.input.height?))
    }
}

/// What the scores of a model are, by the node that makes them; what only moves them is passed over.
fn kind_of_scores(model: &pb::ModelProto) -> ScoreKind {
    const MOVES: [&str; 7] = ["Identity", "Cast", "Transpose", "Reshape", "Squeeze", "Unsqueeze", "Resize"];
    let graph = model.graph.as_ref();
    let mut tensor = graph.and_then(|graph| graph.output.first()).map(|output| output.name.as_str());
    // No graph is deeper than it has nodes.
    for _ in 0..graph.map_or(0, |graph| graph.node.len()) {
        let makes = |node: &&pb::NodeProto| node.output.iter().any(|name| Some(name.as_str()) == tensor);
        let Some(node) = graph.and_then(|graph| graph.node.iter().find(makes)) else { break };
        match node.op_type.as_str() {
            "Softmax" | "Sigmoid" => return ScoreKind::Probabilities,
            moves if MOVES.contains(&moves) => tensor = node.input.first().map(String::as_str),
            _ => break,
        }
    }
    ScoreKind::Logits
}

/// The text of a file, if there is one.
fn read_beside(path: &Path) -> Result<Option<String>, PerceptionError> {
    match intake::read_text(path, intake::most::TEXT) {
        Ok(text) => Ok(Some(text)),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(PerceptionError::Io { path: path.into(), source }),
    }
}

/// The sidecar's word, or else the model's own; the names of the classes may stand in a `config.json` beside them, of
/// which the text is given if they do.
fn metadata_of(
    path: &Path,
    model: &pb::ModelProto,
    sidecar: Option<&str>,
    folder: Option<&Path>,
) -> Result<(Metadata, Option<String>), PerceptionError> {
    let beside = path.with_extension("toml");
    let props = model.metadata_props.iter().map(|p| (p.key.as_str(), p.value.as_str()));
    let (at, written) = match sidecar {
        Some(text) => (beside.as_path(), Written::from_toml(text)),
        None => (path, Written::from_props(props)),
    };
    let refuse = |at: &Path, reason| PerceptionError::Metadata { path: at.into(), reason };
    let mut written = written.map_err(|reason| refuse(at, reason))?;
    let config = match folder.filter(|_| !written.names_classes()) {
        Some(folder) => {
            read_beside(&folder.join("config.json")).map_err(|e| refuse(path, format!("no class names, and {e}")))?
        }
        None => None,
    };
    let config = match config {
        Some(text) if written.take_labels(&text).map_err(|reason| refuse(path, reason))? => Some(text),
        _ => None,
    };
    if sidecar.is_none() && !written.names_classes() {
        let beside = beside.file_name().unwrap_or_default().to_string_lossy();
        let reason = format!("no class names: expected aeye.classes in the model's metadata, or {beside} beside it");
        return Err(refuse(path, reason));
    }
    written.checked().map(|metadata| (metadata, config)).map_err(|reason| refuse(at, reason))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toy::{self, Tail, Toy};

    fn said(path: &Path) -> String {
        let text = Checkpoint::load(path).unwrap_err().to_string();
        assert!(text.contains(&path.file_stem().unwrap().to_string_lossy().into_owned()), "{text}");
        assert!(!text.contains('\n'), "{text}");
        text
    }

    #[test]
    fn a_model_tells_about_itself() {
        let dir = tempfile::tempdir().unwrap();
        let path = Toy { size: Some((32, 48)), ..Toy::default() }.write(dir.path());
        let checkpoint = Checkpoint::load(&path).unwrap();
        assert_eq!(checkpoint.name(), "toy");
        assert_eq!(checkpoint.input_size(), Some((48, 32)));
        assert_eq!(checkpoint.classes().names(), toy::CLASSES);
        assert_eq!(checkpoint.metadata(), &toy::metadata());
        assert_eq!(checkpoint.digest(), blake3::hash(&std::fs::read(&path).unwrap()));
    }

    #[test]
    fn a_softmax_at_the_end_gives_probabilities() {
        let dir = tempfile::tempdir().unwrap();
        let open = |ending: &[&str], scores: Option<ScoreKind>| {
            let metadata = Some(Metadata { scores, ..toy::metadata() });
            let mut model = Toy { stride: 1, metadata, ..Toy::default() }.model();
            let graph = model.graph.as_mut().unwrap();
            for op in ending {
                let last = graph.output[0].name.clone();
                graph.node.push(toy::node(op, &[&last], op, vec![]));
                graph.output[0].name = (*op).into();
            }
            Checkpoint::load(toy::write(dir.path(), "toy.onnx", &model)).unwrap()
        };
        let kind = |ending: &[&str]| open(ending, None).score_kind;
        assert_eq!([kind(&[]), kind(&["Identity"])], [ScoreKind::Logits; 2]);
        assert_eq!([kind(&["Sigmoid"]), kind(&["Sigmoid", "Identity"])], [ScoreKind::Probabilities; 2]);
        assert_eq!(kind(&["Sigmoid", "Tanh"]), ScoreKind::Logits);
        assert_eq!(
            open(&["Sigmoid"], Some(ScoreKind::Logits)).score_kind,
            ScoreKind::Logits,
            "what is said goes first"
        );
    }

    #[test]
    fn a_sidecar_goes_before_the_metadata_and_changes_the_digest() {
        let dir = tempfile::tempdir().unwrap();
        let path = Toy { metadata: None, ..Toy::default() }.write(dir.path());
        assert!(said(&path).contains("no class names"));
        let sidecar = "classes = [\"rider\", \"Bus\", \"road line\"]\nmean = [0.0, 0.0, 0.0]\nstd = [1.0, 1.0, 1.0]";
        std::fs::write(dir.path().join("toy.toml"), sidecar).unwrap();
        let checkpoint = Checkpoint::load(&path).unwrap();
        assert_eq!(checkpoint.classes().tags(), [4, 10, 6]);
        assert_ne!(checkpoint.digest(), blake3::hash(&std::fs::read(&path).unwrap()));
    }

    #[test]
    fn other_files_are_refused_in_one_sentence() {
        let dir = tempfile::tempdir().unwrap();
        assert!(said(&dir.path().join("absent.onnx")).contains("No such file"));
        let noise = dir.path().join("noise.onnx");
        std::fs::write(&noise, (0..999u32).map(|i| (i * i % 251) as u8).collect::<Vec<_>>()).unwrap();
        assert!(said(&noise).contains("not an ONNX model"));
        std::fs::write(&noise, []).unwrap();
        assert!(said(&noise).contains("not an ONNX model"));
        let classifier = toy::write(dir.path(), "classifier.onnx", &toy::classifier());
        assert!(said(&classifier).contains("shape 1x3, expected scores"), "{}", said(&classifier));
    }

    #[test]
    fn contradictions_are_refused_in_one_sentence() {
        let dir = tempfile::tempdir().unwrap();
        let two = Metadata { classes: ClassMap::from_names(&["Road", "Sky"]).unwrap(), ..toy::metadata() };
        let path = Toy { metadata: Some(two), ..Toy::default() }.write(dir.path());
        assert!(said(&path).contains("names 2 classes"), "{}", said(&path));
        let bytes = Metadata { normalisation: None, ..toy::metadata() };
        let path = Toy { metadata: Some(bytes), ..Toy::default() }.write(dir.path());
        assert!(said(&path).contains("mean and std are missing"), "{}", said(&path));
        let mut model = Toy::default().model();
        model.metadata_props[1].value = "[\"Zebra\"]".into();
        let path = toy::write(dir.path(), "zebra.onnx", &model);
        assert!(said(&path).contains("Zebra"), "{}", said(&path));
    }

    #[test]
    fn upsampling_and_argmax_are_taken_out_of_the_graph() {
        let ops = |toy: Toy| {
            let dir = tempfile::tempdir().unwrap();
            let model = Checkpoint::load(toy.write(dir.path())).unwrap().model;
            model.graph.as_ref().unwrap().node.iter().map(|n| n.op_type.clone()).collect::<Vec<_>>()
        };
        assert_eq!(ops(Toy { tail: Tail::Argmax, ..Toy::default() }), ["Conv"]);
        assert_eq!(ops(Toy { tail: Tail::Upsample, ..Toy::default() }), ["Conv"]);
        assert_eq!(ops(Toy { tail: Tail::CoarseArgmax, ..Toy::default() }), ["Conv", "ArgMax"]);
    }
}
