//! The course of a training: epochs of steps, each epoch measured.

use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::path::Path;

use burn_flex::{Flex, FlexDevice};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::adam;
use super::dataset::{Frame, Split};
use super::kernels::loss::Target;
use super::options::TrainOptions;
use super::people::without_small;
use super::pictures::{augmented, class_weights};
use super::progress::{EpochReport, Progress, Trained};
use super::random::Random;
use super::sampling::Rarity;
use super::state::State;
use super::tape::{Lesson, learn};
use super::weights::Weights;
use super::{export, network};
use crate::classes::{TRAIN_CLASSES, tag_of_train_id};
use crate::{Checkpoint, ConfusionMatrix, PerceptionError, RgbView, Segmenter};

/// Names of the splits to learn from and to measure on.
const SPLITS: [&str; 2] = ["train", "val"];

/// A training in memory.
pub(super) struct Run {
    options: TrainOptions,
    train: Split,
    val: Split,
    dataset: blake3::Hash,
    class_weights: [f32; TRAIN_CLASSES.len()],
    rarity: Rarity,
    /// One thread for each replica: burn's operations stay on it, whatever the machine has.
    replicas: Vec<ThreadPool>,
    state: State,
}

/// The splits of a dataset, in the order of [`SPLITS`].
pub(super) fn read(dataset: &Path, options: &TrainOptions) -> Result<[Split; 2], PerceptionError> {
    let input = (options.width, options.height);
    let [train, val] = SPLITS.map(|split| Split::read_for(dataset, split, input, options.sampling.knows_people()));
    Ok([train?, val?])
}

/// BLAKE3 over both splits.
pub(super) fn digest([train, val]: &[Split; 2]) -> blake3::Hash {
    blake3::hash(&[*train.digest.as_bytes(), *val.digest.as_bytes()].concat())
}

/// What a network's file tells of how it was made: of `epoch` passes, where at most `limit` were
/// allowed.
pub(super) fn recipe(options: &TrainOptions, epoch: u64, limit: u32, dataset: &str) -> String {
    let mut recipe = serde_json::json!({
        "network": "Fast-SCNN",
        "stride": network::LOGIT_STRIDE,
        "options": options,
        "epochs": epoch,
        "dataset": dataset,
    });
    if options.patience.is_some() {
        recipe["limit"] = limit.into();
    }
    recipe.to_string()
}

type Watch<'a> = dyn FnMut(Progress<'_>) -> ControlFlow<()> + 'a;

impl Run {
    /// Reads the dataset and an unfinished training, if there is one.
    pub(super) fn open(dataset: &Path, unfinished: &Path, options: &TrainOptions) -> Result<Self, PerceptionError> {
        let splits = read(dataset, options)?;
        let digest = digest(&splits);
        let [train, mut val] = splits;
        count_nobody_small(&mut val, options);
        if train.frames.len() < options.batch {
            let reason =
                format!("{} frames to learn from; expected at least a batch of {}", train.frames.len(), options.batch);
            return Err(PerceptionError::Dataset { path: dataset.to_owned(), reason });
        }
        let thread = |_| ThreadPoolBuilder::new().num_threads(1).build().map_err(std::io::Error::other);
        let replicas = (0..options.replicas).map(thread).collect::<Result<_, _>>();
        Ok(Self {
            class_weights: class_weights(&train.frames),
            rarity: Rarity::of(&train.frames, train.width as f32 / options.width as f32, &options.sampling),
            train,
            val,
            dataset: digest,
            replicas: replicas.map_err(|source| PerceptionError::Io { path: dataset.to_owned(), source })?,
            state: State::load(unfinished, options, digest)?.unwrap_or_else(|| State::new(options.seed)),
            options: options.clone(),
        })
    }

    /// Finished epochs.
    pub(super) fn epochs(&self) -> u32 {
        self.state.history.len() as u32
    }

    fn steps(&self) -> usize {
        self.train.frames.len() / self.options.batch
    }

    pub(super) fn announce(&self, watch: &mut Watch<'_>) -> ControlFlow<()> {
        watch(Progress::Loaded {
            train: self.train.frames.len(),
            val: self.val.frames.len(),
            epochs: self.epochs(),
            steps: self.steps(),
        })
    }

    /// As many pictures as the training split has, in an order of their own, and what they came to.
    pub(super) fn epoch(&mut self, watch: &mut Watch<'_>) -> Result<ControlFlow<()>, PerceptionError> {
        let epoch = self.epochs() + 1;
        let order = self.rarity.epoch(&mut Random::new(&[self.options.seed, 1, u64::from(epoch)]));
        let mut sum = 0.0;
        for (i, batch) in order.chunks_exact(self.options.batch).enumerate() {
            let loss = self.step(batch);
            sum += loss;
            if watch(Progress::Step { step: i + 1, loss }).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        let scores = self.measure()?.scores();
        self.state.record(EpochReport::new(epoch, sum / self.steps() as f64, &scores), &self.options);
        Ok(ControlFlow::Continue(()))
    }

    /// Tells what the last epoch came to.
    pub(super) fn report(&self, watch: &mut Watch<'_>) -> ControlFlow<()> {
        self.state.history.last().map_or(ControlFlow::Continue(()), |report| watch(Progress::Epoch(report)))
    }

    /// One step on the frames with these numbers; gives the loss.
    fn step(&mut self, batch: &[usize]) -> f64 {
        let shares: Vec<&[usize]> = batch.chunks_exact(batch.len() / self.replicas.len()).collect();
        let run = &*self;
        let lessons: Vec<Lesson> = std::thread::scope(|scope| {
            let replicas = run.replicas.iter().zip(&shares).enumerate();
            let running: Vec<_> = replicas
                .map(|(i, (thread, share))| scope.spawn(move || thread.install(|| run.lesson(share, i as u64))))
                .collect();
            running.into_iter().map(|r| r.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
        });
        let Lesson { loss, gradients, moments } = mean(lessons);
        let steps = self.steps() as u64 * u64::from(self.options.horizon);
        let rate = adam::rate(self.options.rate, self.state.adam.steps, steps);
        self.state.weights.follow(&moments);
        self.state.adam.step(&mut self.state.weights, &gradients, rate);
        loss
    }

    /// What one replica learns from its share.
    fn lesson(&self, share: &[usize], replica: u64) -> Lesson {
        let mut random = Random::new(&[self.options.seed, 2, self.state.adam.steps, replica]);
        let pictures = augmented(&self.train, share, (&self.options, &self.rarity), &mut random);
        let target = Target {
            labels: &pictures.labels,
            width: self.options.width,
            height: self.options.height,
            weights: &self.class_weights,
        };
        learn::<Flex>(&self.state.weights, pictures.values, target, &FlexDevice)
    }

    /// Runs the network as it will be shipped over the validation split.
    fn measure(&self) -> Result<ConfusionMatrix, PerceptionError> {
        let checkpoint = Checkpoint::from_bytes("trained", &self.onnx(&self.state.weights, "")?)?;
        let size = (self.val.width, self.val.height);
        let segmenter = Segmenter::new(&checkpoint, size.0, size.1)?;
        let share = self.val.frames.len().div_ceil(rayon::current_num_threads());
        let matrices = self.val.frames.par_chunks(share).map(|frames| confusion(segmenter.clone(), frames, size));
        let matrices = matrices.collect::<Result<Vec<_>, _>>()?;
        let mut sum = ConfusionMatrix::default();
        matrices.iter().for_each(|matrix| sum.merge(matrix));
        Ok(sum)
    }

    fn onnx(&self, weights: &Weights, recipe: &str) -> Result<Vec<u8>, PerceptionError> {
        export::onnx(weights, self.options.width, self.options.height, recipe)
    }

    /// Whether so many epochs as patience allows brought nothing better.
    pub(super) fn is_out_of_patience(&self) -> bool {
        let without_gain = self.epochs() - self.state.best_epoch();
        self.options.patience.is_some_and(|patience| without_gain >= patience)
    }

    pub(super) fn save(&mut self, path: &Path) -> Result<(), PerceptionError> {
        self.state.save(path, &self.options, self.dataset)
    }

    /// The network to keep of at most `limit` epochs.
    pub(super) fn finish(self, limit: u32) -> Result<Trained, PerceptionError> {
        let (epoch, weights) = match &self.state.best {
            Some(best) => (self.state.best_epoch(), best),
            None => (self.epochs(), &self.state.weights),
        };
        let recipe = recipe(&self.options, u64::from(epoch), limit, &self.dataset.to_hex());
        Ok(Trained {
            onnx: self.onnx(weights, &recipe)?,
            epoch,
            is_final: self.epochs() >= self.options.horizon || self.is_out_of_patience(),
            dataset: self.dataset,
            train_frames: self.train.frames.len(),
            val_frames: self.val.frames.len(),
            parameters: self.state.weights.count(),
            history: self.state.history,
        })
    }
}

/// Takes people who are too small to count out of the labels.
fn count_nobody_small(split: &mut Split, options: &TrainOptions) {
    let (scale, least_px) = (options.width as f32 / split.width as f32, options.sampling.least_px);
    for frame in &mut split.frames {
        if let Some(labels) = without_small(&frame.labels, &frame.people, scale, least_px) {
            frame.labels = labels;
        }
    }
}

fn confusion(
    mut segmenter: Segmenter,
    frames: &[Frame],
    (width, height): (usize, usize),
) -> Result<ConfusionMatrix, PerceptionError> {
    let mut matrix = ConfusionMatrix::default();
    for frame in frames {
        let mask = segmenter.run(RgbView::new(width, height, &frame.rgb)?)?;
        let truth: Vec<u8> = frame.labels.iter().map(|id| tag_of_train_id(*id)).collect();
        matrix.add(&truth, &mask.ids);
    }
    Ok(matrix)
}

/// Means over the replicas, summed in their order.
fn mean(lessons: Vec<Lesson>) -> Lesson {
    let count = lessons.len();
    let add = |mut sum: Lesson, mut lesson: Lesson| {
        sum.loss += lesson.loss;
        for (sum, values) in sum.vectors().zip(lesson.vectors()) {
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += *value);
        }
        sum
    };
    let mut mean = lessons.into_iter().reduce(add).unwrap_or_default();
    mean.loss /= count as f64;
    mean.vectors().flatten().for_each(|value| *value *= 1.0 / count as f32);
    mean
}
