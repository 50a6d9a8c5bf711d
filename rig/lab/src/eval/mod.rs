//! Measures a checkpoint on a split of a dataset folder.
//!
//! Integers are counted over all pixels of all frames before anything is divided, so nothing depends
//! on the number of threads.

mod road_users;
mod split;
mod tall;
mod text;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context, bail};
use base::json::Typed;
use perception::classes::TRAIN_CLASSES;
use perception::{BoundaryCounts, Calibration, ConfusionMatrix};
use serde::Serialize;

pub use road_users::{Group, Kind, Range, Recall, RoadUser, RoadUsers, road_users};
pub use tall::Tall;

use self::split::Labelled;
use super::dataset::{Manifest, check_whole};
use super::figures::{Confusion, Figures, pixels_per};
use super::trust::Trust;
use base::output::PendingFolder;
use base::png;
use base::progress::{self, Interrupt};
use base::spread::{jobs, on_threads};
use drivers::checkpoint::CheckpointChoice;
use drivers::vision::Eye;

/// What a checkpoint sees of a split.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// `truth`, or the checkpoint's name.
    pub checkpoint: String,
    /// Its digest in hexadecimal digits.
    pub digest: String,
    /// The scenes of the split, by name.
    pub scenes: Vec<Scene>,
    /// Over all scenes.
    pub matrix: ConfusionMatrix,
    /// Those of that matrix.
    pub figures: Figures,
    /// Boundary IoU by class name.
    pub boundary_iou: BTreeMap<&'static str, Option<f64>>,
    /// How far its certainty can be believed; `None` of one that gives classes only.
    pub trust: Option<Trust>,
    /// The road users of all frames.
    pub road_users: RoadUsers,
    /// How well people are seen who are not small.
    pub tall_people: Vec<Tall>,
}

/// A scene of a split.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scene {
    /// `CITY_SEQ`, what the names of its files begin with.
    pub name: String,
    /// How many pictures it has.
    pub frames: usize,
    /// Over them.
    pub matrix: ConfusionMatrix,
}

impl Evaluation {
    /// How many pictures the split has.
    pub fn frames(&self) -> usize {
        self.scenes.iter().map(|scene| scene.frames).sum()
    }
}

/// An evaluation as it is printed.
#[derive(Serialize)]
pub struct Summary<'a> {
    /// Its name.
    checkpoint: &'a str,
    /// Its digest, hexadecimal.
    digest: &'a str,
    /// The folder.
    dataset: String,
    /// Which split.
    split: &'a str,
    /// Number of scenes.
    scenes: usize,
    /// Number of frames.
    frames: usize,
    #[serde(flatten)]
    figures: &'a Figures,
    /// Mean of the labelled pixels a scene and a frame, by class.
    pixels_per_scene: BTreeMap<&'static str, f64>,
    /// The same a frame.
    pixels_per_frame: BTreeMap<&'static str, f64>,
    /// Boundary IoU by class name (Cheng et al. 2021): IoU of the pixels within 2 % of the picture's diagonal from the
    /// class's outline.
    boundary_iou: &'a BTreeMap<&'static str, Option<f64>>,
    /// Mean of those that there are.
    mean_boundary_iou: Option<f64>,
    /// How far its certainty can be believed; null of one that gives classes only.
    trust: Option<&'a Trust>,
    /// How many road users were seen.
    #[serde(flatten)]
    road_users: &'a RoadUsers,
    /// How well people of at least 8, 16 and 32 pixels of height are seen, where smaller ones count nowhere.
    tall_people: &'a [Tall],
    /// Pixels by labelled and predicted class.
    confusion: Confusion<'a>,
}

/// What `aeye eval` prints.
impl Typed for Summary<'_> {
    const TYPE: &'static str = "aeye.eval";
}

impl<'a> Summary<'a> {
    /// That of a split of a dataset.
    pub fn new(evaluation: &'a Evaluation, dataset: &Path, split: &'a str) -> Self {
        let Evaluation { checkpoint, digest, scenes, matrix, figures, boundary_iou, trust, road_users, tall_people } =
            evaluation;
        let boundaries: Vec<f64> = boundary_iou.values().flatten().copied().collect();
        Self {
            checkpoint,
            digest,
            dataset: dataset.display().to_string(),
            split,
            scenes: scenes.len(),
            frames: evaluation.frames(),
            figures,
            pixels_per_scene: pixels_per(matrix, scenes.len()),
            pixels_per_frame: pixels_per(matrix, evaluation.frames()),
            boundary_iou,
            mean_boundary_iou: (!boundaries.is_empty())
                .then(|| boundaries.iter().sum::<f64>() / boundaries.len() as f64),
            trust: trust.as_ref(),
            road_users,
            tall_people,
            confusion: matrix.into(),
        }
    }
}

/// Measures a checkpoint on a split with so many frames at the same time.
pub fn evaluate(
    checkpoint: &CheckpointChoice,
    dataset: &Path,
    split: &str,
    asked: Option<u16>,
    interrupt: &Interrupt,
) -> anyhow::Result<Evaluation> {
    look((checkpoint, dataset, split), None, jobs(asked), interrupt)
}

/// As [`evaluate`]; the masks go below a new folder.
pub fn evaluate_and_keep(
    checkpoint: &CheckpointChoice,
    dataset: &Path,
    split: &str,
    predictions: &Path,
    asked: Option<u16>,
    interrupt: &Interrupt,
) -> anyhow::Result<Evaluation> {
    let folder = PendingFolder::new(predictions)?;
    let evaluation = look((checkpoint, dataset, split), Some(folder.path()), jobs(asked), interrupt)?;
    folder.finish()?;
    Ok(evaluation)
}

/// What is kept of a frame.
struct Seen {
    matrix: ConfusionMatrix,
    boundaries: BoundaryCounts,
    /// Empty of a checkpoint that gives classes only.
    calibration: Calibration,
    road_users: Vec<RoadUser>,
}

impl Seen {
    fn of(eye: &mut Eye, labelled: &Labelled) -> anyhow::Result<(Self, Vec<u8>)> {
        let Labelled { frame, instances } = labelled;
        let (mask, certainty) = eye.see_with_certainty(frame)?;
        let (mut matrix, mut boundaries) = (ConfusionMatrix::default(), BoundaryCounts::default());
        matrix.add(&frame.class_ids, &mask.ids);
        boundaries.add((mask.width, mask.height), &frame.class_ids, &mask.ids);
        let mut calibration = Calibration::default();
        if let Some(certainty) = certainty {
            calibration.add(&frame.class_ids, &mask.ids, &certainty);
        }
        let road_users = road_users(instances, (frame.width, frame.height), &mask.ids);
        Ok((Self { matrix, boundaries, calibration, road_users }, mask.ids))
    }
}

/// Looks at every frame on so many threads, and writes the masks below a folder if there is one.
fn look(
    (checkpoint, dataset, split): (&CheckpointChoice, &Path, &str),
    predictions: Option<&Path>,
    jobs: usize,
    interrupt: &Interrupt,
) -> anyhow::Result<Evaluation> {
    check_whole(dataset)?;
    let is_of_drivers = Manifest::read(dataset).map_or(true, |manifest| manifest.recipe.cameras().is_empty());
    let images = split::images(dataset, split)?;
    let (first, _) = png::read(&images[0], 3)?;
    let eye = Eye::open_at(checkpoint, first)?;
    let seen: Vec<OnceLock<Seen>> = images.iter().map(|_| OnceLock::new()).collect();
    let bar = progress::bar("frames", images.len() as u64);
    on_threads(
        jobs,
        images.len(),
        || eye.clone(),
        |eye, index| {
            if interrupt.is_raised() {
                bail!("interrupted");
            }
            let image = &images[index];
            let labelled = split::read(image)?;
            let size = (labelled.frame.width, labelled.frame.height);
            if !eye.is_truth() && eye.size() != size {
                *eye = Eye::open_at(checkpoint, size)?;
            }
            let (mut found, mask) = Seen::of(eye, &labelled)?;
            if let Some(folder) = predictions {
                write(&prediction(folder, image), &png::grey(size, &mask)?)?;
            }
            if !is_of_drivers {
                found.road_users.iter_mut().for_each(|user| user.distance_m = None);
            }
            let _ = seen[index].set(found);
            bar.inc(1);
            Ok(())
        },
    )?;
    bar.finish_and_clear();
    let seen = seen.into_iter().map(|seen| seen.into_inner().context("every frame was looked at"));
    Ok(sum(&eye, &images, &seen.collect::<anyhow::Result<Vec<_>>>()?))
}

fn sum(eye: &Eye, images: &[PathBuf], seen: &[Seen]) -> Evaluation {
    let mut scenes: Vec<Scene> = Vec::new();
    let (mut matrix, mut boundaries) = (ConfusionMatrix::default(), BoundaryCounts::default());
    let mut calibration = Calibration::default();
    for (image, seen) in images.iter().zip(seen) {
        let name = split::scene(image);
        if scenes.last().is_none_or(|scene| scene.name != name) {
            scenes.push(Scene { name, frames: 0, matrix: ConfusionMatrix::default() });
        }
        if let Some(scene) = scenes.last_mut() {
            scene.frames += 1;
            scene.matrix.merge(&seen.matrix);
        }
        matrix.merge(&seen.matrix);
        boundaries.merge(&seen.boundaries);
        calibration.merge(&seen.calibration);
    }
    let road_users: Vec<RoadUser> = seen.iter().flat_map(|seen| seen.road_users.iter().copied()).collect();
    let boundary_iou = TRAIN_CLASSES.iter().zip(boundaries.iou());
    Evaluation {
        checkpoint: eye.name().to_owned(),
        digest: eye.digest(),
        scenes,
        figures: (&matrix).into(),
        tall_people: tall::tall(&road_users, &matrix),
        matrix,
        boundary_iou: boundary_iou.map(|(class, iou)| (class.name, Some(iou).filter(|iou| !iou.is_nan()))).collect(),
        trust: Trust::of(&calibration),
        road_users: RoadUsers::of(&road_users),
    }
}

/// Where the mask of a picture goes, under a name by which cityscapesscripts finds it:
/// `CITY/CITY_SEQ_FRAME_pred_labelIds.png`, in tags.
fn prediction(folder: &Path, image: &Path) -> PathBuf {
    let city = image.parent().and_then(Path::file_name).unwrap_or_default();
    folder.join(city).join(format!("{}_pred_labelIds.png", split::name(image)))
}

fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    fs::write(path, bytes).with_context(|| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cityscapes;
    use perception::cityscapes::{Kind, Place};
    use render::Frame;

    const SIZE: (u32, u32) = (64, 32);

    /// Two scenes of two pictures with stripes of classes and somebody on a road.
    fn dataset(dir: &Path) {
        for (scene, number) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let tag = |i: u32| match (i % SIZE.0, i / SIZE.0) {
                (x, 18..26) if (8 * scene..8 * scene + 4).contains(&x) => 4,
                (x, 0..16) => [13, 9, 1, 14][(x / 8 + number) as usize % 4],
                _ => 7,
            };
            let class_ids: Vec<u8> = (0..SIZE.0 * SIZE.1).map(tag).collect();
            let frame = Frame {
                width: SIZE.0,
                height: SIZE.1,
                rgb: class_ids.iter().flat_map(|tag| [9 * tag, 200, 80]).collect(),
                instance_ids: class_ids.iter().map(|tag| 30 * u16::from(*tag == 4)).collect(),
                class_ids,
                ..Frame::default()
            };
            cityscapes::write(dir, &Place { split: "val", city: "toy", scene, frame: number, camera: None }, &frame)
                .expect("written");
        }
    }

    #[test]
    fn truth_is_perfect_and_ignored_pixels_stay_ignored() {
        let dir = tempfile::tempdir().expect("a folder");
        dataset(dir.path());
        let all = evaluate(&CheckpointChoice::Truth, dir.path(), "val", None, &Interrupt::default()).expect("measured");
        assert_eq!((all.figures.miou, all.frames()), (Some(1.0), 4));
        assert_eq!(all.figures.pixels, 4 * 64 * 32 - 4 * 16 * 16, "a quarter of the upper half is Ground");
        assert_eq!(
            all.scenes.iter().map(|scene| scene.name.as_str()).collect::<Vec<_>>(),
            ["toy_000000", "toy_000001"]
        );
        assert_eq!(
            all.tall_people.iter().map(|tall| (tall.count, tall.iou)).collect::<Vec<_>>()[..2],
            [(4, Some(1.0)), (0, None)]
        );
        assert_eq!((all.road_users.pedestrians.all.count, all.road_users.pedestrians.all.half_seen), (4, Some(1.0)));
        assert!(all.boundary_iou.values().flatten().all(|iou| *iou == 1.0) && all.trust.is_none());
        // Feet 10 rows below the horizon are 32 px * 1.5 m / 10 px = 4.8 m away, 8 rows there 1.2 m.
        assert_eq!(all.road_users.pedestrians.by_distance_m[0].recall.count, 4);
    }

    #[test]
    fn a_network_gives_the_same_on_any_number_of_threads_and_its_masks_are_kept() {
        let dir = tempfile::tempdir().expect("a folder");
        let (data, masks) = (dir.path().join("data"), dir.path().join("masks"));
        dataset(&data);
        let early = CheckpointChoice::Bundled("early");
        let one = look((&early, &data, "val"), Some(&masks), 1, &Interrupt::default()).expect("measured");
        assert_eq!(one, look((&early, &data, "val"), None, 3, &Interrupt::default()).expect("measured"));
        let mut sum = ConfusionMatrix::default();
        for image in split::images(&data, "val").expect("pictures") {
            let mask = png::read(&prediction(&masks, &image), 1).expect("a mask").1;
            let labels = perception::cityscapes::sibling(&image, Kind::LabelIds).expect("a path");
            sum.add(&png::read(&labels, 1).expect("labels").1, &mask);
        }
        assert_eq!((sum, 2), (one.matrix, one.scenes.len()));
        let trust = one.trust.expect("a network with scores");
        let pixels: u64 = trust.ranges.iter().map(|range| range.pixels).sum();
        assert_eq!(pixels, one.figures.pixels);
        // Stripes are nothing that it knows: it is surer than it is right, and says so by its entropy at best.
        let gap = trust.confidence.unwrap_or_default() - one.figures.accuracy.unwrap_or_default();
        assert!(gap > 0.0 && trust.ece.is_some_and(|ece| ece >= gap - 1e-6), "{trust:?}");
        assert!(masks.join("toy/toy_000001_000000_pred_labelIds.png").is_file());
    }

    #[test]
    fn what_cannot_be_measured_is_named_in_a_sentence() {
        let dir = tempfile::tempdir().expect("a folder");
        dataset(dir.path());
        let said = |checkpoint: &CheckpointChoice, split: &str| {
            let said = evaluate(checkpoint, dir.path(), split, None, &Interrupt::default());
            let said = said.expect_err("refused").to_string();
            assert!(!said.contains('\n'), "{said}");
            said
        };
        let truth = |words: &str| {
            let said = said(&CheckpointChoice::Truth, "val");
            assert!(said.contains(words), "{said}");
        };
        assert!(said(&CheckpointChoice::Truth, "test").contains("has no split test; expected --split val"));
        let gone = dir.path().join("gone.onnx");
        assert!(said(&CheckpointChoice::File(gone.clone()), "val").contains("gone.onnx: no such checkpoint"));
        fs::write(&gone, "not a network").expect("writable");
        assert!(said(&CheckpointChoice::File(gone), "val").contains("gone.onnx"));

        let label = dir.path().join("gtFine/val/toy/toy_000001_000000_gtFine_labelTrainIds.png");
        let write = |bytes: anyhow::Result<Vec<u8>>| fs::write(&label, bytes.expect("a PNG")).expect("writable");
        write(png::grey((32, 32), &[0; 32 * 32]));
        truth("toy_000001_000000_gtFine_labelTrainIds.png: 32x32 pixels; expected 64x32 like its picture");
        write(png::grey(SIZE, &[18; 64 * 32]));
        truth("holds train id 18; expected 0 to 15 or 255");
        fs::remove_file(&label).expect("there");
        truth("toy_000001_000000_gtFine_labelTrainIds.png: is missing; expected the ground truth of");
    }
}
