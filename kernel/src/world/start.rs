//! Tick 0: where the ego car stands, and who else is there.

use std::sync::Arc;

use crate::arbiter::Arbiter;
use crate::controls::TickInput;
use crate::ego::{self, Ego};
use crate::geometry::rotation;
use crate::map::{LaneId, RoadNetwork};
use crate::motion::Motion;
use crate::route::Route;
use crate::scenario::{Scenario, StartError};
use crate::traffic::Traffic;
use crate::watch::Watch;
use glam::Vec3;

use super::bodies::Bodies;
use super::error::WorldError;
use super::snapshot::{EgoPart, InputPart, OutputPart, Parts, RunPart, origin};

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
    let refused = |error: StartError| WorldError::Scenario { map: network.name.clone(), reason: error.reason };
    let (lane, s_m) = scenario.start_on(network).map_err(refused)?;
    let car = standing(network, lane, s_m);
    let traffic =
        Traffic::spawn(&scenario.traffic, scenario.seed, network.ways(), car.middle()).with_hazards(&scenario.hazards);
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

/// A car at rest whose middle is at a place of a lane.
fn standing(network: &RoadNetwork, lane: LaneId, s_m: f32) -> Ego {
    let point = network.lane_point(lane, s_m);
    let rotation = rotation(point.heading_rad);
    let position = point.position - rotation * Vec3::new(ego::CENTRE_M.x, 0.0, 0.0);
    let motion = Motion { position, rotation, velocity_mps: Vec3::ZERO, spin_radps: Vec3::ZERO };
    Ego::new(motion)
}
