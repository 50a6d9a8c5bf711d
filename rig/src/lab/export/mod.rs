//! Recordings and cases for viewers of robot logs (Foxglove, Lichtblick, Rerun): an MCAP file of
//! Foxglove's protobuf messages, and a layout that shows them.
//!
//! Message times are simulated time, so that the same export gives the same bytes. An export that is there
//! already is kept: its file says what it was made from.

mod criticality;
mod entities;
mod film;
mod happenings;
mod layout;
mod messages;
mod sink;
mod telemetry;
mod topics;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use kernel::time::{TICK_HZ, Tick};
use replay::{Exported, Log, Recording, exported};
use serde::Serialize;

use super::footage::decisive_tick;
use super::library;
use super::looks::{Studio, open_eyes};
use crate::cli::ExportArgs;
use crate::exit::{Usage, Verdict};
use crate::output::{self, PendingFile};
use crate::progress::{self, Interrupt};
use crate::vision::Eye;

use film::{Camera, Counts, Window};
use sink::Sink;

/// What the command prints.
#[derive(Serialize)]
struct Summary {
    layout: PathBuf,
    exports: Vec<Export>,
}

/// A file that was written.
#[derive(Serialize)]
struct Export {
    file: PathBuf,
    out: PathBuf,
    from: Tick,
    to: Tick,
    /// It was there already, made from the same.
    kept: bool,
    #[serde(flatten)]
    counts: Counts,
}

/// Runs `aeye export`.
pub fn run(args: &ExportArgs, json: bool) -> anyhow::Result<Verdict> {
    let summary = export(args)?;
    output::print(json, &summary, || text(&summary))?;
    Ok(Verdict::Ok)
}

fn text(summary: &Summary) -> String {
    let line = |export: &Export| {
        let Export { out, from, to, kept, counts, .. } = export;
        let Counts { frames, poses, events } = counts;
        format!(
            "{}: ticks {from} to {to}, {frames} frames, {poses} poses, {events} events{}",
            out.display(),
            if *kept { ", kept" } else { "" }
        )
    };
    let lines = summary.exports.iter().map(line);
    lines.chain([format!("{}: a layout for the viewer", summary.layout.display())]).collect::<Vec<_>>().join("\n")
}

fn export(args: &ExportArgs) -> anyhow::Result<Summary> {
    let interrupt = Interrupt::listen()?;
    let Places { layout, files } = places(args)?;
    let mut eyes = open_eyes(&args.checkpoint, args.size)?;
    let mut studio = Studio::new(args.size);
    let mut camera = Camera { studio: &mut studio, eyes: &mut eyes };
    let mut exports = Vec::new();
    for (file, out) in files {
        let recording = Recording::open(&file)?;
        let export = export_one(args, (&file, &recording), out, &mut camera, &interrupt);
        exports.push(export.with_context(|| file.display().to_string())?);
    }
    let panels = layout::layout(eyes.iter().map(Eye::name));
    output::write_file(&layout, &serde_json::to_vec_pretty(&panels)?)?;
    Ok(Summary { layout, exports })
}

/// Where everything goes.
struct Places {
    layout: PathBuf,
    /// What is exported, and to where.
    files: Vec<(PathBuf, PathBuf)>,
}

/// One file goes to `OUT.mcap`, or into a folder as several do.
fn places(args: &ExportArgs) -> anyhow::Result<Places> {
    let given = library::cases(&args.files)?;
    let is_file = args.out.extension().is_some_and(|ending| ending == "mcap") && !args.out.is_dir();
    if is_file && given.len() > 1 {
        let sentence = format!("{}: is one file; expected a folder for several", args.out.display());
        return Err(Usage(sentence).into());
    }
    if is_file {
        output::check_file(&args.out)?;
        let layout = args.out.with_extension("layout.json");
        return Ok(Places { layout, files: given.into_iter().map(|file| (file, args.out.clone())).collect() });
    }
    let mut names = BTreeSet::new();
    let mut files = Vec::new();
    for file in given {
        let name = file.file_name().unwrap_or_default().to_owned();
        let to = args.out.join(&name);
        files.push((file, to));
        if !names.insert(name.clone()) {
            let name = name.to_string_lossy();
            return Err(Usage(format!("two files are named {name}; expected names that differ")).into());
        }
    }
    Ok(Places { layout: args.out.join("layout.json"), files })
}

fn export_one(
    args: &ExportArgs,
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
    let window = window(log, args)?;
    output::create_folder(out.parent().unwrap_or(Path::new(".")))?;
    let (about, counts) = (about(recording, &window, args, camera.eyes), Counts::of(log, &window));
    let (from, to) = window.ticks.clone().into_inner();
    let kept = there == Some(Exported { about: about.clone(), is_whole: true });
    let export = Export { file: file.to_owned(), out, from, to, kept, counts };
    if kept {
        return Ok(export);
    }
    let bar = progress::bar("frames", counts.frames as u64);
    let mut sink = Sink::new(PendingFile::new(&export.out)?, about)?;
    film::shoot((log, &network), &window, camera, &mut sink, || {
        bar.inc(1);
        if interrupt.is_raised() {
            bail!("interrupted; nothing of its export is kept");
        }
        Ok(())
    })?;
    sink.finish()?.finish()?;
    bar.finish_and_clear();
    Ok(export)
}

/// The ticks that are asked for.
fn window(log: &Log, args: &ExportArgs) -> anyhow::Result<Window> {
    let (first, last) = (log.first_tick(), log.last_tick());
    let anchor = decisive_tick(log);
    let (from, to) = match args.last {
        Some(length) => ((anchor + 1).saturating_sub(length), anchor),
        None => (args.from.unwrap_or(first), args.to.unwrap_or(last)),
    };
    let ticks = from.max(first)..=to.min(last);
    if ticks.is_empty() {
        let seconds = |tick: Tick| tick as f64 / f64::from(TICK_HZ);
        bail!("holds {:.2} s to {:.2} s of its run, and nothing of that window", seconds(first), seconds(last));
    }
    Ok(Window { ticks, stride: Tick::from(TICK_HZ / args.fps), anchor })
}

/// What the export was made from.
fn about(recording: &Recording, window: &Window, args: &ExportArgs, eyes: &[Eye]) -> BTreeMap<String, String> {
    let eyes: Vec<String> = eyes.iter().map(|eye| format!("{} {}", eye.name(), eye.digest())).collect();
    let entries = [
        ("source", blake3::Hash::from_bytes(recording.digest()).to_hex().to_string()),
        ("ticks", format!("{} to {}", window.ticks.start(), window.ticks.end())),
        ("fps", args.fps.to_string()),
        ("size", format!("{}x{}", args.size.0, args.size.1)),
        ("checkpoints", eyes.join(", ")),
        ("adapter", crate::vision::adapter()),
        ("program", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    entries.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}
