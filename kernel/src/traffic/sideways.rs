//! How fast vehicles move sideways, and where they reach over the border of their lane.

use crate::map_data::{LaneId, MapData, Projection};

use super::traits::Driver;
use super::vehicle::Vehicle;

/// Sideways by so much for each metre driven at most, and so fast, m/s.
const STEEPEST: f32 = 0.45;
const SIDEWAYS_MPS: f32 = 1.0;
/// The tail of a vehicle longer than this, from its middle, swings out by no more than that, metres.
const LONG_M: f32 = 2.5;
const SWING_M: f32 = 0.4;
/// Unless it drives slower than this, m/s; then it moves sideways by so much for each metre.
const SLOW_MPS: f32 = 3.0;
const SLOW_STEEPEST: f32 = 0.15;
/// Sideways motion for each metre driven at most, and so fast, m/s.
const PASS_STEEPEST: f32 = 0.45;
const PASS_SIDEWAYS_MPS: f32 = 1.2;
/// Distance kept from the edge of a narrow lane, metres.
pub(super) const EDGE_M: f32 = 0.2;

/// Sideways motion of a change for each metre driven.
pub(super) fn drift(speed_mps: f32, half_length_m: f32) -> f32 {
    let swing = match half_length_m > LONG_M {
        true if speed_mps < SLOW_MPS => SLOW_STEEPEST,
        true => SWING_M / half_length_m,
        false => STEEPEST,
    };
    swing.min(SIDEWAYS_MPS / speed_mps.max(1.0))
}

/// Sideways motion of one who passes for each metre driven.
pub(super) fn pass_drift(speed_mps: f32) -> f32 {
    PASS_STEEPEST.min(PASS_SIDEWAYS_MPS / speed_mps.max(1.0))
}

/// The lane beside a lane on a side.
pub(super) fn beside(map: &MapData, lane: LaneId, to_left: bool) -> Option<LaneId> {
    let lane = &map.lanes[lane as usize];
    if to_left { lane.left } else { lane.right }
}

/// The place on the lane that a vehicle leaves, as long as it reaches into it.
pub(super) fn reaches_into(map: &MapData, vehicle: &Vehicle, driver: &Driver) -> Option<Projection> {
    if !vehicle.manoeuvre.moves() {
        return None;
    }
    let place = map.lanes[vehicle.lane as usize].straight_on(vehicle.s_m);
    let clear = vehicle.offset_m.abs() + driver.size_m.y * 0.5 <= place.half_width_m;
    let left = beside(map, vehicle.lane, vehicle.offset_m > 0.0).filter(|_| !clear)?;
    Some(map.project(left, place.beside(vehicle.offset_m)))
}
