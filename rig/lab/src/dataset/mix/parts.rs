//! The datasets that a mix is made from.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::bail;

use crate::dataset::manifest::{Manifest, read_frames};
use crate::dataset::provenance::FrameLine;
use crate::dataset::recipe::Recipe;

/// A complete dataset on disk.
pub struct Dataset {
    /// Where it is.
    pub folder: PathBuf,
    /// What it is made from.
    pub manifest: Manifest,
    /// Its frames.
    pub frames: Vec<FrameLine>,
}

impl Dataset {
    /// Reads what it says of itself; its pictures stay where they are.
    pub fn read(folder: &Path) -> anyhow::Result<Self> {
        let manifest = Manifest::read(folder)?;
        let frames = read_frames(folder, &manifest)?;
        Ok(Self { folder: folder.to_owned(), manifest, frames })
    }

    /// Its frames to learn from.
    pub fn training(&self) -> impl Iterator<Item = &FrameLine> {
        self.frames.iter().filter(|line| line.split == "train")
    }

    /// Refuses what is no dataset of corner cases, or what is one.
    pub fn check_kind(&self, of_cases: bool) -> anyhow::Result<()> {
        if matches!(self.manifest.recipe, Recipe::Cases(_)) == of_cases {
            return Ok(());
        }
        let expected = if of_cases { "a dataset of corner cases" } else { "natural frames, not corner cases" };
        bail!("{}: expected {expected}", self.folder.display())
    }

    /// Refuses to take more training frames than there are.
    pub fn check_holds(&self, wanted: u32) -> anyhow::Result<()> {
        let there = self.manifest.train_frames;
        if there < wanted {
            bail!("{}: holds {there} training frames; expected at least {wanted}", self.folder.display());
        }
        Ok(())
    }

    /// Refuses what a network could tell from the natural set by other things than what is to be seen,
    /// and what is in that set already.
    pub fn check_is_like(&self, natural: &Self) -> anyhow::Result<()> {
        let (this, that) = (&self.manifest, &natural.manifest);
        let size = |manifest: &Manifest| {
            let (width, height) = manifest.recipe.size();
            format!("{width}x{height}")
        };
        let imaging = |manifest: &Manifest| manifest.recipe.imaging().to_string();
        let alike = [
            ("pictures of", size(this), size(that)),
            ("pictures of the quality", imaging(this), imaging(that)),
            ("pictures drawn by", this.adapter.clone(), that.adapter.clone()),
            ("pictures drawn by renderer", this.renderer.clone(), that.renderer.clone()),
            ("the classes", this.classes.join(" "), that.classes.join(" ")),
        ];
        let (place, other) = (self.folder.display(), natural.folder.display());
        if let Some((what, got, expected)) = alike.into_iter().find(|(_, got, expected)| got != expected) {
            bail!("{place}: holds {what} {got}; expected {expected}, as {other} has");
        }
        if this.recipe.cameras() != that.recipe.cameras() {
            bail!("{place}: holds pictures of other cameras than {other}; expected the same file after --cameras");
        }
        let drives: BTreeSet<&str> = natural.frames.iter().map(|line| &*line.recording).collect();
        if let Some(line) = self.training().find(|line| drives.contains(&*line.recording)) {
            bail!("{place}: {} is of a drive that {other} shows too; expected drives of another seed", line.image);
        }
        Ok(())
    }
}
