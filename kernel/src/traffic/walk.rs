//! What a walker does in a tick.

use glam::Vec2;

use crate::map_data::{MapData, Place, WalkEdge, WalkEdgeId};
use crate::ops;
use crate::rng::{self, Stream};
use crate::time::{TICK_S, seconds};

use super::body::Body;
use super::crosswalk::Gaps;
use super::edge_lists::EdgeLists;
use super::hazard::Hazard;
use super::jaywalk;
use super::traits::WalkerTraits;
use super::walker::{Walker, WalkerMode, turns};
use super::ways::Ways;

/// Acceleration of a walker, m/s².
const ACCEL_MPS2: f32 = 1.5;
/// People look this far ahead for each other, metres.
const SIGHT_M: f32 = 3.0;
/// Sideways distance that they keep between their middles, metres.
const SHOULDER_M: f32 = 0.7;
/// Sideways speed as a share of the speed ahead.
const DRIFT: f32 = 0.35;
/// Slowest pace in a crowd; nobody stops for others on foot, so no crowd can jam. m/s.
const SHUFFLE_MPS: f32 = 0.3;
/// Distance walked in one cycle of the gait (two steps), metres.
const STRIDE_M: f32 = 1.45;
/// Fastest turn of the body, 2^-16 turns a tick (about 270 degrees a second).
const TURN_PER_TICK: i16 = 820;
/// Distance kept from the edge of the way, metres.
const EDGE_MARGIN_M: f32 = 0.35;
/// Whoever has waited this long at a kerb goes another way.
const GIVE_UP_TICKS: u16 = seconds(90) as u16;
/// Whoever stands before a vehicle on the road for this long turns back.
const TURN_BACK_TICKS: u16 = seconds(8) as u16;

/// The edge a walker takes at the end of its own.
pub(super) fn next_edge(map: &MapData, seed: u64, walker: &Walker) -> WalkEdgeId {
    let node = end_node(map, walker);
    let others = || map.walk_nodes[node as usize].edges.iter().copied().filter(|e| *e != walker.edge);
    let count = others().count() as u32;
    let pick = rng::below(seed, Stream::Walk, u64::from(walker.id), u64::from(walker.hops), count);
    others().nth(pick as usize).unwrap_or(walker.edge)
}

fn end_node(map: &MapData, walker: &Walker) -> u32 {
    map.walk_edges[walker.edge as usize].nodes[usize::from(walker.forward)]
}

/// The crosswalk that a waiting walker wants to take.
pub(super) fn wanted_crosswalk(map: &MapData, seed: u64, walker: &Walker) -> Option<u32> {
    let next = next_edge(map, seed, walker);
    map.walk_edges[next as usize].crosswalk.filter(|_| next != walker.edge)
}

/// What every walker sees of the previous tick.
pub(super) struct Streets<'a> {
    pub map: &'a MapData,
    pub ways: &'a Ways,
    pub seed: u64,
    pub walkers: &'a [Walker],
    pub walker_traits: &'a [WalkerTraits],
    /// Bodies of the walkers.
    pub bodies: &'a [Body],
    pub lists: &'a EdgeLists,
    pub gaps: Gaps<'a>,
    /// Vehicles, the ego car and loose actors: what people do not walk into.
    pub blocks: &'a [Hazard],
    /// Index of the walker that starts to jaywalk.
    pub jaywalker: Option<usize>,
}

impl Streets<'_> {
    /// The next state of walker `index`.
    pub fn walk(&self, index: usize) -> Walker {
        let mut next = self.walkers[index];
        if self.jaywalker == Some(index) {
            next.mode = WalkerMode::Jaywalk;
            next.forward = jaywalk::road_is_left(self.map, self.ways, &next);
        }
        let before = self.bodies[index].position.truncate();
        match next.mode {
            WalkerMode::Walk => self.stroll(index, &mut next),
            WalkerMode::Wait => self.wait(index, &mut next),
            WalkerMode::Jaywalk => self.jaywalk(index, &mut next),
        }
        let place = self.ways.walker_place(&next);
        let moved = place.beside(next.offset_m).truncate() - before;
        next.phase = next.phase.wrapping_add((moved.length() / STRIDE_M * 65536.0) as u16);
        self.face(moved, &place, &mut next);
        next
    }

    fn stroll(&self, index: usize, next: &mut Walker) {
        let edge = &self.map.walk_edges[next.edge as usize];
        let direction = if next.forward { 1.0 } else { -1.0 };
        let (aim_m, limit_mps) = self.avoid(index, edge, direction);
        let mut aim_mps = self.walker_traits[index].speed_mps.min(limit_mps);
        if edge.crosswalk.is_some() {
            // Across the road people hurry a little, and do not walk into vehicles.
            aim_mps = (aim_mps * 1.15).max(1.0);
            let place = self.ways.walker_place(next);
            if self.blocked(index, place.forward.truncate() * direction) {
                aim_mps = 0.0;
                halt(next);
            }
        }
        approach_speed(next, aim_mps);
        let moved_m = next.speed_mps * TICK_S;
        next.s_m += direction * moved_m;
        // Whoever comes back from the road goes straight for the way.
        let astray = next.offset_m.abs() > edge.half_width_m;
        let drift = if astray { moved_m } else { DRIFT * moved_m };
        next.offset_m += (aim_m - next.offset_m).clamp(-drift, drift);
        let left_m = if next.forward { edge.length_m - next.s_m } else { next.s_m };
        if left_m <= 0.0 {
            self.turn_or_wait(index, next);
        }
    }

    /// Where to walk across the way, and how fast at most, because of others on it.
    fn avoid(&self, index: usize, edge: &WalkEdge, direction: f32) -> (f32, f32) {
        let me = &self.walkers[index];
        let room_m = (edge.half_width_m - EDGE_MARGIN_M).max(0.0);
        // A third of the way to the right, as people mostly keep.
        let mut aim_m = (self.walker_traits[index].place - direction * 0.33).clamp(-1.0, 1.0) * room_m;
        let mut limit_mps = f32::MAX;
        let (up, down) = self.lists.around(index);
        let near = |i: &usize| {
            let other = &self.walkers[*i];
            other.edge == me.edge && (other.s_m - me.s_m).abs() < SIGHT_M
        };
        let mut meet = |i: usize| {
            let other = &self.walkers[i];
            let ahead_m = (other.s_m - me.s_m) * direction;
            let beside_m = me.offset_m - other.offset_m;
            if other.mode == WalkerMode::Jaywalk || ahead_m < 0.0 || beside_m.abs() > SHOULDER_M {
                return;
            }
            let same_way = other.forward == me.forward;
            let side = if beside_m.abs() > 0.15 { beside_m.signum() } else { -direction };
            aim_m = other.offset_m + side * (SHOULDER_M + 0.1);
            if ahead_m < 0.9 && beside_m.abs() < 0.45 {
                let pace = if same_way { other.speed_mps } else { 0.0 };
                limit_mps = limit_mps.min(pace.max(SHUFFLE_MPS));
            }
        };
        if direction > 0.0 {
            up.take_while(near).take(1).for_each(&mut meet);
        } else {
            down.take_while(near).take(1).for_each(&mut meet);
        }
        (aim_m.clamp(-room_m, room_m), limit_mps)
    }

    /// At the end of an edge: takes the next one, or waits at the kerb.
    fn turn_or_wait(&self, index: usize, next: &mut Walker) {
        let edge = next_edge(self.map, self.seed, next);
        let crosswalk = self.map.walk_edges[edge as usize].crosswalk.filter(|_| edge != next.edge);
        if crosswalk.is_some_and(|c| !self.may_cross(index, c, next)) {
            next.mode = WalkerMode::Wait;
            next.speed_mps = 0.0;
        } else {
            self.enter(edge, next);
        }
    }

    fn may_cross(&self, index: usize, crosswalk: u32, walker: &Walker) -> bool {
        let ends = self.map.crosswalks[crosswalk as usize].ends;
        let time_s = ends[0].distance(ends[1]) / self.walker_traits[index].speed_mps.max(1.0);
        let body = &self.bodies[index];
        self.gaps.may_cross(crosswalk, walker, body.position.truncate(), time_s)
    }

    fn wait(&self, index: usize, next: &mut Walker) {
        next.wait_ticks = next.wait_ticks.saturating_add(1);
        if next.wait_ticks > GIVE_UP_TICKS {
            next.hops = next.hops.wrapping_add(1);
            next.wait_ticks = 0;
        }
        let edge = next_edge(self.map, self.seed, next);
        match self.map.walk_edges[edge as usize].crosswalk {
            Some(crosswalk) if edge != next.edge && !self.may_cross(index, crosswalk, next) => {}
            _ => self.enter(edge, next),
        }
    }

    /// Goes over to another edge at the same place in the world.
    fn enter(&self, edge: WalkEdgeId, next: &mut Walker) {
        let node = end_node(self.map, next);
        let from = self.ways.walker_place(next).beside(next.offset_m).truncate();
        let to = &self.map.walk_edges[edge as usize];
        // At a dead end one turns round.
        next.forward = if edge == next.edge { !next.forward } else { to.nodes[0] == node };
        let end_m = if next.forward { 0.0 } else { to.length_m };
        let place = self.ways.edge_place(edge, end_m);
        let offset = from - place.position.truncate();
        next.edge = edge;
        next.s_m = end_m + offset.dot(place.forward.truncate().normalize_or(Vec2::X));
        next.offset_m = offset.dot(place.left());
        next.hops = next.hops.wrapping_add(1);
        next.mode = WalkerMode::Walk;
        next.wait_ticks = 0;
    }

    fn jaywalk(&self, index: usize, next: &mut Walker) {
        let place = self.ways.walker_place(next);
        let sign = if next.forward { 1.0 } else { -1.0 };
        let Some(goal) = jaywalk::goal(self.map, self.ways, next) else {
            next.mode = WalkerMode::Walk;
            return;
        };
        let blocked = self.blocked(index, place.left() * sign);
        let aim_mps = if blocked { 0.0 } else { jaywalk::pace(self.seed, next, &self.walker_traits[index]) };
        if blocked {
            halt(next);
        }
        approach_speed(next, aim_mps);
        next.offset_m += sign * next.speed_mps * TICK_S;
        if next.offset_m * sign >= goal.distance_m {
            jaywalk::arrive(self.ways, self.seed, &goal, next);
        }
    }

    /// Whether a vehicle stands right before a walker who goes along `direction`.
    fn blocked(&self, index: usize, direction: Vec2) -> bool {
        let toe = self.bodies[index].position.truncate() + direction.normalize_or_zero() * 0.6;
        self.blocks.iter().any(|block| {
            let offset = toe - block.position.truncate();
            let (x, y) = (offset.dot(block.forward), block.forward.perp_dot(offset));
            x.abs() < block.half.x + 0.2 && y.abs() < block.half.y + 0.2
        })
    }

    /// Turns the body towards where it goes; who stands still looks along the next way.
    fn face(&self, moved: Vec2, place: &Place, next: &mut Walker) {
        let ahead = if next.mode == WalkerMode::Jaywalk { place.left() } else { place.forward.truncate() };
        let toward = if moved.length_squared() > 1e-8 {
            moved
        } else if next.mode == WalkerMode::Wait {
            self.waiting_direction(next)
        } else {
            ahead * if next.forward { 1.0 } else { -1.0 }
        };
        let aim = turns(ops::atan2(toward.y, toward.x));
        let turn = (aim.wrapping_sub(next.heading) as i16).clamp(-TURN_PER_TICK, TURN_PER_TICK);
        next.heading = next.heading.wrapping_add(turn as u16);
    }

    fn waiting_direction(&self, walker: &Walker) -> Vec2 {
        let edge = next_edge(self.map, self.seed, walker);
        let to = &self.map.walk_edges[edge as usize];
        let forward = to.nodes[0] == end_node(self.map, walker);
        let direction = self.ways.edge_place(edge, if forward { 0.0 } else { to.length_m }).forward.truncate();
        if forward { direction } else { -direction }
    }
}

/// Stands before a vehicle, and turns back when it stays.
fn halt(next: &mut Walker) {
    next.speed_mps = 0.0;
    next.wait_ticks += 1;
    if next.wait_ticks > TURN_BACK_TICKS {
        next.wait_ticks = 0;
        next.forward = !next.forward;
    }
}

fn approach_speed(next: &mut Walker, aim_mps: f32) {
    let step = ACCEL_MPS2 * TICK_S;
    next.speed_mps += (aim_mps - next.speed_mps).clamp(-2.0 * step, step);
}
