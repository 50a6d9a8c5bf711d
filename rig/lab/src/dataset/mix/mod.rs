//! The paper's three training sets of equal size (section 5): the natural one, one that is enriched
//! with pedestrians, and one that is enriched with corner cases.
//!
//! The same training frames leave the natural set for both of the others, drawn by the seed. For the
//! third as many frames of corner cases take their place; for the second, frames of a pool of drives
//! among more people, which together show as many pedestrian pixels. Validation and test frames are
//! the natural ones in all three. Files are hard links where the file system has them, else copies.

mod choice;
mod files;
mod parts;

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;
use std::path::PathBuf;

use anyhow::bail;
use base::failure::Usage;
use base::json::Typed;
use base::output::{self, PendingFolder};
use base::progress::Interrupt;
use serde::Serialize;

use super::manifest::Manifest;
use super::provenance::{FrameLine, Part};
use super::recipe::{MixRecipe, Recipe, Replacement};
pub(super) use parts::Dataset;

/// The three training sets, each below its name in the folder that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Sets {
    /// Training frames that differ between the first set and each of the others.
    pub replaced: u32,
    /// `natural`: as it was given.
    pub natural: Manifest,
    /// `pedestrian`.
    pub pedestrian: Manifest,
    /// `corner-case`.
    pub corner_case: Manifest,
}

/// What `aeye dataset mix` prints.
impl Typed for Sets {
    const TYPE: &'static str = "aeye.dataset.mix";
}

impl Sets {
    /// Name and manifest of each.
    pub fn named(&self) -> [(&'static str, &Manifest); 3] {
        [("natural", &self.natural), ("pedestrian", &self.pedestrian), ("corner-case", &self.corner_case)]
    }
}

/// A table with the column of the paper's Table 1.
impl fmt::Display for Sets {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<12} {:>8} {:>8} {:>24}", "set", "frames", "replaced", "pedestrian pixels/frame")?;
        for (name, set) in self.named() {
            let replaced = if name == "natural" { 0 } else { self.replaced };
            let pixels = set.pedestrian_pixels.unwrap_or_default();
            write!(f, "\n{name:<12} {:>8} {replaced:>8} {pixels:>24.1}", set.train_frames)?;
        }
        Ok(())
    }
}

/// What is mixed.
#[derive(Clone, Debug)]
pub struct Options {
    /// Dataset whose training frames are replaced; its other splits are in all three sets.
    pub natural: PathBuf,
    /// Dataset of drives among more people (`dataset natural --pedestrians N` with another seed).
    pub pool: PathBuf,
    /// Dataset of corner cases.
    pub cases: PathBuf,
    /// Training frames replaced (paper: 1500; default: as many as the corner cases have).
    pub replace: Option<u32>,
    /// Seed of which frames are replaced, and by which.
    pub seed: u64,
    /// Folder of the datasets `natural`, `pedestrian` and `corner-case`; must not exist, be empty, or
    /// hold them already.
    pub out: PathBuf,
}

/// Makes the three sets; those that are complete stay as they are.
pub fn make(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Sets> {
    let natural = Dataset::read(&args.natural)?;
    let (pool, cases) = (Dataset::read(&args.pool)?, Dataset::read(&args.cases)?);
    natural.check_kind(false)?;
    pool.check_kind(false)?;
    cases.check_kind(true)?;
    let replace = args.replace.unwrap_or(cases.manifest.train_frames);
    let recipe = |by| MixRecipe { seed: args.seed, replace, natural: natural.manifest.recipe.clone(), by };
    let corner_case = recipe(Replacement::CornerCase { cases: cases.manifest.recipe.clone() });
    corner_case.check(&natural, &cases)?;
    let pixels = corner_case.entering(&cases).iter().map(|line| line.pedestrian_pixels()).sum();
    let pedestrian = recipe(Replacement::Pedestrian { pool: pool.manifest.recipe.clone(), pixels });
    pedestrian.check(&natural, &pool)?;
    if let Some(finished) = finished(&args.out, &natural, &pedestrian, &corner_case)? {
        return Ok(finished);
    }
    for part in [&args.natural, &args.pool, &args.cases] {
        output::check_outside(&args.out, part)?;
    }
    let pending = PendingFolder::new(&args.out)?;
    let folder = |name| pending.path().join(name);
    files::copy(&natural, &folder("natural"), interrupt)?;
    let sets = Sets {
        replaced: replace,
        natural: natural.manifest.clone(),
        pedestrian: pedestrian.assemble(&natural, &pool, &folder("pedestrian"), interrupt)?,
        corner_case: corner_case.assemble(&natural, &cases, &folder("corner-case"), interrupt)?,
    };
    pending.finish()?;
    Ok(sets)
}

/// The sets that a folder holds already.
fn finished(
    out: &Path,
    natural: &Dataset,
    pedestrian: &MixRecipe,
    corner_case: &MixRecipe,
) -> anyhow::Result<Option<Sets>> {
    let of = |name: &str, recipe: Recipe| Manifest::of_finished(&out.join(name), &recipe);
    let part = natural;
    let natural = of("natural", part.manifest.recipe.clone())?;
    if natural.as_ref().is_some_and(|set| set.digest != part.manifest.digest) {
        bail!("{}: holds a mix of other pictures; expected a new folder", out.display());
    }
    let replaced = pedestrian.replace;
    let found = (natural, of("pedestrian", pedestrian.clone().into())?, of("corner-case", corner_case.clone().into())?);
    let (Some(natural), Some(pedestrian), Some(corner_case)) = found else { return Ok(None) };
    Ok(Some(Sets { replaced, natural, pedestrian, corner_case }))
}

impl From<MixRecipe> for Recipe {
    fn from(recipe: MixRecipe) -> Self {
        Self::Mix(Box::new(recipe))
    }
}

impl MixRecipe {
    /// Refuses datasets that cannot be mixed.
    fn check(&self, natural: &Dataset, source: &Dataset) -> anyhow::Result<()> {
        if self.replace == 0 {
            return Err(Usage("--replace 0: expected at least one frame".into()).into());
        }
        natural.check_holds(self.replace)?;
        source.check_holds(self.replace)?;
        source.check_is_like(natural)
    }

    /// The frames that take the place of others.
    fn entering<'a>(&self, source: &'a Dataset) -> Vec<&'a FrameLine> {
        let drawn = choice::shuffled(source.training(), self.seed);
        let wanted = self.replace as usize;
        match self.by {
            Replacement::CornerCase { .. } => drawn[..wanted].to_vec(),
            Replacement::Pedestrian { pixels, .. } => {
                let shown: Vec<u64> = drawn.iter().map(|line| line.pedestrian_pixels()).collect();
                choice::matching(&shown, wanted, pixels).into_iter().map(|i| drawn[i]).collect()
            }
        }
    }

    /// Writes the set into a new folder.
    pub(super) fn assemble(
        &self,
        natural: &Dataset,
        source: &Dataset,
        folder: &Path,
        interrupt: &Interrupt,
    ) -> anyhow::Result<Manifest> {
        let leaving: BTreeSet<&str> = choice::shuffled(natural.training(), self.seed)[..self.replace as usize]
            .iter()
            .map(|l| &*l.image)
            .collect();
        let staying = natural.frames.iter().filter(|line| !leaving.contains(&*line.image));
        let mut entering = self.entering(source);
        entering.sort_by(|a, b| a.image.cmp(&b.image));
        let entering = entering.into_iter().map(|line| (source, line, self.by.part()));
        let frames = staying.map(|line| (natural, line, Part::Natural)).chain(entering);
        let lines = files::link(&frames.collect::<Vec<_>>(), folder, interrupt)?;
        Manifest::complete(folder, self.clone().into(), natural.manifest.adapter.clone(), &lines)
    }
}
