//! Trains a checkpoint from a dataset folder, and writes its card beside it.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use anyhow::Context;
use indicatif::ProgressBar;
use perception::classes::TRAIN_CLASSES;
use perception::training::{self, CLASS_WEIGHT_OFFSET, EpochReport, LOGIT_STRIDE, Progress, TrainOptions, Trained};

use crate::cli::TrainArgs;
use crate::exit::Verdict;
use crate::output;
use crate::progress::{self, Interrupt};

/// Runs `aeye train`. Ctrl-C stops it; the same command goes on from the last finished epoch.
pub fn run(args: &TrainArgs, json: bool) -> anyhow::Result<Verdict> {
    output::check_file(&args.out)?;
    let options = options(args);
    let unfinished = beside(&args.out, "onnx.part");
    let interrupt = Interrupt::listen()?;
    let mut screen = Screen { bar: ProgressBar::hidden(), epochs: args.epochs, json, failed: None };
    let watch = &mut |progress: Progress<'_>| {
        screen.show(progress);
        if interrupt.is_raised() || screen.failed.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let trained = training::train(&args.dataset, &unfinished, &options, args.epochs, watch)?;
    screen.bar.finish_and_clear();
    if let Some(error) = screen.failed {
        return Err(error);
    }
    let Some(trained) = trained else {
        anyhow::bail!("interrupted; the same command goes on from {}", unfinished.display());
    };
    output::write_file(&args.out, &trained.onnx)?;
    output::write_file(&beside(&args.out, "md"), card(args, &options, &trained).as_bytes())?;
    if trained.history.len() >= options.horizon as usize {
        fs::remove_file(&unfinished).with_context(|| unfinished.display().to_string())?;
    }
    Ok(Verdict::Ok)
}

fn options(args: &TrainArgs) -> TrainOptions {
    TrainOptions {
        horizon: args.horizon.unwrap_or(args.epochs),
        seed: args.seed,
        width: args.size.0 as usize,
        height: args.size.1 as usize,
        batch: args.batch as usize,
        replicas: args.replicas as usize,
        rate: args.rate,
    }
}

fn beside(out: &Path, ending: &str) -> PathBuf {
    out.with_extension(ending)
}

/// What is seen of a training: a bar an epoch on stderr, a line an epoch on stdout.
struct Screen {
    bar: ProgressBar,
    epochs: u32,
    json: bool,
    /// Why stdout could not be written.
    failed: Option<anyhow::Error>,
}

impl Screen {
    fn show(&mut self, progress: Progress<'_>) {
        match progress {
            Progress::Loaded { train, val, epochs, steps } => {
                eprintln!("{train} frames to learn from, {val} to measure on; {epochs} epochs are done");
                let left = u64::from(self.epochs.saturating_sub(epochs)) * steps as u64;
                self.bar = progress::bar("train", left);
            }
            Progress::Step { loss, .. } => {
                self.bar.inc(1);
                self.bar.set_message(format!("loss {loss:.3}"));
            }
            Progress::Epoch(report) => {
                let print = || output::print(self.json, report, || line(report));
                self.failed = self.bar.suspend(print).err();
            }
        }
    }
}

fn line(report: &EpochReport) -> String {
    let pedestrian = report.iou.get(pedestrian()).copied().flatten();
    let EpochReport { epoch, loss, miou, .. } = report;
    format!("epoch {epoch:3}  loss {loss:.4}  mIoU {}  IoU Pedestrian {}", number(*miou), number(pedestrian))
}

/// What the folder says about how it was made.
fn dataset_recipe(dataset: &Path) -> String {
    let text = fs::read_to_string(dataset.join("dataset.json")).unwrap_or_default();
    let about: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    match (&about["kind"], &about["recipe"]) {
        (serde_json::Value::String(kind), recipe) if recipe.is_object() => format!("{kind}, recipe `{recipe}`"),
        _ => "of unknown making".into(),
    }
}

fn pedestrian() -> usize {
    TRAIN_CLASSES.iter().position(|c| c.name == "Pedestrian").unwrap_or_default()
}

fn number(value: Option<f64>) -> String {
    value.map_or("-".into(), |v| format!("{v:.4}"))
}

/// What the checkpoint is and how to make it again.
fn card(args: &TrainArgs, options: &TrainOptions, trained: &Trained) -> String {
    let name = args.out.file_stem().unwrap_or_default().to_string_lossy();
    let epochs = trained.history.len();
    let stopped = if epochs < options.horizon as usize { " (stopped on purpose)" } else { "" };
    let TrainOptions { horizon, seed, width, height, batch, replicas, rate } = options;
    let mut card = format!(
        "# {name}\n\n\
         Fast-SCNN (Poudel et al. 2019) whose classifier gives 4x4 logits a position (dense upsampling, Wang et al. \
         2018): {} parameters, 16 classes, input {width}x{height}, logits at stride {LOGIT_STRIDE}.\n\n\
         | recipe | |\n|---|---|\n\
         | epochs | {epochs} of a schedule of {horizon}{stopped} |\n\
         | frames | {} to learn from, {} to measure on (scenes of seeds of their own) |\n\
         | dataset | {}; BLAKE3 over its files `{}` |\n\
         | seed | {seed} |\n\
         | optimiser | Adam, rate {rate}, polynomial decay of power 0.9 |\n\
         | batch | {batch} in {replicas} replicas |\n\
         | loss | cross-entropy at full resolution, a class weighs 1 / ln({CLASS_WEIGHT_OFFSET} + its share of the pixels) |\n\
         | augmentation | horizontal flip; windows enlarged up to twice; contrast, brightness and tint |\n\
         | digest | BLAKE3 `{}` |\n\n",
        trained.parameters,
        trained.train_frames,
        trained.val_frames,
        dataset_recipe(&args.dataset),
        trained.dataset,
        blake3::hash(&trained.onnx).to_hex(),
    );
    if let Some(last) = trained.history.last() {
        card += &format!("| class | validation IoU |\n|---|---|\n| **mean** | **{}** |\n", number(last.miou));
        for (class, iou) in TRAIN_CLASSES.iter().zip(&last.iou) {
            card += &format!("| {} | {} |\n", class.name, number(*iou));
        }
    }
    card += "\n| epoch | loss | mIoU |\n|---|---|---|\n";
    for EpochReport { epoch, loss, miou, .. } in &trained.history {
        card += &format!("| {epoch} | {loss:.4} | {} |\n", number(*miou));
    }
    card
}
