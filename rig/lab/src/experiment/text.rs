//! Both tables as text.

use measures::statistics::table;

use super::table_1::{Score, TestScores};
use super::tables::Tables;
use crate::figures::decimal;

/// Tables 1 and 2.
pub fn tables(tables: &Tables) -> String {
    let mut lines = vec![format!(
        "{:<12} {:>12}   {:<40}   {}",
        "trained on", "ped px/frame", "safety-critical: IoU pedestrian, mIoU", "natural: IoU pedestrian, mIoU"
    )];
    for row in &tables.table_1 {
        let pixels = row.pedestrian_pixels_per_frame;
        lines.push(format!(
            "{:<12} {pixels:>12.1}   {:<40}   {}",
            row.set.name(),
            both(&row.safety_critical),
            both(&row.natural)
        ));
    }
    for row in tables.table_1.iter().filter(|row| row.safety_critical.miou.gain.is_some()) {
        lines.push(format!("{} minus natural, 95 %:", row.set.name()));
        for (test, scores) in [("safety-critical", &row.safety_critical), ("natural", &row.natural)] {
            let (pedestrian, miou) = (gain(&scores.pedestrian_iou), gain(&scores.miou));
            lines.push(format!("  {test:<16} IoU pedestrian {pedestrian}, mIoU {miou}"));
        }
    }
    let columns = tables.table_2.iter().map(|c| (c.checkpoint.as_str(), &c.statistics, c.against_reference.as_ref()));
    lines.push(String::new());
    lines.push(table(columns));
    lines.join("\n")
}

fn both(scores: &TestScores) -> String {
    format!("{}, {}", decimal(scores.pedestrian_iou.mean), decimal(scores.miou.mean))
}

/// A gain with its interval.
pub fn gain(score: &Score) -> String {
    match (score.gain, score.gain_95) {
        (Some(gain), Some((low, high))) => format!("{gain:+.3} [{low:+.3}, {high:+.3}]"),
        _ => "-".into(),
    }
}
