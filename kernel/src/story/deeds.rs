//! What roles do: how it begins, and how it ends.

use crate::geometry::direction;
use crate::map::RoadNetwork;
use crate::ops;
use crate::time::Tick;

use super::actor::StoryActor;
use super::cues::Seen;
use super::script::{Action, Dynamics, LaneTarget, Path, Position, RoleId, Script, Shape, SpeedTarget, Takes};
use super::spot::{OnLane, Spot};
use super::state::{Change, Progress, StoryState};
use super::{lanes, places, relative};

/// Where everybody begins, as the first actions of a script say.
pub fn begin(script: &Script, network: &RoadNetwork) -> Result<Vec<StoryActor>, String> {
    let mut placed: Vec<Option<StoryActor>> = vec![None; script.cast.len()];
    let teleports = || {
        script.init.iter().filter_map(|(role, action)| match action {
            Action::Teleport(place) => Some((*role, place)),
            _ => None,
        })
    };
    // Who begins beside another may be told of before it.
    for _ in 0..script.cast.len() {
        for (role, place) in teleports() {
            if placed[role].is_none() {
                placed[role] = relative::spot_among(network, &placed, place).map(StoryActor::standing);
            }
        }
    }
    let missing =
        |role: usize| format!("nothing says where {} begins: expected a teleport in <Init>", script.cast[role].name);
    let actors = placed.into_iter().enumerate().map(|(role, actor)| actor.ok_or_else(|| missing(role)));
    let mut actors = actors.collect::<Result<Vec<_>, _>>()?;
    for (role, action) in &script.init {
        let speeds: Vec<f32> = actors.iter().map(|actor| actor.speed_mps).collect();
        let name = &script.cast[*role].name;
        let actor = &mut actors[*role];
        match action {
            Action::Teleport(_) => {}
            Action::Speed(_, target) => {
                actor.speed_mps = speed_of(*target, &speeds).min(script.cast[*role].most_mps);
                actor.velocity_mps = (direction(actor.spot.heading_rad) * actor.speed_mps).extend(0.0);
            }
            Action::Route(via) => actor.route = route(network, actor.spot, via).unwrap_or_default(),
            Action::Acquire(place) => {
                let to = std::slice::from_ref(place);
                actor.route = route(network, actor.spot, to).unwrap_or_default();
            }
            Action::LaneOffset(_, offset_m, None) => {
                if let Some(on) = actor.spot.on {
                    actor.spot = Spot::on(network, OnLane { offset_m: *offset_m, ..on });
                }
            }
            Action::Leave => actor.gone = true,
            Action::LaneChange(..) | Action::LaneOffset(..) | Action::Follow(_) => {
                return Err(format!("what {name} does in <Init> is supported in events only"));
            }
        }
    }
    Ok(actors)
}

fn route(network: &RoadNetwork, from: Spot, via: &[Position]) -> Option<Vec<u32>> {
    let mut route = Vec::new();
    let mut at = from.on?;
    for place in via {
        let Position::Known(Spot { on: Some(to), .. }) = place else { continue };
        route.extend(lanes::way(network, at, *to)?);
        at = *to;
    }
    Some(route)
}

/// The speed that is asked for, m/s.
pub fn speed_of(target: SpeedTarget, speeds: &[f32]) -> f32 {
    match target {
        SpeedTarget::Absolute(speed_mps) => speed_mps,
        SpeedTarget::Faster(role, by_mps, _) => speeds[role] + by_mps,
        SpeedTarget::Times(role, times, _) => speeds[role] * times,
    }
}

/// How long a change takes: seconds, or metres.
fn length_of(dynamics: Dynamics, change: f32) -> f32 {
    match dynamics.takes {
        _ if dynamics.shape == Shape::Step => 0.0,
        Takes::Time(seconds) => seconds,
        Takes::Distance(metres) => metres,
        Takes::Rate(rate) => change.abs() / rate.max(1e-3),
    }
}

/// How long a move across a lane takes whose greatest acceleration is the rate, seconds.
fn calm_s(dynamics: Dynamics, change_m: f32) -> f32 {
    let Takes::Rate(most_mps2) = dynamics.takes else { return length_of(dynamics, change_m) };
    let by = match dynamics.shape {
        Shape::Step => return 0.0,
        Shape::Sinusoidal => core::f32::consts::PI * core::f32::consts::PI / 2.0,
        Shape::Linear | Shape::Cubic => 6.0,
    };
    ops::sqrt(by * change_m.abs() / most_mps2.max(1e-3))
}

/// A deed begins.
pub fn start(state: &mut StoryState, number: usize, seen: &Seen<'_>) {
    let (of, tick) = (&seen.plan.deeds[number], seen.tick);
    state.deeds[number].mark.turn(Progress::Running, Change::Started, tick);
    state.deeds[number].gone_m = 0.0;
    let is_ego = of.role == seen.plan.ego;
    // The drivers decide what the ego car does.
    if is_ego || state.actors[of.role].gone {
        return end(state, number, Change::Ended, tick);
    }
    if !begins(state, number, seen) {
        end(state, number, Change::Ended, tick);
    }
}

/// Begins a deed; `false` when it is over at once.
fn begins(state: &mut StoryState, number: usize, seen: &Seen<'_>) -> bool {
    let (of, network, before) = (&seen.plan.deeds[number], seen.network, seen.before);
    let by = Some(number as u32);
    match &of.action {
        Action::Teleport(place) => {
            if let Some(spot) = relative::spot(network, before, place) {
                state.actors[of.role].spot = spot;
                state.actors[of.role].route.clear();
            }
            false
        }
        Action::Leave => {
            state.actors[of.role].gone = true;
            false
        }
        Action::Speed(dynamics, target) => {
            let speeds: Vec<f32> = before.actors.iter().map(|actor| actor.speed_mps).collect();
            let (from, to) = (state.actors[of.role].speed_mps, speed_of(*target, &speeds));
            let replaced = std::mem::replace(&mut state.actors[of.role].speed_by, by);
            let deed = &mut state.deeds[number];
            (deed.from, deed.to, deed.takes) = (from, to, length_of(*dynamics, to - from));
            replace(state, replaced, number, seen.tick);
            true
        }
        Action::LaneChange(dynamics, target, offset_m) => {
            let Some(to) = lane_of(network, before, of.role, *target) else { return false };
            let spot = state.actors[of.role].spot;
            let there = network.project(to.lane, spot.position);
            let now = OnLane { s_m: there.s_m, offset_m: there.lateral_m, ..to };
            let to_m = offset_m * if now.against { -1.0 } else { 1.0 };
            state.actors[of.role].spot.on = Some(now);
            state.actors[of.role].route.clear();
            moves_aside(state, number, seen, (now.offset_m, to_m), length_of(*dynamics, to_m - now.offset_m));
            true
        }
        Action::LaneOffset(dynamics, offset_m, role) => {
            let Some(on) = state.actors[of.role].spot.on else { return false };
            let of_other = role.and_then(|role| before.actors[role].spot.on).map_or(0.0, |on| on.offset_m);
            let to_m = of_other + offset_m;
            moves_aside(state, number, seen, (on.offset_m, to_m), calm_s(*dynamics, to_m - on.offset_m));
            true
        }
        Action::Follow(path) => {
            let actor = &mut state.actors[of.role];
            let replaced = [actor.way_by.replace(number as u32), actor.side_by.take()];
            let replaced_speed = if path.timed { actor.speed_by.take() } else { None };
            let is_known = |(place, _): &(Position, Option<f32>)| matches!(place, Position::Known(_));
            let line = if path.corners.iter().all(is_known) { Some(Vec::new()) } else { line(network, before, path) };
            let deed = &mut state.deeds[number];
            (deed.gone_m, deed.line) = (path.from_m, line.unwrap_or_default());
            replaced.into_iter().chain([replaced_speed]).for_each(|deed| replace(state, deed, number, seen.tick));
            true
        }
        Action::Route(via) => {
            state.actors[of.role].route = route(network, state.actors[of.role].spot, via).unwrap_or_default();
            false
        }
        Action::Acquire(place) => {
            let Some(to) = relative::spot(network, before, place) else { return false };
            let actor = &mut state.actors[of.role];
            let Some(way) = route(network, actor.spot, &[Position::Known(to)]) else { return false };
            let replaced = actor.way_by.replace(number as u32);
            actor.route = way;
            replace(state, replaced, number, seen.tick);
            true
        }
    }
}

/// The corners of a line where they are now; nothing where one of them is nowhere.
fn line(network: &RoadNetwork, before: &StoryState, path: &Path) -> Option<Vec<Spot>> {
    path.corners.iter().map(|(place, _)| relative::spot(network, before, place)).collect()
}

fn moves_aside(state: &mut StoryState, number: usize, seen: &Seen<'_>, (from, to): (f32, f32), takes: f32) {
    let role = seen.plan.deeds[number].role;
    let replaced = state.actors[role].side_by.replace(number as u32);
    let deed = &mut state.deeds[number];
    (deed.from, deed.to, deed.takes) = (from, to, takes);
    replace(state, replaced, number, seen.tick);
}

/// Ends the deed that another replaces.
fn replace(state: &mut StoryState, replaced: Option<u32>, by: usize, tick: Tick) {
    if let Some(replaced) = replaced.map(|deed| deed as usize).filter(|deed| *deed != by) {
        end(state, replaced, Change::Stopped, tick);
    }
}

/// The lane that a change leads to, at the place of who changes.
fn lane_of(network: &RoadNetwork, before: &StoryState, role: RoleId, target: LaneTarget) -> Option<OnLane> {
    let spot = before.actors[role].spot;
    match target {
        LaneTarget::Absolute(id) => {
            let (road, _) = network.lanes[spot.on?.lane as usize].name.rsplit_once('/')?;
            let found = places::nearest(network, &format!("{road}/{id}"), spot.position)?;
            Some(relative::facing(network, found.lane, found.s_m, 0.0, spot.heading_rad))
        }
        LaneTarget::Relative(other, count) => {
            let of_other = relative::beside(network, before.actors[other].spot, count)?;
            let name = &network.lanes[of_other.lane as usize].name;
            let found = places::nearest(network, name, spot.position)?;
            Some(relative::facing(network, found.lane, found.s_m, 0.0, spot.heading_rad))
        }
    }
}

/// A deed comes to its end.
pub fn end(state: &mut StoryState, number: usize, change: Change, tick: Tick) {
    state.deeds[number].mark.turn(Progress::Complete, change, tick);
    let by = Some(number as u32);
    for actor in &mut state.actors {
        for held in [&mut actor.speed_by, &mut actor.side_by, &mut actor.way_by] {
            if *held == by {
                *held = None;
            }
        }
    }
}
