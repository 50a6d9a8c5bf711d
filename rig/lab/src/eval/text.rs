//! An evaluation as tables.

use std::fmt::{self, Formatter};

use base::words::count;
use perception::classes::{PEDESTRIAN, TRAIN_CLASSES};

use super::super::figures::decimal;
use super::super::trust::Trust;
use super::{Group, Range, Recall, Summary, Tall};

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.classes(f)?;
        let a_scene = self.pixels_per_scene.get(TRAIN_CLASSES[PEDESTRIAN].name).copied().unwrap_or_default();
        let (frames, scenes) = (count(self.frames, "frame"), count(self.scenes, "scene"));
        write!(f, "\n{frames} of {scenes} of {}; {a_scene:.1} pixels of pedestrians a scene\n", self.split)?;
        if let Some(trust) = self.trust {
            certainty(f, trust)?;
        }
        let users = self.road_users;
        for (name, group) in [("on foot", &users.pedestrians), ("riders", &users.riders), ("vehicles", &users.vehicles)]
        {
            recall(f, name, group)?;
        }
        self.tall(f)
    }
}

impl Summary<'_> {
    /// A row for each least height.
    fn tall(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "\n{:<14} {:>12} {:>12} {:>12} {:>12}", "not small", "count", "pixels", "recall", "IoU")?;
        for Tall { least_px, count, pixels, iou, recall } in self.tall_people {
            let (name, recall, iou) = (format!("{least_px}+ px high"), decimal(*recall), decimal(*iou));
            write!(f, "\n{name:<14} {count:>12} {pixels:>12} {recall:>12} {iou:>12}")?;
        }
        f.write_str("\n")
    }

    /// IoU and boundary IoU of each class.
    fn classes(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut row = |name: &str, iou: &str, boundary: &str| writeln!(f, "{name:<14} {iou:>12} {boundary:>12}");
        row("IoU", self.checkpoint, "boundary")?;
        for class in &TRAIN_CLASSES {
            row(class.name, &decimal(self.figures.iou[class.name]), &decimal(self.boundary_iou[class.name]))?;
        }
        row("mean", &decimal(self.figures.miou), &decimal(self.mean_boundary_iou))?;
        write!(f, "{:<14} {:>12}", "accuracy", decimal(self.figures.accuracy))
    }
}

fn certainty(f: &mut Formatter<'_>, trust: &Trust) -> fmt::Result {
    let rows = [
        ("expected calibration error", trust.ece),
        ("mean confidence", trust.confidence),
        ("entropy where right", trust.entropy_if_right),
        ("entropy where wrong", trust.entropy_if_wrong),
        ("surely wrong (0.9 or more)", trust.surely_wrong),
        ("the same of pedestrians", trust.surely_wrong_of_people()),
    ];
    f.write_str("\n")?;
    rows.iter().try_for_each(|(name, value)| writeln!(f, "{name:<27} {:>12}", decimal(*value)))
}

/// A row for all, for each range, and for those whose feet or wheels are hidden.
fn recall(f: &mut Formatter<'_>, name: &str, group: &Group) -> fmt::Result {
    write!(f, "\n{name:<14} {:>12} {:>12} {:>12} {:>12}", "count", "pixels", "recall", "half seen")?;
    let mut row = |name: &str, Recall { count, pixels, pixel_recall, half_seen, .. }: &Recall| {
        let (recall, half) = (decimal(*pixel_recall), decimal(*half_seen));
        write!(f, "\n{name:<14} {count:>12} {pixels:>12} {recall:>12} {half:>12}")
    };
    row("all", &group.all)?;
    for (ranges, unit) in [(&group.by_height_px, "px high"), (&group.by_distance_m, "m away")] {
        for Range { from, to, recall } in ranges {
            row(&to.map_or_else(|| format!("{from}+ {unit}"), |to| format!("{from}-{to} {unit}")), recall)?;
        }
    }
    row("feet hidden", &group.feet_hidden)?;
    f.write_str("\n")
}
