//! What a walker does in a tick.

use glam::Vec2;

use crate::map_data::{MapData, Place, WalkEdge, WalkEdgeId};
use crate::ops;
use crate::time::{TICK_S, Tick, seconds};

use super::body::Body;
use super::calls::Call;
use super::company::{Leeway, Near, gather, leeway};
use super::crosswalk::Gaps;
use super::groups::Groups;
use super::hazard::past_front_m;
use super::hazards::Hazards;
use super::jaywalk;
use super::nearby::Nearby;
use super::outline::{self, Outline};
use super::slack;
use super::traits::WalkerTraits;
use super::turns::{Turns, end_node};
use super::walker::{Walker, WalkerMode, turns};
use super::ways::Ways;

/// Acceleration of a walker, m/s².
const ACCEL_MPS2: f32 = 1.5;
/// Sideways speed as a share of the speed ahead.
const DRIFT: f32 = 0.35;
/// Sideways speed of somebody who gets out of another's way, m/s.
pub(super) const SIDESTEP_MPS: f32 = 0.35;
/// Whoever is slower than this is held up by others, m/s.
const HELD_UP_MPS: f32 = 0.3;
/// Whoever has stood before others for this long goes back, so that no crowd can jam.
const GIVE_WAY_TICKS: u16 = seconds(3) as u16;
/// Whoever waits steps back from what sweeps over the kerb at this speed, m/s.
const BACK_MPS: f32 = 1.2;
/// Whoever waits looks out for that so often.
const LOOK_TICKS: Tick = 6;
/// A queue before a crosswalk is at most so long, metres.
const QUEUE_M: f32 = 4.0;
/// Where so many are in sight nobody joins those who cross the road, but goes another way.
const CROWD: usize = 8;
/// Whoever goes round a vehicle goes so far out of the way if need be, metres.
const DETOUR_M: f32 = 1.2;
/// Distance walked in one cycle of the gait (two steps), metres.
const STRIDE_M: f32 = 1.45;
/// Fastest turn of the body, 2^-16 turns a tick (about 270 degrees a second).
const TURN_PER_TICK: i16 = 820;
/// After that long it has turned to where it will go.
pub(super) const TURNED_TICKS: u16 = 60;
/// Whoever moves less than this in a tick turns to where it wants to go, metres.
const FACES_M: f32 = 0.003;
/// How far to the right of the middle people keep, metres.
const RIGHT_M: f32 = 0.3;
/// Past others one goes so far beyond the border of the way, metres: the outermost half metre of the pavement is not part of it.
const VERGE_M: f32 = 0.25;
/// Whoever stands on a crosswalk no farther than this from its end looks again before going on, metres.
const KERB_M: f32 = 0.8;
/// Whoever walks farther from the middle of a pavement than this steps back from what sweeps over the kerb, metres.
const AT_KERB_M: f32 = 0.2;
/// Room to both sides of somebody who crosses the road, metres.
const SIDE_ROOM_M: f32 = 2.0;
/// Whoever has waited this long at a kerb goes another way.
const GIVE_UP_TICKS: u16 = seconds(90) as u16;
/// Whoever stands before a vehicle on the road for this long turns back.
pub(super) const TURN_BACK_TICKS: u16 = seconds(8) as u16;

/// Who walks so far beside a way is on the road, metres.
pub(super) const ASTRAY_M: f32 = 0.3;

/// What every walker sees of the previous tick.
pub(super) struct Streets<'a> {
    pub map: &'a MapData,
    pub ways: &'a Ways,
    pub seed: u64,
    pub walkers: &'a [Walker],
    pub walker_traits: &'a [WalkerTraits],
    pub groups: &'a Groups,
    /// Where they stand on their ways.
    pub places: &'a [Place],
    /// Their bodies, and those of vehicles.
    pub bodies: &'a [Body],
    pub driven: &'a [Body],
    pub crowd: &'a Nearby,
    pub gaps: Gaps<'a>,
    pub hazards: &'a Hazards,
    /// Buses whose doors are open.
    pub calls: &'a [Call],
    pub tick: Tick,
    /// Index of the walker that starts to jaywalk.
    pub jaywalker: Option<usize>,
}

impl Streets<'_> {
    fn turns(&self) -> Turns<'_> {
        let Self { map, ways, seed, walkers, groups, crowd, .. } = *self;
        Turns { map, ways, seed, walkers, groups, crowd }
    }

    /// The next state of walker `index`, and where that is on its way. `near` is scratch.
    pub fn walk(&self, index: usize, near: &mut Vec<Near>) -> (Walker, Place) {
        let mut next = self.walkers[index];
        if self.jaywalker == Some(index) {
            next.mode = WalkerMode::Jaywalk;
            next.forward = jaywalk::road_is_left(self.map, self.ways, &next);
        }
        self.heed_buses(index, &mut next);
        match next.mode {
            WalkerMode::Rides => {
                next.wait_ticks = next.wait_ticks.saturating_add(1);
                return (next, self.places[index]);
            }
            WalkerMode::Wait if !self.looks(&next) => {
                next.wait_ticks = next.wait_ticks.saturating_add(1);
                if next.wait_ticks < TURNED_TICKS {
                    self.turn_where_it_stands(index, near, self.waiting_direction(index, &next), &mut next);
                }
                return (next, self.places[index]);
            }
            WalkerMode::Wait => {
                gather(self.crowd, self.bodies, index, near);
                self.wait(index, &mut next);
            }
            WalkerMode::Walk => {
                gather(self.crowd, self.bodies, index, near);
                self.stroll(index, near, &mut next);
            }
            WalkerMode::Jaywalk => {
                gather(self.crowd, self.bodies, index, near);
                self.jaywalk(index, near, &mut next);
            }
            WalkerMode::Boards if next.bus == 0 => {
                self.wait_for_bus(index, near, &mut next);
                if !self.looks(&next) {
                    return (next, self.places[index]);
                }
                gather(self.crowd, self.bodies, index, near);
                self.step_back(index, &mut next);
            }
            WalkerMode::Boards => {
                gather(self.crowd, self.bodies, index, near);
                self.go_aboard(index, near, &mut next);
            }
            WalkerMode::Alights => {
                gather(self.crowd, self.bodies, index, near);
                self.go_onto_way(index, near, &mut next);
            }
        }
        self.settle(index, near, next)
    }

    /// Goes as far towards what was decided as others leave room for.
    fn settle(&self, index: usize, near: &[Near], mut next: Walker) -> (Walker, Place) {
        let was = &self.walkers[index];
        let before = self.bodies[index].position.truncate();
        let step_to = |next: &Walker| {
            let place = self.ways.walker_place(next);
            (place, place.beside(next.offset_m).truncate() - before)
        };
        let (mut place, mut step) = step_to(&next);
        // What has wheels reaches over the kerb while it turns, where long vehicles sweep over it, too.
        let keeps_off = self.is_on_road(was) || self.bodies[index].kind.is_wheeled_on_foot();
        let then = |step: Vec2| Outline { middle: before + step, ..Outline::of(&self.bodies[index]) };
        let hinders = |step: Vec2| keeps_off && self.runs_into_vehicle(index, &then(step));
        let mut hindered = hinders(step);
        let free = self.free_step(index, near, step, hindered);
        if free != step {
            let change = free - step;
            next.s_m += change.dot(place.forward.truncate().normalize_or(Vec2::X));
            next.offset_m += change.dot(place.left());
            (place, step) = step_to(&next);
            next.speed_mps = next.speed_mps.min(step.length() / TICK_S);
            hindered = hinders(step);
        }
        if hindered || !slack::is_free(near, step) {
            next = Walker { wait_ticks: next.wait_ticks, speed_mps: 0.0, ..*was };
            (place, step) = (self.places[index], Vec2::ZERO);
            if hindered && was.mode == WalkerMode::Walk {
                next.wait_ticks = was.wait_ticks;
                halt(&mut next);
            }
        }
        next.phase = next.phase.wrapping_add((step.length() / STRIDE_M * 65536.0) as u16);
        let ahead = if next.mode == WalkerMode::Jaywalk { place.left() } else { place.forward.truncate() };
        let toward = match next.mode {
            WalkerMode::Boards if next.bus == 0 => return (next, place),
            WalkerMode::Wait => self.waiting_direction(index, &next),
            _ if step.length_squared() > FACES_M * FACES_M => step,
            WalkerMode::Boards => self.toward_bus(&next),
            _ => ahead * if next.forward { 1.0 } else { -1.0 },
        };
        self.turn(index, near, step, toward, &mut next);
        (next, place)
    }

    /// Turns somebody who stands. `near` is scratch.
    pub(super) fn turn_where_it_stands(&self, index: usize, near: &mut Vec<Near>, toward: Vec2, next: &mut Walker) {
        if self.bodies[index].kind.is_wheeled_on_foot() {
            gather(self.crowd, self.bodies, index, near);
        }
        self.turn(index, near, Vec2::ZERO, toward, next);
    }

    /// Whether somebody who waits looks around in this tick.
    fn looks(&self, walker: &Walker) -> bool {
        (self.tick + Tick::from(walker.id)).is_multiple_of(LOOK_TICKS)
    }

    fn stroll(&self, index: usize, near: &[Near], next: &mut Walker) {
        let edge = &self.map.walk_edges[next.edge as usize];
        let direction = if next.forward { 1.0 } else { -1.0 };
        let place = self.places[index];
        let ahead = place.forward.truncate().normalize_or(Vec2::X) * direction;
        let idling = self.ways.edges[next.edge as usize].draw.pace(self.seed, next, edge.length_m);
        let own_mps = self.walker_traits[index].speed_mps * idling;
        // Across the road people hurry a little.
        let pace_mps = if edge.crosswalk.is_some() { (own_mps * 1.15).max(1.0) } else { own_mps };
        let together = self.together(index, near, next, pace_mps);
        let wants_mps = together.speed_mps.unwrap_or(pace_mps);
        let mut leeway = leeway(near, ahead, wants_mps, room_m(edge, next, direction));
        let held_up = leeway.most_mps < HELD_UP_MPS;
        let wheeled = self.bodies[index].kind.is_wheeled_on_foot();
        let before = if edge.crosswalk.is_some() || wheeled { self.before(index, ahead) } else { None };
        let half_m = outline::half_m(self.bodies[index].kind);
        let begins = edge.crosswalk.filter(|_| next.speed_mps < HELD_UP_MPS && gone_m(edge, next) < KERB_M + half_m);
        if begins.is_some_and(|crosswalk| !self.may_cross(index, crosswalk, next)) {
            halt(next);
        } else if let Some((block, ..=0.0)) = before {
            halt(next);
            leeway.aside_m = Some(past_front_m(block, ahead));
        } else if held_up && self.joins_those_who_wait(index, near, edge, next) {
            return;
        } else {
            give_way(held_up, next);
            next.forward ^= together.back && !held_up;
            approach_speed(next, wants_mps.min(leeway.most_mps));
            if before.is_some() {
                leeway.aside_m = leeway.aside_m.or(Some(0.0));
            }
        }
        let moved_m = next.speed_mps * TICK_S;
        next.s_m += direction * moved_m;
        let likes_m = together.aside_m.unwrap_or_else(|| self.likes_m(index, edge, direction));
        drift(edge, direction, likes_m, &leeway, moved_m, next);
        // The front stays off the road, and the rear is off it before the crosswalk is left.
        let ends_m = if edge.crosswalk.is_some() { -half_m } else { half_m };
        let left_m = if next.forward { edge.length_m - next.s_m } else { next.s_m };
        if left_m <= ends_m {
            self.turn_or_wait(index, near, next);
        } else if edge.crosswalk.is_none() && next.offset_m.abs() > AT_KERB_M && self.looks(next) {
            self.step_back(index, next);
        }
    }

    /// Where somebody likes to walk, metres to the left of the way.
    fn likes_m(&self, index: usize, edge: &WalkEdge, direction: f32) -> f32 {
        // To the right, as people mostly keep, and the more so the narrower the way is.
        self.walker_traits[index].place * (edge.half_width_m - RIGHT_M).max(0.1) - direction * RIGHT_M
    }

    /// Whoever is held up by others shortly before a crosswalk that is not free waits behind them.
    fn joins_those_who_wait(&self, index: usize, near: &[Near], edge: &WalkEdge, next: &mut Walker) -> bool {
        let left_m = if next.forward { edge.length_m - next.s_m } else { next.s_m };
        let wanted = || self.turns().wanted_crosswalk(index, next);
        let waits =
            left_m < QUEUE_M && edge.crosswalk.is_none() && wanted().is_some_and(|c| !self.may_cross(index, c, next));
        if waits && near.len() > CROWD && self.groups.leader(index).is_none() {
            next.hops = next.hops.wrapping_add(1);
            return false;
        }
        if waits {
            begin_waiting(next);
        }
        waits
    }

    /// At the end of an edge: takes the next one, or waits at the kerb.
    fn turn_or_wait(&self, index: usize, near: &[Near], next: &mut Walker) {
        let edge = self.turns().next_edge(index, next);
        let crosswalk = self.map.walk_edges[edge as usize].crosswalk.filter(|_| edge != next.edge);
        if crosswalk.is_some() && near.len() > CROWD && self.groups.leader(index).is_none() {
            next.hops = next.hops.wrapping_add(1);
        } else if crosswalk.is_some_and(|c| !self.may_cross(index, c, next)) {
            begin_waiting(next);
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

    /// Steps back from what sweeps over where somebody stands.
    fn step_back(&self, index: usize, next: &mut Walker) {
        let away = self.swept_from(index) * (BACK_MPS * TICK_S * LOOK_TICKS as f32);
        let place = self.places[index];
        next.s_m += away.dot(place.forward.truncate());
        next.offset_m += away.dot(place.left());
    }

    fn wait(&self, index: usize, next: &mut Walker) {
        self.step_back(index, next);
        next.wait_ticks = next.wait_ticks.saturating_add(1);
        if next.wait_ticks > GIVE_UP_TICKS {
            next.hops = next.hops.wrapping_add(1);
            next.wait_ticks = 0;
        }
        let edge = self.turns().next_edge(index, next);
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

    fn jaywalk(&self, index: usize, near: &[Near], next: &mut Walker) {
        let place = self.places[index];
        let sign = if next.forward { 1.0 } else { -1.0 };
        let Some(goal) = jaywalk::goal(self.map, self.ways, next) else {
            next.mode = WalkerMode::Walk;
            return;
        };
        let before = self.before(index, place.left() * sign);
        let pace_mps = jaywalk::pace(self.seed, next, &self.walker_traits[index]);
        let mut leeway = leeway(near, place.left() * sign, pace_mps, [-SIDE_ROOM_M, SIDE_ROOM_M]);
        let on_way = next.offset_m * sign < place.half_width_m;
        let here = place.beside(next.offset_m).truncate();
        let there = place.beside(sign * goal.distance_m).truncate();
        let dares = || {
            jaywalk::can_stop(self.gaps.vehicles, self.driven, here, there)
                && self.gaps.leaves_time([here, there], pace_mps)
        };
        if on_way && !dares() {
            // Who could go when it began may not be able to any more.
            next.mode = WalkerMode::Walk;
            return;
        }
        if let Some((block, ..=0.0)) = before {
            halt(next);
            leeway.aside_m = Some(past_front_m(block, place.left() * sign));
        } else {
            approach_speed(next, pace_mps.min(leeway.most_mps));
        }
        next.offset_m += sign * next.speed_mps * TICK_S;
        // Seen along the way, the left of who goes to the left is backwards.
        let aside_m = leeway.aside_m.unwrap_or(0.0).clamp(-SIDESTEP_MPS * TICK_S, SIDESTEP_MPS * TICK_S);
        next.s_m -= sign * aside_m;
        if next.offset_m * sign >= goal.distance_m {
            jaywalk::arrive(self.ways, self.seed, &goal, next);
        }
    }

    pub(super) fn is_on_road(&self, walker: &Walker) -> bool {
        let edge = &self.map.walk_edges[walker.edge as usize];
        edge.crosswalk.is_some()
            || walker.mode != WalkerMode::Walk
            || walker.offset_m.abs() > edge.half_width_m + ASTRAY_M
    }

    /// Turns the body towards a direction.
    pub(super) fn face(&self, toward: Vec2, next: &mut Walker) {
        let aim = turns(ops::atan2(toward.y, toward.x));
        let turn = (aim.wrapping_sub(next.heading) as i16).clamp(-TURN_PER_TICK, TURN_PER_TICK);
        next.heading = next.heading.wrapping_add(turn as u16);
    }

    fn waiting_direction(&self, index: usize, walker: &Walker) -> Vec2 {
        let edge = self.turns().next_edge(index, walker);
        let to = &self.map.walk_edges[edge as usize];
        let forward = to.nodes[0] == end_node(self.map, walker);
        let direction = self.ways.edge_place(edge, if forward { 0.0 } else { to.length_m }).forward.truncate();
        if forward { direction } else { -direction }
    }
}

/// The room to the right (negative) and to the left of somebody on a way, metres.
fn room_m(edge: &WalkEdge, walker: &Walker, direction: f32) -> [f32; 2] {
    let (most_m, at_m) = (edge.half_width_m + VERGE_M, walker.offset_m * direction);
    [-most_m - at_m, most_m - at_m]
}

/// Moves sideways: to where somebody likes to walk, or past others.
fn drift(edge: &WalkEdge, direction: f32, likes_m: f32, leeway: &Leeway, moved_m: f32, next: &mut Walker) {
    let half_m = edge.half_width_m;
    let aim_m = leeway.aside_m.map_or(likes_m, |aside_m| next.offset_m + direction * aside_m);
    // Whoever comes back from the road goes straight for the way.
    let over_m = if edge.crosswalk.is_some() { DETOUR_M } else { VERGE_M };
    let astray = next.offset_m.abs() > half_m + over_m;
    let least_m = if leeway.aside_m.is_some() { SIDESTEP_MPS * TICK_S } else { 0.0 };
    let most_m = if astray { moved_m } else { (DRIFT * moved_m).max(least_m) };
    let room_m = if leeway.aside_m.is_some() { half_m + over_m } else { half_m };
    next.offset_m += (aim_m.clamp(-room_m, room_m) - next.offset_m).clamp(-most_m, most_m);
}

/// Whoever has stood before others for long turns back.
fn give_way(held_up: bool, next: &mut Walker) {
    if held_up {
        next.wait_ticks = next.wait_ticks.saturating_add(1);
    } else if next.speed_mps > HELD_UP_MPS {
        next.wait_ticks = 0;
    }
    if next.wait_ticks > GIVE_WAY_TICKS {
        next.wait_ticks = 0;
        next.forward = !next.forward;
    }
}

/// How far somebody has gone on an edge, metres.
fn gone_m(edge: &WalkEdge, walker: &Walker) -> f32 {
    if walker.forward { walker.s_m } else { edge.length_m - walker.s_m }
}

fn begin_waiting(next: &mut Walker) {
    next.mode = WalkerMode::Wait;
    next.speed_mps = 0.0;
    next.wait_ticks = 0;
}

/// Stands before a vehicle, and turns back when it stays.
fn halt(next: &mut Walker) {
    next.speed_mps = 0.0;
    next.wait_ticks = next.wait_ticks.saturating_add(1);
    if next.wait_ticks > TURN_BACK_TICKS {
        next.wait_ticks = 0;
        next.forward = !next.forward;
    }
}

pub(super) fn approach_speed(next: &mut Walker, aim_mps: f32) {
    let step = ACCEL_MPS2 * TICK_S;
    next.speed_mps += (aim_mps - next.speed_mps).clamp(-2.0 * step, step);
}
