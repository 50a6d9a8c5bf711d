//! Getting on: some of those who come by a bus stop wait there for a while, and go to the front door of a bus that halts.

use glam::Vec2;

use crate::rng::{Stream, unit};
use crate::time::{TICK_S, seconds};

use super::calls::{Call, OUT_M, SEATS};
use super::company::{Near, gather, leeway};
use super::drive::View;
use super::jaywalk;
use super::riders::GET_ON_TICKS;
use super::vehicle::Vehicle;
use super::walk::{SIDESTEP_MPS, Streets, TURN_BACK_TICKS, TURNED_TICKS, approach_speed};
use super::walker::{Walker, WalkerMode};

/// Share of those who come by a stop, alone or in a group, who want to go with a bus (assumption), and what draws where they
/// wait for it, as a key of random numbers.
const SHARE: f32 = 0.4;
const PLACE_KEY: u64 = 1 << 33;
/// They wait so far before and behind where its front door will be, metres, for so long (assumption), where so many others are
/// in sight at most.
const WAIT_M: f32 = 4.0;
const PATIENCE_TICKS: u16 = seconds(150) as u16;
const MOST_NEAR: usize = 4;
/// Somebody who comes by is at the place to wait within this, metres, and in company with who leads within that.
const AT_PLACE_M: f32 = 0.05;
const BESIDE_M: f32 = 2.5;
/// Who is no farther from the door is at the stop, metres.
const REACH_M: f32 = 12.0;
/// The last steps to the door take this long, s, and nobody goes round others so near to it, metres.
const CLOSE_S: f32 = 0.5;
const QUEUE_M: f32 = 2.0;
/// Room to both sides of who goes to the door, metres.
const SIDE_ROOM_M: f32 = 1.5;
/// Who is so nearly abreast of a door goes straight to it, metres.
const ABREAST_M: f32 = 0.5;

impl View<'_> {
    /// Whether somebody stands at the door of a bus at its stop.
    pub(super) fn is_awaited(&self, vehicle: &Vehicle) -> bool {
        self.calls.iter().any(|call| call.bus == vehicle.id && call.awaited)
    }
}

impl Streets<'_> {
    fn call_of(&self, walker: &Walker) -> Option<&Call> {
        self.calls.iter().find(|call| call.bus == walker.bus)
    }

    /// Who walks past a bus that is about to go may go to it; who was at one that has gone forgets it.
    pub(super) fn heed_buses(&self, index: usize, next: &mut Walker) {
        if next.mode != WalkerMode::Walk {
            return;
        }
        if next.bus != 0 && self.call_of(next).is_none() {
            next.bus = 0;
        }
        if let Some(call) = self.calls.iter().find(|call| self.wants_aboard(index, next, call)) {
            (next.mode, next.bus, next.wait_ticks) = (WalkerMode::Boards, call.bus, 0);
        } else if next.bus == 0 && self.waits_here(index, next) {
            (next.mode, next.speed_mps, next.wait_ticks) = (WalkerMode::Boards, 0.0, 0);
        }
    }

    /// Who leads somebody and is there.
    fn led_by(&self, index: usize) -> Option<usize> {
        self.groups.leader(index).filter(|leader| self.crowd.has(*leader))
    }

    fn waits(&self, index: usize) -> bool {
        self.walkers[index].mode == WalkerMode::Boards && self.walkers[index].bus == 0
    }

    /// Whether somebody, alone or in a group, wants to go with a bus.
    fn wants_bus(&self, index: usize, walker: &Walker) -> bool {
        let leads = self.groups.leader(index).map_or(walker, |leader| &self.walkers[leader]);
        unit(self.seed, Stream::Ride, u64::from(leads.id), u64::from(leads.hops)) < SHARE
    }

    /// Whether somebody waits for a bus from here on: beside who leads, or at a place of its own.
    fn waits_here(&self, index: usize, walker: &Walker) -> bool {
        let stops = &self.ways.edges[walker.edge as usize].stops;
        if stops.is_empty() {
            return false;
        }
        if let Some(leader) = self.led_by(index) {
            let away_m = self.bodies[index].position.distance(self.bodies[leader].position);
            return self.waits(leader) && away_m < BESIDE_M;
        }
        let id = u64::from(walker.id) | PLACE_KEY;
        let aside_m = WAIT_M * (2.0 * unit(self.seed, Stream::Ride, id, u64::from(walker.hops)) - 1.0);
        let here = stops.iter().any(|s_m| (s_m + aside_m - walker.s_m).abs() < AT_PLACE_M);
        here && self.wants_bus(index, walker) && self.has_room(index)
    }

    fn has_room(&self, index: usize) -> bool {
        let mut near = Vec::new();
        gather(self.crowd, self.bodies, index, &mut near);
        near.len() <= MOST_NEAR
    }

    /// Waits at a stop: until a bus comes, but not for ever, and no longer than who leads.
    pub(super) fn wait_for_bus(&self, index: usize, near: &mut Vec<Near>, next: &mut Walker) {
        if let Some(call) = self.calls.iter().find(|call| self.wants_aboard(index, next, call)) {
            (next.bus, next.wait_ticks) = (call.bus, 0);
            return;
        }
        next.wait_ticks = next.wait_ticks.saturating_add(1);
        let left = self.led_by(index).is_some_and(|leader| self.walkers[leader].mode != WalkerMode::Boards);
        if next.wait_ticks > PATIENCE_TICKS || left {
            (next.mode, next.wait_ticks, next.hops) = (WalkerMode::Walk, 0, next.hops.wrapping_add(1));
        } else if next.wait_ticks < TURNED_TICKS {
            let left = self.places[index].left();
            let toward = if jaywalk::road_is_left(self.map, self.ways, next) { left } else { -left };
            self.turn_where_it_stands(index, near, toward, next);
        }
    }

    /// Whether somebody wants to go with a bus, and gets to it in time.
    fn wants_aboard(&self, index: usize, walker: &Walker, call: &Call) -> bool {
        let from_door = self.bodies[index].position.truncate() - call.doors[0];
        let at_stop = from_door.length_squared() < REACH_M * REACH_M && from_door.dot(call.out) > -0.1;
        if !at_stop || walker.bus == call.bus || !self.ways.stop_ways[call.stop].contains(&walker.edge) {
            return false;
        }
        let before_s = call.goers as f32 * GET_ON_TICKS as f32 * TICK_S;
        let comes_s = from_door.length() / self.walker_traits[index].speed_mps.max(0.1);
        before_s.max(comes_s) < call.left_s
            && call.goers + call.riders < SEATS
            && self.wants_bus(index, walker)
            && jaywalk::is_free(self.map, self.ways.onto(walker.edge, call.doors[0]), call.doors[0])
    }

    /// Goes to the door of a bus, behind those who were there before, for as long as it is open.
    pub(super) fn go_aboard(&self, index: usize, near: &[Near], next: &mut Walker) {
        let Some(call) = self.call_of(next) else {
            (next.mode, next.wait_ticks) = (WalkerMode::Alights, 0);
            return;
        };
        let body = &self.bodies[index];
        let to_door = call.before(0, body.kind) - body.position.truncate();
        // Along the way first, and then straight out of it: what is parked before the bus is not there.
        let along = to_door - call.out * to_door.dot(call.out);
        let off_way = next.offset_m.abs() > self.places[index].half_width_m + OUT_M;
        let abreast = off_way || along.length_squared() < ABREAST_M * ABREAST_M;
        let (away_m, ahead) = (to_door.length(), if abreast { to_door } else { along }.normalize_or_zero());
        let pace_mps = self.walker_traits[index].speed_mps.min(away_m / CLOSE_S);
        let leeway = leeway(near, ahead, pace_mps, [-SIDE_ROOM_M, SIDE_ROOM_M]);
        approach_speed(next, pace_mps.min(leeway.most_mps));
        let most_m = if away_m > QUEUE_M { SIDESTEP_MPS * TICK_S } else { 0.0 };
        let aside_m = leeway.aside_m.unwrap_or(0.0).clamp(-most_m, most_m);
        let step = ahead * (next.speed_mps * TICK_S).min(away_m) + ahead.perp() * aside_m;
        let place = self.places[index];
        next.s_m += step.dot(place.forward.truncate().normalize_or(Vec2::X));
        next.offset_m += step.dot(place.left());
    }

    /// Goes from a door or the kerb straight onto its way, or after some time by any way.
    pub(super) fn go_onto_way(&self, index: usize, near: &[Near], next: &mut Walker) {
        let place = self.places[index];
        next.wait_ticks = next.wait_ticks.saturating_add(1);
        if next.offset_m.abs() <= place.half_width_m || next.wait_ticks > TURN_BACK_TICKS {
            (next.mode, next.wait_ticks) = (WalkerMode::Walk, 0);
            return;
        }
        let to_left = -next.offset_m.signum();
        let pace_mps = self.walker_traits[index].speed_mps;
        let leeway = leeway(near, place.left() * to_left, pace_mps, [-SIDE_ROOM_M, SIDE_ROOM_M]);
        approach_speed(next, pace_mps.min(leeway.most_mps));
        next.offset_m += to_left * next.speed_mps * TICK_S;
        let most_m = SIDESTEP_MPS * TICK_S;
        next.s_m -= to_left * leeway.aside_m.unwrap_or(0.0).clamp(-most_m, most_m);
    }

    /// From somebody who waits at its door to a bus.
    pub(super) fn toward_bus(&self, walker: &Walker) -> Vec2 {
        self.call_of(walker).map_or(Vec2::X, |call| -call.out)
    }
}
