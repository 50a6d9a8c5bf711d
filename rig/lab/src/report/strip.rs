//! The pictures of a case: a row for the camera, the ground truth and each checkpoint, a column a
//! frame.

use base::png;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use drivers::recorded_eye;
use drivers::vision::Eye;
use kernel::time::{CLIP_STRIDE_TICKS, TICK_HZ, Tick};
use measures::footage::Footage;
use perception::classes::PEDESTRIAN_TAG;
use perception::{ConfusionMatrix, Mask};
use render::Frame;
use serde::Serialize;

use super::super::figures::{Figures, decimal};

/// Frames from one that is always on the page to the next; the others are in the player.
const KEY_FRAMES: Tick = 5;

/// A column.
#[derive(Serialize)]
pub struct Moment {
    /// When it is, seen from the end.
    text: String,
    /// Whether it is always on the page.
    key: bool,
}

#[derive(Serialize)]
struct Picture {
    png: String,
    caption: String,
}

/// A row.
#[derive(Serialize)]
pub struct PictureRow {
    name: String,
    /// What else there is to say about the row.
    note: &'static str,
    class: &'static str,
    cells: Vec<Picture>,
}

/// Which tags appear in pictures.
pub struct Seen([bool; 256]);

impl Seen {
    /// Nothing yet.
    pub fn nothing() -> Self {
        Self([false; 256])
    }

    /// Whether a tag appears.
    pub fn has(&self, tag: u8) -> bool {
        self.0[usize::from(tag)]
    }

    /// Adds what other pictures show.
    pub fn merge(&mut self, other: &Self) {
        self.0.iter_mut().zip(other.0).for_each(|(seen, other)| *seen |= other);
    }

    /// Adds what a picture shows.
    pub fn add(&mut self, ids: &[u8]) {
        ids.iter().for_each(|id| self.0[usize::from(*id)] = true);
    }
}

/// The pictures of a case, as they are added.
pub struct Strip {
    last: Tick,
    /// What the last frame shows.
    end: &'static str,
    pub(super) moments: Vec<Moment>,
    pub(super) rows: Vec<PictureRow>,
    matrices: Vec<ConfusionMatrix>,
}

impl Strip {
    /// An empty strip for the frames of a window.
    pub fn new(eyes: &[Eye], footage: &Footage) -> Self {
        let last = footage.scenes.last().map_or(0, |scene| scene.tick);
        let end = if footage.log.intervention.is_some() { "takeover" } else { "collision" };
        let driver = recorded_eye::digest_of(&footage.log.manifest.provenance);
        let row = |name: &str, note, class| PictureRow { name: name.to_owned(), note, class, cells: Vec::new() };
        let mut rows = vec![row("camera", "", "rgb"), row("ground truth", "", "mask")];
        rows.extend(eyes.iter().map(|eye| {
            let drove = driver.as_ref().is_some_and(|digest| *digest == eye.digest());
            row(eye.name(), if drove { "drove" } else { "looks on" }, "mask")
        }));
        Self { last, end, moments: Vec::new(), rows, matrices: vec![ConfusionMatrix::default(); eyes.len()] }
    }

    /// Adds a frame and what each eye made of it.
    pub fn add(&mut self, frame: &Frame, masks: &[Mask], seen: &mut Seen) -> anyhow::Result<()> {
        let size = (frame.width, frame.height);
        self.moments.push(self.moment(self.last - frame.tick));
        let mut mask = |ids: &[u8], caption| -> anyhow::Result<Picture> {
            seen.add(ids);
            Ok(Picture { png: STANDARD.encode(png::tags(size, ids)?), caption })
        };
        let mut pictures = vec![
            Picture { png: STANDARD.encode(png::rgb(size, &frame.rgb)?), caption: String::new() },
            mask(&frame.class_ids, pedestrian_pixels(frame))?,
        ];
        for (predicted, sum) in masks.iter().zip(&mut self.matrices) {
            let mut matrix = ConfusionMatrix::default();
            matrix.add(&frame.class_ids, &predicted.ids);
            let Figures { pedestrian_iou, miou, .. } = Figures::from(&matrix);
            let caption = format!("IoU pedestrian {}, mean {}", decimal(pedestrian_iou), decimal(miou));
            pictures.push(mask(&predicted.ids, caption)?);
            sum.merge(&matrix);
        }
        self.rows.iter_mut().zip(pictures).for_each(|(row, picture)| row.cells.push(picture));
        Ok(())
    }

    fn moment(&self, before: Tick) -> Moment {
        let seconds = before as f64 / f64::from(TICK_HZ);
        let text = if before > 0 { format!("\u{2212}{seconds:.1} s") } else { self.end.into() };
        Moment { text, key: before.is_multiple_of(KEY_FRAMES * CLIP_STRIDE_TICKS) }
    }

    /// The matrix of each eye over all frames.
    pub fn matrices(&self) -> &[ConfusionMatrix] {
        &self.matrices
    }
}

fn pedestrian_pixels(frame: &Frame) -> String {
    format!("{} pedestrian pixels", frame.class_ids.iter().filter(|id| **id == PEDESTRIAN_TAG).count())
}
