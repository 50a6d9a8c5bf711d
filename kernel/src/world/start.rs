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
use crate::story::Stage;
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

/// The story of a scenario on its map.
pub(super) fn stage(scenario: &Scenario, network: &RoadNetwork) -> Result<Option<Arc<Stage>>, WorldError> {
    let Some(story) = &scenario.story else { return Ok(None) };
    let refused = |reason| WorldError::Scenario { map: network.name.clone(), reason };
    Stage::new(story, network).map(|stage| Some(Arc::new(stage))).map_err(refused)
}

pub(super) fn begin(
    scenario: &Scenario,
    network: &Arc<RoadNetwork>,
    stage: Option<&Stage>,
) -> Result<(Parts, Traffic), WorldError> {
    check_map(scenario, network)?;
    let refused = |reason| WorldError::Scenario { map: network.name.clone(), reason };
    let (car, lane, s_m) = match stage {
        Some(stage) => placed(network, stage).map_err(refused)?,
        None => {
            let (lane, s_m) = scenario.start_on(network).map_err(|error: StartError| refused(error.reason))?;
            (standing(network, lane, s_m), lane, s_m)
        }
    };
    let taken: Vec<Vec3> = std::iter::once(car.middle()).chain(stage.iter().flat_map(|stage| stage.starts())).collect();
    let traffic = Traffic::spawn_clear_of(&scenario.traffic, scenario.seed, network.ways(), &taken);
    let traffic = traffic.with_hazards(&scenario.hazards);
    let way = stage.map_or_else(Vec::new, |stage| stage.ego_way(network, lane));
    let lanes = std::iter::once(lane).chain(way).collect();
    let route = Route::along(network, scenario.seed, lanes, s_m);
    let parts = Parts {
        input: InputPart { origin: origin(scenario, network), tick: 0, controls: TickInput::default() },
        ego: EgoPart { car, route },
        bodies: Bodies::default(),
        run: RunPart { arbiter: Arbiter::new(), watch: Watch::default(), keyframe_at: 0 },
        output: OutputPart::default(),
        story: stage.map(Stage::begin),
    };
    Ok((parts, traffic))
}

/// The car where a story begins, as fast as that says, and its place on the road.
fn placed(network: &RoadNetwork, stage: &Stage) -> Result<(Ego, LaneId, f32), String> {
    let (spot, speed_mps) = stage.ego_start();
    let (lane, s_m) = stage.ego_road(network)?;
    let rotation = rotation(spot.heading_rad);
    let position = spot.position - rotation * Vec3::new(ego::CENTRE_M.x, 0.0, 0.0);
    let velocity_mps = rotation * Vec3::X * speed_mps;
    Ok((Ego::new(Motion { position, rotation, velocity_mps, spin_radps: Vec3::ZERO }), lane, s_m))
}

/// A car at rest whose middle is at a place of a lane.
fn standing(network: &RoadNetwork, lane: LaneId, s_m: f32) -> Ego {
    let point = network.lane_point(lane, s_m);
    let rotation = rotation(point.heading_rad);
    let position = point.position - rotation * Vec3::new(ego::CENTRE_M.x, 0.0, 0.0);
    let motion = Motion { position, rotation, velocity_mps: Vec3::ZERO, spin_radps: Vec3::ZERO };
    Ego::new(motion)
}
