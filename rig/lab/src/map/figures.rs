//! What is told of a map.

use base::json::Typed;
use serde::Serialize;

/// What is in a map, and what was not understood of its file.
#[derive(Clone, Debug, Serialize)]
pub struct Inspected {
    /// Its file, or the name of a bundled map.
    pub file: String,
    /// What it is called.
    pub name: String,
    /// Digest of what it bakes to, as recordings hold it.
    pub digest: String,
    /// Version of OpenDRIVE that the file declares; empty without one.
    pub opendrive: String,
    /// What wrote the file, as it says.
    pub vendor: String,
    /// What was subtracted from the coordinates of the file, metres east and north.
    pub origin_m: [f64; 2],
    /// Countries of roads and signals, as the file writes them; signs of files that name none are those of Germany.
    pub countries: Vec<String>,
    /// Side of the road that is driven on: `right`, `left`, or `both` where roads differ.
    pub traffic_side: &'static str,
    /// From the westernmost to the easternmost lane, and from the southernmost to the northernmost, metres.
    pub extent_m: [f64; 2],
    /// Heights.
    pub relief: Relief,
    /// Lanes by kind.
    pub lanes: Vec<Lanes>,
    /// Driving lanes by their speed limit.
    pub limits: Vec<Limit>,
    /// Roads that have a lane.
    pub roads: usize,
    /// Those of them that lead through junctions.
    pub roads_inside: usize,
    /// Junctions by what tells who goes first.
    pub junctions: Junctions,
    /// Circles on which traffic drives round; each has a junction at every way in.
    pub roundabouts: usize,
    /// Crosswalks with lights.
    pub crosswalks_lit: usize,
    /// Crosswalks without.
    pub crosswalks_unlit: usize,
    /// Stops at which buses halt.
    pub bus_stops: usize,
    /// Room to park, and who does.
    pub parking: Parking,
    /// What stands around, by kind.
    pub props: Vec<Props>,
    /// Ways of people on foot.
    pub walkways: Walkways,
    /// Whether every driving lane leads to every other.
    pub reach: Reach,
    /// What was not understood of the file, by kind, the largest groups first.
    pub not_understood: Vec<NotUnderstood>,
}

/// What `aeye map inspect` prints, a line for each file.
impl Typed for Inspected {
    const TYPE: &'static str = "aeye.map";
}

/// Heights of a map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Relief {
    /// Lowest place of a lane, metres.
    pub lowest_m: f64,
    /// Highest place of a lane, metres.
    pub highest_m: f64,
    /// Greatest gradient of a driving lane over five metres, either way.
    pub gradient_pct: f64,
    /// The lane that is so steep; empty on flat maps.
    pub steepest: String,
}

/// Lanes of a kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lanes {
    /// What they are for: `driving`, `biking`, `sidewalk`, `shoulder`, `parking` or `other`.
    pub kind: &'static str,
    /// Their type in OpenDRIVE.
    pub lane_type: &'static str,
    /// How many, from section to section.
    pub count: usize,
    /// Kilometres of them.
    pub km: f64,
}

/// Driving lanes with a speed limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// The limit.
    pub kmh: f64,
    /// Kilometres of them.
    pub km: f64,
}

/// Junctions by what tells who goes first; each counts once, for what comes first here.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Junctions {
    /// All of them.
    pub count: usize,
    /// With traffic lights.
    pub signals: usize,
    /// Of roundabouts.
    pub roundabout: usize,
    /// With stop signs.
    pub stop: usize,
    /// With signs to give way.
    pub give_way: usize,
    /// With signs of priority alone, or records of priority in the file.
    pub priority: usize,
    /// With none of these: right before left.
    pub right_before_left: usize,
    /// Nobody's way meets another's.
    pub open: usize,
}

/// Room to park.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parking {
    /// Kilometres of parking lanes.
    pub lanes_km: f64,
    /// Parked cars.
    pub cars: usize,
}

/// What stands around, of a kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Props {
    /// What it is.
    pub kind: &'static str,
    /// How many the file names.
    pub named: usize,
    /// How many dress the map where the file has none.
    pub made_up: usize,
}

/// Ways of people on foot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Walkways {
    /// Kilometres of sidewalks and crosswalks.
    pub km: f64,
    /// Parts between which nobody can walk.
    pub parts: usize,
}

/// Which driving lanes lead to which, with changes of lanes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reach {
    /// Kilometres of driving lanes.
    pub km: f64,
    /// Largest sets of lanes that all lead to each other; 1 where every lane leads to every other.
    pub parts: usize,
    /// Kilometres of driving lanes outside the largest part.
    pub outside_km: f64,
    /// How many lanes lie outside it.
    pub outside_lanes: usize,
    /// Some of them, as road and lane.
    pub outside: Vec<String>,
    /// Driving lanes that lead nowhere.
    pub dead_ends: usize,
    /// Some of them.
    pub dead_end_lanes: Vec<String>,
}

/// Things of the file that were passed over alike.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NotUnderstood {
    /// What kind of thing: `warning` of the parser, `reference`, `signal`, `object`, `lane`, `road mark`, `surface` or `element`.
    pub kind: &'static str,
    /// What the file calls it.
    pub what: String,
    /// Why, or what became of it instead; empty where `first` says so.
    pub why: &'static str,
    /// How many.
    pub count: usize,
    /// Where the first of them is; of a warning all that the parser says.
    pub first: String,
}
