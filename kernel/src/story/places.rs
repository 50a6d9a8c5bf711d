//! Places in the words of a text, found on a map.

use glam::Vec3;

use crate::baking::Survey;
use crate::map::{Projection, RoadNetwork};
use crate::map_data::LaneId;
use crate::ops;

use super::lanes;
use super::script::{Action, Event, Facing, OfRole, Position, Script, Trigger, When};
use super::spot::{OnLane, Spot};

/// What is told so near to the ground is on it, metres: pavements are raised.
const ABOUT_M: f32 = 0.5;

/// Farther nobody gets, metres.
pub const MOST_M: f32 = 1e6;

/// Replaces all places of a script that do not depend on where somebody is. A refusal says where the text has it.
pub fn find(script: &mut Script, network: &RoadNetwork) -> Result<(), (usize, String)> {
    let mut places = Vec::new();
    script.init.iter_mut().for_each(|(_, action)| of_action(action, &mut places));
    of_trigger(&mut script.stop, &mut places);
    for act in &mut script.acts {
        of_trigger(&mut act.start, &mut places);
        of_trigger(&mut act.stop, &mut places);
        act.groups.iter_mut().flat_map(|group| &mut group.events).for_each(|event| of_event(event, &mut places));
    }
    places.into_iter().try_for_each(|place| {
        let at = match place {
            Position::World { at, .. }
            | Position::Lane { at, .. }
            | Position::Road { at, .. }
            | Position::Route { at, .. } => *at,
            _ => return Ok(()),
        };
        if let Some(spot) = spot(place, network).map_err(|reason| (at, reason))? {
            if spot.position.abs().max_element() >= MOST_M {
                return Err((at, format!("a place is at {}, expected one within {MOST_M} m", spot.position)));
            }
            *place = Position::Known(spot);
        }
        Ok(())
    })
}

fn of_event<'a>(event: &'a mut Event, out: &mut Vec<&'a mut Position>) {
    of_trigger(&mut event.start, out);
    event.actions.iter_mut().for_each(|(_, _, action)| of_action(action, out));
}

fn of_trigger<'a>(trigger: &'a mut Trigger, out: &mut Vec<&'a mut Position>) {
    for condition in trigger.groups.iter_mut().flatten() {
        if let When::Role { what: OfRole::Reaches(place, _) | OfRole::Distance(_, _, _, place), .. } =
            &mut condition.when
        {
            out.push(place);
        }
    }
}

fn of_action<'a>(action: &'a mut Action, out: &mut Vec<&'a mut Position>) {
    match action {
        Action::Teleport(place) | Action::Acquire(place) | Action::Enter(place) => out.push(place),
        Action::Route(places) => out.extend(places),
        Action::Follow(path) => out.extend(path.corners.iter_mut().map(|(place, _)| place)),
        Action::Meet(meeting) => out.extend([&mut meeting.theirs.0, &mut meeting.own.0]),
        Action::Speed(..)
        | Action::SpeedProfile(_)
        | Action::Gap(_)
        | Action::LaneChange(..)
        | Action::LaneOffset(..)
        | Action::Abreast(_)
        | Action::Leave
        | Action::Door(_)
        | Action::HandOver
        | Action::Light(_)
        | Action::Programme(..)
        | Action::Environment(_) => {}
    }
}

/// Where a place is, if that does not depend on anybody.
fn spot(place: &Position, network: &RoadNetwork) -> Result<Option<Spot>, String> {
    match place {
        Position::World { at_m: [x, y], z_m, heading_rad, .. } => {
            let [east, north] = network.origin_m;
            let top = network.bounds[1].z + 1.0;
            let given = Vec3::new((x - east) as f32, (y - north) as f32, z_m.map_or(top, |z| z as f32 + 0.5));
            let below = if network.ground(given).is_some() { given } else { given.with_z(top) };
            let ground = Spot::grounded(network, below);
            // Feet and wheels are where the file has them, if that is about the ground.
            let told = z_m.map(|z| ground.with_z(z as f32)).filter(|told| (told.z - ground.z).abs() < ABOUT_M);
            let position = told.unwrap_or(ground);
            let facing = heading_rad.unwrap_or_else(|| lane_heading(network, position));
            Ok(Some(Spot::at(network, position, facing)))
        }
        Position::Lane { road, lane, s_m, offset_m, facing, .. } => {
            let point = survey(network)?.on_lane(road, *lane, *s_m, *offset_m)?;
            let found = nearest(network, &format!("{road}/{lane}"), point);
            let found = found.ok_or_else(|| format!("nobody can be on lane {lane} of road {road}"))?;
            let on = OnLane { lane: found.lane, s_m: found.s_m, offset_m: found.lateral_m, against: false };
            Ok(Some(turned(Spot::on(network, on), *facing)))
        }
        Position::Road { road, s_m, t_m, facing, .. } => {
            let (point, along_rad) = survey(network)?.on_road(road, *s_m, *t_m)?;
            let heading_rad = match facing {
                Facing::Absolute(heading_rad) => *heading_rad,
                Facing::Relative(by_rad) => along_rad + by_rad,
            };
            Ok(Some(Spot::at(network, point, ops::wrap_angle(heading_rad))))
        }
        Position::Route { via, s_m, lane, offset_m, facing, .. } => {
            on_way(network, via, *s_m, (*lane, *offset_m)).map(|found| Some(turned(found, *facing)))
        }
        Position::Known(_) | Position::Beside { .. } | Position::BesideRoad { .. } | Position::BesideLane { .. } => {
            Ok(None)
        }
    }
}

/// The place so far along a way through others, on a lane of the road there; lane 0 is the reference line.
fn on_way(network: &RoadNetwork, via: &[Position], s_m: f32, (lane, offset_m): (i32, f32)) -> Result<Spot, String> {
    let told = |place: &Position| {
        let found = spot(place, network)?.and_then(|found| found.on);
        found.ok_or_else(|| "a place of its route is on no lane, expected roads and lanes by their ids".to_owned())
    };
    let via = via.iter().map(told).collect::<Result<Vec<OnLane>, String>>()?;
    let mut route = Vec::new();
    for leg in via.windows(2) {
        route.extend(lanes::way(network, leg[0], leg[1]).ok_or("no way leads through all places of its route")?);
    }
    let on = lanes::along(network, via[0], s_m, route);
    let here = Spot::on(network, OnLane { offset_m: 0.0, ..on });
    let (road, _) = network.lanes[on.lane as usize].name.rsplit_once('/').unwrap_or_default();
    let beside = if lane == 0 { if on_right(network, on) { -1 } else { 1 } } else { lane };
    let found = nearest(network, &format!("{road}/{beside}"), here.position);
    let found = found.ok_or_else(|| format!("road {road} has no lane {lane} where its route is"))?;
    let mut there = OnLane { lane: found.lane, s_m: found.s_m, offset_m, against: false };
    let right = on_right(network, there);
    let half_m = if lane == 0 { network.lane_point(found.lane, found.s_m).half_width_m } else { 0.0 };
    // Offsets of the text are to the left along the reference line; lanes on its left lead against it.
    there.offset_m = if right { offset_m + half_m } else { -(offset_m - half_m) };
    Ok(Spot::on(network, there))
}

/// Whether a lane is on the right of its road's reference line.
fn on_right(network: &RoadNetwork, on: OnLane) -> bool {
    network.lanes[on.lane as usize].name.rsplit_once('/').is_some_and(|(_, id)| id.starts_with('-'))
}

/// A place on a lane, faced as the text says: who is turned round drives against it.
pub fn turned(spot: Spot, facing: Facing) -> Spot {
    let heading_rad = match facing {
        Facing::Absolute(heading_rad) => heading_rad,
        Facing::Relative(by_rad) => spot.heading_rad + by_rad,
    };
    let away = ops::cos(heading_rad - spot.heading_rad) < 0.0;
    let on = spot.on.map(|on| OnLane { against: on.against != away, ..on });
    Spot { on, ..spot }.facing(heading_rad)
}

/// How traffic on the lane under a place faces.
fn lane_heading(network: &RoadNetwork, position: Vec3) -> f32 {
    let under = Spot::at(network, position, 0.0).on;
    under.map_or(0.0, |on| network.lane_point(on.lane, on.s_m).heading_rad)
}

fn survey(network: &RoadNetwork) -> Result<&Survey, String> {
    network.survey().ok_or_else(|| format!("map {} has no roads with ids", network.name))
}

/// The nearest place on the lanes of a name: a road has some of it in each of its sections.
pub fn nearest(network: &RoadNetwork, name: &str, position: Vec3) -> Option<Projection> {
    let named = (0..network.lanes.len() as LaneId).filter(|lane| network.lanes[*lane as usize].name == name);
    named.map(|lane| network.project(lane, position)).min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
}
