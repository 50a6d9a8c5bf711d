//! Measures a checkpoint on a split of a dataset folder.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use perception::ConfusionMatrix;
use perception::classes::tag_of_train_id;
use render::Frame;
use serde::Serialize;

use super::cityscapes::{Kind, sibling};
use super::figures::{Figures, table};
use super::png;
use crate::cli::EvalArgs;
use crate::exit::Verdict;
use crate::output;
use crate::progress;
use crate::vision::Eye;

/// What the command prints.
#[derive(Serialize)]
struct Summary {
    checkpoint: String,
    digest: String,
    dataset: String,
    split: String,
    frames: usize,
    #[serde(flatten)]
    figures: Figures,
}

/// Runs `aeye eval`.
pub fn run(args: &EvalArgs, json: bool) -> anyhow::Result<Verdict> {
    let images = images(&args.dataset, &args.split)?;
    let bar = progress::bar("frames", images.len() as u64);
    let mut matrix = ConfusionMatrix::default();
    let mut eye: Option<Eye> = None;
    for image in &images {
        let frame = read(image)?;
        let size = (frame.width, frame.height);
        let eye = match &mut eye {
            Some(eye) if sees(eye, size) => eye,
            other => other.insert(Eye::open_at(&args.checkpoint, size)?),
        };
        let truth = frame.class_ids.clone();
        matrix.add(&truth, &eye.see(frame)?.ids);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let eye = eye.context("an eye")?;
    let summary = Summary {
        checkpoint: eye.name().to_owned(),
        digest: eye.digest(),
        dataset: args.dataset.display().to_string(),
        split: args.split.clone(),
        frames: images.len(),
        figures: (&matrix).into(),
    };
    output::print(json, &summary, || {
        let columns = [(summary.checkpoint.clone(), summary.figures.clone())];
        format!("{}\n{} frames of {}", table(&columns), summary.frames, args.split)
    })?;
    Ok(Verdict::Ok)
}

/// Whether an eye is ready for pictures of a size.
fn sees(eye: &Eye, size: (u32, u32)) -> bool {
    matches!(eye, Eye::Truth) || eye.size() == size
}

/// All pictures of a split, sorted.
fn images(dataset: &Path, split: &str) -> anyhow::Result<Vec<PathBuf>> {
    let top = dataset.join("leftImg8bit").join(split);
    let mut found = Vec::new();
    for city in entries(&top)?.iter().filter(|path| path.is_dir()) {
        found.extend(entries(city)?.into_iter().filter(|path| path.to_string_lossy().ends_with("_leftImg8bit.png")));
    }
    if found.is_empty() {
        bail!("{}: no pictures; expected CITY/NAME_leftImg8bit.png", top.display());
    }
    found.sort();
    Ok(found)
}

fn entries(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let context = || folder.display().to_string();
    fs::read_dir(folder).with_context(context)?.map(|entry| Ok(entry.with_context(context)?.path())).collect()
}

/// A picture with its ground truth, in tags.
fn read(image: &Path) -> anyhow::Result<Frame> {
    let labels = sibling(image, Kind::TrainIds).with_context(|| image.display().to_string())?;
    let ((width, height), rgb) = png::read(image, 3)?;
    let (size, ids) = png::read(&labels, 1)?;
    if size != (width, height) {
        bail!("{}: {}x{}; expected {width}x{height} like its picture", labels.display(), size.0, size.1);
    }
    let class_ids = ids.into_iter().map(tag_of_train_id).collect();
    Ok(Frame { width, height, rgb, class_ids, ..Frame::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::CheckpointChoice;
    use crate::lab::cityscapes::{Place, write};

    #[test]
    fn truth_is_perfect_and_ignored_pixels_stay_ignored() {
        let dir = tempfile::tempdir().expect("a folder");
        let frame = Frame {
            width: 2,
            height: 2,
            rgb: vec![9; 12],
            class_ids: vec![7, 4, 14, 13],
            instance_ids: vec![0; 4],
            ..Frame::default()
        };
        let place = Place { split: "val", city: "city", scene: 0, frame: 0 };
        write(dir.path(), &place, &frame).expect("written");
        let back = read(&images(dir.path(), "val").expect("one")[0]).expect("reads back");
        assert_eq!((back.rgb, back.class_ids), (frame.rgb, vec![7, 4, 0, 13]));
        let args =
            EvalArgs { checkpoint: CheckpointChoice::Truth, dataset: dir.path().to_owned(), split: "val".into() };
        assert_eq!(run(&args, true).expect("runs"), Verdict::Ok);
        assert!(images(dir.path(), "test").is_err());
    }
}
