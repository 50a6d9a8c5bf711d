//! One self-contained page about corner cases: what the camera saw, what was there, what each
//! checkpoint made of it, and where it happened.

mod drive;
mod fact;
mod map;
mod page;
mod story;
mod strip;
mod trace;

use std::path::PathBuf;

use anyhow::{anyhow, bail};
use base::failure::{Failed, Failure};
use base::library::Entry;
use base::progress;
use base::say::say;
use base::spread::{in_order, jobs};
use drivers::checkpoint::CheckpointChoice;
use drivers::recorded_eye::RecordedEye;
use drivers::vision::Eye;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use measures::Tally;
use measures::footage::Footage;
use measures::statistics::Library;
use perception::ConfusionMatrix;
use render::{AdapterChoice, Imaging};

use super::looks::{Size, Studio, look, open_eyes};
use super::pipeline::Studios;
use drive::Drive;
use page::{CasePart, Page};
pub use page::{Class, STYLE, legend};
use story::Story;
pub use strip::Seen;
use strip::Strip;

/// A page, and what it is not about.
pub struct Report {
    /// The page.
    pub html: String,
    /// How many corner cases are on it.
    pub cases: usize,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// What came of a case.
enum Told {
    Case(Box<(Drive, CasePart, Vec<ConfusionMatrix>, Seen)>),
    /// It was a drive to get used to the rig.
    Uncounted,
}

/// The page about the corner cases among files and folders, each drawn at a size (see [`open_eyes`]) as its drive was, and looked at through each
/// checkpoint, so many at the same time. Kilometres, and the corner cases that they are divided by, are those of all rides behind the cases (see
/// [`Library::of`]), of which few may be shown. Drives to get used to the rig do not count.
pub fn render(
    places: &[PathBuf],
    choices: &[CheckpointChoice],
    size: Option<Size>,
    threads: Option<u16>,
) -> anyhow::Result<Report> {
    let (eyes, size) = open_eyes(choices, size)?;
    AdapterChoice::default().find()?;
    let mut overall = vec![ConfusionMatrix::default(); eyes.len()];
    let (mut cases, mut drives, mut seen) = (Vec::new(), Vec::new(), Seen::nothing());
    let Library { cases: files, rides, mut failed } = Library::of(places);
    if files.is_empty() && failed.is_empty() {
        bail!("none of the files and folders holds a corner case; expected at least one *.case.mcap");
    }
    let (bar, studios) = (progress::bar("report", files.len() as u64), Studios::new(Imaging::default()));
    let work = |index: usize| studios.with(size, |studio| tell(&files[index], studio, &mut eyes.clone()));
    in_order(jobs(threads), files.len(), work, |index, told| {
        let path = &files[index].path;
        match told {
            Ok(Told::Case(told)) => {
                let (drive, part, matrices, shown) = *told;
                overall.iter_mut().zip(&matrices).for_each(|(sum, matrix)| sum.merge(matrix));
                seen.merge(&shown);
                cases.push(part);
                drives.push(drive);
            }
            Ok(Told::Uncounted) => say(format_args!("{}: left out, a drive to get used to the rig", path.display())),
            Err(error) => failed.push(Failure::new(path, &error)),
        }
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    if cases.is_empty() {
        let why = Failed::check(&failed, 0).err();
        return Err(why.unwrap_or_else(|| anyhow!("no case is left: expected one of a drive that counts")));
    }
    let tally = Tally::of(drives.iter().map(|drive| (&drive.recording, drive.measures.as_ref())));
    let number = cases.len();
    let html = Page::new(&eyes, size, &overall, &seen, (&rides, &tally), cases).render()?;
    Ok(Report { html, cases: number, failed })
}

/// What is on the page about a case.
fn tell(file: &Entry, studio: &mut Studio, eyes: &mut [Eye]) -> anyhow::Result<Told> {
    let drive = Drive::of(&file.path)?;
    if drive.is_familiarisation() {
        return Ok(Told::Uncounted);
    }
    let footage = Footage::read(&file.path, CLIP_TICKS, CLIP_FPS)?;
    let (mut strip, mut seen) = (Strip::new(eyes, &footage), Seen::nothing());
    // As it was seen in the drive.
    let imaging = RecordedEye::of(&footage.log.manifest.provenance)?.camera.imaging();
    let camera = studio.camera().at(imaging);
    for scene in &footage.scenes {
        let frame = studio.draw_through(&footage.network, scene, &camera)?;
        let masks = look(eyes, &frame)?;
        strip.add(&frame, &masks, &mut seen)?;
    }
    let matrices = strip.matrices().to_vec();
    let (story, trace) = (Story::of(&drive, &footage)?, trace::of(&footage));
    Ok(Told::Case(Box::new((drive, CasePart::new(&file.name, story, strip, trace), matrices, seen))))
}
