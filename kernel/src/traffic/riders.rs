//! Who rides in a bus: gets in at its front door, and out at the one in its middle.
//!
//! Riders stay in the state, by which they are as many as before, and stand nowhere in the world: nothing sees or meets them.
//! They ride on in whatever becomes of the bus, but for so long at most.

use glam::Vec2;

use crate::map_data::WalkEdgeId;
use crate::ops;
use crate::rng::{Stream, below, bits, unit};
use crate::time::{Tick, seconds};

use super::SIGHT_M;
use super::actors::Actors;
use super::body::{Obstacle, Surroundings};
use super::calls::{Call, SEATS};
use super::groups::first_of_group;
use super::hazard::Hazard;
use super::jaywalk;
use super::outline;
use super::walker::{Walker, WalkerMode, turns};

/// Through a door one gets on so often, and another gets off: 2.5 to 4 and 1.5 to 2.5 s each (Transit Capacity and Quality of
/// Service Manual 2013).
pub(super) const GET_ON_TICKS: Tick = seconds(3);
const GET_OFF_TICKS: Tick = seconds(2);
/// Who gets on stands so near to the place before the door, metres.
const AT_DOOR_M: f32 = 0.6;
/// Shortest and longest time after which somebody gets off at the next stop, s (assumption), as long for all of a group.
const RIDE_S: [f32; 2] = [60.0, 240.0];
/// What draws that, as a key of random numbers.
const RIDE_KEY: u64 = 1 << 32;
/// Who has ridden this long, because the bus comes to no stop any more, is set down somewhere out of sight of the ego car.
const LOST_TICKS: u16 = seconds(600) as u16;
/// Nobody stands within this of where somebody is set down, nor any vehicle, nor will one in so many seconds, metres.
const FREE_M: f32 = 0.8;
const FREE_S: f32 = 2.0;
/// Speed of who has got off, m/s.
const OFF_MPS: f32 = 0.6;

impl Actors {
    /// Lets people on and off buses whose doors were open at the start of the tick.
    pub(super) fn exchange(&mut self, calls: &[Call], around: &Surroundings<'_>) {
        for call in calls {
            let due = |every: Tick| (around.tick + Tick::from(call.bus)).is_multiple_of(every);
            if due(GET_ON_TICKS) {
                self.get_on(call, around);
            }
            if due(GET_OFF_TICKS) {
                self.get_off(call, around);
            }
        }
        self.set_down_lost(around);
    }

    /// Who stands nearest to the door gets on, if there is a seat.
    fn get_on(&mut self, call: &Call, around: &Surroundings<'_>) {
        if call.riders >= SEATS {
            return;
        }
        let waits = |w: &Walker| w.mode == WalkerMode::Boards && w.bus == call.bus && !around.holds(w.id);
        let people = self.state.walkers.iter().zip(&self.places).enumerate().filter(|(_, (w, _))| waits(w));
        let door = |i: usize| call.before(0, self.walker_traits[i].kind);
        let near = people.map(|(i, (w, place))| (place.beside(w.offset_m).truncate().distance(door(i)), w.id, i));
        let first = near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some((_, _, i)) = first.filter(|(away_m, ..)| *away_m < AT_DOOR_M) {
            let walker = &mut self.state.walkers[i];
            (walker.mode, walker.wait_ticks, walker.speed_mps) = (WalkerMode::Rides, 0, 0.0);
        }
    }

    /// Who has ridden longest of those who have come far enough gets off.
    fn get_off(&mut self, call: &Call, around: &Surroundings<'_>) {
        let leaves = |w: &Walker| w.rides() && w.bus == call.bus && f32::from(w.wait_ticks) > self.ride_ticks(w);
        let riders = self.state.walkers.iter().enumerate().filter(|(_, w)| leaves(w));
        let first = riders.min_by_key(|(_, w)| (u16::MAX - w.wait_ticks, w.id)).map(|(i, _)| i);
        let aside_m = |edge: &WalkEdgeId| self.ways.project(*edge, call.doors[1]).1.abs();
        let ways = self.ways.stop_ways[call.stop].iter().copied();
        let edge = ways.min_by(|a, b| aside_m(a).total_cmp(&aside_m(b)));
        let (Some(i), Some(edge)) = (first, edge) else { return };
        let door = call.before(1, self.walker_traits[i].kind);
        if self.is_open(i, door, call.bus, around) && jaywalk::is_free(self.map(), door, self.ways.onto(edge, door)) {
            self.set_down(i, edge, door, call.out);
        }
    }

    /// How long somebody rides at least.
    fn ride_ticks(&self, walker: &Walker) -> f32 {
        let group = u64::from(first_of_group(self.seed, walker.id));
        let drawn = unit(self.seed, Stream::Ride, group | RIDE_KEY, u64::from(walker.bus));
        seconds(1) as f32 * (RIDE_S[0] + (RIDE_S[1] - RIDE_S[0]) * drawn)
    }

    /// Puts a rider on an edge at a place, facing some way.
    fn set_down(&mut self, index: usize, edge: WalkEdgeId, place: Vec2, faces: Vec2) {
        let (s_m, offset_m) = self.ways.project(edge, place);
        let walker = &mut self.state.walkers[index];
        walker.hops = walker.hops.wrapping_add(1);
        let forward = bits(self.seed, Stream::Walk, u64::from(walker.id), u64::from(walker.hops)) & 1 == 0;
        let (mode, speed_mps, heading) = (WalkerMode::Alights, OFF_MPS, turns(ops::atan2(faces.y, faces.x)));
        *walker = Walker { mode, forward, edge, s_m, offset_m, speed_mps, wait_ticks: 0, heading, ..*walker };
        self.places[index] = self.ways.walker_place(walker);
    }

    /// Whether nobody stands where somebody gets off, or is about to drive there; the bus itself is not asked.
    fn is_open(&self, index: usize, place: Vec2, bus: u16, around: &Surroundings<'_>) -> bool {
        let half_m = |i: usize| outline::half_m(self.walker_traits[i].kind);
        let own_m = FREE_M + half_m(index);
        let people = self.state.walkers.iter().zip(&self.places).enumerate();
        let mut people = people.filter(|(_, (w, _))| !w.rides() && !around.holds(w.id));
        let vehicles =
            self.state.vehicles.iter().zip(&self.drivers).filter(|(v, _)| v.id != bus && !around.holds(v.id));
        let mut driven = vehicles.map(|(v, driver)| Hazard::of_body(&self.ways.vehicle_body(self.seed, v, driver)));
        let free = |o: &Obstacle| keeps_off(&Hazard::of(o), place, own_m);
        people.all(|(i, (w, there))| there.beside(w.offset_m).truncate().distance(place) > own_m + half_m(i))
            && driven.all(|hazard| keeps_off(&hazard, place, own_m))
            && free(&around.ego)
            && around.loose.iter().all(free)
    }

    /// Sets down who has ridden for too long; each tries a place a second.
    fn set_down_lost(&mut self, around: &Surroundings<'_>) {
        for i in 0..self.state.walkers.len() {
            let walker = self.state.walkers[i];
            let due = (around.tick + Tick::from(walker.id)).is_multiple_of(seconds(1));
            if due && walker.rides() && walker.wait_ticks > LOST_TICKS {
                self.set_down_anywhere(i, around);
            }
        }
    }

    fn set_down_anywhere(&mut self, index: usize, around: &Surroundings<'_>) {
        let id = u64::from(self.state.walkers[index].id);
        let count = self.map().walk_edges.len() as u32;
        let edge = below(self.seed, Stream::Ride, id, around.tick, count);
        let Some(way) = self.map().walk_edges.get(edge as usize).filter(|way| way.crosswalk.is_none()) else { return };
        let there = self.ways.edge_place(edge, unit(self.seed, Stream::Spawn, id, around.tick) * way.length_m);
        let place = there.position.truncate();
        if there.position.distance(around.ego.position) > SIGHT_M && self.is_open(index, place, 0, around) {
            self.set_down(index, edge, place, there.forward.truncate());
            self.state.walkers[index].bus = 0;
        }
    }
}

/// Whether a box keeps so far off a place, now and soon.
fn keeps_off(hazard: &Hazard, place: Vec2, room_m: f32) -> bool {
    let local = hazard.turned(place - hazard.position.truncate());
    let comes_m = hazard.velocity.dot(hazard.forward).max(0.0) * FREE_S;
    let nearest = local.clamp(-hazard.half, hazard.half + Vec2::new(comes_m, 0.0));
    local.distance_squared(nearest) > room_m * room_m
}
