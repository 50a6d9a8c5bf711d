//! A dataset of corner cases: the 3 s up to each takeover at 10 frames a second (paper, section 5), with
//! ground truth.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::failure::{Failed, Usage};
use base::library::{self, Entry, Kind};
use base::output::PendingFolder;
use base::progress::{self, Interrupt};
use base::spread::{in_order, jobs};
use drivers::vision;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use measures::footage::Footage;
use perception::cityscapes::Place;
use render::Imaging;
use replay::{Label, Recording};

use super::manifest::Manifest;
use super::provenance::{Drive, FrameLine};
use super::recipe::{CaseUsed, CasesRecipe, Recipe, city};
use super::views::{View, say_sizes, views};
use crate::looks::Studio;
use crate::pipeline::Studios;
use crate::redrive::{Need, keep_judged};
use crate::{cameras, cityscapes};

/// Which corner cases become a dataset.
#[derive(Clone, Debug)]
pub struct Options {
    /// Corner cases, or folders of them.
    pub files: Vec<PathBuf>,
    /// Take only cases with this label: walker, vehicle, rules or boredom; may be given again.
    pub label: Vec<Label>,
    /// Take only cases on whose takeover a campaign came to one of these verdicts.
    pub verdict: Vec<Need>,
    /// Which split they become.
    pub split: String,
    /// Size of the pictures.
    pub size: (u32, u32),
    /// How good the pictures are.
    pub imaging: Imaging,
    /// A file with cameras that take the frames, each all of them, instead of the drivers' ([`crate::cameras`]).
    pub cameras: Option<PathBuf>,
    /// Cases drawn at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// Folder of the dataset; must not exist, be empty, or hold this dataset already.
    pub out: PathBuf,
}

/// Makes a dataset; one that is complete stays as it is.
pub fn make(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Manifest> {
    let mut found = cases_in(&args.files)?;
    if !args.label.is_empty() {
        let wanted = |case: &CaseUsed| args.label.iter().any(|label| case.label.as_deref() == Some(label.name()));
        found.retain(|(_, case)| wanted(case));
        if found.is_empty() {
            let labels: Vec<&str> = args.label.iter().map(|label| label.name()).collect();
            bail!("none of the corner cases is labelled {}", labels.join(" or "));
        }
    }
    let found = keep_judged(found, |(path, _)| path, &args.verdict)?;
    let (files, cases): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let Imaging { quality, sensor, models } = args.imaging;
    let cameras = cameras::of_file(args.cameras.as_deref(), (args.size, args.imaging))?;
    let recipe = CasesRecipe { split: args.split.clone(), size: args.size, quality, sensor, models, cameras, cases };
    recipe.check().map_err(Usage)?;
    build(&recipe, &files, &args.out, args.jobs, interrupt)
}

/// The corner cases among files and folders, each once. One that cannot be read is an error: a dataset is whole.
pub(super) fn cases_in(places: &[PathBuf]) -> anyhow::Result<Vec<(PathBuf, CaseUsed)>> {
    let read = |entry: Entry| Ok((entry.path.clone(), CaseUsed::read(&entry)?));
    let found = library::find(places, Kind::Cases).only_cases();
    if !found.failed.is_empty() {
        return Err(Failed::new(found.failed).into());
    }
    found.files.into_iter().map(read).collect()
}

impl CaseUsed {
    fn read(entry: &Entry) -> anyhow::Result<Self> {
        let log = Recording::open(&entry.path)?.into_log();
        let info = log.manifest.case.as_ref();
        let info = info.with_context(|| format!("{}: is no corner case any more", entry.path.display()))?;
        Ok(Self {
            name: entry.name.clone(),
            digest: entry.digest.to_hex().to_string(),
            recording: blake3::Hash::from_bytes(info.source).to_hex().to_string(),
            to: info.to,
            map: city(&log.manifest.scenario.map),
            seed: log.manifest.scenario.seed,
            label: log.annotation.as_ref().map(|annotation| annotation.label.name().to_owned()),
        })
    }
}

/// Makes a dataset from a recipe and the files of its cases.
pub(super) fn build(
    recipe: &CasesRecipe,
    files: &[PathBuf],
    out: &Path,
    threads: Option<u16>,
    interrupt: &Interrupt,
) -> anyhow::Result<Manifest> {
    let whole = Recipe::Cases(recipe.clone());
    if let Some(finished) = Manifest::of_finished(out, &whole)? {
        return Ok(finished);
    }
    let views = views(&recipe.cameras, recipe.size, recipe.imaging())?;
    let adapter = vision::find_adapter()?;
    let (pending, studios) = (PendingFolder::new(out)?, Studios::new(recipe.imaging()));
    say_sizes(&views);
    let bar = progress::bar("cases", files.len() as u64);
    let draw = |scene: usize| {
        studios.with(recipe.size, |studio| {
            let mut shoot =
                Shoot { recipe, views: &views, adapter: &adapter, folder: pending.path(), studio, interrupt };
            shoot.case(scene, &files[scene])
        })
    };
    let mut lines = Vec::new();
    in_order(jobs(threads), files.len(), draw, |_, drawn| {
        lines.extend(drawn?.with_context(|| format!("{}: interrupted; nothing of it is kept", out.display()))?);
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    let manifest = Manifest::complete(pending.path(), whole, adapter, &lines)?;
    pending.finish()?;
    Ok(manifest)
}

/// Draws cases, one after the other.
struct Shoot<'a> {
    recipe: &'a CasesRecipe,
    views: &'a [View],
    adapter: &'a str,
    folder: &'a Path,
    studio: &'a mut Studio,
    interrupt: &'a Interrupt,
}

impl Shoot<'_> {
    /// Writes the frames of a case, which is the scene of that number; `None` when interrupted.
    fn case(&mut self, scene: usize, path: &Path) -> anyhow::Result<Option<Vec<FrameLine>>> {
        let footage = Footage::read(path, CLIP_TICKS, CLIP_FPS)?;
        let case = &self.recipe.cases[scene];
        let drive = Drive { recording: case.recording.clone(), seed: case.seed, label: case.label.as_deref() };
        let mut lines = Vec::new();
        for (number, snapshot) in (0..).zip(&footage.scenes) {
            if self.interrupt.is_raised() {
                return Ok(None);
            }
            for view in self.views {
                let frame = self.studio.draw_through(&footage.network, snapshot, &view.camera)?;
                let (split, city, camera) = (&self.recipe.split, &case.map, view.name.as_deref());
                let place = Place { split, city, scene: scene as u32, frame: number, camera };
                cityscapes::write(self.folder, &place, &frame)?;
                let state = (snapshot, footage.log.hash(frame.tick));
                lines.push(FrameLine::new(&place, (&frame, view), state, &drive, self.adapter));
            }
        }
        Ok(Some(lines))
    }
}
