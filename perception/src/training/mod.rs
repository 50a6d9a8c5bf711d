//! Trains Fast-SCNN from a dataset folder and writes it as ONNX.
//!
//! The network is told once (`network`) and read three times: to draw first weights, to run on
//! burn's tape, to write ONNX. A batch is shared out over a fixed number of replicas, each with its
//! own thread and batch statistics, whose derivatives are averaged in order: the same options and
//! dataset give the same bytes on one machine, however many cores it has.

mod adam;
mod dataset;
mod export;
mod flex;
#[cfg(test)]
mod gradient;
mod kernels;
mod light;
mod network;
mod options;
mod people;
mod pictures;
mod progress;
mod random;
mod resample;
mod run;
mod sampling;
mod state;
mod tape;
mod view;
mod weights;

use std::ops::ControlFlow;
use std::path::Path;

pub use dataset::{Frame, Split, check_train_ids, image_paths};
pub use light::Looks;
pub use network::LOGIT_STRIDE;
pub use options::{Preset, TrainOptions};
pub use people::{Person, people};
pub use pictures::CLASS_WEIGHT_OFFSET;
pub use progress::{EpochReport, Progress, Trained};
pub use sampling::Sampling;

use crate::{Checkpoint, PerceptionError};

/// Trains until `epochs` passes over the split `train` are done or patience is at its end, or until
/// `watch` breaks; then `None` comes back. After every epoch the network is measured on the split `val` and saved at
/// `unfinished`, from where the same call goes on. The caller removes that file when it is no longer
/// needed.
pub fn train(
    dataset: &Path,
    unfinished: &Path,
    options: &TrainOptions,
    epochs: u32,
    watch: &mut dyn FnMut(Progress<'_>) -> ControlFlow<()>,
) -> Result<Option<Trained>, PerceptionError> {
    options.check()?;
    let mut run = run::Run::open(dataset, unfinished, options)?;
    if run.epochs() > epochs {
        let reason = format!(
            "{epochs} epochs, but {} has {} already; expected at least as many, or another file",
            unfinished.display(),
            run.epochs()
        );
        return Err(PerceptionError::TrainOptions { reason });
    }
    if run.announce(watch).is_break() {
        return Ok(None);
    }
    while run.epochs() < epochs && !run.is_out_of_patience() {
        if run.epoch(watch)?.is_break() {
            return Ok(None);
        }
        run.save(unfinished)?;
        if run.report(watch).is_break() {
            return Ok(None);
        }
    }
    run.finish(epochs).map(Some)
}

/// Which training a checkpoint comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// It is what [`train`] would give.
    This,
    /// The same training with another number of epochs.
    OtherEpochs,
    /// Another one, or none that it tells of.
    Foreign,
}

/// Whether a checkpoint comes from [`train`] with these options, this number of epochs and this dataset,
/// by what it tells of itself.
pub fn origin(
    checkpoint: &Checkpoint,
    dataset: &Path,
    options: &TrainOptions,
    epochs: u32,
) -> Result<Origin, PerceptionError> {
    options.check()?;
    let text = checkpoint.recipe().unwrap_or_default();
    let told: serde_json::Value = serde_json::from_str(text).unwrap_or_default();
    let (Some(digest), Some(epoch)) = (told["dataset"].as_str(), told["epochs"].as_u64()) else {
        return Ok(Origin::Foreign);
    };
    // With patience the best epoch is known only afterwards.
    let limit = told["limit"].as_u64().map_or(epochs, |limit| limit as u32);
    let is_known = run::recipe(options, epoch, limit, digest) == text
        && run::digest(&run::read(dataset, options)?).to_hex().as_str() == digest;
    let is_long_enough = if options.patience.is_some() { limit == epochs } else { epoch == u64::from(epochs) };
    Ok(match (is_known, is_long_enough) {
        (false, _) => Origin::Foreign,
        (true, false) => Origin::OtherEpochs,
        (true, true) => Origin::This,
    })
}

#[cfg(test)]
mod tests;
