//! How vehicles leave the map and enter it again: where it ends, and when the watchdog takes them off.

use std::ops::Range;

use glam::Vec3;

use crate::events::EventKind;
use crate::geometry::rectangles_overlap;
use crate::map_data::LaneId;
use crate::rng::{Stream, below};

use super::actors::Actors;
use super::body::{Body, Surroundings};
use super::lapse::Lapse;
use super::manoeuvre::Manoeuvre;
use super::plan::way_end_m;
use super::poses::walker_body;
use super::spawn::EGO_CLEARANCE_M;
use super::vehicle::Vehicle;
use super::watchdog::{DISSOLVE_S, DISSOLVE_SEEN_S, STUCK_S};

/// Vehicles leave and enter the map no nearer to the ego car than this, metres.
const UNSEEN_M: f32 = 2.0 * EGO_CLEARANCE_M;
/// Who has stood where the map ends for so long leaves it though the ego car sees it: behind it a queue stands for nothing.
const AT_END_S: u8 = 3;
/// Who has stood there for so long enters it again before those who came later: where roads are full, a bus finds no gap
/// that a car does not take. Who finds none for longer holds nobody up.
const FIRST_S: Range<u8> = 20..160;
/// Speed at which they enter it, m/s.
const ENTRY_MPS: f32 = 3.0;
/// Free space before a vehicle that enters, metres, and beside it.
const SPACE_M: f32 = 4.0;
const ASIDE_M: f32 = 0.5;
/// Nobody who passes somebody comes the other way within this, metres, nor within this time, s.
const ONCOMING_M: f32 = 30.0;
const ONCOMING_S: f32 = 5.0;
/// Whoever comes from behind keeps at least this time, s.
const COMES_S: f32 = 3.0;
/// Vehicles farther away than this are not in the way, metres.
const FAR_M: f32 = 100.0;

/// What became of a vehicle that the watchdog looks after, with its id.
pub(super) type Told = (EventKind, u32);

impl Actors {
    /// Moves vehicles that stand where the map ends, and those that the watchdog takes off the road, to a
    /// lane on which a road begins. What the watchdog found goes to `told`; `before` are they a tick earlier.
    pub(super) fn return_to_map(&mut self, before: &[Vehicle], around: &Surroundings<'_>, told: &mut Vec<Told>) {
        for (i, was) in before.iter().enumerate() {
            let vehicle = self.state.vehicles[i];
            if around.holds(vehicle.id) {
                continue;
            }
            let id = u32::from(vehicle.id);
            if self.at_end(i) {
                if !self.is_after_others(i) {
                    self.enter_map(i, around, vehicle.stuck_s >= AT_END_S);
                }
                continue;
            }
            if vehicle.stuck_s == STUCK_S && was.stuck_s < STUCK_S {
                told.push((EventKind::Stuck, id));
            }
            let off = vehicle.stuck_s >= DISSOLVE_S && self.enter_map(i, around, vehicle.stuck_s >= DISSOLVE_SEEN_S);
            if off && vehicle.lapse != Lapse::Crashed {
                told.push((EventKind::Dissolved, id));
            }
        }
    }

    /// Whether a vehicle stands where its way ends.
    fn at_end(&self, index: usize) -> bool {
        let vehicle = &self.state.vehicles[index];
        let lane = vehicle.lane as usize;
        let end_m = way_end_m(&self.map().lanes[lane]);
        let near_end = vehicle.s_m > end_m - self.drivers[index].size_m.x * 0.5 - 4.0;
        self.ways.lanes[lane].onward.is_empty() && near_end && vehicle.speed_mps < 0.5
    }

    /// Whether somebody goes before a vehicle that stands where its way ends.
    fn is_after_others(&self, index: usize) -> bool {
        let vehicle = &self.state.vehicles[index];
        let goes_before = |other: &Vehicle| {
            let longer = FIRST_S.contains(&other.stuck_s) && other.stuck_s > vehicle.stuck_s;
            longer && other.kind.is_pedalled() == vehicle.kind.is_pedalled()
        };
        self.state.vehicles.iter().enumerate().any(|(i, other)| goes_before(other) && self.at_end(i))
    }

    /// Moves a vehicle to where a road begins, drawn anew each tick, if there is room; out of sight of the
    /// ego car, or `seen` where it was. Whether it did.
    fn enter_map(&mut self, index: usize, around: &Surroundings<'_>, seen: bool) -> bool {
        let vehicle = self.state.vehicles[index];
        let bicycle = vehicle.kind.is_pedalled();
        let entries = if bicycle { &self.ways.bicycle_entries } else { &self.ways.entries };
        let pick = below(self.seed, Stream::Spawn, u64::from(vehicle.id), around.tick, entries.len() as u32);
        let Some(&lane) = entries.get(pick as usize) else { return false };
        let unseen = |p: Vec3| p.distance(around.ego.position) > UNSEEN_M;
        let place = |v: &Vehicle| self.map().lanes[v.lane as usize].straight_on(v.s_m).position;
        let entry = self.entering(index, lane);
        if !unseen(place(&entry)) || !(seen || unseen(place(&vehicle))) || !self.is_free(index, &entry, around) {
            return false;
        }
        self.state.vehicles[index] = entry;
        true
    }

    fn entering(&self, index: usize, lane: LaneId) -> Vehicle {
        let (vehicle, driver) = (self.state.vehicles[index], &self.drivers[index]);
        let (s_m, half_width_m) = (driver.size_m.x * 0.5 + 0.5, self.map().lanes[lane as usize].start().half_width_m);
        let offset_m = driver.keeps_to_m(half_width_m, self.ways.kerb);
        let (trips, flags) = (vehicle.trips.wrapping_add(1), vehicle.flags & Vehicle::BRAKING);
        let fresh = Vehicle { wait_ticks: 0, stuck_s: 0, manoeuvre: Manoeuvre::Keep, signal_ticks: 0, ..vehicle };
        let fresh = Vehicle { accel_cmps2: 0, drift: 0, drift_aim: 0, ..fresh };
        let fresh = Vehicle { lapse: Lapse::None, lapse_left: 0, late_ticks: 0, ..fresh };
        Vehicle { lane, before: lane, s_m, offset_m, flags, trips, speed_mps: ENTRY_MPS, ..fresh }
    }

    /// Whether a vehicle has room at a place, and nobody is about to come there.
    fn is_free(&self, index: usize, entry: &Vehicle, around: &Surroundings<'_>) -> bool {
        let me = self.ways.vehicle_body(self.seed, entry, &self.drivers[index]);
        let (vehicles, walkers) = (self.state.vehicles.iter(), self.state.walkers.iter().zip(&self.walker_traits));
        let walkers = walkers.zip(&self.places).filter(|((w, _), _)| !w.rides());
        let others = vehicles.zip(&self.drivers).filter(|(v, _)| v.id != entry.id && !around.holds(v.id));
        let near = |body: &Body| body.position.distance_squared(me.position) < FAR_M * FAR_M;
        let mut others = others.map(|(v, d)| self.ways.vehicle_body(self.seed, v, d)).filter(near);
        let mut people = walkers.map(|((w, t), place)| walker_body(w, t, place)).filter(near);
        let loose = |o: &super::body::Obstacle| o.position.distance(me.position) > EGO_CLEARANCE_M;
        around.loose.iter().all(loose) && others.all(|b| keeps_off(&me, &b)) && people.all(|b| keeps_off(&me, &b))
    }
}

/// Whether another leaves room for one who enters, now and until it could come near, from behind or the other way.
fn keeps_off(me: &Body, other: &Body) -> bool {
    let forward = (me.rotation * Vec3::X).truncate();
    let to = (other.position - me.position).truncate();
    let axis = (other.rotation * Vec3::X).truncate();
    let turned = |v: glam::Vec2| glam::Vec2::new(v.dot(forward), forward.perp_dot(v));
    let comes_m = (other.velocity_mps.truncate().dot(forward) * COMES_S).max(0.0);
    let against_mps = -other.velocity_mps.truncate().dot(forward);
    let meets_m = if axis.dot(forward) < -0.5 { ONCOMING_M.max(against_mps * ONCOMING_S) } else { 0.0 };
    // From its tail to as far as it comes.
    let (half, reach) = (me.kind.size_m().truncate() * 0.5, other.kind.size_m().truncate() * 0.5);
    let grown = half + glam::Vec2::new(SPACE_M + (comes_m + meets_m) * 0.5, ASIDE_M);
    let way = turned(to) + glam::Vec2::new((comes_m - meets_m) * 0.5, 0.0);
    let level = (other.position.z - me.position.z).abs() > 3.0;
    level || !rectangles_overlap(grown, way, turned(axis), reach)
}
