//! Trains a checkpoint from a dataset folder. `C.onnx` is written last, after its card `C.md` and its
//! learning curves `C.jsonl` and `C.svg`, so that it stands for all of them.

mod card;
mod curves;
mod options;

use std::fs;
use std::io::ErrorKind;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use base::json::Typed;
use perception::Checkpoint;
use perception::training::{self, Origin, Progress, Sampling, TrainOptions, Trained};
use serde::Serialize;

pub use curves::Epoch;
pub use options::Options;

use crate::dataset::check_whole;
use base::output;
use base::progress::{self, Interrupt};
use base::say::say;
use base::words::count;

/// A checkpoint that is trained.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// Its file.
    pub checkpoint: PathBuf,
    /// Its card.
    pub card: PathBuf,
    /// What every epoch came to, as lines of JSON.
    pub curves: PathBuf,
    /// The same as a picture.
    pub picture: PathBuf,
    /// Its digest, as recordings and evaluations name it, in hexadecimal digits.
    pub digest: String,
    /// Whether it was there already, from the same options and the same dataset.
    pub was_there: bool,
}

/// What `aeye train` prints at its end.
impl Typed for Summary {
    const TYPE: &'static str = "aeye.train";
}

/// Endings of what is written beside a checkpoint: its card, its learning curves, and their picture.
const BESIDE: [&str; 3] = ["md", "jsonl", "svg"];

/// Trains a checkpoint unless it is there, and shows every epoch as it ends. What is interrupted goes
/// on from its last finished epoch, to the same bytes.
pub fn train(
    args: &Options,
    interrupt: &Interrupt,
    show: &mut dyn FnMut(&Epoch) -> anyhow::Result<()>,
) -> anyhow::Result<Summary> {
    output::check_file(&args.out)?;
    check_whole(&args.dataset)?;
    let options = options(args);
    let unfinished = beside(&args.out, "onnx.part");
    if args.out.exists() {
        let known = Checkpoint::load(&args.out).ok();
        let origin = |known| training::origin(known, &args.dataset, &options, args.epochs);
        match (known.as_ref().map(origin).transpose()?, known) {
            (Some(Origin::This), Some(known)) => {
                // A process that was killed just after it wrote the last file leaves it.
                if args.epochs >= options.horizon {
                    remove(&unfinished)?;
                }
                return Ok(summary(args, &known, true));
            }
            // What is unfinished goes on from there.
            (Some(Origin::OtherEpochs), _) if unfinished.exists() => {}
            _ => {
                let out = args.out.display();
                bail!(
                    "{out}: exists already and is not what these options make of this dataset; expected another place"
                );
            }
        }
    }
    check_beside(args, &unfinished)?;
    let mut screen =
        Screen { bar: progress::Bar::hidden(), options: &options, epochs: args.epochs, show, failed: None };
    let watch = &mut |progress: Progress<'_>| {
        screen.watch(progress);
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
        bail!("interrupted; the same command goes on from {}", unfinished.display());
    };
    write(args, &options, &trained)?;
    if trained.is_final {
        remove(&unfinished)?;
    }
    Ok(summary(args, &Checkpoint::load(&args.out)?, false))
}

/// What stands beside a checkpoint may be overwritten with it only.
fn check_beside(args: &Options, unfinished: &Path) -> anyhow::Result<()> {
    let is_own = args.out.exists() || unfinished.exists();
    let there = BESIDE.iter().map(|ending| beside(&args.out, ending)).find(|path| path.exists());
    match there.filter(|_| !is_own) {
        Some(path) => bail!("{}: exists already; expected another place", path.display()),
        None => Ok(()),
    }
}

/// Removes a file, if it is there.
fn remove(path: &Path) -> anyhow::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => Err(e).with_context(|| path.display().to_string()),
        _ => Ok(()),
    }
}

fn write(args: &Options, options: &TrainOptions, trained: &Trained) -> anyhow::Result<()> {
    let epochs: Vec<Epoch> = trained.history.iter().map(|report| Epoch::new(report, options)).collect();
    let texts = [card::card(args, options, trained), curves::lines(&epochs)?, curves::picture(&epochs)];
    for (ending, text) in BESIDE.iter().zip(texts) {
        output::write_file(&beside(&args.out, ending), text.as_bytes())?;
    }
    output::write_file(&args.out, &trained.onnx)
}

fn summary(args: &Options, checkpoint: &Checkpoint, was_there: bool) -> Summary {
    let [card, curves, picture] = BESIDE.map(|ending| beside(&args.out, ending));
    let digest = checkpoint.digest().to_hex().to_string();
    Summary { checkpoint: args.out.clone(), card, curves, picture, digest, was_there }
}

fn options(args: &Options) -> TrainOptions {
    let (looks, sampling) = args.preset.choice();
    let least_px = args.min_height_px.unwrap_or(sampling.least_px);
    TrainOptions {
        horizon: args.horizon.unwrap_or(args.epochs),
        seed: args.seed,
        width: args.size.0 as usize,
        height: args.size.1 as usize,
        batch: args.batch as usize,
        replicas: args.replicas as usize,
        rate: args.rate,
        patience: args.patience,
        looks,
        sampling: Sampling { least_px, ..sampling },
    }
}

/// `C.ENDING` for the checkpoint `C.onnx`, or `C` with any other name.
fn beside(out: &Path, ending: &str) -> PathBuf {
    let mut name = if out.extension().is_some_and(|e| e == "onnx") { out.with_extension("") } else { out.into() };
    name.as_mut_os_string().push(format!(".{ending}"));
    name
}

/// What is seen of a training: a bar an epoch on stderr, and what the caller makes of it.
struct Screen<'a> {
    bar: progress::Bar,
    options: &'a TrainOptions,
    epochs: u32,
    show: &'a mut dyn FnMut(&Epoch) -> anyhow::Result<()>,
    /// Why an epoch could not be shown.
    failed: Option<anyhow::Error>,
}

impl Screen<'_> {
    fn watch(&mut self, progress: Progress<'_>) {
        match progress {
            Progress::Loaded { train, val, epochs, steps } => {
                let (train, done) = (count(train, "frame"), count(epochs, "epoch"));
                say(format_args!("{train} to learn from, {val} to measure on; {done} done"));
                let left = u64::from(self.epochs.saturating_sub(epochs)) * steps as u64;
                self.bar = progress::bar("train", left);
            }
            Progress::Step { loss, .. } => {
                self.bar.inc(1);
                self.bar.set_message(format!("loss {loss:.3}"));
            }
            Progress::Epoch(report) => {
                let epoch = Epoch::new(report, self.options);
                self.failed = self.bar.suspend(|| (self.show)(&epoch)).err();
            }
        }
    }
}
