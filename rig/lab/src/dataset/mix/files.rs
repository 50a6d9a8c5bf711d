//! The files of a mix: links to those of its parts, once it is certain that these are whole.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use anyhow::{Context, bail};
use base::png;
use base::progress::{self, Interrupt};
use perception::cityscapes::Kind;
use rayon::prelude::*;

use super::Dataset;
use crate::cityscapes::train_ids;
use crate::dataset::provenance::{self, FrameLine, Part};

/// Where the scenes of other parts begin, so that no two frames have one name.
const FIRST_SCENE: [(Part, u32); 3] = [(Part::Natural, 0), (Part::Pool, 100_000), (Part::Cases, 200_000)];

/// Links frames into a folder; gives their lines there, in the same order.
pub fn link(
    frames: &[(&Dataset, &FrameLine, Part)],
    folder: &Path,
    interrupt: &Interrupt,
) -> anyhow::Result<Vec<FrameLine>> {
    let bar = progress::bar("frames", frames.len() as u64);
    let link = |(dataset, line, part): &(&Dataset, &FrameLine, Part)| {
        check_interrupt(interrupt)?;
        check_frame(&dataset.folder, line)?;
        let moved = moved(line, *part);
        for kind in Kind::ALL {
            link_file(&dataset.folder.join(line.place().path(kind)), &folder.join(moved.place().path(kind)))?;
        }
        bar.inc(1);
        Ok(moved)
    };
    let lines = frames.par_iter().map(link).collect();
    bar.finish_and_clear();
    lines
}

/// Links a whole dataset.
pub fn copy(dataset: &Dataset, folder: &Path, interrupt: &Interrupt) -> anyhow::Result<()> {
    dataset.frames.par_iter().try_for_each(|line| {
        check_interrupt(interrupt)?;
        check_frame(&dataset.folder, line)
    })?;
    copy_folder(&dataset.folder, folder)
}

fn copy_folder(from: &Path, to: &Path) -> anyhow::Result<()> {
    let context = || from.display().to_string();
    for entry in fs::read_dir(from).with_context(context)? {
        let path = entry.with_context(context)?.path();
        let target = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() { copy_folder(&path, &target)? } else { link_file(&path, &target)? }
    }
    Ok(())
}

fn check_interrupt(interrupt: &Interrupt) -> anyhow::Result<()> {
    if interrupt.is_raised() {
        bail!("interrupted; nothing of the mix is kept");
    }
    Ok(())
}

fn link_file(from: &Path, to: &Path) -> anyhow::Result<()> {
    let folder = to.parent().unwrap_or(to);
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    match fs::hard_link(from, to) {
        Ok(()) => Ok(()),
        // A copy would write through the link that is there, into its source.
        Err(e) if e.kind() == ErrorKind::AlreadyExists => {
            bail!("{}: two frames have this name; expected parts that are no mixes themselves", to.display())
        }
        Err(_) => {
            let copied = fs::copy(from, to).with_context(|| format!("{} to {}", from.display(), to.display()));
            copied.map(|_| ())
        }
    }
}

/// A frame's line where it goes.
fn moved(line: &FrameLine, part: Part) -> FrameLine {
    let first = FIRST_SCENE.iter().find(|(p, _)| *p == part).map_or(0, |(_, first)| *first);
    let mut moved = FrameLine { scene: first + line.scene, part: Some(part), ..line.clone() };
    (moved.image, moved.labels) = (moved.place().path(Kind::Image), moved.place().path(Kind::TrainIds));
    moved
}

/// Whether a frame's files hold what its line says.
fn check_frame(folder: &Path, line: &FrameLine) -> anyhow::Result<()> {
    let path = |kind| folder.join(line.place().path(kind));
    let changed = |kind| format!("{}: was changed since; expected what frames.jsonl tells", path(kind).display());
    let (size, rgb) = png::read(&path(Kind::Image), 3)?;
    let read = |kind, samples| -> anyhow::Result<Vec<u8>> {
        let (found, ids) = png::read(&path(kind), samples)?;
        if found != size {
            let ((w, h), (width, height)) = (found, size);
            bail!("{}: {w}x{h}; expected {width}x{height} like its picture", path(kind).display());
        }
        Ok(ids)
    };
    if blake3::hash(&rgb).to_hex().as_str() != line.rgb_digest {
        bail!(changed(Kind::Image));
    }
    let (labels, train) = (read(Kind::LabelIds, 1)?, read(Kind::TrainIds, 1)?);
    let instances = read(Kind::InstanceIds, 2)?;
    let instances: Vec<u16> = instances.chunks_exact(2).map(|b| u16::from_be_bytes([b[0], b[1]])).collect();
    if provenance::labels_digest(&labels, &instances) != line.labels_digest {
        bail!(changed(Kind::LabelIds));
    }
    if train != train_ids(&labels) {
        bail!(changed(Kind::TrainIds));
    }
    Ok(())
}
