//! The network as a whole: what is shipped agrees with what was trained, it learns, and it goes on
//! where it was interrupted.

use std::fs::{self, File};
use std::path::PathBuf;

use burn_flex::{Flex, FlexDevice};

use super::random::Random;
use super::tape::logits;
use super::weights::Weights;
use super::*;
use crate::classes::TRAIN_CLASSES;
use crate::onnx::{self, Element, Engine, Output, Pixels, decode};

const WIDTH: usize = 128;
const HEIGHT: usize = 64;

/// Pictures that differ in colour as a whole and from square to square, normalised.
fn pictures(count: usize) -> Vec<f32> {
    let mut random = Random::new(&[1]);
    let mut values = Vec::new();
    for _ in 0..count {
        let whole: [f32; 3] = std::array::from_fn(|_| random.normal());
        let squares: Vec<f32> = (0..WIDTH * HEIGHT * 3 / 64).map(|_| random.normal()).collect();
        let at = |y: usize, x: usize, c: usize| whole[c] + squares[(y / 8 * (WIDTH / 8) + x / 8) * 3 + c];
        let pixels = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (y, x)));
        values.extend(pixels.flat_map(|(y, x)| (0..3).map(move |c| at(y, x, c)).collect::<Vec<_>>()));
    }
    values
}

#[test]
fn the_shipped_network_gives_the_logits_of_the_trained_one() {
    let pictures = pictures(8);
    let mut weights = Weights::new(5);
    let (trained, moments) = logits::<Flex>(&weights, pictures.clone(), HEIGHT, WIDTH, &FlexDevice);
    weights.moments = moments;
    let bytes = export::onnx(&weights, WIDTH, HEIGHT, "{}").unwrap();
    assert_eq!(bytes, export::onnx(&weights, WIDTH, HEIGHT, "{}").unwrap());
    let cpu = onnx::runtime("cpu").unwrap();
    let engine = Engine::new(cpu, &decode(&bytes).unwrap(), Element::Float, [1, 3, HEIGHT, WIDTH]).unwrap();
    let classes = TRAIN_CLASSES.len();
    let positions = WIDTH / LOGIT_STRIDE * (HEIGHT / LOGIT_STRIDE);
    let spread = trained.iter().fold(0.0f32, |m, v| m.max(v.abs()));
    assert!(spread > 0.5, "logits of at most {spread} would agree by chance");
    let images = pictures.chunks_exact(WIDTH * HEIGHT * 3).zip(trained.chunks_exact(positions * classes));
    for (picture, trained) in images {
        let planes: Vec<f32> = (0..3).flat_map(|c| picture.iter().skip(c).step_by(3).copied()).collect();
        let pixels = if engine.takes_last { picture } else { &planes };
        let Output::Scores(shipped) = engine.run(Pixels::Float(pixels)).unwrap() else { panic!("no scores") };
        assert_eq!(shipped.len(), trained.len());
        for (i, logit) in trained.iter().enumerate() {
            let is_last = engine.output_shape.last() == Some(&classes);
            let other = shipped[if is_last { i } else { i % classes * positions + i / classes }];
            assert!((logit - other).abs() < 1e-3, "logit {i}: {logit} trained, {other} shipped");
        }
    }
}

/// A dataset of pictures that a child could tell apart: sky above, road below, and a walker that
/// stands somewhere.
fn dataset(dir: &Path, train: usize, val: usize) {
    for (split, count) in [("train", train), ("val", val)] {
        for i in 0..count {
            let walker = 8 + (i * 37) % (WIDTH - 24);
            let (mut rgb, mut labels) = (Vec::new(), Vec::new());
            for (y, x) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (y, x))) {
                let is_walker = (walker..walker + 16).contains(&x) && (16..48).contains(&y);
                let (id, colour) = match (is_walker, y < HEIGHT / 2) {
                    (true, _) => (2, [200, 30, 60]),
                    (false, true) => (11, [90, 140, 220]),
                    (false, false) => (5, [80, 80, 80]),
                };
                rgb.extend(colour);
                labels.push(id);
            }
            let name = format!("scene/scene_{i:06}_000000");
            let [image, truth] = ["leftImg8bit", "gtFine"].map(|part| dir.join(part).join(split));
            let write = |path: PathBuf, colour, depth, bytes: &[u8]| {
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                let file = File::create(path).unwrap();
                let mut encoder = png::Encoder::new(file, WIDTH as u32, HEIGHT as u32);
                encoder.set_color(colour);
                encoder.set_depth(depth);
                encoder.write_header().unwrap().write_image_data(bytes).unwrap();
            };
            let (grey, eight) = (png::ColorType::Grayscale, png::BitDepth::Eight);
            write(image.join(format!("{name}_leftImg8bit.png")), png::ColorType::Rgb, eight, &rgb);
            write(truth.join(format!("{name}_gtFine_labelTrainIds.png")), grey, eight, &labels);
            let instances: Vec<u8> =
                labels.iter().flat_map(|id| (if *id == 2 { 4000u16 } else { 7 }).to_be_bytes()).collect();
            write(truth.join(format!("{name}_gtFine_instanceIds.png")), grey, png::BitDepth::Sixteen, &instances);
        }
    }
}

fn options() -> TrainOptions {
    TrainOptions { horizon: 12, width: WIDTH, height: HEIGHT, batch: 4, ..TrainOptions::default() }
}

fn go_on(_: Progress<'_>) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn it_learns_and_an_interrupted_training_ends_with_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    dataset(dir.path(), 24, 4);
    let part = |name: &str| dir.path().join(name);
    let train = |part: &Path, epochs, watch: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>| {
        train(dir.path(), part, &options(), epochs, watch).unwrap()
    };
    let whole = train(&part("a"), 12, &mut go_on).unwrap();
    let last = whole.history.last().unwrap();
    assert!(last.loss < 0.5 * whole.history[0].loss, "{:?}", whole.history);
    assert!(last.miou.unwrap() > 0.8, "{last:?}");

    let mut steps = 0;
    let interrupted = train(&part("b"), 12, &mut |progress| {
        steps += usize::from(matches!(progress, Progress::Step { .. }));
        if steps == 33 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(interrupted.is_none());
    let mut found = 0;
    let resumed = train(&part("b"), 12, &mut |progress| {
        if let Progress::Loaded { epochs, .. } = progress {
            found = epochs;
        }
        ControlFlow::Continue(())
    });
    assert_eq!(found, 5, "33 steps are five epochs of six steps, and some");
    assert!(resumed.unwrap().onnx == whole.onnx, "the resumed network differs");
}

#[test]
fn out_of_patience_the_best_epoch_is_kept_also_when_it_was_interrupted() {
    let dir = tempfile::tempdir().unwrap();
    dataset(dir.path(), 8, 2);
    let train = |name: &str, patience, epochs, watch: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>| {
        let options = TrainOptions { patience, ..options() };
        train(dir.path(), &dir.path().join(name), &options, epochs, watch).unwrap()
    };
    let kept = train("a", Some(1), 6, &mut go_on).unwrap();
    let mious: Vec<f64> = kept.history.iter().map(|report| report.miou.unwrap()).collect();
    let best = mious.iter().fold(0.0, |best: f64, miou| best.max(*miou));
    assert_eq!(kept.epoch as usize, 1 + mious.iter().position(|miou| *miou == best).unwrap());
    assert_eq!(kept.is_final, mious.len() > kept.epoch as usize);
    assert!(kept.is_final || mious.len() == 6, "{mious:?}");

    let graph = |trained: &Trained| decode(&trained.onnx).unwrap().graph;
    let plain = train("b", None, kept.epoch, &mut go_on).unwrap();
    assert!(graph(&kept) == graph(&plain), "the network is that of epoch {}", kept.epoch);
    assert!(kept.onnx != plain.onnx, "it tells that there was patience");

    let an_epoch = &mut |progress: Progress<'_>| match progress {
        Progress::Epoch(_) => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let resumed = mious.iter().filter_map(|_| train("c", Some(1), 6, an_epoch)).last();
    let resumed = resumed.or_else(|| train("c", Some(1), 6, &mut go_on)).unwrap();
    assert!(resumed.onnx == kept.onnx, "interrupted after every epoch it differs");
}

#[test]
fn people_are_learned_from_larger_frames_to_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    dataset(dir.path(), 8, 2);
    let (looks, sampling) = Preset::People.choice();
    let people = TrainOptions { width: WIDTH / 2, height: HEIGHT / 2, looks, sampling, ..options() };
    let trained = |name: &str, options: &TrainOptions| {
        let trained = train(dir.path(), &dir.path().join(name), options, 2, &mut go_on).unwrap().unwrap();
        assert!(trained.history.iter().all(|report| report.loss.is_finite() && report.miou.is_some()));
        trained
    };
    let [first, again] = ["a", "b"].map(|name| trained(name, &people));
    assert!(first.onnx == again.onnx);
    let plain =
        trained("c", &TrainOptions { looks: Looks::default(), sampling: Sampling::default(), ..people.clone() });
    assert!(
        first.onnx != plain.onnx && first.dataset != plain.dataset,
        "instance ids are part of what is learned from"
    );

    // The walker is 32 rows high, 16 in the network's input.
    let nobody = TrainOptions { sampling: Sampling { least_px: 40, ..sampling }, ..people };
    let iou = |trained: &Trained| trained.history[1].iou[crate::classes::PEDESTRIAN];
    let without = trained("d", &nobody);
    assert!(iou(&first).is_some() && iou(&without).unwrap_or(0.0) == 0.0, "who is too small is not measured");
}

#[test]
fn what_was_never_measured_ends_with_patience() {
    let dir = tempfile::tempdir().unwrap();
    dataset(dir.path(), 4, 1);
    let label = dir.path().join("gtFine/val/scene/scene_000000_000000_gtFine_labelTrainIds.png");
    let mut encoder = png::Encoder::new(File::create(label).unwrap(), WIDTH as u32, HEIGHT as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(&[crate::classes::IGNORE; WIDTH * HEIGHT]).unwrap();
    let options = TrainOptions { patience: Some(2), ..options() };
    let trained = train(dir.path(), &dir.path().join("p"), &options, 12, &mut go_on).unwrap().unwrap();
    assert_eq!((trained.epoch, trained.history.len(), trained.is_final), (1, 3, true));
}

#[test]
fn a_network_is_known_by_its_options_and_its_dataset() {
    let dir = tempfile::tempdir().unwrap();
    dataset(dir.path(), 4, 1);
    let options = |patience| TrainOptions { patience, ..options() };
    let trained = [None, Some(1)].map(|patience| {
        let trained = train(dir.path(), &dir.path().join("p"), &options(patience), 2, &mut go_on).unwrap().unwrap();
        fs::remove_file(dir.path().join("p")).unwrap();
        (patience, Checkpoint::from_bytes("c", &trained.onnx).unwrap())
    });
    let of = |checkpoint: &Checkpoint, options, epochs| origin(checkpoint, dir.path(), &options, epochs).unwrap();
    for (patience, checkpoint) in &trained {
        assert_eq!(of(checkpoint, options(*patience), 2), Origin::This);
        assert_eq!(of(checkpoint, options(*patience), 3), Origin::OtherEpochs);
        assert_eq!(of(checkpoint, TrainOptions { seed: 2, ..options(*patience) }, 2), Origin::Foreign);
        assert_eq!(of(checkpoint, options(Some(3)), 2), Origin::Foreign);
    }
    assert_eq!(of(&crate::bundled("full").unwrap().unwrap(), options(None), 2), Origin::Foreign);
    dataset(dir.path(), 4, 2);
    for (patience, checkpoint) in &trained {
        assert_eq!(of(checkpoint, options(*patience), 2), Origin::Foreign, "a picture more");
    }
}

#[test]
fn what_cannot_be_trained_is_refused_in_one_sentence() {
    let dir = tempfile::tempdir().unwrap();
    let said = |options: TrainOptions| {
        let text = train(dir.path(), &dir.path().join("p"), &options, 1, &mut go_on).unwrap_err().to_string();
        assert!(!text.contains('\n'));
        text
    };
    assert!(said(TrainOptions { width: 100, ..options() }).contains("multiples of 32"));
    assert!(said(TrainOptions { batch: 5, ..options() }).contains("replicas"));
    assert!(said(TrainOptions { patience: Some(0), ..options() }).contains("patience"));
    assert!(said(options()).contains("No such file"));
    dataset(dir.path(), 2, 1);
    assert!(said(options()).contains("2 frames to learn from"));
    assert!(said(TrainOptions { width: 64, ..options() }).contains("expected 64x64"));
    let label = "gtFine/train/scene/scene_000000_000000_gtFine_labelTrainIds.png";
    let (looks, sampling) = Preset::People.choice();
    let with = |looks, sampling| said(TrainOptions { looks, sampling, ..options() });
    assert!(with(Looks { noise: 2.0, ..looks }, sampling).contains("look noise of 2; expected 0 to 1"));
    assert!(with(looks, Sampling { round_rare: -1.0, ..sampling }).contains("round_rare of -1; expected 0 to 1"));
    let instances = "gtFine/train/scene/scene_000000_000000_gtFine_instanceIds.png";
    fs::remove_file(dir.path().join(instances)).unwrap();
    assert!(with(looks, sampling).contains(&format!("{instances}: is missing")));
    fs::remove_file(dir.path().join(label)).unwrap();
    assert!(said(options()).contains(&format!("{label}: is missing")));
}
