//! Objects and signals beside a road.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::constants::{PIECE_M, RECORDS};
use super::document::children;
use super::numbers::number;
use super::sums::{Sum, Sums, at_most};
use crate::baking::error::BakeError;

/// Longer sides of objects count as this, metres.
const SIDE_M: f64 = 200.0;

/// The objects of a file by their ids, which references name.
pub type References<'a> = BTreeMap<&'a str, Node<'a, 'a>>;

/// Every object that has an id, the first of each.
pub fn references<'a>(root: Node<'a, 'a>) -> References<'a> {
    let mut found = References::new();
    let parents = root.children().flat_map(|n| children(n, "objects"));
    for object in parents.flat_map(|objects| children(objects, "object")) {
        if let Some(id) = object.attribute("id") {
            found.entry(id).or_insert(object);
        }
    }
    found
}

/// Checks the objects and signals of a road with so many `lanes`, which each of them keeps.
pub fn check(road: Node<'_, '_>, lanes: usize, references: &References<'_>, sums: &mut Sums) -> Result<(), BakeError> {
    for node in children(road, "objects").flat_map(|objects| objects.children()).filter(|n| n.is_element()) {
        let named = || node.attribute("id").and_then(|id| references.get(id)).copied();
        let object = if node.has_tag_name("objectReference") { named() } else { Some(node) };
        let Some(object) = object else { continue };
        let copies = if is_structure(object) { pieces(road, object) } else { copies(object) };
        sums.add(Sum::Objects, copies, node)?;
        sums.add(Sum::Covered, copies * covered_m2(object), node)?;
        sums.add(Sum::CopiedBytes, (copies - 1.0) * object.range().len() as f64, node)?;
        sums.add(Sum::Steps, copies * lanes as f64, node)?;
    }
    for node in children(road, "signals").flat_map(|signals| signals.children()).filter(|n| n.is_element()) {
        sums.add(Sum::Signals, 1.0, node)?;
        sums.add(Sum::Steps, lanes as f64, node)?;
    }
    let types = children(road, "type").count();
    at_most(road, types, RECORDS, "records <type>")?;
    sums.add(Sum::Steps, (types * lanes) as f64, road)
}

/// Whether it is a bridge or tunnel, which is built along its road.
fn is_structure(node: Node<'_, '_>) -> bool {
    ["bridge", "tunnel"].iter().any(|name| node.has_tag_name(*name))
}

/// More pieces than a bridge or tunnel of a road is built of, in each of its sections.
fn pieces(road: Node<'_, '_>, structure: Node<'_, '_>) -> f64 {
    let length_m = |node| number(node, "length").unwrap_or(0.0).max(0.0);
    let sections = children(road, "lanes").flat_map(|lanes| children(lanes, "laneSection")).count();
    4.0 * (length_m(structure).min(length_m(road)) / f64::from(PIECE_M) + sections as f64)
}

/// How often an object stands there.
fn copies(object: Node<'_, '_>) -> f64 {
    let of = |repeat: Node<'_, '_>| {
        let (length_m, distance_m) = (number(repeat, "length"), number(repeat, "distance"));
        match (length_m, distance_m) {
            (Some(length_m), Some(distance_m)) if distance_m > 0.0 => (length_m.max(0.0) / distance_m).max(0.0) + 1.0,
            _ => 1.0,
        }
    };
    children(object, "repeat").map(of).sum::<f64>().max(1.0)
}

/// What lies below an object, each side a metre longer, m²; of one too large for any object, what counts as that.
fn covered_m2(object: Node<'_, '_>) -> f64 {
    let own = |name| number(object, name).unwrap_or(0.0);
    let repeated = |names: [&str; 2]| {
        let numbers = children(object, "repeat").flat_map(|node| names.map(|name| number(node, name).unwrap_or(0.0)));
        numbers.fold(0.0, f64::max)
    };
    let spread = |names: [&str; 2]| {
        let corners = object.descendants().filter(|n| n.tag_name().name().starts_with("corner"));
        let numbers = corners.filter_map(|corner| names.iter().find_map(|name| number(corner, name)));
        let (low, high) = numbers.fold((f64::MAX, f64::MIN), |(low, high), n| (low.min(n), high.max(n)));
        (high - low).max(0.0)
    };
    let round_m = 2.0 * own("radius").max(repeated(["radiusStart", "radiusEnd"]));
    let length_m = own("length").max(repeated(["lengthStart", "lengthEnd"])).max(round_m).max(spread(["u", "s"]));
    let width_m = own("width").max(repeated(["widthStart", "widthEnd"])).max(round_m).max(spread(["v", "t"]));
    let side = |m: f64| m.min(SIDE_M) + 1.0;
    side(length_m) * side(width_m)
}
