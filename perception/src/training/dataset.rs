//! A dataset folder in the layout of Cityscapes:
//! `leftImg8bit/SPLIT/SCENE/NAME_leftImg8bit.png` with
//! `gtFine/SPLIT/SCENE/NAME_gtFine_labelTrainIds.png` (train ids; 255 counts nowhere).

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

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

impl Split {
    /// Reads one split (`train`, `val`) whose pictures must all have one size.
    pub fn read(dataset: &Path, split: &str, width: usize, height: usize) -> Result<Self, PerceptionError> {
        let paths = image_paths(&dataset.join("leftImg8bit").join(split))?;
        let read: Vec<(Frame, blake3::Hash)> =
            paths.par_iter().map(|path| read_frame(path, width, height)).collect::<Result<_, _>>()?;
        let mut digest = blake3::Hasher::new();
        for (path, (_, hash)) in paths.iter().zip(&read) {
            let name = path.strip_prefix(dataset).unwrap_or(path);
            digest.update(name.to_string_lossy().as_bytes()).update(hash.as_bytes());
        }
        let frames = read.into_iter().map(|(frame, _)| frame).collect();
        Ok(Self { frames, width, height, digest: digest.finalize() })
    }
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

fn read_frame(image: &Path, width: usize, height: usize) -> Result<(Frame, blake3::Hash), PerceptionError> {
    let label = sibling(image, Kind::TrainIds).ok_or_else(|| bad(image, "is no picture of a split"))?;
    if !label.is_file() {
        return Err(bad(&label, format!("is missing; expected the ground truth of {}", image.display())));
    }
    let mut digest = blake3::Hasher::new();
    let rgb = read_png(image, 3, width, height, &mut digest)?;
    let labels = read_png(&label, 1, width, height, &mut digest)?;
    check_train_ids(&label, &labels)?;
    Ok((Frame { rgb, labels }, digest.finalize()))
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
    let file = intake::read(path, intake::most::PICTURE)
        .map_err(|source| PerceptionError::Io { path: path.to_owned(), source })?;
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
