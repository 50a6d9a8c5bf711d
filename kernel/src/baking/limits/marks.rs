//! Road marks.

use roxmltree::Node;

use super::constants::{MARK_LINES, MARKS};
use super::document::children;
use super::numbers::number;
use super::stretch::Section;
use super::sums::{Sum, Sums, at_most};
use crate::baking::error::BakeError;

/// Period of a broken line that the file does not tell, metres.
const BROKEN_M: f64 = 12.0;

/// Checks the marks along a lane's border.
pub fn check(lane: Node<'_, '_>, section: &Section, sums: &mut Sums) -> Result<(), BakeError> {
    let marks: Vec<_> = children(lane, "roadMark").collect();
    at_most(lane, marks.len(), MARKS, "road marks of a lane")?;
    let mut starts: Vec<f64> = marks.iter().map(|m| number(*m, "sOffset").unwrap_or(0.0)).collect();
    starts.sort_by(f64::total_cmp);
    for mark in marks {
        let start = number(mark, "sOffset").unwrap_or(0.0);
        let next = starts.get(starts.partition_point(|s| *s <= start)).copied().unwrap_or(section.length_m);
        of_mark(mark, next.min(section.length_m) - start, section, sums)?;
    }
    Ok(())
}

fn of_mark(mark: Node<'_, '_>, length_m: f64, section: &Section, sums: &mut Sums) -> Result<(), BakeError> {
    let groups = || mark.children().filter(|n| n.has_tag_name("type") || n.has_tag_name("explicit"));
    let lines: Vec<_> = groups().flat_map(|group| children(group, "line")).collect();
    at_most(mark, lines.len(), MARK_LINES, "lines of a road mark")?;
    let sways = mark.children().filter(|n| n.has_tag_name("sway")).count();
    let stations = section.stations * (length_m / section.length_m.max(1e-3)).clamp(0.0, 1.0) + 2.0;
    let mut paint = |period_m: f64| {
        let dashes = (length_m.max(0.0) / period_m + 1.0).max(1.0);
        sums.add(Sum::Dashes, dashes, mark)?;
        // Each dash is cut at the stations that it passes; where they are follows from all records.
        let cuts = (dashes + stations) * 4.0 * (section.records + sways) as f64;
        sums.add(Sum::Steps, dashes * section.stations + cuts, mark)
    };
    let is_broken = mark.attribute("type").is_some_and(|kind| kind.contains("broken"));
    match lines.is_empty() {
        true => paint(if is_broken { BROKEN_M } else { f64::INFINITY }),
        false => lines.into_iter().try_for_each(|line| {
            let of = |name| number(line, name).unwrap_or(0.0).max(0.0);
            let is_dashed = line.parent().is_some_and(|group| group.has_tag_name("type")) && of("space") > 0.0;
            paint(if is_dashed { of("length") + of("space") } else { f64::INFINITY })
        }),
    }
}
