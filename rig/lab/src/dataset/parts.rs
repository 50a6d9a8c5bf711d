//! The scenes of a dataset that is not finished: a file of frames' lines for each, written when its pictures are there.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::files::{self, most};
use base::output;
use perception::cityscapes::Kind;
use serde::{Deserialize, Serialize};

use super::manifest::PARTS;
use super::provenance::{self, FrameLine};
use super::recipe::NaturalRecipe;
use crate::store::remove_folder;

const BEGUN: &str = "begun.json";
/// Characters of the digest by which scenes of one beginning are known.
const STAMP: usize = 16;

/// What an unfinished dataset was begun with.
#[derive(PartialEq, Serialize, Deserialize)]
struct Begun {
    recipe: NaturalRecipe,
    kernel: String,
    renderer: String,
    adapter: String,
}

/// The folder of finished scenes, all of them of one beginning.
pub(super) struct Parts {
    folder: PathBuf,
    stamp: String,
}

impl Parts {
    /// That of a dataset, once it is certain that all scenes in it belong to this recipe.
    pub(super) fn open(out: &Path, recipe: &NaturalRecipe, adapter: &str) -> anyhow::Result<Self> {
        let folder = out.join(PARTS);
        let file = folder.join(BEGUN);
        let is_foreign = !file.exists() && fs::read_dir(out).is_ok_and(|mut entries| entries.next().is_some());
        if is_foreign && !only_parts(out) {
            bail!("{}: holds something else; expected a new or an empty folder, or this dataset", out.display());
        }
        output::create_folder(&folder)?;
        let now = Begun {
            recipe: recipe.clone(),
            kernel: kernel::identity(),
            renderer: render::identity(),
            adapter: adapter.to_owned(),
        };
        let text = serde_json::to_string_pretty(&now)?;
        if !file.exists() {
            output::write_file(&file, text.as_bytes())?;
        }
        now.check(out, &file)?;
        let stamp = blake3::hash(text.as_bytes()).to_hex()[..STAMP].to_owned();
        let parts = Self { folder, stamp };
        parts.check(out)?;
        Ok(parts)
    }

    /// Refuses scenes that were copied here from another beginning.
    fn check(&self, out: &Path) -> anyhow::Result<()> {
        let ending = self.ending();
        for entry in fs::read_dir(&self.folder).with_context(|| self.folder.display().to_string())? {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if !name.starts_with('.') && name != BEGUN && !name.ends_with(&ending) {
                bail!(
                    "{}: {PARTS}/{name} is a scene of another dataset, program or graphics adapter; expected scenes of \
                     one alone",
                    out.display()
                );
            }
        }
        Ok(())
    }

    fn ending(&self) -> String {
        format!("-{}.jsonl", self.stamp)
    }

    fn path(&self, split: &str, number: u32) -> PathBuf {
        self.folder.join(format!("{split}_{number:06}{}", self.ending()))
    }

    /// The frames of a scene that is there with all its pictures.
    pub(super) fn find(&self, out: &Path, split: &str, number: u32) -> anyhow::Result<Option<Vec<FrameLine>>> {
        let path = self.path(split, number);
        if !path.is_file() {
            return Ok(None);
        }
        let lines = provenance::parse(&files::read_text(&path, most::TABLE)?);
        let lines = lines.with_context(|| path.display().to_string())?;
        let is_there = |line: &FrameLine| Kind::ALL.iter().all(|kind| out.join(line.place().path(*kind)).is_file());
        Ok(lines.iter().all(is_there).then_some(lines))
    }

    /// Keeps the frames of a scene whose pictures are in their place.
    pub(super) fn keep(&self, split: &str, number: u32, lines: &[FrameLine]) -> anyhow::Result<()> {
        output::write_file(&self.path(split, number), provenance::text(lines)?.as_bytes())
    }

    /// Removes them all, of a dataset that is complete.
    pub(super) fn remove(self) -> anyhow::Result<()> {
        remove_folder(&self.folder)
    }
}

impl Begun {
    /// Refuses a dataset that was begun with anything else.
    fn check(&self, out: &Path, file: &Path) -> anyhow::Result<()> {
        let begun: Self =
            serde_json::from_str(&files::read_text(file, most::TABLE)?).with_context(|| file.display().to_string())?;
        if begun.recipe != self.recipe {
            bail!("{}: was begun with other arguments; expected the same to complete it", out.display());
        }
        if begun != *self {
            let Self { adapter: first, kernel, renderer, .. } = begun;
            bail!(
                "{}: was begun with kernel {kernel} and renderer {renderer} on {first}; expected the same to complete it, \
                 not {}, {} and {}",
                out.display(),
                self.kernel,
                self.renderer,
                self.adapter
            );
        }
        Ok(())
    }
}

/// Whether a folder holds nothing but `parts` in which there is nothing with a name, as a kill at the very begin
/// leaves it.
fn only_parts(out: &Path) -> bool {
    let names = |path: &Path| fs::read_dir(path).map(|entries| entries.flatten().map(|e| e.file_name()).collect());
    let inside: Vec<_> = names(out).unwrap_or_default();
    let is_hidden = |name: &OsString| name.to_string_lossy().starts_with('.');
    inside == [PARTS] && names(&out.join(PARTS)).is_ok_and(|inside: Vec<_>| inside.iter().all(is_hidden))
}
