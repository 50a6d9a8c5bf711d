//! The frames of a split, read from a dataset folder.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::png;
use perception::cityscapes::{IMAGE_ENDING, Kind, sibling};
use perception::classes::tag_of_train_id;
use perception::training::{check_train_ids, image_paths};
use render::Frame;

/// A picture with its ground truth.
pub(super) struct Labelled {
    /// Colour, and classes in tags.
    pub(super) frame: Frame,
    /// Tag * 1000 + number for road users, else the tag.
    pub(super) instances: Vec<u16>,
}

/// All pictures of a split, sorted.
pub(super) fn images(dataset: &Path, split: &str) -> anyhow::Result<Vec<PathBuf>> {
    let top = dataset.join("leftImg8bit");
    let folder = top.join(split);
    if folder.is_dir() {
        return Ok(image_paths(&folder)?);
    }
    match splits(&top).as_slice() {
        [] => bail!("{}: holds no split; expected a dataset in the layout of Cityscapes", top.display()),
        there => bail!("{}: has no split {split}; expected --split {}", dataset.display(), there.join(" or ")),
    }
}

/// Names of the folders below, sorted.
fn splits(top: &Path) -> Vec<String> {
    let entries = fs::read_dir(top).into_iter().flatten().flatten();
    let folders = entries.filter(|entry| entry.path().is_dir());
    let mut names: Vec<String> = folders.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// City and sequence of a picture, as its name tells: what stands before the number of the frame.
pub(super) fn scene(image: &Path) -> String {
    let stem = name(image);
    stem.rsplit_once('_').map_or(stem.as_str(), |(scene, _)| scene).to_owned()
}

/// The name of a picture's files without their endings: `CITY_SEQ_FRAME`.
pub(super) fn name(image: &Path) -> String {
    let file = image.file_name().unwrap_or_default().to_string_lossy();
    file.strip_suffix(IMAGE_ENDING).unwrap_or(&file).to_owned()
}

/// Reads a picture with its ground truth.
pub(super) fn read(image: &Path) -> anyhow::Result<Labelled> {
    let (size, rgb) = png::read(image, 3)?;
    let (labels, ids) = truth(image, Kind::TrainIds, size, 1)?;
    check_train_ids(&labels, &ids)?;
    let (_, instances) = truth(image, Kind::InstanceIds, size, 2)?;
    let instances = instances.as_chunks::<2>().0.iter().map(|id| u16::from_be_bytes(*id)).collect();
    let class_ids = ids.into_iter().map(tag_of_train_id).collect();
    Ok(Labelled { frame: Frame { width: size.0, height: size.1, rgb, class_ids, ..Frame::default() }, instances })
}

/// A file of ground truth of a picture, with its bytes.
fn truth(image: &Path, kind: Kind, size: (u32, u32), samples: usize) -> anyhow::Result<(PathBuf, Vec<u8>)> {
    let path = sibling(image, kind).with_context(|| image.display().to_string())?;
    if !path.is_file() {
        bail!("{}: is missing; expected the ground truth of {}", path.display(), image.display());
    }
    let (found, bytes) = png::read(&path, samples)?;
    if found != size {
        let ((width, height), (w, h)) = (found, size);
        bail!("{}: {width}x{height} pixels; expected {w}x{h} like its picture", path.display());
    }
    Ok((path, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_split_that_is_not_there_is_refused_with_those_that_are() {
        let dir = tempfile::tempdir().expect("a folder");
        let said = || images(dir.path(), "val").expect_err("no such split").to_string();
        assert!(said().ends_with("holds no split; expected a dataset in the layout of Cityscapes"), "{}", said());
        ["train", "test"].iter().for_each(|split| {
            fs::create_dir_all(dir.path().join("leftImg8bit").join(split)).expect("writable");
        });
        assert!(said().ends_with("has no split val; expected --split test or train"), "{}", said());
    }
}
