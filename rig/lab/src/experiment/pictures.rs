//! Pictures of corner cases: what both drivers saw, and what each network makes of it.

use std::path::{Path, PathBuf};

use anyhow::Context;
use base::png;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use drivers::checkpoint::CheckpointChoice;
use kernel::time::{CLIP_FPS, CLIP_TICKS};
use measures::footage::Footage;
use perception::ConfusionMatrix;
use render::Imaging;
use serde::Serialize;

use crate::figures::{Figures, decimal};
use crate::looks::{Studio, look, open_eyes};
use crate::report::Seen;

/// Cases that are shown, at most.
const CASES: usize = 4;
/// Frames before the takeover of the picture that is shown: half a second.
const BEFORE: usize = 5;

/// A case half a second before its takeover.
#[derive(Serialize)]
pub struct Shot {
    name: String,
    cells: Vec<Cell>,
}

/// A picture.
#[derive(Serialize)]
struct Cell {
    class: &'static str,
    png: String,
    caption: String,
}

/// What the camera saw of the first cases, the truth if it is asked for, and what each checkpoint predicts.
pub fn shots(
    cases: &[PathBuf],
    checkpoints: &[PathBuf],
    (size, imaging): ((u32, u32), Imaging),
    with_truth: bool,
    seen: &mut Seen,
) -> anyhow::Result<Vec<Shot>> {
    let choices: Vec<_> = checkpoints.iter().cloned().map(CheckpointChoice::File).collect();
    let (mut eyes, _) = open_eyes(&choices, Some(size))?;
    let mut studio = Studio::new(size, imaging);
    let mut shots = Vec::new();
    for path in cases.iter().take(CASES) {
        let footage = Footage::read(path, CLIP_TICKS, CLIP_FPS)?;
        let scene = footage.scenes.iter().rev().nth(BEFORE).with_context(|| path.display().to_string())?;
        let frame = studio.draw(&footage.network, scene)?;
        let masks = look(&mut eyes, &frame)?;
        let mut mask = |ids: &[u8], caption| -> anyhow::Result<Cell> {
            seen.add(ids);
            Ok(Cell { class: "mask", png: STANDARD.encode(png::tags(size, ids)?), caption })
        };
        let mut cells =
            vec![Cell { class: "rgb", png: STANDARD.encode(png::rgb(size, &frame.rgb)?), caption: "camera".into() }];
        if with_truth {
            cells.push(mask(&frame.class_ids, "ground truth".into())?);
        }
        for (eye, predicted) in eyes.iter().zip(&masks) {
            let mut matrix = ConfusionMatrix::default();
            matrix.add(&frame.class_ids, &predicted.ids);
            let iou = decimal(Figures::from(&matrix).pedestrian_iou);
            cells.push(mask(&predicted.ids, format!("{}, IoU pedestrian {iou}", eye.name()))?);
        }
        shots.push(Shot { name: name_of(path), cells });
    }
    Ok(shots)
}

/// Name of a file without its endings.
pub fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.split('.').next().unwrap_or_default().to_owned()
}
