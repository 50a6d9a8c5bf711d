//! The card beside a checkpoint: what it is, and how to make it again.

use std::path::Path;

use base::files::{self, most};
use perception::classes::TRAIN_CLASSES;
use perception::training::{CLASS_WEIGHT_OFFSET, EpochReport, LOGIT_STRIDE, Looks, Sampling, TrainOptions, Trained};

use super::curves::number;
use super::options::Options;

/// The content of `C.md`.
pub(super) fn card(args: &Options, options: &TrainOptions, trained: &Trained) -> String {
    let name = args.out.file_stem().unwrap_or_default().to_string_lossy();
    let TrainOptions { seed, width, height, batch, replicas, rate, .. } = options;
    let mut card = format!(
        "# {name}\n\n\
         Fast-SCNN (Poudel et al. 2019) whose classifier gives 4x4 logits a position (dense upsampling, Wang et al. \
         2018): {} parameters, 16 classes, input {width}x{height}, logits at stride {LOGIT_STRIDE}.\n\n\
         | recipe | |\n|---|---|\n\
         | epochs | {} |\n\
         | frames | {} to learn from, {} to measure on (scenes of seeds of their own) |\n\
         | dataset | {}; BLAKE3 over its files `{}` |\n\
         | seed | {seed} |\n\
         | optimiser | Adam, rate {rate}, polynomial decay of power 0.9 |\n\
         | batch | {batch} in {replicas} replicas |\n\
         | loss | cross-entropy at full resolution, a class weighs 1 / ln({CLASS_WEIGHT_OFFSET} + its share of the pixels) |\n\
         | augmentation | {} |\n\
         {}\
         | digest | BLAKE3 `{}` |\n\n",
        trained.parameters,
        epochs(options, trained),
        trained.train_frames,
        trained.val_frames,
        dataset_recipe(&args.dataset),
        trained.dataset,
        augmentation(&options.looks),
        sampling(&options.sampling),
        blake3::hash(&trained.onnx).to_hex(),
    );
    if let Some(kept) = trained.history.iter().find(|report| report.epoch == trained.epoch) {
        card += &format!("| class | validation IoU |\n|---|---|\n| **mean** | **{}** |\n", number(kept.miou));
        for (class, iou) in TRAIN_CLASSES.iter().zip(&kept.iou) {
            card += &format!("| {} | {} |\n", class.name, number(*iou));
        }
    }
    card += "\n| epoch | loss | mIoU |\n|---|---|---|\n";
    for EpochReport { epoch, loss, miou, .. } in &trained.history {
        card += &format!("| {epoch} | {loss:.4} | {} |\n", number(*miou));
    }
    card
}

/// What is done to pictures.
fn augmentation(looks: &Looks) -> String {
    let mut text = "horizontal flip; windows enlarged up to twice; contrast, brightness and tint".to_owned();
    let Looks { gamma, saturation, hue_deg, blur_px, noise } = *looks;
    if *looks != Looks::default() {
        text += &format!(
            "; to half of the pictures each: gamma up to e^{gamma}, saturation up to {saturation}, hue up to {hue_deg} \
             degrees, blur up to {blur_px} px, noise up to {noise}"
        );
    }
    text
}

/// A row on what is rare, where anything is done about it.
fn sampling(sampling: &Sampling) -> String {
    let Sampling { rare_below, round_rare, tall_px, least_px } = *sampling;
    if *sampling == Sampling::default() {
        return String::new();
    }
    format!(
        "| sampling | frames with what is in less than {rare_below} of them more often (Gupta et al. 2019); {round_rare} \
         of the pictures laid round people of {tall_px} px and more, or else what is rare; people of less than {least_px} \
         px count nowhere |\n"
    )
}

/// How many there were, and why no more.
fn epochs(options: &TrainOptions, trained: &Trained) -> String {
    let (done, horizon) = (trained.history.len(), options.horizon);
    let stopped = if done < horizon as usize { " (stopped on purpose)" } else { "" };
    match options.patience {
        None => format!("{done} of a schedule of {horizon}{stopped}"),
        Some(patience) => format!(
            "{} of {done} is kept, the best; a schedule of {horizon}, to be stopped after {patience} without a better \
             validation mIoU",
            trained.epoch
        ),
    }
}

/// What the folder says about how it was made.
fn dataset_recipe(dataset: &Path) -> String {
    let text = files::read_text(&dataset.join("dataset.json"), most::TABLE).unwrap_or_default();
    let about: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    match (&about["kind"], &about["recipe"]) {
        (serde_json::Value::String(kind), recipe) if recipe.is_object() => format!("{kind}, recipe `{recipe}`"),
        _ => "of unknown making".into(),
    }
}
