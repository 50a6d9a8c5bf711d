//! Recordings and cases for viewers of robot logs (Foxglove, Lichtblick, Rerun): an MCAP file of
//! Foxglove's protobuf messages, and a layout that shows them.
//!
//! Message times are simulated time, so that the same export gives the same bytes. An export that is there
//! already is kept: its file says what it was made from.

mod criticality;
mod film;
mod happenings;
mod layout;
mod sink;
mod topics;

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

use anyhow::bail;
use base::failure::{Failed, Failure, Usage};
use base::json::Typed;
use base::library::{self, Entry, Found, Kind};
use base::output::{self, OutputFolder, PendingFile};
use base::progress::{self, Interrupt};
use base::spread::{in_order, jobs};
use drivers::checkpoint::CheckpointChoice;
use drivers::vision::Eye;
use kernel::RoadNetwork;
use kernel::time::Tick;
use measures::footage::{Asked, Window};
use replay::{Exported, Recording, exported};
use serde::Serialize;

use super::looks::{Size, open_eyes};
use super::pipeline::Studios;

use film::Camera;
pub use film::Counts;
use sink::Sink;

/// The layout for viewers, in a folder of several exports.
const LAYOUT: &str = "layout.json";

/// What was written.
#[derive(Debug, Serialize)]
pub struct Exports {
    /// A layout for viewers.
    pub layout: PathBuf,
    /// The files.
    pub exports: Vec<Export>,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// What `aeye export` prints.
impl Typed for Exports {
    const TYPE: &'static str = "aeye.export";
}

/// A file that was written.
#[derive(Debug, Serialize)]
pub struct Export {
    /// What was exported.
    pub file: PathBuf,
    /// To where.
    pub out: PathBuf,
    /// The first tick.
    pub from: Tick,
    /// The last tick.
    pub to: Tick,
    /// It was there already, made from the same.
    pub kept: bool,
    /// How much is in it.
    #[serde(flatten)]
    pub counts: Counts,
}

/// What is exported.
#[derive(Clone, Debug)]
pub struct Options {
    /// Recordings or cases, or folders with cases anywhere below.
    pub files: Vec<PathBuf>,
    /// Checkpoints whose masks come along with the ground truth.
    pub checkpoint: Vec<CheckpointChoice>,
    /// Only a window of this length that ends at the intervention (or at the end), as in `3s`; without a
    /// window everything is exported.
    pub last: Option<Tick>,
    /// Only from this time of the run on, as in `10s`.
    pub from: Option<Tick>,
    /// Only up to this time of the run, as in `20s`.
    pub to: Option<Tick>,
    /// Pictures a second; must divide 60. What is measured is exported at every tick.
    pub fps: u32,
    /// Size of the pictures; none: that which the first network takes.
    pub size: Option<(u32, u32)>,
    /// Files exported at the same time (default: one a core); the results do not depend on it.
    pub jobs: Option<u16>,
    /// File of the export, with its layout for viewers beside it; or a folder, for several files.
    pub out: PathBuf,
}

impl fmt::Display for Exports {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Export { out, from, to, kept, counts, .. } in &self.exports {
            let Counts { frames, poses, events } = counts;
            let kept = if *kept { ", kept" } else { "" };
            let out = out.display();
            writeln!(f, "{out}: ticks {from} to {to}, {frames} frames, {poses} poses, {events} events{kept}")?;
        }
        write!(f, "{}: a layout for the viewer", self.layout.display())
    }
}

/// Exports what is asked for; what is whole already is kept.
pub fn export(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Exports> {
    let Places { layout, files, mut failed, folder } = places(args)?;
    let (eyes, size) = open_eyes(&args.checkpoint, args.size)?;
    let studios = Studios::default();
    let bar = progress::bar("files", files.len() as u64);
    let work = |index: usize| {
        let (file, out) = &files[index];
        studios.with(size, |studio| {
            let mut camera = Camera { studio, eyes: &mut eyes.clone() };
            let recording = Recording::open(file)?;
            if let (Some(folder), Some(below)) = (&folder, out.parent()) {
                folder.make(below)?;
            }
            export_one((args, size), (file, &recording), out.clone(), &mut camera, interrupt)
        })
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
    let panels = layout::layout(eyes.iter().map(Eye::name));
    output::write_file(&layout, &serde_json::to_vec_pretty(&panels)?)?;
    Ok(Exports { layout, exports, failed })
}

/// Where everything goes.
struct Places {
    layout: PathBuf,
    /// What is exported, and to where.
    files: Vec<(PathBuf, PathBuf)>,
    failed: Vec<Failure>,
    /// The folder, where they go into one.
    folder: Option<OutputFolder>,
}

/// One file goes to `OUT.mcap`, or into a folder as several do.
fn places(args: &Options) -> anyhow::Result<Places> {
    let Found { files: given, failed } = library::find(&args.files, Kind::Cases).apart_from(LAYOUT).or_failed()?;
    let is_file = args.out.extension().is_some_and(|ending| ending == "mcap") && !args.out.is_dir();
    if is_file && given.len() > 1 {
        let sentence = format!("{}: is one file; expected a folder for several", args.out.display());
        return Err(Usage(sentence).into());
    }
    if args.out.to_str().is_none() {
        bail!("{}: its name is not UTF-8; expected one that is", args.out.display());
    }
    if is_file {
        output::check_file(&args.out)?;
    }
    let to = |file: &Entry| if is_file { args.out.clone() } else { args.out.join(format!("{}.mcap", file.name)) };
    let layout = if is_file { args.out.with_extension("layout.json") } else { args.out.join(LAYOUT) };
    let files = given.into_iter().map(|file| (file.path.clone(), to(&file))).collect();
    let folder = if is_file { None } else { Some(OutputFolder::open(&args.out)?) };
    Ok(Places { layout, files, failed, folder })
}

fn export_one(
    (args, size): (&Options, Size),
    (file, recording): (&Path, &Recording),
    out: PathBuf,
    camera: &mut Camera<'_>,
    interrupt: &Interrupt,
) -> anyhow::Result<Export> {
    let there = exported(&out);
    if there.is_none() && out.exists() {
        bail!("{}: exists already and is no export; expected another place", out.display());
    }
    let (log, network) = (recording.log(), recording.network()?);
    let window = Window::of(log, &Asked { last: args.last, from: args.from, to: args.to, fps: args.fps })?;
    let mut about = about(recording, &window, (args, size), camera.eyes);
    about.extend(origin(&network));
    let counts = Counts::of(log, &window);
    let (from, to) = window.ticks.clone().into_inner();
    let kept = there == Some(Exported { about: about.clone(), is_whole: true });
    let export = Export { file: file.to_owned(), out, from, to, kept, counts };
    if kept {
        return Ok(export);
    }
    let mut sink = Sink::new(PendingFile::new(&export.out)?, about)?;
    film::shoot((log, &network), &window, camera, &mut sink, || {
        if interrupt.is_raised() {
            bail!("interrupted; nothing of its export is kept");
        }
        Ok(())
    })?;
    sink.finish()?.finish()?;
    Ok(export)
}

/// What the export was made from.
fn about(
    recording: &Recording,
    window: &Window,
    (args, size): (&Options, Size),
    eyes: &[Eye],
) -> BTreeMap<String, String> {
    let eyes: Vec<String> = eyes.iter().map(|eye| format!("{} {}", eye.name(), eye.digest())).collect();
    let entries = [
        ("source", blake3::Hash::from_bytes(recording.digest()).to_hex().to_string()),
        ("ticks", format!("{} to {}", window.ticks.start(), window.ticks.end())),
        ("fps", args.fps.to_string()),
        ("size", format!("{}x{}", size.0, size.1)),
        ("checkpoints", eyes.join(", ")),
        ("adapter", drivers::vision::adapter()),
        ("program", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    entries.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// What to add to coordinates to have those of the map's file, where they differ: metres to the east and to the north.
fn origin(network: &RoadNetwork) -> Option<(String, String)> {
    let [east_m, north_m] = network.origin_m;
    ([east_m, north_m] != [0.0; 2]).then(|| ("origin_m".to_owned(), format!("{east_m} {north_m}")))
}
