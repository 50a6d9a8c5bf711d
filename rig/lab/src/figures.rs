//! Scores as they are printed and written.

use std::collections::BTreeMap;
use std::fmt::Write;

use perception::classes::{PEDESTRIAN, TRAIN_CLASSES};
use perception::{ConfusionMatrix, Scores};
use serde::Serialize;

/// The figures of a confusion matrix; what is not a number is `null` in JSON.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Pixels that count.
    pub pixels: u64,
    /// Share of correct pixels.
    pub accuracy: Option<f64>,
    /// Mean IoU over the classes that appear.
    pub miou: Option<f64>,
    /// IoU of pedestrians.
    pub pedestrian_iou: Option<f64>,
    /// IoU by class name.
    pub iou: BTreeMap<&'static str, Option<f64>>,
}

impl From<&ConfusionMatrix> for Figures {
    fn from(matrix: &ConfusionMatrix) -> Self {
        let Scores { iou, miou, accuracy, pixels } = matrix.scores();
        let number = |value: f64| Some(value).filter(|v| !v.is_nan());
        Self {
            pixels,
            accuracy: number(accuracy),
            miou: number(miou),
            pedestrian_iou: number(iou[PEDESTRIAN]),
            iou: TRAIN_CLASSES.iter().zip(iou).map(|(class, iou)| (class.name, number(iou))).collect(),
        }
    }
}

/// A confusion matrix as it is written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Confusion<'a> {
    /// Names of the classes, in the order of rows and columns.
    pub classes: Vec<&'static str>,
    /// Pixels: a row for each true class; in it a number for each predicted class, and a last one
    /// for those that are not trained.
    pub pixels: &'a [[u64; TRAIN_CLASSES.len() + 1]],
}

impl<'a> From<&'a ConfusionMatrix> for Confusion<'a> {
    fn from(matrix: &'a ConfusionMatrix) -> Self {
        Self { classes: TRAIN_CLASSES.iter().map(|class| class.name).collect(), pixels: matrix.rows() }
    }
}

/// The labelled pixels of each class, divided by the number of scenes or frames.
pub fn pixels_per(matrix: &ConfusionMatrix, count: usize) -> BTreeMap<&'static str, f64> {
    let mean = |id: usize| matrix.truth_pixels(id as u8) as f64 / count as f64;
    TRAIN_CLASSES.iter().enumerate().map(|(id, class)| (class.name, mean(id))).collect()
}

/// A figure between 0 and 1 with three decimals, or a dash.
pub fn decimal(value: Option<f64>) -> String {
    value.map_or("-".into(), |v| format!("{v:.3}"))
}

/// A table with a column for each of the named figures and a row for each class.
pub fn table(columns: &[(String, Figures)]) -> String {
    let mut text = format!("{:<14}", "IoU");
    // Writing to a string cannot fail.
    let mut row = |name: &str, cells: Vec<String>| {
        let _ = write!(text, "{}{name:<14}", if name.is_empty() { "" } else { "\n" });
        cells.iter().for_each(|cell| {
            let _ = write!(text, " {cell:>12}");
        });
    };
    row("", columns.iter().map(|(name, _)| name.clone()).collect());
    for class in &TRAIN_CLASSES {
        row(class.name, columns.iter().map(|(_, f)| decimal(f.iou[class.name])).collect());
    }
    row("mean", columns.iter().map(|(_, f)| decimal(f.miou)).collect());
    row("accuracy", columns.iter().map(|(_, f)| decimal(f.accuracy)).collect());
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absent_classes_are_null_and_dashes() {
        let mut matrix = ConfusionMatrix::default();
        matrix.add(&[7, 7, 4], &[7, 7, 7]);
        let figures = Figures::from(&matrix);
        assert_eq!(figures.iou["Sky"], None);
        assert_eq!(figures.pedestrian_iou, Some(0.0));
        let json = serde_json::to_string(&figures).expect("serialises");
        assert!(json.contains("\"Sky\":null") && json.contains("\"pixels\":3"), "{json}");
        let table = table(&[("full".into(), figures)]);
        assert!(table.starts_with("IoU ") && table.contains("full\nBuilding"), "{table}");
        assert!(table.lines().any(|l| l.starts_with("Road ") && l.ends_with("0.667")), "{table}");
    }
}
