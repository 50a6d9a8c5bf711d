//! One self-contained page about corner cases: what the camera saw, what was there, what each
//! checkpoint made of it, and where it happened.

mod drive;
mod driven;
mod fact;
mod map;
mod page;
mod story;
mod strip;
mod trace;

use std::path::PathBuf;

use anyhow::anyhow;
use base::failure::{Failed, Failure};
use base::library::{self, Found, Kind, Listed};
use base::progress;
use base::say::say;
use drivers::checkpoint::CheckpointChoice;
use drivers::vision::Eye;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use measures::Tally;
use measures::footage::Footage;
use perception::ConfusionMatrix;
use render::AdapterChoice;

use super::looks::{Size, Studio, look, open_eyes};
use drive::Drive;
use driven::driven;
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
    Case(Box<(Drive, CasePart, Vec<ConfusionMatrix>)>),
    /// It was a drive to get used to the rig.
    Uncounted,
}

/// The page about the corner cases among files and folders, each drawn at a size (see [`open_eyes`]) and looked at through each
/// checkpoint. Kilometres, and the corner cases that they are divided by, are those of all recordings in and below
/// the folders of the cases, of which few may be shown. Drives to get used to the rig do not count.
pub fn render(places: &[PathBuf], choices: &[CheckpointChoice], size: Option<Size>) -> anyhow::Result<Report> {
    let (mut eyes, size) = open_eyes(choices, size)?;
    AdapterChoice::default().find()?;
    let mut studio = Studio::new(size);
    let mut overall = vec![ConfusionMatrix::default(); eyes.len()];
    let (mut cases, mut drives, mut seen) = (Vec::new(), Vec::new(), Seen::nothing());
    let Found { files, mut failed } = library::list(places, Kind::Cases).or_failed()?;
    let bar = progress::bar("report", files.len() as u64);
    for file in &files {
        match tell(file, &mut studio, &mut eyes, &mut seen) {
            Ok(Told::Case(told)) => {
                let (drive, part, matrices) = *told;
                overall.iter_mut().zip(&matrices).for_each(|(sum, matrix)| sum.merge(matrix));
                cases.push(part);
                drives.push(drive);
            }
            Ok(Told::Uncounted) => {
                say(format_args!("{}: left out, a drive to get used to the rig", file.path.display()))
            }
            Err(error) => failed.push(Failure::new(&file.path, &error)),
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    if cases.is_empty() {
        let why = Failed::check(&failed, 0).err();
        return Err(why.unwrap_or_else(|| anyhow!("no case is left: expected one of a drive that counts")));
    }
    let tally = Tally::of(drives.iter().map(|drive| (&drive.recording, drive.measures.as_ref())));
    let (number, driven) = (cases.len(), driven(&files, &mut failed));
    let html = Page::new(&eyes, size, &overall, &seen, (&driven, &tally), cases).render()?;
    Ok(Report { html, cases: number, failed })
}

/// What is on the page about a case.
fn tell(file: &Listed, studio: &mut Studio, eyes: &mut [Eye], seen: &mut Seen) -> anyhow::Result<Told> {
    let drive = Drive::of(&file.path)?;
    if drive.is_familiarisation() {
        return Ok(Told::Uncounted);
    }
    let footage = Footage::read(&file.path, CLIP_TICKS, CLIP_FPS)?;
    let mut strip = Strip::new(eyes, &footage);
    for scene in &footage.scenes {
        let frame = studio.draw(&footage.network, scene)?;
        let masks = look(eyes, &frame)?;
        strip.add(&frame, &masks, seen)?;
    }
    let matrices = strip.matrices().to_vec();
    let (story, trace) = (Story::of(&drive, &footage)?, trace::of(&footage));
    Ok(Told::Case(Box::new((drive, CasePart::new(&file.name, story, strip, trace), matrices))))
}
