//! Buses that stand at their stops with open doors.

use glam::{Vec2, Vec3};

use crate::actor::ActorKind;
use crate::map_data::MapData;

use super::actors::Actors;
use super::body::{Body, Surroundings};
use super::outline;
use super::vehicle::Vehicle;
use super::walker::WalkerMode;

/// From the front of a bus to the doors at which people get on and off, metres.
pub(super) const DOORS_M: [f32; 2] = [1.3, 6.5];
/// From its side to who stands before a door, metres.
pub(super) const OUT_M: f32 = 0.5;
/// Riders that a bus takes.
pub(super) const SEATS: usize = 40;
/// Who is so near to the door is waited for, metres.
const AWAITED_M: f32 = 2.5;
/// A bus stands at a stop that is within so much of its front, metres.
const AT_STOP_M: f32 = 2.0;

/// A bus whose doors are open.
#[derive(Clone, Copy, Debug)]
pub(super) struct Call {
    /// Id of the bus.
    pub bus: u16,
    /// Index of the stop.
    pub stop: usize,
    /// Where people stand who get on, and off.
    pub doors: [Vec2; 2],
    /// Out of the doors.
    pub out: Vec2,
    /// Until they shut, s.
    pub left_s: f32,
    /// People who go to it, and who ride in it.
    pub goers: usize,
    pub riders: usize,
    /// Somebody stands at the door.
    pub awaited: bool,
}

impl Call {
    /// Where the middle of somebody is who stands before a door.
    pub fn before(&self, door: usize, kind: ActorKind) -> Vec2 {
        self.doors[door] + self.out * outline::half_m(kind)
    }
}

/// All buses whose doors are open.
pub(super) fn gather(actors: &Actors, around: &Surroundings<'_>, calls: &mut Vec<Call>) {
    calls.clear();
    let buses = actors.state.vehicles.iter().zip(&actors.bodies).filter(|(v, _)| !around.holds(v.id));
    calls.extend(buses.filter_map(|(vehicle, body)| call(actors, vehicle, body)));
}

fn call(actors: &Actors, vehicle: &Vehicle, body: &Body) -> Option<Call> {
    let left_ds = vehicle.doors_open_ds()?;
    let stop = stop_of(actors.map(), vehicle)?;
    let (middle, forward) = (body.position.truncate(), (body.rotation * Vec3::X).truncate().normalize_or(Vec2::X));
    let (half, out) = (body.kind.size_m() * 0.5, forward.perp() * f32::from(actors.ways.kerb));
    let doors = DOORS_M.map(|m| middle + forward * (half.x - m) + out * (half.y + OUT_M));
    let people = actors.state.walkers.iter().zip(&actors.bodies[actors.state.vehicles.len()..]);
    let (mut goers, mut riders, mut awaited) = (0, 0, false);
    for (walker, body) in people.filter(|(w, _)| w.bus == vehicle.id) {
        let goes = walker.mode == WalkerMode::Boards;
        goers += usize::from(goes);
        riders += usize::from(walker.rides());
        awaited |= goes && body.position.truncate().distance(doors[0]) < AWAITED_M;
    }
    Some(Call { bus: vehicle.id, stop, doors, out, left_s: f32::from(left_ds) * 0.1, goers, riders, awaited })
}

/// The stop at which a bus stands.
fn stop_of(map: &MapData, vehicle: &Vehicle) -> Option<usize> {
    let front_m = vehicle.s_m + vehicle.kind.size_m().x * 0.5;
    map.bus_stops.iter().position(|stop| stop.lane == vehicle.lane && (stop.s_m - front_m).abs() < AT_STOP_M)
}
