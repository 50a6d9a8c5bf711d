//! What adds up over a file.

use roxmltree::Node;

use super::constants::{ALL_ROADS_M, COPIED_BYTES, COVERED, DASHES, LANE_POINTS, OBJECTS, SIGNALS, SQUARES, STEPS};
use super::place::refused;
use crate::baking::error::BakeError;

/// Numbers from this on are said by their order alone.
const MOST_DIGITS: f64 = 1e12;

/// What adds up over a file, each with its limit.
#[derive(Clone, Copy, Debug)]
pub enum Sum {
    Roads,
    Geometry,
    LanePoints,
    Squares,
    Dashes,
    Objects,
    Covered,
    Signals,
    CopiedBytes,
    Steps,
}

impl Sum {
    /// The limit, and how the refusal says it.
    fn limit(self) -> (f64, &'static str) {
        match self {
            Self::Roads => (ALL_ROADS_M, "m of roads"),
            Self::Geometry => (ALL_ROADS_M, "m of geometry"),
            Self::LanePoints => (LANE_POINTS, "points on the centre lines of lanes"),
            Self::Squares => (SQUARES, "squares of 10 m that parts of lanes touch"),
            Self::Dashes => (DASHES, "dashes of road marks"),
            Self::Objects => (OBJECTS, "objects, repeated ones each time"),
            Self::Covered => (COVERED, "m² below objects, repeated ones each time,"),
            Self::Signals => (SIGNALS as f64, "signals"),
            Self::CopiedBytes => (COPIED_BYTES, "bytes of text in repeated objects"),
            Self::Steps => (STEPS, "steps of computing"),
        }
    }
}

/// The sums so far.
#[derive(Debug, Default)]
pub struct Sums([f64; Sum::Steps as usize + 1]);

impl Sums {
    /// Adds what `node` needs; refused where the whole file then needs too much.
    pub fn add(&mut self, sum: Sum, amount: f64, node: Node<'_, '_>) -> Result<(), BakeError> {
        let total = &mut self.0[sum as usize];
        *total += amount;
        let (limit, what) = sum.limit();
        if *total <= limit {
            return Ok(());
        }
        let total = if *total < MOST_DIGITS { format!("{total:.0}") } else { format!("{total:.0e}") };
        Err(refused(node, format!("expected at most {limit} {what} in the file, but with these it has {total}")))
    }
}

/// Refuses more than `most` of something in one place.
pub fn at_most(node: Node<'_, '_>, count: usize, most: usize, what: &str) -> Result<(), BakeError> {
    if count <= most {
        return Ok(());
    }
    Err(refused(node, format!("expected at most {most} {what}, but there are {count}")))
}
