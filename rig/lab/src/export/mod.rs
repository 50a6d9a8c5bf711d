//! Recordings and cases for the programs of others: for viewers of robot logs (Foxglove, Lichtblick, Rerun) an MCAP file
//! of Foxglove's protobuf messages, and a layout that shows them; or as moving pictures, or as stories in OpenSCENARIO XML,
//! or as traces of OSI, pictures annotated as in COCO, labels of OpenLABEL, bags of ROS 2,
//! or as what was heard.
//!
//! An export that is there already is kept: its file says what it was made from.

mod about;
mod coco;
mod criticality;
mod film;
mod format;
mod happenings;
mod hearing;
mod layout;
mod openlabel;
mod options;
mod osi;
mod robot_log;
mod ros2;
mod sink;
mod story;
mod topics;
mod video;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::bail;
use base::failure::{Failed, Failure, Usage};
use base::json::Typed;
use base::library::{self, Entry, Found, Kind};
use base::output::{self, OutputFolder};
use base::progress::{self, Interrupt};
use base::spread::{in_order, jobs};
use base::words::count;
use drivers::vision::Eye;
use replay::Recording;
use serde::Serialize;

use super::cameras;
use super::looks::open_eyes;
use super::pipeline::Studios;
use super::shots::Workshop;

use film::Camera;
pub use film::Counts;
pub use format::{Format, Written};
pub use options::{Export, Options};
use video::Screen;

/// The layout for viewers, in a folder of several exports.
const LAYOUT: &str = "layout.json";

/// What was written.
#[derive(Debug, Serialize)]
pub struct Exports {
    /// A layout for viewers; absent where something else was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layout: Option<PathBuf>,
    /// The files.
    pub exports: Vec<Export>,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// What `aeye export` prints.
impl Typed for Exports {
    const TYPE: &'static str = "aeye.export";
}

impl fmt::Display for Exports {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Export { out, from, to, kept, counts, .. } in &self.exports {
            let kept = if *kept { ", kept" } else { "" };
            writeln!(f, "{}: ticks {from} to {to}, {counts}{kept}", out.display())?;
        }
        match &self.layout {
            Some(layout) => write!(f, "{}: a layout for the viewer", layout.display()),
            None => write!(f, "{}", count(self.exports.len(), "file")),
        }
    }
}

/// Exports what is asked for; what is whole already is kept.
pub fn export(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Exports> {
    args.format.check(args.camera, &args.checkpoint, args.cameras.is_some())?;
    let Places { layout, files, mut failed, folder } = places(args)?;
    let (eyes, size) = open_eyes(&args.checkpoint, args.size)?;
    cameras::check(&args.camera.camera(size).at(args.imaging))?;
    let others = match &args.cameras {
        Some(path) => cameras::read(path, size, args.imaging)?,
        None => Vec::new(),
    };
    if args.format == Format::Ros2 {
        ros2::check_names(&others)?;
    }
    let others = &others;
    let (studios, workshop) = (Studios::new(args.imaging), Arc::new(Workshop::default()));
    let bar = progress::bar("files", files.len() as u64);
    let work = |index: usize| {
        let (file, out) = &files[index];
        if let (Some(folder), Some(below)) = (&folder, out.parent()) {
            folder.make(below)?;
        }
        let eyes = &mut eyes.clone();
        match args.format {
            Format::Mcap => studios.with(size, |studio| {
                let (recording, mut camera) = (Recording::open(file)?, Camera { studio, eyes, others });
                robot_log::export((args, size), (file, &recording), out.clone(), &mut camera, interrupt)
            }),
            Format::Ros2 => studios.with(size, |studio| {
                ros2::export((args, size), file, out.clone(), &mut Camera { studio, eyes, others }, interrupt)
            }),
            Format::Coco => {
                studios.with(size, |studio| coco::export((args, size), file, out.clone(), (studio, others), interrupt))
            }
            Format::OpenLabel => openlabel::export((args, size), file, out.clone(), others, interrupt),
            Format::OpenScenario => story::export(args, file, out.clone(), interrupt),
            Format::Osi => osi::export(args, file, out.clone(), interrupt),
            Format::Wav => hearing::export(args, file, out.clone(), interrupt),
            Format::Apng | Format::Gif | Format::Mp4 => {
                video::export(args, file, out.clone(), Screen { workshop: &workshop, size, eyes }, interrupt)
            }
        }
    };
    let mut exports = Vec::new();
    in_order(jobs(args.jobs), files.len(), work, |index, export| {
        let file = &files[index].0;
        match export {
            Ok(export) => exports.push(export),
            Err(error) if interrupt.is_raised() => return Err(error.context(file.display().to_string())),
            Err(error) => failed.push(Failure::new(file, &error)),
        }
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    if exports.is_empty() {
        return Err(Failed::new(failed).into());
    }
    if let Some(layout) = &layout {
        let panels = layout::layout(eyes.iter().map(Eye::name), others.iter().map(|named| named.name.as_str()));
        output::write_file(layout, &serde_json::to_vec_pretty(&panels)?)?;
    }
    Ok(Exports { layout, exports, failed })
}

/// Where everything goes.
struct Places {
    /// Where viewers want one.
    layout: Option<PathBuf>,
    /// What is exported, and to where.
    files: Vec<(PathBuf, PathBuf)>,
    failed: Vec<Failure>,
    /// The folder, where they go into one.
    folder: Option<OutputFolder>,
}

/// One file goes to `OUT.mcap` (or another ending, by the format), or into a folder as several do. Where a format writes
/// folders, one file that is named goes to `OUT` itself.
fn places(args: &Options) -> anyhow::Result<Places> {
    let Found { files: given, failed } = library::find(&args.files, Kind::Cases).apart_from(LAYOUT).or_failed()?;
    check_out(args, given.len())?;
    let is_out = match args.format.written() {
        Written::File(ending) => is_file(&args.out, ending),
        Written::Folder => args.files.len() == 1 && args.files[0].is_file(),
    };
    let to = |file: &Entry| match args.format.written() {
        _ if is_out => args.out.clone(),
        Written::File(ending) => args.out.join(format!("{}.{ending}", file.name)),
        Written::Folder => args.out.join(&file.name),
    };
    let layout = if is_out { args.out.with_extension("layout.json") } else { args.out.join(LAYOUT) };
    let layout = (args.format == Format::Mcap).then_some(layout);
    let files = given.into_iter().map(|file| (file.path.clone(), to(&file))).collect();
    let folder = if is_out { None } else { Some(OutputFolder::open(&args.out)?) };
    Ok(Places { layout, files, failed, folder })
}

/// Refuses a place for so many files that does not fit the format.
fn check_out(args: &Options, files: usize) -> anyhow::Result<()> {
    let (format, shown) = (args.format, args.out.display());
    let is_other_file = Format::by_ending(&args.out).is_some() && !args.out.is_dir();
    match format.written() {
        Written::Folder if is_other_file => {
            return Err(Usage(format!("{shown}: {} writes a folder; expected the name of one", format.name())).into());
        }
        Written::File(ending) if is_other_file && !is_file(&args.out, ending) => {
            return Err(Usage(format!("{shown}: expected a folder, or a file *.{ending}")).into());
        }
        Written::File(ending) if is_file(&args.out, ending) && files > 1 => {
            return Err(Usage(format!("{shown}: is one file; expected a folder for several")).into());
        }
        _ => {}
    }
    if args.out.to_str().is_none() {
        bail!("{shown}: its name is not UTF-8; expected one that is");
    }
    match format.written() {
        Written::File(ending) if is_file(&args.out, ending) => output::check_file(&args.out),
        _ => Ok(()),
    }
}

fn is_file(out: &Path, ending: &str) -> bool {
    out.extension().is_some_and(|of_out| of_out == ending) && !out.is_dir()
}
