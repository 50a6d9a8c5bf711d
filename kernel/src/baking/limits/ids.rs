//! What roads say they are: each has an id of its own, and a junction has so many.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use super::constants::JUNCTION_ROADS;
use super::place::refused;
use crate::baking::error::BakeError;

/// Refuses a road whose id another one has (ASAM OpenDRIVE: ids are unique within their class), and more roads inside
/// a junction than any has.
pub fn check<'a>(roads: impl Iterator<Item = Node<'a, 'a>>) -> Result<(), BakeError> {
    let mut ids = BTreeSet::new();
    let mut inside: BTreeMap<&str, usize> = BTreeMap::new();
    for road in roads {
        if let Some(id) = road.attribute("id")
            && !ids.insert(id)
        {
            return Err(refused(road, "expected an id of its own, but another road has it".to_owned()));
        }
        let Some(junction) = road.attribute("junction").filter(|junction| *junction != "-1") else { continue };
        let count = inside.entry(junction).or_default();
        *count += 1;
        if *count > JUNCTION_ROADS {
            return Err(refused(road, format!("expected at most {JUNCTION_ROADS} roads inside a junction")));
        }
    }
    Ok(())
}
