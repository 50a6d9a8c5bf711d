//! What a file may hold, looked at before it is interpreted: numbers that are some, counts and sizes
//! that a machine can bear. Files come from strangers.

mod constants;
mod crowd;
mod cubic;
mod document;
mod ids;
mod junctions;
mod lanes;
mod marks;
mod numbers;
mod objects;
mod place;
mod roads;
mod stretch;
mod sums;

pub use constants::{CROWD, EXTENT_M, LANE_POINTS};
pub use document::malformed;

use self::constants::ROADS;
use self::crowd::Crowd;
use self::sums::{Sums, at_most};
use super::error::BakeError;

/// Refuses a text that holds more than any map does.
pub fn check(text: &str) -> Result<(), BakeError> {
    let body = document::body(text)?;
    let document = document::parse(&body)?;
    let root = document.root_element();
    let roads = root.children().filter(|n| n.has_tag_name("road"));
    at_most(root, roads.clone().count(), ROADS, "roads")?;
    ids::check(roads.clone())?;
    let mut sums = Sums::default();
    let mut crowd = Crowd::default();
    let references = objects::references(root);
    for road in roads {
        numbers::check(road)?;
        roads::check(road, &references, &mut sums, &mut crowd)?;
    }
    crowd.check()?;
    junctions::check(root, &references, &mut sums)
}
