//! A dataset of corner cases: the 3 s up to each takeover at 10 frames a second (paper, section 5), with
//! ground truth. `dataset.json` says which cases, `frames.jsonl` where each frame comes from.

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use kernel::time::{CLIP_FPS, CLIP_TICKS, Tick};
use perception::classes::{TRAIN_CLASSES, TRAIN_ID_OF_TAG};
use render::{Camera, Frame, RenderOptions, Renderer};
use replay::Label;
use serde::Serialize;

use super::cityscapes::{self, Kind, Place};
use super::footage::Footage;
use crate::cli::CasesArgs;
use crate::exit::Verdict;
use crate::output::{self, PendingFolder};
use crate::progress::{self, Interrupt};

/// The content of `dataset.json`.
#[derive(Serialize)]
struct Manifest {
    kind: &'static str,
    split: String,
    size: (u32, u32),
    /// The graphics adapter that drew it; colours depend on it, labels do not.
    adapter: String,
    frames: usize,
    cases: Vec<CaseLine>,
    /// Names of the train ids, in order.
    classes: Vec<&'static str>,
    /// BLAKE3 over `frames.jsonl`.
    digest: String,
}

/// A case of the dataset.
#[derive(Serialize)]
struct CaseLine {
    scene: u32,
    file: String,
    /// Digest of the recording it was cut from, and the window's last tick.
    source: String,
    to: Tick,
    map: String,
    seed: u64,
    label: Option<&'static str>,
}

/// A frame's provenance, a line of `frames.jsonl`.
#[derive(Serialize)]
struct FrameLine<'a> {
    image: String,
    labels: String,
    split: &'a str,
    map: &'a str,
    scene: u32,
    frame: u32,
    source: &'a str,
    tick: Tick,
    state_hash: Option<String>,
    camera: String,
    adapter: &'a str,
    /// Pixels of each class that counts; those that are not in the picture are left out.
    class_pixels: BTreeMap<&'static str, usize>,
    /// BLAKE3 over colour, tags and instances, before they are compressed.
    pixels: String,
}

/// Runs `aeye dataset cases`.
pub fn run(args: &CasesArgs, json: bool) -> anyhow::Result<Verdict> {
    let manifest = make(args, &Interrupt::listen()?)?;
    output::print(json, &manifest, || {
        let (cases, frames, digest) = (manifest.cases.len(), manifest.frames, &manifest.digest);
        format!("{}: {frames} {} frames of {cases} cases, digest {digest}", args.out.display(), manifest.split)
    })?;
    Ok(Verdict::Ok)
}

fn make(args: &CasesArgs, interrupt: &Interrupt) -> anyhow::Result<Manifest> {
    let options = RenderOptions::default();
    let adapter = options.adapter.find()?.name;
    let out = PendingFolder::new(&args.out)?;
    let mut renderers: HashMap<u128, Renderer> = HashMap::new();
    let mut known: HashMap<(String, Tick), PathBuf> = HashMap::new();
    let (mut cases, mut lines) = (Vec::new(), String::new());
    let bar = progress::bar("cases", args.files.len() as u64);
    for (scene, path) in (0..).zip(&args.files) {
        let footage = Footage::read(path, CLIP_TICKS, CLIP_FPS)?;
        let case = case_line(&footage, path, scene)?;
        if let Some(twin) = known.insert((case.source.clone(), case.to), path.clone()) {
            bail!("{}: holds the same case as {}; expected each once", path.display(), twin.display());
        }
        let renderer = match renderers.entry(footage.network.digest) {
            std::collections::hash_map::Entry::Occupied(entry) => entry.into_mut(),
            std::collections::hash_map::Entry::Vacant(entry) => {
                entry.insert(Renderer::new(&footage.network, &options)?)
            }
        };
        for (number, scene) in (0..).zip(&footage.scenes) {
            if interrupt.is_raised() {
                bail!("{}: interrupted; nothing of it is kept", args.out.display());
            }
            let frame = renderer.draw(scene, &Camera::driver(args.size.0, args.size.1))?;
            lines.push_str(&keep(&case, &footage, number, &frame, &args.split, &adapter, out.path())?);
            lines.push('\n');
        }
        cases.push(case);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let write = |name: &str, text: &str| {
        let path = out.path().join(name);
        fs::write(&path, text).with_context(|| path.display().to_string())
    };
    write("frames.jsonl", &lines)?;
    let manifest = Manifest {
        kind: "cases",
        split: args.split.clone(),
        size: args.size,
        adapter,
        frames: lines.lines().count(),
        cases,
        classes: TRAIN_CLASSES.iter().map(|c| c.name).collect(),
        digest: blake3::hash(lines.as_bytes()).to_hex().to_string(),
    };
    write("dataset.json", &output::json_file(&manifest)?)?;
    out.finish()?;
    Ok(manifest)
}

fn case_line(footage: &Footage, path: &Path, scene: u32) -> anyhow::Result<CaseLine> {
    let log = &footage.log;
    let info = log.manifest.case.as_ref();
    let info = info.with_context(|| format!("{}: is a recording, expected a corner case", path.display()))?;
    Ok(CaseLine {
        scene,
        file: footage.name.clone(),
        source: blake3::Hash::from_bytes(info.source).to_hex().to_string(),
        to: info.to,
        map: footage.network.name.replace('_', "-"),
        seed: log.manifest.scenario.seed,
        label: log.annotation.as_ref().map(|annotation| Label::name(annotation.label)),
    })
}

fn keep(
    case: &CaseLine,
    footage: &Footage,
    number: u32,
    frame: &Frame,
    split: &str,
    adapter: &str,
    out: &Path,
) -> anyhow::Result<String> {
    let place = Place { split, city: &case.map, scene: case.scene, frame: number };
    cityscapes::write(out, &place, frame)?;
    Ok(serde_json::to_string(&FrameLine {
        image: place.path(Kind::Image),
        labels: place.path(Kind::TrainIds),
        split,
        map: &case.map,
        scene: case.scene,
        frame: number,
        source: &case.source,
        tick: frame.tick,
        state_hash: footage.log.hash(frame.tick).map(|hash| format!("{hash:08x}")),
        camera: format!("driver {}x{}", frame.width, frame.height),
        adapter,
        class_pixels: class_pixels(frame),
        pixels: cityscapes::digest(frame),
    })?)
}

fn class_pixels(frame: &Frame) -> BTreeMap<&'static str, usize> {
    let mut pixels = BTreeMap::new();
    for tag in &frame.class_ids {
        if let Some(class) = TRAIN_CLASSES.get(usize::from(TRAIN_ID_OF_TAG[usize::from(*tag)])) {
            *pixels.entry(class.name).or_insert(0) += 1;
        }
    }
    pixels
}
