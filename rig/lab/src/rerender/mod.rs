//! Renders the window of recordings or cases through checkpoints.
//!
//! `OUT/NAME/rgb/TICK.png`, `OUT/NAME/labels/TICK.png`, `OUT/NAME/predictions/CHECKPOINT/TICK.png`
//! (ids are tags of CARLA 0.9.10), and `OUT/metrics.jsonl`: a line for each frame and checkpoint, for
//! each file and checkpoint, and for each checkpoint over all. Further cameras have `OUT/NAME/cameras/CAMERA`. What is whole is found again through
//! `OUT/.rerender`; pictures in a folder are of the same options, through as many checkpoints as one likes.

mod options;
mod pictures;
mod surround;

pub use self::options::Options;
use std::{fmt, fs};

use anyhow::{Context, bail};
use base::failure::{Failed, Failure};
use base::json::Typed;
use base::json::json_line;
use base::library::{self, Entry, Kind};
use base::output;
use base::progress::{self, Interrupt};
use base::spread::jobs;
use base::words::count;
use drivers::vision::Eye;
use kernel::time::Tick;
use perception::ConfusionMatrix;
use render::{AdapterChoice, Camera};
use serde::Serialize;

use self::pictures::{Matrices, Pictures};
use self::surround::Surround;
use super::cameras;
use super::figures::{Figures, table};
use super::looks::open_eyes;
use super::pipeline::{Pipeline, Studios, set_aside};
use super::store::{Settings, Store};
use crate::share::{Share, ShareDone};

/// The table of all metrics, in the folder of the results.
const TABLE: &str = "metrics.jsonl";

/// A line of `metrics.jsonl`.
#[derive(Serialize)]
struct Line<'a> {
    /// What it sums over: `frame`, `file` or `overall`.
    over: &'a str,
    /// Name of the file, of a line of a frame or file.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a str>,
    /// Tick of the frame, of a line of a frame.
    #[serde(skip_serializing_if = "Option::is_none")]
    tick: Option<Tick>,
    /// Name of the checkpoint.
    checkpoint: &'a str,
    #[serde(flatten)]
    figures: Figures,
}

/// A line of `metrics.jsonl`.
impl Typed for Line<'_> {
    const TYPE: &'static str = "aeye.rerender.metrics";
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rerendered {
    /// Folder of the results.
    pub out: String,
    /// Recordings and cases.
    pub files: usize,
    /// Frames of all of them.
    pub frames: usize,
    /// What each checkpoint made of them.
    pub checkpoints: Vec<Seen>,
    /// Files that were left out, and why.
    pub failed: Vec<Failure>,
}

/// What `aeye rerender` prints.
impl Typed for Rerendered {
    const TYPE: &'static str = "aeye.rerender";
}

/// A checkpoint over all frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Seen {
    /// Its name.
    pub name: String,
    /// Its digest in hexadecimal digits.
    pub digest: String,
    /// How good it was.
    #[serde(flatten)]
    pub figures: Figures,
}

impl fmt::Display for Rerendered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { out, files, frames, checkpoints, .. } = self;
        let columns: Vec<_> = checkpoints.iter().map(|c| (c.name.clone(), c.figures.clone())).collect();
        let (frames, files) = (count(*frames, "frame"), count(*files, "file"));
        write!(f, "{}\n{frames} of {files} in {out}", table(&columns))
    }
}

/// Draws the windows and looks at them; what an earlier call left whole is kept.
pub fn rerender(args: &Options, interrupt: &Interrupt) -> anyhow::Result<Rerendered> {
    let Drawn { files, eyes, found, failed, _store } = draw(args, None, interrupt)?;
    let (lines, overall) = lines(&files, &eyes, &found)?;
    output::write_file(&args.out.join(TABLE), lines.as_bytes())?;
    let frames = found.iter().filter_map(|file| file.first()).map(Vec::len).sum();
    let seen = |(eye, matrix): (&Eye, &ConfusionMatrix)| Seen {
        name: eye.name().to_owned(),
        digest: eye.digest(),
        figures: matrix.into(),
    };
    let checkpoints = eyes.iter().zip(&overall).map(seen).collect();
    Ok(Rerendered { out: args.out.display().to_string(), files: files.len(), frames, checkpoints, failed })
}

/// Does so with a share of the files and writes no table: a later call finds their pictures in the folder.
pub fn rerender_shard(args: &Options, share: Share, interrupt: &Interrupt) -> anyhow::Result<ShareDone> {
    let Drawn { files, failed, .. } = draw(args, Some(share), interrupt)?;
    Ok(ShareDone { share, out: args.out.display().to_string(), done: files.len(), failed })
}

/// Files whose pictures are there.
struct Drawn {
    files: Vec<Entry>,
    eyes: Vec<Eye>,
    /// By file and checkpoint.
    found: Vec<Vec<Matrices>>,
    failed: Vec<Failure>,
    /// Nobody else works in the folder for as long.
    _store: Store,
}

/// Draws what is missing of a share, or of all.
fn draw(args: &Options, share: Option<Share>, interrupt: &Interrupt) -> anyhow::Result<Drawn> {
    AdapterChoice::default().find()?;
    let store = Store::open(&args.out, "rerender")?;
    let found = library::find(&args.files, Kind::Cases).apart_from(TABLE).or_failed()?;
    let library::Found { mut files, mut failed } = match share {
        Some(share) => share.pick(found),
        None => found,
    };
    let (eyes, size) = open_eyes(&args.checkpoint, args.size)?;
    cameras::check(&Camera::driver(size.0, size.1).at(args.imaging))?;
    let cameras = args.cameras.as_ref().map(|path| cameras::read(path, size, args.imaging)).transpose()?;
    store.hold(&options::of_pictures(args, size))?;
    let metrics = args.out.join(TABLE);
    // That of an earlier call would not be about these files.
    if share.is_none() && metrics.exists() {
        fs::remove_file(&metrics).with_context(|| metrics.display().to_string())?;
    }
    let bar = progress::bar("frames", 0);
    let settings = Settings::new(args.last, args.fps, size, args.imaging);
    let work = Pictures { args, files: &files, eyes: &eyes, store: &store, bar: &bar, settings: settings.clone() };
    let left = work.left();
    bar.set_length(work.expected() * left.len() as u64);
    let (jobs, studios) = (jobs(args.jobs), Studios::new(args.imaging));
    let (_, unread) = Pipeline { work: &work, files: &left, size, eyes: &eyes, jobs, interrupt, studios }.run()?;
    bar.finish_and_clear();
    failed.extend(set_aside(&mut files, unread));
    if files.is_empty() && !failed.is_empty() {
        return Err(Failed::new(failed).into());
    }
    if let Some(cameras) = &cameras {
        Surround { args, cameras, store: &store, settings: &settings }.draw(&files, interrupt)?;
    }
    let work = Pictures { args, files: &files, eyes: &eyes, store: &store, bar: &bar, settings };
    let Some(found) = work.found() else {
        bail!("{}: interrupted; the same command goes on from there", args.out.display());
    };
    Ok(Drawn { files, eyes, found, failed, _store: store })
}

/// The text of `metrics.jsonl`, and each checkpoint's matrix over all; `found` is by file and checkpoint.
fn lines(files: &[Entry], eyes: &[Eye], found: &[Vec<Matrices>]) -> anyhow::Result<(String, Vec<ConfusionMatrix>)> {
    let mut text = String::new();
    let mut line = |over, file, tick, eye: &Eye, matrix: &ConfusionMatrix| -> anyhow::Result<()> {
        let line = Line { over, file, tick, checkpoint: eye.name(), figures: matrix.into() };
        text.push_str(&json_line(&line)?);
        text.push('\n');
        Ok(())
    };
    let mut overall = vec![ConfusionMatrix::default(); eyes.len()];
    for (file, found) in files.iter().zip(found) {
        let name = Some(file.name.as_str());
        for frame in 0..found.first().map_or(0, Vec::len) {
            for (eye, matrices) in eyes.iter().zip(found) {
                let (tick, matrix) = &matrices[frame];
                line("frame", name, Some(*tick), eye, matrix)?;
            }
        }
        for ((eye, matrices), overall) in eyes.iter().zip(found).zip(&mut overall) {
            let mut sum = ConfusionMatrix::default();
            matrices.iter().for_each(|(_, matrix)| sum.merge(matrix));
            overall.merge(&sum);
            line("file", name, None, eye, &sum)?;
        }
    }
    for (eye, matrix) in eyes.iter().zip(&overall) {
        line("overall", None, None, eye, matrix)?;
    }
    Ok((text, overall))
}
