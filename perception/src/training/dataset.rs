//! A dataset folder in the layout of Cityscapes:
//! `leftImg8bit/SPLIT/SCENE/NAME_leftImg8bit.png` with
//! `gtFine/SPLIT/SCENE/NAME_gtFine_labelTrainIds.png` (train ids; 255 counts nowhere) and, where people are told
//! apart, `NAME_gtFine_instanceIds.png` (16 bits). Frames are kept as bytes: 4 for each pixel.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::people::{Person, people};
use crate::PerceptionError;
use crate::cityscapes::{IMAGE_ENDING, Kind, sibling};
use crate::classes::{IGNORE, TRAIN_CLASSES};

/// A picture with its ground truth.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Frame {
    /// Row by row; red, green, blue.
    pub rgb: Vec<u8>,
    /// Train ids, row by row.
    pub labels: Vec<u8>,
    /// Who is seen, where instance ids were read.
    pub people: Vec<Person>,
}

/// A part of a dataset, in memory.
#[derive(Clone, Debug)]
pub struct Split {
    /// In the order of their paths.
    pub frames: Vec<Frame>,
    /// Of all.
    pub width: usize,
    /// Of all.
    pub height: usize,
    /// BLAKE3 over names and files, in order.
    pub digest: blake3::Hash,
}

/// Frames may be so many times as wide as the network's input: 16 times as many pixels to keep.
const LARGEST_SCALE: usize = 4;

impl Split {
    /// Reads one split (`train`, `val`) whose pictures must all have one size.
    pub fn read(dataset: &Path, split: &str, width: usize, height: usize) -> Result<Self, PerceptionError> {
        Self::read_for(dataset, split, (width, height), false)
    }

    /// The same for a network whose input has a size: pictures have that size, or all have one that is larger by the
    /// same share in both directions. With `knows_people` instance ids are read, too.
    pub(super) fn read_for(
        dataset: &Path,
        split: &str,
        input: (usize, usize),
        knows_people: bool,
    ) -> Result<Self, PerceptionError> {
        let paths = image_paths(&dataset.join("leftImg8bit").join(split))?;
        let (width, height) = frame_size(&paths[0], input)?;
        let read_one = |path: &PathBuf| read_frame(path, width, height, knows_people);
        let read: Vec<(Frame, blake3::Hash)> = paths.par_iter().map(read_one).collect::<Result<_, _>>()?;
        let mut digest = blake3::Hasher::new();
        for (path, (_, hash)) in paths.iter().zip(&read) {
            let name = path.strip_prefix(dataset).unwrap_or(path);
            digest.update(name.to_string_lossy().as_bytes()).update(hash.as_bytes());
        }
        let frames = read.into_iter().map(|(frame, _)| frame).collect();
        Ok(Self { frames, width, height, digest: digest.finalize() })
    }
}

/// The size of all frames, which is the first one's.
fn frame_size(path: &Path, (width, height): (usize, usize)) -> Result<(usize, usize), PerceptionError> {
    let file = read_file(path)?;
    let reader = png::Decoder::new(Cursor::new(&file)).read_info().map_err(|e| bad(path, e.to_string()))?;
    let (w, h) = (reader.info().width as usize, reader.info().height as usize);
    if w < width || w > LARGEST_SCALE * width || w * height != h * width {
        let (most_w, most_h) = (LARGEST_SCALE * width, LARGEST_SCALE * height);
        let reason = format!(
            "{w}x{h} pixels; expected {width}x{height}, or more of the same proportions up to {most_w}x{most_h}"
        );
        return Err(bad(path, reason));
    }
    Ok((w, h))
}

fn read_file(path: &Path) -> Result<Vec<u8>, PerceptionError> {
    intake::read(path, intake::most::PICTURE).map_err(|source| PerceptionError::Io { path: path.to_owned(), source })
}

fn bad(path: &Path, reason: impl Into<String>) -> PerceptionError {
    PerceptionError::Dataset { path: path.to_owned(), reason: reason.into() }
}

/// All pictures of the folder of a split, `leftImg8bit/SPLIT`, sorted; at least one.
pub fn image_paths(split: &Path) -> Result<Vec<PathBuf>, PerceptionError> {
    let mut found = Vec::new();
    for scene in entries(split)?.iter().filter(|p| p.is_dir()) {
        found.extend(entries(scene)?.into_iter().filter(|p| p.to_string_lossy().ends_with(IMAGE_ENDING)));
    }
    if found.is_empty() {
        return Err(bad(split, format!("no pictures; expected SCENE/NAME{IMAGE_ENDING}")));
    }
    found.sort();
    Ok(found)
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, PerceptionError> {
    let io = |source| PerceptionError::Io { path: folder.to_owned(), source };
    fs::read_dir(folder).map_err(io)?.map(|entry| entry.map(|e| e.path()).map_err(io)).collect()
}

fn read_frame(
    image: &Path,
    width: usize,
    height: usize,
    knows_people: bool,
) -> Result<(Frame, blake3::Hash), PerceptionError> {
    let label = truth(image, Kind::TrainIds)?;
    let mut digest = blake3::Hasher::new();
    let rgb = read_png(image, 3, width, height, &mut digest)?;
    let labels = read_png(&label, 1, width, height, &mut digest)?;
    check_train_ids(&label, &labels)?;
    let people = if knows_people {
        let bytes = read_png(&truth(image, Kind::InstanceIds)?, 2, width, height, &mut digest)?;
        let instances: Vec<u16> = bytes.as_chunks::<2>().0.iter().map(|id| u16::from_be_bytes(*id)).collect();
        people(&instances, width)
    } else {
        Vec::new()
    };
    Ok((Frame { rgb, labels, people }, digest.finalize()))
}

/// A file of ground truth of a picture, which must be there.
fn truth(image: &Path, kind: Kind) -> Result<PathBuf, PerceptionError> {
    let path = sibling(image, kind).ok_or_else(|| bad(image, "is no picture of a split"))?;
    if path.is_file() {
        return Ok(path);
    }
    Err(bad(&path, format!("is missing; expected the ground truth of {}", image.display())))
}

/// Refuses labels of a file that are neither train ids nor ignored.
pub fn check_train_ids(label: &Path, ids: &[u8]) -> Result<(), PerceptionError> {
    let last = TRAIN_CLASSES.len() - 1;
    match ids.iter().find(|id| **id != IGNORE && usize::from(**id) > last) {
        Some(id) => Err(bad(label, format!("holds train id {id}; expected 0 to {last} or {IGNORE}"))),
        None => Ok(()),
    }
}

/// The samples of an 8-bit PNG, palette indices included, without expansion.
fn read_png(
    path: &Path,
    samples: usize,
    width: usize,
    height: usize,
    digest: &mut blake3::Hasher,
) -> Result<Vec<u8>, PerceptionError> {
    let file = read_file(path)?;
    digest.update(&file);
    let mut decoder = png::Decoder::new(Cursor::new(&file));
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().map_err(|e| bad(path, e.to_string()))?;
    let info = reader.info();
    let found = (info.width as usize, info.height as usize, info.bits_per_pixel());
    if found != (width, height, 8 * samples) {
        let (w, h, bits) = found;
        return Err(bad(
            path,
            format!("{w}x{h} with {bits} bits a pixel; expected {width}x{height} with {}", 8 * samples),
        ));
    }
    let mut bytes = vec![0; width * height * samples];
    reader.next_frame(&mut bytes).map_err(|e| bad(path, e.to_string()))?;
    Ok(bytes)
}
