//! What every epoch came to, as lines of JSON and as a picture.

use std::collections::BTreeMap;
use std::fmt;

use base::json::Typed;
use base::json::json_line;
use perception::classes::{PEDESTRIAN, TRAIN_CLASSES};
use perception::training::{EpochReport, TrainOptions};
use serde::Serialize;

use crate::plot::{Axis, Line, Plot, row};

/// An epoch, a line of `C.jsonl`; nothing in it depends on the machine's speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Epoch {
    /// Counted from 1.
    pub epoch: u32,
    /// Mean loss over the epoch's steps.
    pub loss: f64,
    /// Learning rate at its begin.
    pub rate: f32,
    /// Mean IoU over the classes that appear in the validation split.
    pub miou: Option<f64>,
    /// IoU of pedestrians on the validation split.
    pub pedestrian_iou: Option<f64>,
    /// IoU on the validation split by class name.
    pub iou: BTreeMap<&'static str, Option<f64>>,
}

/// A line of `C.jsonl`, and what `aeye train` prints of an epoch.
impl Typed for Epoch {
    const TYPE: &'static str = "aeye.train.epoch";
}

impl fmt::Display for Epoch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { epoch, loss, miou, pedestrian_iou, .. } = self;
        write!(f, "epoch {epoch:3}  loss {loss:.4}  mIoU {}  IoU Pedestrian {}", number(*miou), number(*pedestrian_iou))
    }
}

/// A figure with four decimals, or a dash.
pub(super) fn number(value: Option<f64>) -> String {
    value.map_or("-".into(), |v| format!("{v:.4}"))
}

impl Epoch {
    pub(super) fn new(report: &EpochReport, options: &TrainOptions) -> Self {
        let EpochReport { epoch, loss, miou, iou } = report;
        let of = |train_id: usize| iou.get(train_id).copied().flatten();
        Self {
            epoch: *epoch,
            loss: *loss,
            rate: options.rate_of(*epoch),
            miou: *miou,
            pedestrian_iou: of(PEDESTRIAN),
            iou: TRAIN_CLASSES.iter().enumerate().map(|(id, class)| (class.name, of(id))).collect(),
        }
    }
}

/// The content of `C.jsonl`.
pub(super) fn lines(epochs: &[Epoch]) -> anyhow::Result<String> {
    epochs.iter().map(|epoch| Ok(json_line(epoch)? + "\n")).collect()
}

/// The content of `C.svg`: the loss, and beside it both IoU, over the epochs.
pub(super) fn picture(epochs: &[Epoch]) -> String {
    let last = epochs.last().map_or(1, |e| e.epoch).max(2);
    let x = Axis { name: "epoch", low: 1.0, high: last.into() };
    let line = |name, colour, value: fn(&Epoch) -> f64| {
        let points = epochs.iter().map(|e| (f64::from(e.epoch), value(e))).collect();
        Line { name, colour, points }
    };
    let highest = epochs.iter().map(|e| e.loss).fold(0.0, f64::max);
    row(&[
        Plot {
            title: "Training",
            x,
            y: Axis { name: "loss", low: 0.0, high: if highest > 0.0 { 1.05 * highest } else { 1.0 } },
            lines: vec![line("mean of the epoch", "#c8102e", |e| e.loss)],
        },
        Plot {
            title: "Validation",
            x,
            y: Axis { name: "IoU", low: 0.0, high: 1.0 },
            lines: vec![
                line("mean of the classes", "#1f6feb", |e| e.miou.unwrap_or(f64::NAN)),
                line("Pedestrian", "#b8860b", |e| e.pedestrian_iou.unwrap_or(f64::NAN)),
            ],
        },
    ])
}
