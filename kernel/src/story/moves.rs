//! How somebody who plays comes on in a tick.

use std::borrow::Cow;

use glam::Vec2;

use crate::geometry::direction;
use crate::map_data::LaneKind;
use crate::ops;
use crate::time::TICK_S;

use super::actor::StoryActor;
use super::cues::Seen;
use super::script::{Action, Path, Position, RoleId};
use super::spot::{OnLane, Spot};
use super::state::{Change, Deed, StoryState};
use super::{deeds, lanes, pace, plan, relative};

/// A place is reached so near to it, metres.
const REACHED_M: f32 = 1.0;
/// Who changes lanes for its way moves across so fast, m/s.
const SLIDES_MPS: f32 = 1.2;

/// Who faces more than 45 degrees away from a lane is across it.
const ACROSS_COS: f32 = core::f32::consts::FRAC_1_SQRT_2;

/// Moves a role by one tick.
pub fn advance(state: &mut StoryState, role: RoleId, seen: &Seen<'_>) {
    begin_line(state, role, seen);
    // Who was taken elsewhere did not drive there.
    let was = StoryActor { spot: state.actors[role].spot, ..seen.before.actors[role].clone() };
    pace::set(state, role, seen);
    let follows = state.actors[role].way_by.map(|deed| deed as usize);
    let path = follows.and_then(|deed| match &*seen.plan.deeds[deed].action {
        Action::Follow(path) => Some((deed, path)),
        _ => None,
    });
    let at_end = match path {
        Some((deed, path)) => {
            follow(state, role, (deed, path), seen);
            false
        }
        None => drive_on(state, role, seen),
    };
    if let Some((deed, Action::Acquire(place))) = follows.map(|deed| (deed, &*seen.plan.deeds[deed].action)) {
        arrive(state, role, (deed, place), seen);
    }
    let script = seen.script;
    let on_road = is_on_road(seen, &state.actors[role]);
    state.actors[role].came(&was, script.cast[role].kind, on_road, at_end);
    if !state.actors[role].is_possible() {
        leaves(state, role, was, seen);
    }
}

/// Who came where nobody can be leaves the map; the ego car is left to its drivers.
fn leaves(state: &mut StoryState, role: RoleId, was: StoryActor, seen: &Seen<'_>) {
    deeds::end_all(state, role, seen.tick);
    let is_ego = role == seen.plan.ego;
    state.actors[role] = StoryActor { gone: !is_ego, speed_by: None, side_by: None, way_by: None, ..was };
    state.carries_ego &= !is_ego;
}

/// Takes a role to where a line is when it begins with it.
fn begin_line(state: &mut StoryState, role: RoleId, seen: &Seen<'_>) {
    let Some(number) = state.actors[role].way_by.map(|deed| deed as usize) else { return };
    let (Action::Follow(path), deed) = (&*seen.plan.deeds[number].action, &state.deeds[number]) else { return };
    if deed.mark.at != seen.tick {
        return;
    }
    let (at, _) = if path.timed {
        by_time(path, line_time_s(path, deed, seen) - TICK_S)
    } else {
        by_way(&stations_m(number, deed, seen), deed.gone_m)
    };
    if let Some((from, to, share)) = segment(path, &deed.line, at) {
        state.actors[role].spot.position = from.position.lerp(to.position, share);
    }
}

/// Where the corners of a line are along it, metres.
fn stations_m<'a>(number: usize, deed: &Deed, seen: &Seen<'a>) -> Cow<'a, [f32]> {
    if deed.line.is_empty() {
        return Cow::Borrowed(&seen.plan.deeds[number].stations_m);
    }
    Cow::Owned(plan::stations_m(deed.line.iter().map(|spot| Some(spot.plan()))))
}

/// The time of a timed line at the end of the tick that is computed, seconds.
fn line_time_s(path: &Path, deed: &Deed, seen: &Seen<'_>) -> f32 {
    if path.absolute { seen.tick as f32 * TICK_S } else { pace::since_s(deed, seen) }
}

fn is_on_some(seen: &Seen<'_>, actor: &StoryActor) -> bool {
    let kinds = [LaneKind::Driving, LaneKind::Biking, LaneKind::Shoulder];
    kinds.into_iter().any(|kind| !seen.network.lanes_at(actor.spot.position, kind).is_empty())
}

fn is_on_road(seen: &Seen<'_>, actor: &StoryActor) -> bool {
    let is_road = |kind: LaneKind| matches!(kind, LaneKind::Driving | LaneKind::Biking | LaneKind::Shoulder);
    actor.spot.on.is_some_and(|on| {
        let lane = &seen.network.lanes[on.lane as usize];
        let within = on.offset_m.abs() <= lane.at(on.s_m).half_width_m;
        // Who left its lane sideways may be on another, or beside all.
        is_road(lane.kind) && (within || is_on_some(seen, actor))
    })
}

/// Whether somebody walks or rides across a lane: on foot one keeps to none that leads elsewhere.
fn crosses(role: RoleId, on: OnLane, heading_rad: f32, seen: &Seen<'_>) -> bool {
    let along_rad = seen.network.lane_point(on.lane, on.s_m).heading_rad;
    let is_free = seen.script.cast[role].kind.is_some_and(|kind| kind.is_on_foot() || kind.is_pedalled());
    is_free && ops::cos(heading_rad - along_rad).abs() < ACROSS_COS
}

/// Along its lane, or straight on where there is none; `true` where its road ends.
fn drive_on(state: &mut StoryState, role: RoleId, seen: &Seen<'_>) -> bool {
    let StoryActor { spot, speed_mps, .. } = state.actors[role];
    let by_m = speed_mps * TICK_S;
    let Some(mut on) = spot.on.filter(|on| !crosses(role, *on, spot.heading_rad, seen)) else {
        let to = spot.position + (direction(spot.heading_rad) * by_m).extend(0.5);
        let position = Spot::grounded(seen.network, to);
        let position = if position == to { spot.position + (to - spot.position).with_z(0.0) } else { position };
        state.actors[role].spot = Spot::at(seen.network, position, spot.heading_rad);
        return false;
    };
    change_for_way(&mut on, &mut state.actors[role], seen);
    let goes_on = lanes::advance(seen.network, &mut on, by_m, &mut state.actors[role].route);
    if speed_mps == 0.0 && state.actors[role].side_by.is_none() {
        // As it was put there.
        state.actors[role].drift_mps = 0.0;
        return !goes_on;
    }
    let before_m = on.offset_m;
    if let Some(offset_m) = aside(state, role, by_m, seen) {
        (on.offset_m, state.actors[role].slip_m) = (offset_m, 0.0);
    }
    let actor = &mut state.actors[role];
    let back_m = actor.slip_m.clamp(-SLIDES_MPS * TICK_S, SLIDES_MPS * TICK_S);
    (on.offset_m, actor.slip_m) = (on.offset_m - back_m, actor.slip_m - back_m);
    actor.drift_mps = (on.offset_m - before_m) / TICK_S * if on.against { -1.0 } else { 1.0 };
    let there = Spot::on(seen.network, on);
    // Who moves across faces where it goes.
    let slant_rad = if speed_mps.abs() > 1.0 { ops::atan2(actor.drift_mps, speed_mps.abs()) } else { 0.0 };
    actor.spot = there.facing(there.heading_rad + slant_rad * speed_mps.signum());
    if !goes_on && actor.speed_mps != 0.0 {
        actor.ended_mps = std::mem::take(&mut actor.speed_mps);
    }
    !goes_on
}

/// Goes over to the lane beside where the way goes on there, and begins to move to its middle.
fn change_for_way(on: &mut OnLane, actor: &mut StoryActor, seen: &Seen<'_>) {
    if on.against || actor.speed_mps <= 0.0 || actor.side_by.is_some() {
        return;
    }
    let before_m = on.offset_m;
    if lanes::change(seen.network, on, &mut actor.route) {
        let there = seen.network.project(on.lane, actor.spot.position);
        (on.s_m, on.offset_m) = (there.s_m, there.lateral_m);
        actor.slip_m += there.lateral_m - before_m;
    }
}

/// Where across its lane somebody is who moves across it, metres to the left of the middle.
fn aside(state: &mut StoryState, role: RoleId, by_m: f32, seen: &Seen<'_>) -> Option<f32> {
    let number = state.actors[role].side_by? as usize;
    let dynamics = match *seen.plan.deeds[number].action {
        Action::LaneChange(dynamics, ..) | Action::LaneOffset(dynamics, ..) => dynamics,
        Action::Abreast(wanted) => wanted.dynamics(),
        _ => return None,
    };
    let deed = &mut state.deeds[number];
    deed.gone_m += by_m.abs();
    let share = pace::share_aside(deed, dynamics, seen);
    let offset_m = deed.from + (deed.to - deed.from) * pace::course(dynamics.shape, share);
    if share >= 1.0 {
        deeds::end(state, number, Change::Ended, seen.tick);
    }
    Some(offset_m)
}

/// Ends the way to a place where that is reached.
fn arrive(state: &mut StoryState, role: RoleId, (deed, place): (usize, &Position), seen: &Seen<'_>) {
    let actor = &state.actors[role];
    let spot = relative::spot(seen.network, seen.before, place);
    let step_m = actor.speed_mps.abs() * TICK_S;
    let is_past = |to: OnLane| actor.spot.on.is_some_and(|on| on.lane == to.lane && !on.against && on.s_m >= to.s_m);
    let is_there = |spot: Spot| {
        let near = spot.plan().distance(actor.spot.plan()) <= REACHED_M + step_m;
        near || (actor.route.is_empty() && spot.on.is_some_and(is_past))
    };
    if spot.is_none_or(is_there) {
        deeds::end(state, deed, Change::Ended, seen.tick);
    }
}

/// Along a line.
fn follow(state: &mut StoryState, role: RoleId, (number, path): (usize, &Path), seen: &Seen<'_>) {
    let speed_mps = state.actors[role].speed_mps;
    let deed = &mut state.deeds[number];
    let (at, over) = if path.timed {
        by_time(path, line_time_s(path, deed, seen))
    } else {
        deed.gone_m += speed_mps.abs() * TICK_S;
        by_way(&stations_m(number, deed, seen), deed.gone_m)
    };
    let line = std::mem::take(&mut state.deeds[number].line);
    let part = segment(path, &line, at);
    let last = last_mps(path, &line);
    state.deeds[number].line = line;
    let Some((from, to, share)) = part else {
        return deeds::end(state, number, Change::Ended, seen.tick);
    };
    let position = from.position.lerp(to.position, share);
    let along = to.plan() - from.plan();
    let actor = &mut state.actors[role];
    let heading_rad = if path.headings {
        ops::wrap_angle(from.heading_rad + ops::wrap_angle(to.heading_rad - from.heading_rad) * share)
    } else if along == Vec2::ZERO {
        actor.spot.heading_rad
    } else {
        // At a speed below zero it comes backwards.
        let ahead = if !path.timed && speed_mps < 0.0 { -along } else { along };
        ops::atan2(ahead.y, ahead.x)
    };
    if path.timed {
        let step = (position - actor.spot.position).truncate();
        actor.speed_mps = step.dot(direction(heading_rad)) / TICK_S;
        if over {
            actor.speed_mps = last.length() * last.dot(direction(heading_rad)).signum();
        }
    }
    actor.drift_mps = 0.0;
    actor.spot = Spot::at(seen.network, position, heading_rad);
    if over {
        deeds::end(state, number, Change::Ended, seen.tick);
    }
}

/// A place on a line: the corner before it, and the share of the way from that to the next one.
type Between = (usize, f32);

/// Where on a line somebody is at a time, and whether that is its end.
fn by_time(path: &Path, time_s: f32) -> (Between, bool) {
    let time = |k: usize| path.corners[k].1.unwrap_or(0.0);
    let last = path.corners.len() - 1;
    let next = path.corners.partition_point(|(_, at_s)| at_s.unwrap_or(0.0) <= time_s);
    match next {
        0 => ((0, 0.0), false),
        next if next > last => ((last - 1, 1.0), true),
        next => {
            let span_s = (time(next) - time(next - 1)).max(1e-6);
            let share = (time_s - time(next - 1)) / span_s;
            // Within a hundredth of a tick of the end it is there.
            ((next - 1, share), next == last && time(last) - time_s < 0.01 * TICK_S)
        }
    }
}

/// The same so far along it.
fn by_way(stations_m: &[f32], gone_m: f32) -> (Between, bool) {
    let last = stations_m.len() - 1;
    let next = stations_m.partition_point(|station_m| *station_m <= gone_m);
    if next > last {
        return ((last - 1, 1.0), true);
    }
    let next = next.max(1);
    let span_m = (stations_m[next] - stations_m[next - 1]).max(1e-6);
    ((next - 1, ((gone_m - stations_m[next - 1]) / span_m).max(0.0)), false)
}

/// The part of a line on which somebody is, and the share of it that is behind; `line` are corners that were found when it began.
fn segment(path: &Path, line: &[Spot], (first, share): Between) -> Option<(Spot, Spot, f32)> {
    let corner = |k: usize| match path.corners.get(k)?.0 {
        Position::Known(spot) if line.is_empty() => Some(spot),
        _ => line.get(k).copied(),
    };
    Some((corner(first)?, corner(first + 1)?, share))
}

/// The velocity on the last part of a timed line, m/s.
fn last_mps(path: &Path, line: &[Spot]) -> Vec2 {
    let last = path.corners.len() - 1;
    let span_s = path.corners[last].1.unwrap_or(0.0) - path.corners[last - 1].1.unwrap_or(0.0);
    let way = segment(path, line, (last - 1, 1.0)).map_or(Vec2::ZERO, |(from, to, _)| to.plan() - from.plan());
    if span_s > 1e-6 { way / span_s } else { Vec2::ZERO }
}
