//! Who signals to a lane beside its own, and wants to be let in there. Others ask only where their way needs the change: who
//! would just drive faster there waits for a gap, or a full road would carry less.

use crate::controls::Controls;
use crate::geometry::direction;
use crate::map_data::{LaneId, LaneKind};

use super::actors::Actors;
use super::body::Surroundings;
use super::journey::Journey;
use super::manoeuvre::Manoeuvre;
use super::sideways::beside;
use super::vehicle::Vehicle;

/// Vehicles of traffic that drive slower than this do not change lanes, m/s.
const ROLLS_MPS: f32 = 1.5;
/// The ego car is on a lane this near, metres.
const ON_LANE_M: f32 = 4.0;

/// Somebody who signals to a lane beside its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asking {
    /// Id of the vehicle; 0 for the ego car.
    pub id: u16,
    /// The lane it wants to be on, and its middle there, metres from the start.
    pub lane: LaneId,
    pub s_m: f32,
    pub half_m: f32,
    pub speed_mps: f32,
    /// Whether it has to be let in: a bus that leaves its stop (StVO § 20).
    pub owed: bool,
}

/// Adds everybody who signals to a lane beside its own: vehicles of traffic, and the ego car.
pub(super) fn gather(actors: &Actors, around: &Surroundings<'_>, asking: &mut Vec<Asking>) {
    let map = actors.map();
    let signals = |(i, v): (usize, &Vehicle)| {
        let rolls = v.manoeuvre.signals() && v.speed_mps > ROLLS_MPS && !around.holds(v.id);
        let lane = beside(map, v.lane, v.manoeuvre == Manoeuvre::SignalLeft).filter(|_| rolls)?;
        if !needs(actors, v, lane) {
            return None;
        }
        let s_m = map.project(lane, actors.bodies[i].position).s_m;
        Some(Asking {
            id: v.id,
            lane,
            s_m,
            half_m: actors.drivers[i].size_m.x * 0.5,
            speed_mps: v.speed_mps,
            owed: false,
        })
    };
    let leaves = |(i, v): (usize, &Vehicle)| {
        let half_m = actors.drivers[i].size_m.x * 0.5;
        let asks = v.wants_out() && !around.holds(v.id);
        asks.then_some(Asking { id: v.id, lane: v.lane, s_m: v.s_m, half_m, speed_mps: 0.0, owed: true })
    };
    asking.clear();
    asking.extend(actors.state.vehicles.iter().enumerate().filter_map(signals));
    asking.extend(actors.state.vehicles.iter().enumerate().filter_map(leaves));
    asking.extend(ego(actors, around));
}

/// Whether a vehicle comes to its goal sooner from another lane, or its own lane ends.
fn needs(actors: &Actors, vehicle: &Vehicle, lane: LaneId) -> bool {
    let journey = Journey::of(&actors.ways, actors.seed, vehicle);
    actors.ways.lanes[vehicle.lane as usize].ends_m.is_some() || journey.seconds(lane) < journey.seconds(vehicle.lane)
}

fn ego(actors: &Actors, around: &Surroundings<'_>) -> Option<Asking> {
    let Surroundings { ego, ego_flags, .. } = around;
    let to_left = match ego_flags & Controls::INDICATORS {
        Controls::INDICATE_LEFT => true,
        Controls::INDICATE_RIGHT => false,
        _ => return None,
    };
    let roads = actors.ways.places.roads();
    let here = roads.nearest(ego.position, LaneKind::Driving, Some(ego.heading_rad), ON_LANE_M)?;
    let lane = beside(actors.map(), here.lane, to_left)?;
    let s_m = actors.map().project(lane, ego.position).s_m;
    let speed_mps = ego.velocity_mps.truncate().dot(direction(ego.heading_rad)).max(0.0);
    Some(Asking { id: 0, lane, s_m, half_m: ego.size_m.x * 0.5, speed_mps, owed: false })
}
