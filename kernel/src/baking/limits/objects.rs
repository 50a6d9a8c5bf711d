//! Objects and signals beside a road.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::constants::RECORDS;
use super::document::children;
use super::numbers::number;
use super::sums::{Sum, Sums, at_most};
use crate::baking::error::BakeError;

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
        let copies = copies(object);
        sums.add(Sum::Objects, copies, node)?;
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
