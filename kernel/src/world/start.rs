//! Tick 0: where the ego car stands, and who else is there.

use std::sync::Arc;

use crate::arbiter::Arbiter;
use crate::controls::TickInput;
use crate::ego::{self, Ego};
use crate::geometry::rotation;
use crate::map::{LaneId, LaneKind, RoadNetwork};
use crate::motion::Motion;
use crate::rng::{self, Stream};
use crate::route::Route;
use crate::scenario::Scenario;
use crate::traffic::Traffic;
use crate::watch::Watch;
use glam::Vec3;

use super::bodies::Bodies;
use super::error::WorldError;
use super::snapshot::{EgoPart, InputPart, OutputPart, Parts, RunPart, origin};

/// Shortest lane on which a car starts when the scenario names none, metres.
const LEAST_LANE_M: f32 = 20.0;

/// Refuses a map that is not the scenario's.
pub(super) fn check_map(scenario: &Scenario, network: &RoadNetwork) -> Result<(), WorldError> {
    if scenario.map == network.name {
        return Ok(());
    }
    let reason = format!("its map is {:?}, expected {:?}", scenario.map, network.name);
    Err(WorldError::Scenario { map: network.name.clone(), reason })
}

pub(super) fn begin(scenario: &Scenario, network: &Arc<RoadNetwork>) -> Result<(Parts, Traffic), WorldError> {
    check_map(scenario, network)?;
    let (lane, s_m) =
        place(scenario, network).map_err(|reason| WorldError::Scenario { map: network.name.clone(), reason })?;
    let car = standing(network, lane, s_m);
    let traffic = Traffic::spawn(&scenario.traffic, scenario.seed, network.ways(), car.middle());
    let route = Route::from(network, scenario.seed, lane, s_m);
    let parts = Parts {
        input: InputPart { origin: origin(scenario, network), tick: 0, controls: TickInput::default() },
        ego: EgoPart { car, route },
        bodies: Bodies::default(),
        run: RunPart { arbiter: Arbiter::new(), watch: Watch::default(), keyframe_at: 0 },
        output: OutputPart::default(),
    };
    Ok((parts, traffic))
}

/// Lane and distance along it of the middle of the car.
fn place(scenario: &Scenario, network: &RoadNetwork) -> Result<(LaneId, f32), String> {
    match scenario.ego.lane {
        Some(lane) => given(network, lane, scenario.ego.s_m),
        None => drawn(scenario.seed, network).ok_or_else(|| "it has no driving lane to start on".to_owned()),
    }
}

fn given(network: &RoadNetwork, lane: LaneId, s_m: f32) -> Result<(LaneId, f32), String> {
    let found = network.lanes.get(lane as usize);
    let Some(found) = found.filter(|found| found.kind == LaneKind::Driving) else {
        return Err(format!("ego.lane is {lane}, expected a driving lane out of {}", network.lanes.len()));
    };
    if s_m > found.length_m {
        return Err(format!("ego.s_m is {s_m}, expected at most {} (the length of lane {lane})", found.length_m));
    }
    Ok((lane, s_m))
}

/// Any driving lane outside junctions, at any place that leaves room for the car before its end.
fn drawn(seed: u64, network: &RoadNetwork) -> Option<(LaneId, f32)> {
    let fits = |least_m: f32| {
        let driving = network.lanes.iter().enumerate().filter(|(_, lane)| lane.kind == LaneKind::Driving);
        let long = driving.filter(|(_, lane)| lane.junction.is_none() && lane.length_m >= least_m);
        long.map(|(id, _)| id as LaneId).collect::<Vec<_>>()
    };
    let mut lanes = fits(LEAST_LANE_M);
    if lanes.is_empty() {
        lanes = fits(0.0);
    }
    let lane = *lanes.get(rng::below(seed, Stream::Route, u64::MAX, 0, lanes.len() as u32) as usize)?;
    let room = (network.lanes[lane as usize].length_m - 2.0 * ego::SIZE_M.x).max(0.0);
    Some((lane, ego::SIZE_M.x / 2.0 + room * rng::unit(seed, Stream::Route, u64::MAX, 1)))
}

/// A car at rest whose middle is at a place of a lane.
fn standing(network: &RoadNetwork, lane: LaneId, s_m: f32) -> Ego {
    let point = network.lane_point(lane, s_m);
    let rotation = rotation(point.heading_rad);
    let position = point.position - rotation * Vec3::new(ego::CENTRE_M.x, 0.0, 0.0);
    let motion = Motion { position, rotation, velocity_mps: Vec3::ZERO, spin_radps: Vec3::ZERO };
    Ego { motion, wheel_angle_rad: 0.0, odometer_um: 0 }
}
