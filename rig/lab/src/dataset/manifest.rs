//! `dataset.json`: what a dataset is made from, and what came of it.

use std::path::Path;

use anyhow::{Context, anyhow, bail};
use base::files::{self, most};
use base::json::{self, Typed};
use base::output;
use base::words::count;
use perception::classes::TRAIN_CLASSES;

use serde::{Deserialize, Serialize};

use super::provenance::{self, FrameLine};
use super::recipe::Recipe;

const MANIFEST: &str = "dataset.json";
/// What a natural dataset holds besides until it is finished: its scenes so far.
pub(super) const PARTS: &str = "parts";
const FRAMES: &str = "frames.jsonl";

/// The content of `dataset.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// What it is made from.
    #[serde(flatten)]
    pub recipe: Recipe,
    /// Version of the kernel that simulated it.
    pub kernel: String,
    /// Version of the renderer that drew it.
    pub renderer: String,
    /// The graphics adapter and driver that drew it; colours depend on them, and labels at the edges of triangles.
    pub adapter: String,
    /// Frames to learn from.
    pub train_frames: u32,
    /// Frames to measure on while learning.
    pub val_frames: u32,
    /// Frames to measure on at the end.
    pub test_frames: u32,
    /// Mean number of pedestrian pixels in a training frame; none without training frames.
    pub pedestrian_pixels: Option<f64>,
    /// Names of the train ids, in order.
    pub classes: Vec<String>,
    /// BLAKE3 over the frames' `labels_digest`, in order.
    pub labels_digest: String,
    /// BLAKE3 over `frames.jsonl`.
    pub digest: String,
}

/// `dataset.json`, and what `aeye dataset natural` and `aeye dataset cases` print.
impl Typed for Manifest {
    const TYPE: &'static str = "aeye.dataset";
}

impl Manifest {
    /// Reads that of a dataset folder.
    pub fn read(folder: &Path) -> anyhow::Result<Self> {
        Self::read_file(&folder.join(MANIFEST))
    }

    /// Reads one wherever it lies.
    pub fn read_file(path: &Path) -> anyhow::Result<Self> {
        let text = files::read_text(path, most::TABLE)?;
        let place = || format!("{}: does not describe a dataset", path.display());
        let manifest: Self = json::read_json(&text).with_context(place)?;
        manifest.recipe.check().map_err(|reason| anyhow!("{}: {reason}", path.display()))?;
        Ok(manifest)
    }

    /// That of a folder which holds a complete dataset of this recipe already; `None` when the dataset
    /// has yet to be made or completed.
    pub fn of_finished(folder: &Path, recipe: &Recipe) -> anyhow::Result<Option<Self>> {
        if !folder.join(MANIFEST).exists() {
            return Ok(None);
        }
        let manifest = Self::read(folder)?;
        if manifest.recipe != *recipe {
            let place = folder.display();
            bail!("{place}: holds a complete dataset of another recipe; expected a new folder, or the same recipe");
        }
        let made_by = |kernel: &str, renderer: &str| format!("kernel {kernel} and renderer {renderer}");
        let (then, now) =
            (made_by(&manifest.kernel, &manifest.renderer), made_by(&kernel::identity(), &render::identity()));
        if then != now {
            bail!("{}: holds this dataset as made by {then}; expected a new folder for {now}", folder.display());
        }
        Ok(Some(manifest))
    }

    /// What a command says of it.
    pub fn sentence(&self, folder: &Path) -> String {
        let splits = [(self.train_frames, "training"), (self.val_frames, "validation"), (self.test_frames, "test")];
        let counts = splits.iter().filter(|(n, _)| *n > 0).map(|(n, name)| count(*n, &format!("{name} frame")));
        let counts = counts.collect::<Vec<_>>().join(", ");
        format!("{}: {counts}, digest {}", folder.display(), self.digest)
    }

    /// Completes a dataset whose pictures are there: writes the frames' lines, and itself last.
    pub(super) fn complete(
        folder: &Path,
        recipe: Recipe,
        adapter: String,
        frames: &[FrameLine],
    ) -> anyhow::Result<Self> {
        let lines = provenance::text(frames)?;
        let manifest = Self::new(recipe, adapter, frames, &lines);
        output::write_file(&folder.join(FRAMES), lines.as_bytes())?;
        output::write_file(&folder.join(MANIFEST), json::json_file(&manifest)?.as_bytes())?;
        Ok(manifest)
    }

    fn new(recipe: Recipe, adapter: String, frames: &[FrameLine], lines: &str) -> Self {
        let count = |split: &str| frames.iter().filter(|f| f.split == split).count() as u32;
        let pedestrians = frames.iter().filter(|f| f.split == "train").map(FrameLine::pedestrian_pixels).sum::<u64>();
        let train_frames = count("train");
        let mut labels = blake3::Hasher::new();
        frames.iter().for_each(|frame| {
            labels.update(frame.labels_digest.as_bytes());
        });
        Self {
            recipe,
            kernel: kernel::identity(),
            renderer: render::identity(),
            adapter,
            train_frames,
            val_frames: count("val"),
            test_frames: count("test"),
            pedestrian_pixels: (train_frames > 0).then(|| pedestrians as f64 / f64::from(train_frames)),
            classes: TRAIN_CLASSES.iter().map(|c| c.name.to_owned()).collect(),
            labels_digest: labels.finalize().to_hex().to_string(),
            digest: blake3::hash(lines.as_bytes()).to_hex().to_string(),
        }
    }
}

/// The frames' lines of a complete dataset, once it is certain that they are those of its manifest.
pub(super) fn read_frames(folder: &Path, manifest: &Manifest) -> anyhow::Result<Vec<FrameLine>> {
    let path = folder.join(FRAMES);
    let text = files::read_text(&path, most::TABLE)?;
    if blake3::hash(text.as_bytes()).to_hex().to_string() != manifest.digest {
        bail!("{}: was changed since; expected the digest that {MANIFEST} tells", path.display());
    }
    provenance::parse(&text).with_context(|| path.display().to_string())
}

/// Refuses a dataset that is not finished.
pub fn check_whole(dataset: &Path) -> anyhow::Result<()> {
    if dataset.join(PARTS).is_dir() && !dataset.join(MANIFEST).is_file() {
        bail!("{}: is unfinished; expected the command that began it to complete it first", dataset.display());
    }
    Ok(())
}
