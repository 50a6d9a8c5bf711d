//! Makes a dataset again from its recipe, so that it travels as kilobytes.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::json::Typed;
use base::maps::Map;
use base::output::PendingFolder;
use base::progress::Interrupt;
use base::say::say;
use drivers::vision;

use serde::Serialize;

use super::cases;
use super::manifest::Manifest;
use super::mix::Dataset;
use super::natural;
use super::recipe::{CaseUsed, MapUsed, MixRecipe, Recipe};

/// A dataset made again, and what it has in common with the first one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rebuilt {
    /// The new one.
    #[serde(flatten)]
    pub manifest: Manifest,
    /// Why its pictures may differ: another adapter or version.
    pub made_otherwise: Option<String>,
    /// Whether every picture and every line is the same.
    pub same: bool,
    /// Whether all label and instance ids are.
    pub same_labels: bool,
}

/// What `aeye dataset rebuild` prints.
impl Typed for Rebuilt {
    const TYPE: &'static str = "aeye.dataset.rebuild";
}

impl Rebuilt {
    /// Not where labels differ, nor where anything differs although the same adapter and versions made both.
    /// On another adapter labels may differ at the edges of triangles: that is no damage, but is said.
    pub fn is_as_promised(&self) -> bool {
        self.same || self.made_otherwise.is_some() && self.same_labels
    }

    /// What it is, in a folder.
    pub fn sentence(&self, out: &Path) -> String {
        let what = match (self.same, self.same_labels) {
            (true, _) => "the same as the first",
            (false, true) => "other pictures than the first, the same labels",
            (false, false) => "other labels than the first",
        };
        format!("{}: {what}", self.manifest.sentence(out))
    }
}

/// What is made again, and from what.
#[derive(Clone, Debug)]
pub struct Options {
    /// `dataset.json` of a dataset, or its folder.
    pub recipe: PathBuf,
    /// Corner cases that the recipe asks for, or folders of them; they are found by their digests.
    pub cases: Vec<PathBuf>,
    /// OpenDRIVE files of maps that are not bundled.
    pub maps: Vec<String>,
    /// Scenes simulated, or cases drawn, at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the dataset; one that was interrupted is completed.
    pub out: PathBuf,
}

/// Makes a dataset again, or completes one that was interrupted.
pub fn make(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Rebuilt> {
    let first = if args.recipe.is_dir() { Manifest::read(&args.recipe) } else { Manifest::read_file(&args.recipe) }?;
    let made_otherwise = difference(&first)?;
    if let Some(difference) = &made_otherwise {
        say(format_args!("{}: {difference}; colours may differ", args.recipe.display()));
    }
    let sources = Sources::find(args)?;
    let manifest = sources.build(&first.recipe, &args.out, interrupt)?;
    let (same, same_labels) = (manifest.digest == first.digest, manifest.labels_digest == first.labels_digest);
    Ok(Rebuilt { manifest, made_otherwise, same, same_labels })
}

/// What draws now that did not draw the first time.
fn difference(first: &Manifest) -> anyhow::Result<Option<String>> {
    let adapter = vision::find_adapter()?;
    let (this_kernel, this_renderer) = (kernel::identity(), render::identity());
    let compared = [
        ("graphics adapter", first.adapter.as_str(), adapter.as_str()),
        ("renderer", &first.renderer, &this_renderer),
        ("kernel", &first.kernel, &this_kernel),
    ];
    let other = compared.into_iter().find(|(_, then, now)| then != now);
    Ok(other.map(|(what, then, now)| format!("was made with {what} {then}, this one is {now}")))
}

/// Where maps and cases are found.
struct Sources {
    maps: Vec<Map>,
    cases: Vec<(PathBuf, CaseUsed)>,
    jobs: Option<u16>,
}

impl Sources {
    fn find(args: &Options) -> anyhow::Result<Self> {
        let names = [&["all".to_owned()][..], &args.maps].concat();
        Ok(Self { maps: Map::find_all(&names)?, cases: cases::cases_in(&args.cases)?, jobs: args.jobs })
    }

    fn build(&self, recipe: &Recipe, out: &Path, interrupt: &Interrupt) -> anyhow::Result<Manifest> {
        match recipe {
            Recipe::Natural(natural) => {
                let maps = natural.maps.iter().map(|used| self.map(used)).collect::<anyhow::Result<Vec<_>>>()?;
                natural::build(natural, &maps, out, self.jobs, interrupt)
            }
            Recipe::Cases(recipe) => {
                let files = recipe.cases.iter().map(|used| self.case(used)).collect::<anyhow::Result<Vec<_>>>()?;
                cases::build(recipe, &files, out, self.jobs, interrupt)
            }
            Recipe::Mix(mix) => self.build_mix(mix, out, interrupt),
        }
    }

    /// Makes the parts beside the mix first; they go when it is complete.
    fn build_mix(&self, recipe: &MixRecipe, out: &Path, interrupt: &Interrupt) -> anyhow::Result<Manifest> {
        if let Some(finished) = Manifest::of_finished(out, &recipe.clone().into())? {
            return Ok(finished);
        }
        let mut name = out.file_name().unwrap_or_default().to_owned();
        name.push(".parts");
        let parts = out.with_file_name(name);
        let part = |recipe, name| {
            let folder = parts.join(name);
            self.build(recipe, &folder, interrupt)?;
            Dataset::read(&folder)
        };
        let natural = part(&recipe.natural, "natural")?;
        let source = part(recipe.by.source(), "source")?;
        let pending = PendingFolder::new(out)?;
        let manifest = recipe.assemble(&natural, &source, pending.path(), interrupt)?;
        pending.finish()?;
        fs::remove_dir_all(&parts).with_context(|| parts.display().to_string())?;
        Ok(manifest)
    }

    fn map(&self, used: &MapUsed) -> anyhow::Result<Map> {
        if let Some(map) = self.maps.iter().find(|map| MapUsed::new(map) == *used) {
            return Ok(map.clone());
        }
        let MapUsed { name, digest } = used;
        bail!("map {name} with digest {digest}: is none of the bundled ones; expected its .xodr file after --maps")
    }

    fn case(&self, used: &CaseUsed) -> anyhow::Result<PathBuf> {
        if let Some((path, _)) = self.cases.iter().find(|(_, case)| case.digest == used.digest) {
            return Ok(path.clone());
        }
        let CaseUsed { name, digest, .. } = used;
        bail!("case {name} with digest {digest}: expected it among the files and folders after the recipe")
    }
}
