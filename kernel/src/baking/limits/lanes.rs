//! Lane sections, and the lanes in them.

use std::ops::Range;

use roxmltree::Node;

use super::constants::{ASIDE_M, LANES, RECORDS, SECTIONS, WIDTH_M};
use super::cubic::Profile;
use super::document::children;
use super::marks;
use super::numbers::number;
use super::stretch::{Along, Section};
use super::sums::{Sum, Sums, at_most};
use crate::baking::error::BakeError;

/// Side of the squares in which lanes are looked up, metres, and points of a lane that are one entry there.
const SQUARE_M: f64 = 10.0;
const STRETCH: f64 = 8.0;

/// The lanes of a road.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lanes {
    pub count: usize,
    /// How many lie beside each other, on average.
    pub per_m: f64,
}

/// One side of a section; the next one may go on with it, so it may have begun before.
#[derive(Clone, Copy, Default)]
struct Side<'a> {
    node: Option<Node<'a, 'a>>,
    start_m: f64,
}

/// Checks the lanes of a road, and says how many there are.
pub fn check(along: &Along<'_>, sums: &mut Sums) -> Result<Lanes, BakeError> {
    let mut all = Lanes::default();
    for lanes in children(along.node, "lanes") {
        let mut sections: Vec<_> = children(lanes, "laneSection").collect();
        at_most(lanes, sections.len(), SECTIONS, "lane sections of a road")?;
        let start = |section: &Node<'_, '_>| number(*section, "s").unwrap_or(0.0).max(0.0);
        sections.sort_by(|a, b| start(a).total_cmp(&start(b)));
        let offsets = Profile::read(lanes, "laneOffset", "s")?;
        let mut sides = [Side::default(); 3];
        for (k, section) in sections.iter().enumerate() {
            let end = sections.get(k + 1).map_or(along.length_m, start).min(along.length_m);
            let over = start(section)..end.max(start(section));
            go_on(&mut sides, *section, over.start);
            let count = of_section(along, *section, &over, &sides, &offsets, sums)?;
            all.count += count;
            all.per_m += count as f64 * (over.end - over.start) / along.length_m;
        }
    }
    Ok(all)
}

/// The sides of a section: its own, or of one that tells a single side, those before.
fn go_on<'a>(sides: &mut [Side<'a>; 3], section: Node<'a, 'a>, start_m: f64) {
    let is_single = matches!(section.attribute("singleSide"), Some("true" | "1"));
    for (side, tag) in sides.iter_mut().zip(["left", "center", "right"]) {
        let node = children(section, tag).next();
        if node.is_some() || !is_single {
            *side = Side { node, start_m };
        }
    }
}

fn of_section<'a>(
    along: &Along<'_>,
    section: Node<'a, 'a>,
    over: &Range<f64>,
    sides: &[Side<'a>; 3],
    offsets: &Profile<'_>,
    sums: &mut Sums,
) -> Result<usize, BakeError> {
    let of_side = |side: &Side<'a>| {
        let start_m = side.start_m;
        side.node.into_iter().flat_map(move |node| children(node, "lane").map(move |lane| (lane, start_m)))
    };
    let [left, center, right] = sides;
    let lanes = || of_side(left).chain(of_side(right));
    let count = lanes().count();
    at_most(section, count, LANES, "lanes of a section")?;
    let mut bend = !offsets.is_constant(over);
    let mut records = along.records + offsets.len();
    let mut squares = 0.0;
    for (lane, start_m) in lanes() {
        let within = over.start - start_m..over.end - start_m;
        let (widths, borders) = (Profile::read(lane, "width", "sOffset")?, Profile::read(lane, "border", "sOffset")?);
        let width_m = widths.within(&within, WIDTH_M, "a lane width", "m", false)?;
        let aside_m = borders.within(&within, ASIDE_M, "a lane border", "m", true)?;
        bend |= !widths.is_constant(&within) || !borders.is_constant(&within);
        let across = 2.0 + width_m.max(aside_m) / SQUARE_M;
        squares += across * across / STRETCH;
        let others = lane.children().filter(|n| n.is_element() && !n.has_tag_name("roadMark")).count();
        at_most(lane, others, 2 * RECORDS, "records of a lane")?;
        records += others;
    }
    let stations = along.stations(over, bend);
    sums.add(Sum::Steps, along.geometries() as f64, section)?;
    sums.add(Sum::LanePoints, stations * count as f64, section)?;
    sums.add(Sum::Squares, stations * squares, section)?;
    sums.add(Sum::Steps, stations * count as f64 * records as f64, section)?;
    let section = Section { length_m: over.end - over.start, stations, records };
    of_side(center).chain(lanes()).try_for_each(|(lane, _)| marks::check(lane, &section, sums))?;
    Ok(count)
}
