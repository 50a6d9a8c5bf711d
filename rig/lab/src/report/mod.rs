//! One self-contained page about corner cases: what the camera saw, what was there, what each
//! checkpoint made of it, and where it happened.

mod drive;
mod map;
mod page;
mod story;
mod strip;
mod trace;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::progress;
use drivers::checkpoint::CheckpointChoice;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use measures::Tally;
use measures::footage::Footage;
use measures::statistics::Ride;
use perception::ConfusionMatrix;
use render::AdapterChoice;
use replay::Recording;

use super::looks::{Studio, look, open_eyes};
use drive::Drive;
use page::{CasePart, Page};
pub use page::{Class, STYLE, legend};
use story::Story;
pub use strip::Seen;
use strip::Strip;

/// The page about these corner cases, each drawn at `size` and looked at through each checkpoint.
/// Kilometres, and the corner cases that they are divided by, are those of all recordings that lie beside the
/// cases, which may be a few of theirs. Drives to get used to the rig do not count.
pub fn render(files: &[PathBuf], choices: &[CheckpointChoice], size: (u32, u32)) -> anyhow::Result<String> {
    let mut eyes = open_eyes(choices, size)?;
    AdapterChoice::default().find()?;
    let mut studio = Studio::new(size);
    let mut overall = vec![ConfusionMatrix::default(); eyes.len()];
    let (mut cases, mut drives, mut seen) = (Vec::new(), Vec::new(), Seen::nothing());
    let bar = progress::bar("report", files.len() as u64);
    for path in files {
        let drive = Drive::of(path)?;
        if drive.is_familiarisation() {
            eprintln!("{}: left out, a drive to get used to the rig", path.display());
            continue;
        }
        let footage = Footage::read(path, CLIP_TICKS, CLIP_FPS)?;
        let mut strip = Strip::new(&eyes, &footage);
        for scene in &footage.scenes {
            let frame = studio.draw(&footage.network, scene)?;
            let masks = look(&mut eyes, &frame)?;
            strip.add(&frame, &masks, &mut seen)?;
        }
        overall.iter_mut().zip(strip.matrices()).for_each(|(sum, matrix)| sum.merge(matrix));
        let story = Story::of(&drive, &footage)?;
        let trace = trace::of(&footage);
        cases.push(CasePart::new(&footage.name, story, strip, trace));
        drives.push(drive);
        bar.inc(1);
    }
    bar.finish_and_clear();
    if cases.is_empty() {
        bail!("no case is left: expected one of a drive that counts");
    }
    let tally = Tally::of(drives.iter().map(|drive| (&drive.recording, drive.measures.as_ref())));
    Page::new(&eyes, size, &overall, &seen, (&driven(files)?, &tally), cases).render()
}

/// What was driven beside the cases: the rides of all recordings in their folders, each once, whichever of
/// their cases are shown. Forks of `aeye redrive` were driven by nobody.
fn driven(cases: &[PathBuf]) -> anyhow::Result<Vec<Ride>> {
    let here = Path::new(".");
    let folder = |path: &PathBuf| path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(here).to_owned();
    let (mut rides, mut known) = (Vec::new(), BTreeSet::new());
    for folder in cases.iter().map(folder).collect::<BTreeSet<_>>() {
        let entries = std::fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
        let mut paths = entries.map(|e| e.map(|e| e.path())).collect::<Result<Vec<_>, _>>()?;
        paths.sort();
        for path in paths.iter().filter(|path| is_recording(path)) {
            let recording = Recording::open(path)?;
            let is_fork = recording.log().manifest.provenance.contains_key("fork");
            if !is_fork && known.insert(recording.digest()) {
                rides.extend(Ride::of(&recording));
            }
        }
    }
    Ok(rides)
}

fn is_recording(path: &Path) -> bool {
    let name = path.to_string_lossy();
    name.ends_with(".mcap") && !name.ends_with(".case.mcap")
}
