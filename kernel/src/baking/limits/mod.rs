//! What a file may hold, looked at before it is interpreted: numbers that are some, counts and sizes
//! that a machine can bear. Files come from strangers.

mod constants;
mod crowd;
mod cubic;
mod document;
mod elements;
mod ids;
mod junctions;
mod lanes;
mod marks;
mod missing;
mod numbers;
mod objects;
mod origin;
mod place;
mod roads;
mod speeds;
mod stretch;
mod sums;

pub use constants::{CROSSINGS, CROWD, EXTENT_M, LANE_POINTS, PIECE_M};
pub use document::malformed;

use std::borrow::Cow;

use self::constants::ROADS;
use self::crowd::Crowd;
use self::sums::{Sums, at_most};
use super::error::BakeError;
use super::notes::Notes;

/// A text that may be interpreted.
pub struct Checked<'a> {
    /// It itself, or where its coordinates are large, the same about an origin of its own.
    pub text: Cow<'a, str>,
    /// What was subtracted from its coordinates, metres east and north.
    pub origin_m: [f64; 2],
    /// How many roads it names.
    pub roads: usize,
}

/// Refuses a text that holds more than any map does; notes what is not read of it.
pub fn check<'a>(text: &'a str, notes: &mut Notes) -> Result<Checked<'a>, BakeError> {
    let body = document::body(text)?;
    let document = document::parse(&body)?;
    let root = document.root_element();
    let roads = root.children().filter(|n| n.has_tag_name("road"));
    let count = roads.clone().count();
    at_most(root, count, ROADS, "roads")?;
    ids::check(roads.clone())?;
    let mut sums = Sums::default();
    let mut crowd = Crowd::default();
    let references = objects::references(root);
    for road in roads.clone() {
        numbers::check(road)?;
        speeds::check(road)?;
        roads::check(road, &references, &mut sums, &mut crowd)?;
    }
    crowd.check()?;
    junctions::check(root, &references, &mut sums)?;
    elements::note(root, notes);
    missing::note(root, notes);
    let origin_m = origin::of(roads);
    let text = if origin_m == [0.0; 2] { text.into() } else { origin::subtract(&document, origin_m).into() };
    Ok(Checked { text, origin_m, roads: count })
}
