//! Roads and their sections, as what lies along them needs to know them.

use std::ops::Range;

use roxmltree::Node;

/// A road as its lanes need it.
pub struct Along<'a> {
    pub length_m: f64,
    /// How densely the lanes of each geometry have points.
    pub stations: Vec<(Range<f64>, f64)>,
    /// Records of elevation, superelevation and lateral profile, each looked at for every station of a lane.
    pub records: usize,
    pub node: Node<'a, 'a>,
}

/// Points of a lane per metre: where everything is straight, and where it bends most.
pub const STRAIGHT_PER_M: f64 = 0.5;
pub const BENT_PER_M: f64 = 4.0;
/// From one point to the next, a lane turns by this at most where it may have fewer than [`BENT_PER_M`].
pub const POINT_RAD: f64 = 0.03;

impl Along<'_> {
    /// Points that a lane may have in a stretch, of which the lanes bend by themselves as well or do not.
    pub fn stations(&self, over: &Range<f64>, lanes_bend: bool) -> f64 {
        let length_m = over.end - over.start;
        if lanes_bend {
            return length_m * BENT_PER_M + 2.0;
        }
        let of = |(stretch, per_m): &(Range<f64>, f64)| {
            (stretch.end.min(over.end) - stretch.start.max(over.start)).max(0.0) * (per_m - STRAIGHT_PER_M)
        };
        length_m * STRAIGHT_PER_M + self.stations.iter().map(of).sum::<f64>() + 2.0
    }

    /// How many geometries [`Self::stations`] looks at.
    pub fn geometries(&self) -> usize {
        self.stations.len()
    }
}

/// A stretch of a road with the same lanes.
pub struct Section {
    pub length_m: f64,
    /// Where its lanes have points, at most.
    pub stations: f64,
    /// Records that tell where the lanes are, each looked at for every station.
    pub records: usize,
}
