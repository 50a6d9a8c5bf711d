//! Renders the window of recordings or cases through checkpoints.
//!
//! `OUT/NAME/rgb/TICK.png`, `OUT/NAME/labels/TICK.png`, `OUT/NAME/predictions/CHECKPOINT/TICK.png`
//! (ids are tags of CARLA 0.9.10), and `OUT/metrics.jsonl`: a line for each frame and checkpoint, for
//! each file and checkpoint, and for each checkpoint over all.

use std::fs;
use std::path::Path;

use anyhow::Context;
use kernel::time::Tick;
use perception::{ConfusionMatrix, Mask};
use render::Frame;
use serde::Serialize;

use super::figures::{Figures, table};
use super::footage::{Footage, is_divergence};
use super::looks::{Studio, look, open_eyes};
use super::png;
use crate::cli::RerenderArgs;
use crate::exit::{Usage, Verdict, sentence};
use crate::output::{self, PendingFolder, json_line};
use crate::progress;
use crate::vision::Eye;

/// A line of `metrics.jsonl`.
#[derive(Serialize)]
struct Line<'a> {
    /// What it sums over: `frame`, `file` or `overall`.
    over: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tick: Option<Tick>,
    checkpoint: &'a str,
    #[serde(flatten)]
    figures: Figures,
}

/// What the command prints.
#[derive(Serialize)]
struct Summary {
    out: String,
    files: usize,
    frames: usize,
    checkpoints: Vec<Seen>,
}

#[derive(Serialize)]
struct Seen {
    name: String,
    digest: String,
    #[serde(flatten)]
    figures: Figures,
}

/// Runs `aeye rerender`.
pub fn run(args: &RerenderArgs, json: bool) -> anyhow::Result<Verdict> {
    match rerender(args) {
        Ok(summary) => {
            output::print(json, &summary, || text(&summary))?;
            Ok(Verdict::Ok)
        }
        Err(error) if is_divergence(&error) => {
            eprintln!("error: {}", sentence(&error));
            Ok(Verdict::CheckFailed)
        }
        Err(error) => Err(error),
    }
}

fn text(summary: &Summary) -> String {
    let columns: Vec<_> = summary.checkpoints.iter().map(|c| (c.name.clone(), c.figures.clone())).collect();
    let Summary { out, files, frames, .. } = summary;
    format!("{}\n{frames} frames of {files} files in {out}", table(&columns))
}

fn rerender(args: &RerenderArgs) -> anyhow::Result<Summary> {
    let mut eyes = open_eyes(&args.checkpoint, args.size)?;
    let mut studio = Studio::new(args.size)?;
    let out = PendingFolder::new(&args.out)?;
    let mut overall = vec![ConfusionMatrix::default(); eyes.len()];
    let mut metrics = String::new();
    let mut frames = 0;
    let bar = progress::bar("files", args.files.len() as u64);
    for path in &args.files {
        let footage = Footage::read(path, args.last, args.fps)?;
        let folder = out.path().join(&footage.name);
        if folder.exists() {
            return Err(Usage(format!("two files are named {}; expected names that differ", footage.name)).into());
        }
        let matrices = shoot(&footage, &mut studio, &mut eyes, &folder, &mut metrics)?;
        for ((eye, overall), matrix) in eyes.iter().zip(&mut overall).zip(&matrices) {
            overall.merge(matrix);
            line(&mut metrics, "file", Some(&footage.name), None, eye, matrix)?;
        }
        frames += footage.scenes.len();
        bar.inc(1);
    }
    bar.finish_and_clear();
    for (eye, matrix) in eyes.iter().zip(&overall) {
        line(&mut metrics, "overall", None, None, eye, matrix)?;
    }
    let path = out.path().join("metrics.jsonl");
    fs::write(&path, metrics).with_context(|| path.display().to_string())?;
    out.finish()?;
    let seen = |(eye, matrix): (&Eye, &ConfusionMatrix)| Seen {
        name: eye.name().to_owned(),
        digest: eye.digest(),
        figures: matrix.into(),
    };
    let checkpoints = eyes.iter().zip(&overall).map(seen).collect();
    Ok(Summary { out: args.out.display().to_string(), files: args.files.len(), frames, checkpoints })
}

/// Writes the pictures of a window; gives the matrix of each eye over it.
fn shoot(
    footage: &Footage,
    studio: &mut Studio,
    eyes: &mut [Eye],
    folder: &Path,
    metrics: &mut String,
) -> anyhow::Result<Vec<ConfusionMatrix>> {
    let mut sums = vec![ConfusionMatrix::default(); eyes.len()];
    for scene in &footage.scenes {
        let frame = studio.draw(&footage.network, scene)?;
        let masks = look(eyes, &frame)?;
        write_pictures(folder, &frame, eyes, &masks)?;
        for ((eye, mask), sum) in eyes.iter().zip(&masks).zip(&mut sums) {
            let mut matrix = ConfusionMatrix::default();
            matrix.add(&frame.class_ids, &mask.ids);
            line(metrics, "frame", Some(&footage.name), Some(scene.tick), eye, &matrix)?;
            sum.merge(&matrix);
        }
    }
    Ok(sums)
}

fn write_pictures(folder: &Path, frame: &Frame, eyes: &[Eye], masks: &[Mask]) -> anyhow::Result<()> {
    let size = (frame.width, frame.height);
    let write = |below: &str, bytes: Vec<u8>| {
        let path = folder.join(below).join(format!("{:08}.png", frame.tick));
        fs::create_dir_all(folder.join(below)).with_context(|| path.display().to_string())?;
        fs::write(&path, bytes).with_context(|| path.display().to_string())
    };
    write("rgb", png::rgb(size, &frame.rgb)?)?;
    write("labels", png::tags(size, &frame.class_ids)?)?;
    for (eye, mask) in eyes.iter().zip(masks) {
        write(&format!("predictions/{}", eye.name()), png::tags(size, &mask.ids)?)?;
    }
    Ok(())
}

fn line(
    metrics: &mut String,
    over: &str,
    file: Option<&str>,
    tick: Option<Tick>,
    eye: &Eye,
    matrix: &ConfusionMatrix,
) -> anyhow::Result<()> {
    let line = Line { over, file, tick, checkpoint: eye.name(), figures: matrix.into() };
    metrics.push_str(&json_line(&line)?);
    metrics.push('\n');
    Ok(())
}
