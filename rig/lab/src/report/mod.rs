//! One self-contained page about corner cases: what the camera saw, what was there, what each
//! checkpoint made of it, and where it happened.

mod drive;
mod exposure;
mod fact;
mod map;
mod page;
mod story;
mod strip;
mod trace;

use std::path::PathBuf;

use anyhow::bail;
use base::progress;
use drivers::checkpoint::CheckpointChoice;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use measures::Tally;
use measures::footage::Footage;
use perception::ConfusionMatrix;
use render::AdapterChoice;

use super::looks::{Studio, look, open_eyes};
use drive::Drive;
use exposure::exposure;
use page::{CasePart, Page};
pub use page::{Class, STYLE, legend};
use story::Story;
pub use strip::Seen;
use strip::Strip;

/// The page about these corner cases, each drawn at `size` and looked at through each checkpoint.
/// Kilometres and minutes are those of all recordings that lie beside the cases. Drives to get used
/// to the rig do not count.
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
    Page::new(&eyes, size, &overall, &seen, (&exposure(files)?, &tally), cases).render()
}
