//! Where the ego car starts: on the lane that a scenario names, or on one that its seed draws.

use crate::ego;
use crate::map::{Lane, LaneId, LaneKind, RoadNetwork};
use crate::rng::{self, Stream};
use crate::story::Stage;

use super::fields::Scenario;

/// Shortest lane on which a car starts when the scenario names none, metres.
const LEAST_LANE_M: f32 = 20.0;
/// So far from the end of a lane from which none leads on it starts, metres: a run ends there.
const BEFORE_END_M: f32 = 40.0;
/// Ranges of lanes that a refusal names at most.
const RANGES_NAMED: usize = 8;

/// Why the ego car cannot start on a map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct StartError {
    /// The key of the scenario that does not fit the map; none where no scenario would.
    pub key: Option<&'static str>,
    /// What does not fit, and what would.
    pub reason: String,
}

impl Scenario {
    /// Where the ego car starts on a map: lane, and distance along it of the middle of the car, metres.
    pub fn start_on(&self, network: &RoadNetwork) -> Result<(LaneId, f32), StartError> {
        if let Some(story) = &self.story {
            let refused = |reason| StartError { key: Some("story"), reason };
            return Stage::new(story, network).and_then(|stage| stage.ego_road(network)).map_err(refused);
        }
        match self.ego.lane {
            Some(lane) => given(network, lane, self.ego.s_m),
            None => drawn(self.seed, network).ok_or_else(|| {
                let reason = format!("map {} has no driving lane to start on", network.name);
                StartError { key: None, reason }
            }),
        }
    }
}

fn given(network: &RoadNetwork, lane: LaneId, s_m: f32) -> Result<(LaneId, f32), StartError> {
    let refuse = |key, reason| Err(StartError { key: Some(key), reason });
    let found = network.lanes.get(lane as usize);
    let Some(found) = found.filter(|found| found.kind == LaneKind::Driving) else {
        let mut ranges = driving_lanes(network);
        if ranges.len() > RANGES_NAMED {
            ranges.truncate(RANGES_NAMED);
            ranges.push("...".into());
        }
        let (map, lanes) = (&network.name, ranges.join(", "));
        return refuse("ego.lane", format!("ego.lane is {lane}, expected a driving lane of {map}: {lanes}"));
    };
    if s_m > found.length_m {
        let length_m = found.length_m;
        return refuse(
            "ego.s_m",
            format!("ego.s_m is {s_m}, expected at most {length_m} (the length of lane {lane} of {})", network.name),
        );
    }
    Ok((lane, s_m))
}

/// The driving lanes of a map in ascending order, those without a gap as one: `3`, `5 to 8`.
pub fn driving_lanes(network: &RoadNetwork) -> Vec<String> {
    let is_driving = |lane: &usize| network.lanes[*lane].kind == LaneKind::Driving;
    let driving: Vec<usize> = (0..network.lanes.len()).filter(is_driving).collect();
    let ranges = driving.chunk_by(|a, b| a + 1 == *b);
    let words = ranges.map(|range| match range {
        [first, .., last] => format!("{first} to {last}"),
        lanes => lanes.iter().map(ToString::to_string).collect(),
    });
    words.collect()
}

/// Any driving lane outside junctions, at any place that leaves room for the car before its end.
fn drawn(seed: u64, network: &RoadNetwork) -> Option<(LaneId, f32)> {
    let fits = |least_m: f32| {
        let driving = network.lanes.iter().enumerate().filter(|(_, lane)| lane.kind == LaneKind::Driving);
        let long = driving.filter(|(_, lane)| lane.junction.is_none() && usable_m(lane) >= least_m);
        long.map(|(id, _)| id as LaneId).collect::<Vec<_>>()
    };
    let mut lanes = fits(LEAST_LANE_M);
    if lanes.is_empty() {
        lanes = fits(0.0);
    }
    let lane = *lanes.get(rng::below(seed, Stream::Route, u64::MAX, 0, lanes.len() as u32) as usize)?;
    let room = (usable_m(&network.lanes[lane as usize]) - 2.0 * ego::SIZE_M.x).max(0.0);
    Some((lane, ego::SIZE_M.x / 2.0 + room * rng::unit(seed, Stream::Route, u64::MAX, 1)))
}

/// The part of a lane that a drive can begin on, metres.
fn usable_m(lane: &Lane) -> f32 {
    if lane.successors.is_empty() { (lane.length_m - BEFORE_END_M).max(0.0) } else { lane.length_m }
}
