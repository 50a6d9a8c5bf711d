//! Places told by where others are.

use glam::Vec2;

use crate::geometry::direction;
use crate::map::RoadNetwork;
use crate::ops;

use super::actor::StoryActor;
use super::script::{Facing, Position, RoleId};
use super::spot::{OnLane, Spot};
use super::state::StoryState;
use super::{lanes, places};

/// A place in a state, if that says where it is.
pub fn spot(network: &RoadNetwork, state: &StoryState, place: &Position) -> Option<Spot> {
    let found = resolved(network, place, |role| state.actors.get(role).map(|actor| actor.spot));
    found.filter(|spot| spot.position.abs().max_element() < places::MOST_M)
}

/// The same among those who were placed.
pub fn spot_among(network: &RoadNetwork, placed: &[Option<StoryActor>], place: &Position) -> Option<Spot> {
    resolved(network, place, |role| placed.get(role)?.as_ref().map(|actor| actor.spot))
}

fn resolved(network: &RoadNetwork, place: &Position, of: impl Fn(RoleId) -> Option<Spot>) -> Option<Spot> {
    match place {
        Position::Known(spot) => Some(*spot),
        Position::Beside { role, by_m, own_axes, facing } => {
            let from = of(*role)?;
            let ahead = if *own_axes { direction(from.heading_rad) } else { Vec2::X };
            let by = ahead * by_m[0] + ahead.perp() * by_m[1];
            let heading_rad = match facing {
                Facing::Absolute(heading_rad) => *heading_rad,
                Facing::Relative(by_rad) => from.heading_rad + by_rad,
            };
            let position = Spot::grounded(network, from.position + by.extend(0.5));
            Some(Spot::at(network, position, ops::wrap_angle(heading_rad)))
        }
        Position::BesideRoad { role, by_m: [along_m, left_m], facing } => {
            let from = of(*role)?;
            let on = from.on?;
            // Lanes on the left of a road's line lead against it.
            let (_, number) = network.lanes[on.lane as usize].name.rsplit_once('/')?;
            let sign = if number.starts_with('-') { 1.0 } else { -1.0 };
            let towards = if on.against { -sign } else { sign };
            let there = lanes::ahead(network, on, along_m * towards);
            let offset_m = on.offset_m + left_m * sign;
            Some(places::turned(Spot::on(network, OnLane { offset_m, ..there }), *facing))
        }
        Position::BesideLane { role, lanes: count, ahead_m, offset_m, facing } => {
            let from = of(*role)?;
            let ahead = lanes::ahead(network, from.on?, *ahead_m);
            let there = beside(network, Spot::on(network, ahead), *count)?;
            let sign = if there.against { -1.0 } else { 1.0 };
            let offset_m = there.offset_m + offset_m * sign;
            Some(places::turned(Spot::on(network, OnLane { offset_m, ..there }), *facing))
        }
        Position::World { .. } | Position::Lane { .. } | Position::Road { .. } | Position::Route { .. } => None,
    }
}

/// The place on the lane so many lanes to the left of one, seen as who is there faces; where the road has fewer, as if it went on
/// in lanes as wide as its last one.
pub fn beside(network: &RoadNetwork, from: Spot, count: i32) -> Option<OnLane> {
    let on = from.on?;
    let left = direction(from.heading_rad).perp() * if count < 0 { -1.0 } else { 1.0 };
    let mut here = OnLane { offset_m: 0.0, ..on };
    let lanes = count.unsigned_abs().min(64);
    for passed in 0..lanes {
        let middle = Spot::on(network, here);
        let (road, number) = network.lanes[here.lane as usize].name.rsplit_once('/')?;
        let number: i32 = number.parse().ok()?;
        let next = [number + 1, number - 1].map(|id| if id == 0 { 2 * id.signum() - number.signum() } else { id });
        let there =
            next.into_iter().filter_map(|id| places::nearest(network, &format!("{road}/{id}"), middle.position));
        let is_beside = |at: &crate::map::Projection| {
            let point = network.lane_point(at.lane, at.s_m).position;
            (point - middle.position).truncate().dot(left) > 0.0
        };
        let Some(found) = there.filter(is_beside).min_by(|a, b| a.distance_m.total_cmp(&b.distance_m)) else {
            let width_m = 2.0 * network.lane_point(here.lane, here.s_m).half_width_m;
            let away_m = (lanes - passed) as f32 * width_m * count.signum() as f32;
            return Some(OnLane { offset_m: if here.against { -away_m } else { away_m }, ..here });
        };
        here = facing(network, found.lane, found.s_m, 0.0, from.heading_rad);
    }
    Some(here)
}

/// A place on a lane for who faces so.
pub fn facing(network: &RoadNetwork, lane: u32, s_m: f32, offset_m: f32, heading_rad: f32) -> OnLane {
    let along_rad = network.lane_point(lane, s_m).heading_rad;
    OnLane { lane, s_m, offset_m, against: ops::cos(along_rad - heading_rad) < 0.0 }
}
