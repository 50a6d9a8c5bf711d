//! What roles do: how it begins, and how it ends.

use glam::Vec3;

use crate::geometry::direction;
use crate::map::{Lane, RoadNetwork};
use crate::map_data::LaneKind;
use crate::ops;
use crate::time::Tick;

use super::actor::{self, StoryActor};
use super::cues::Seen;
use super::script::{Abreast, Action, Dynamics, LaneTarget, Path, Position, RoleId, Script, Shape, SpeedTarget, Takes};
use super::spot::{OnLane, Spot};
use super::state::{Change, Progress, StoryState};
use super::{doors, lanes, lights, places, relative};

/// A lane is beside somebody whose place on it is within this along it, metres.
const BESIDE_M: f32 = 3.0;
/// Most lanes of a route: keyframes hold them. After them who goes it goes straight on.
const ROUTE_LANES: usize = 1000;
/// Nobody needs longer for a way than at this speed, m/s.
const LEAST_MPS: f32 = 0.1;

/// Where everybody begins, as the first actions of a script say.
pub fn begin(script: &Script, network: &RoadNetwork) -> Result<Vec<StoryActor>, (usize, String)> {
    let mut placed: Vec<Option<StoryActor>> = vec![None; script.cast.len()];
    // Who is put to several places is at the last one.
    let mut places: Vec<Option<&Position>> = vec![None; script.cast.len()];
    for (role, action) in &script.init {
        if let Action::Teleport(place) | Action::Enter(place) = action {
            places[*role] = Some(place);
        }
    }
    // Who begins beside another may be told of before it.
    for _ in 0..script.cast.len() {
        for (role, place) in places.iter().enumerate().filter_map(|(role, place)| Some((role, (*place)?))) {
            if placed[role].is_none() {
                placed[role] = relative::spot_among(network, &placed, place).map(StoryActor::standing);
            }
        }
    }
    let is_told = |role: usize| places[role].is_some();
    let missing = |role: usize| {
        let expected = if is_told(role) { "one that is not told by its own" } else { "a teleport in <Init>" };
        (script.cast[role].at, format!("nothing says where {} begins, expected {expected}", script.cast[role].name))
    };
    // Who comes later, or never, is unseen.
    let ego = script.ego();
    let leaves = |(role, action): &&(RoleId, Action)| *action == Action::Leave && *role != ego;
    let absent = script.init.iter().filter(leaves).map(|(role, _)| *role);
    for role in script.entrances().chain(absent) {
        let nowhere = Spot { position: Vec3::ZERO, heading_rad: 0.0, on: None };
        placed[role].get_or_insert_with(|| StoryActor { gone: true, ..StoryActor::standing(nowhere) });
    }
    let actors = placed.into_iter().enumerate().map(|(role, actor)| actor.ok_or_else(|| missing(role)));
    let mut actors = actors.collect::<Result<Vec<_>, _>>()?;
    for (role, action) in &script.init {
        let asked_mps = match action {
            Action::Speed(_, target) => speed_of(*target, |role| actors[role].speed_mps),
            _ => 0.0,
        };
        let actor = &mut actors[*role];
        match action {
            Action::Teleport(_) | Action::Enter(_) => {}
            Action::Speed(..) => {
                let most_mps = script.cast[*role].most_mps;
                actor.speed_mps = asked_mps.clamp(-most_mps, most_mps);
                actor.velocity_mps = (direction(actor.spot.heading_rad) * actor.speed_mps).extend(0.0);
            }
            Action::Route(via) => actor.route = first_route(network, actor.spot, via),
            Action::Acquire(place) => actor.route = first_route(network, actor.spot, std::slice::from_ref(place)),
            Action::LaneOffset(_, offset_m, None) => {
                if let Some(on) = actor.spot.on {
                    let offset_m = offset_m * if on.against { -1.0 } else { 1.0 };
                    actor.spot = Spot::on(network, OnLane { offset_m, ..on });
                }
            }
            Action::Leave => actor.gone = *role != ego,
            Action::HandOver => {}
            Action::Door(door) => doors::swing(actor, *door, 0),
            // What takes time is an act of its own.
            _ => {}
        }
    }
    let ego = &mut actors[ego];
    if ego.route.is_empty() {
        // Drivers know their way from the beginning, whenever the story tells it.
        ego.route = match script.ego_way() {
            Some(Action::Route(via)) => first_route(network, ego.spot, via),
            Some(Action::Acquire(place)) => first_route(network, ego.spot, std::slice::from_ref(place)),
            Some(Action::Follow(path)) => route_along(network, ego.spot, path),
            _ => Vec::new(),
        };
    }
    Ok(actors)
}

/// The lanes of a way through places; nothing where there is none, or a place is nowhere. Places that were passed are left out.
fn route(network: &RoadNetwork, from: Spot, via: impl IntoIterator<Item = Option<Spot>>) -> Option<Vec<u32>> {
    let via: Vec<OnLane> = via.into_iter().map(|place| place?.on).collect::<Option<_>>()?;
    let mut at = from.on?;
    let is_between = |ends: &[OnLane]| lanes::is_on_way(network, at, ends[0], ends[1]);
    let passed = via.windows(2).rposition(is_between).map_or(0, |leg| leg + 1);
    let mut route = Vec::new();
    for to in &via[passed..] {
        route.extend(lanes::way(network, at, *to)?);
        at = *to;
        if route.len() > ROUTE_LANES {
            route.truncate(ROUTE_LANES);
            break;
        }
    }
    Some(route)
}

/// The same before anybody moves: through those places that do not depend on anybody.
fn first_route(network: &RoadNetwork, from: Spot, via: &[Position]) -> Vec<u32> {
    let known = |place: &Position| if let Position::Known(spot) = place { Some(Some(*spot)) } else { None };
    route(network, from, via.iter().filter_map(known)).unwrap_or_default()
}

/// The lanes of a line: of its corners those count that first come to another lane, outside of junctions.
fn route_along(network: &RoadNetwork, from: Spot, path: &Path) -> Vec<u32> {
    let known =
        path.corners.iter().filter_map(|(place, _)| if let Position::Known(spot) = place { spot.on } else { None });
    let is_road = |lane: &Lane| lane.junction.is_none() && lane.kind == LaneKind::Driving;
    let mut at = from.on.map(|on| on.lane);
    let first = known.filter(|on| is_road(&network.lanes[on.lane as usize]) && at.replace(on.lane) != Some(on.lane));
    let via: Vec<Option<Spot>> = first.map(|on| Some(Spot::on(network, on))).collect();
    route(network, from, via).unwrap_or_default()
}

/// The speed that is asked for, m/s.
pub fn speed_of(target: SpeedTarget, speed_mps: impl Fn(RoleId) -> f32) -> f32 {
    match target {
        SpeedTarget::Absolute(speed_mps) => speed_mps,
        SpeedTarget::Faster(role, by_mps, _) => speed_mps(role) + by_mps,
        SpeedTarget::Times(role, times, _) => speed_mps(role) * times,
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

/// How long a change of the speed takes, seconds: the courses are even about their middle, so that its way tells the time.
fn speeds_up_s(dynamics: Dynamics, from_mps: f32, to_mps: f32) -> f32 {
    match dynamics.takes {
        Takes::Distance(metres) if dynamics.shape != Shape::Step => {
            2.0 * metres / (from_mps + to_mps).abs().max(LEAST_MPS)
        }
        _ => length_of(dynamics, to_mps - from_mps),
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
    let goes_on = match of.role {
        None => {
            lights::change(state, &of.action, &seen.script.programmes, tick);
            false
        }
        Some(ego) if ego == seen.plan.ego && *of.action == Action::HandOver => {
            state.carries_ego = false;
            false
        }
        // The drivers decide what the ego car does, once they have it.
        Some(role) => {
            let plays = role != seen.plan.ego || state.carries_ego;
            let enters = matches!(*of.action, Action::Enter(_));
            plays && state.actors[role].gone == enters && begins(state, number, role, seen)
        }
    };
    if !goes_on {
        end(state, number, Change::Ended, tick);
    }
}

/// Begins a deed; `false` when it is over at once.
fn begins(state: &mut StoryState, number: usize, role: RoleId, seen: &Seen<'_>) -> bool {
    let (of, network, before) = (&seen.plan.deeds[number], seen.network, seen.before);
    match &*of.action {
        Action::Teleport(place) => {
            if let Some(spot) = relative::spot(network, before, place) {
                leaves_its_way(state, role, seen.tick);
                let actor = &mut state.actors[role];
                actor.spot = spot;
                actor.slip_m = 0.0;
                actor.route.clear();
                if actor.speed_mps == 0.0 {
                    actor.speed_mps = std::mem::take(&mut actor.ended_mps);
                }
            }
            false
        }
        // The ego car stays.
        Action::Leave if role == seen.plan.ego => false,
        Action::Leave => {
            end_all(state, role, seen.tick);
            // Nothing of it is left when it comes again.
            state.actors[role] = StoryActor { gone: true, ..StoryActor::standing(state.actors[role].spot) };
            false
        }
        Action::Enter(place) => {
            if let Some(spot) = relative::spot(network, before, place) {
                state.actors[role] = StoryActor::standing(spot);
            }
            false
        }
        Action::Speed(..) | Action::SpeedProfile(_) | Action::Gap(_) | Action::Meet(_) => {
            let from = state.actors[role].speed_mps;
            let (to, takes) = match &*of.action {
                Action::Speed(dynamics, target) => {
                    let to = speed_of(*target, |role| before.actors[role].speed_mps);
                    (to, speeds_up_s(*dynamics, from, to))
                }
                _ => (from, 0.0),
            };
            let replaced = [state.actors[role].speed_by.replace(number as u32), line_of(state, role, seen, true)];
            let deed = &mut state.deeds[number];
            (deed.from, deed.to, deed.takes) = (from, to, takes);
            replaced.into_iter().for_each(|deed| replace(state, deed, number, seen.tick));
            true
        }
        Action::LaneChange(..) | Action::LaneOffset(..) | Action::Abreast(_) => {
            begins_across(state, (role, number), seen)
        }
        Action::Follow(path) => {
            let actor = &mut state.actors[role];
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
            let via = via.iter().map(|place| relative::spot(network, before, place));
            let actor = &mut state.actors[role];
            actor.route = route(network, actor.spot, via).unwrap_or_default();
            let replaced = actor.way_by.take();
            replace(state, replaced, number, seen.tick);
            false
        }
        Action::Acquire(place) => {
            let Some(to) = relative::spot(network, before, place) else { return false };
            let actor = &mut state.actors[role];
            let Some(way) = route(network, actor.spot, [Some(to)]) else { return false };
            let replaced = actor.way_by.replace(number as u32);
            actor.route = way;
            replace(state, replaced, number, seen.tick);
            true
        }
        // Of the world, not of a role.
        Action::Light(_) | Action::Programme(..) | Action::Environment(_) => false,
        Action::Door(door) => {
            doors::swing(&mut state.actors[role], *door, seen.tick);
            false
        }
        // Others have no drivers.
        Action::HandOver => false,
    }
}

/// Begins a move across the lane, or to another; `false` where there is none.
fn begins_across(state: &mut StoryState, (role, number): (RoleId, usize), seen: &Seen<'_>) -> bool {
    let spot = state.actors[role].spot;
    let Some(mut on) = spot.on else { return false };
    let (to_m, takes_s) = match &*seen.plan.deeds[number].action {
        Action::LaneChange(dynamics, target, offset_m) => {
            let Some(to) = lane_of(seen.network, seen.before, role, *target) else { return false };
            let there = seen.network.project(to.lane, spot.position);
            on = OnLane { s_m: there.s_m, offset_m: there.lateral_m, ..to };
            let to_m = to.offset_m + offset_m * if on.against { -1.0 } else { 1.0 };
            let actor = &mut state.actors[role];
            actor.spot.on = Some(on);
            actor.slip_m = 0.0;
            actor.route = lanes::onward_way(seen.network, on, &actor.route);
            (to_m, length_of(*dynamics, to_m - on.offset_m))
        }
        Action::LaneOffset(dynamics, offset_m, beside) => {
            let of_other = beside.and_then(|other| seen.before.actors[other].spot.on).map_or(0.0, |on| on.offset_m);
            let to_m = of_other + offset_m * if on.against { -1.0 } else { 1.0 };
            (to_m, calm_s(*dynamics, to_m - on.offset_m))
        }
        Action::Abreast(wanted) => {
            let to_m = abreast_m(*wanted, role, on, seen);
            (to_m, calm_s(wanted.dynamics(), to_m - on.offset_m))
        }
        _ => return false,
    };
    moves_aside(state, (role, number), seen, (on.offset_m, to_m), takes_s);
    true
}

/// To the left of the middle of its lane in its direction, metres: where somebody is as far beside another as it should be.
fn abreast_m(wanted: Abreast, role: RoleId, on: OnLane, seen: &Seen<'_>) -> f32 {
    let actors = &seen.before.actors;
    let other_m = seen.network.project(on.lane, actors[wanted.role].spot.position).lateral_m;
    let half_m = |role: RoleId| actor::size_m(&seen.script.cast[role]).y * 0.5;
    let widths_m = if wanted.free { half_m(role) + half_m(wanted.role) } else { 0.0 };
    let is_left = wanted.is_left.map_or(on.offset_m >= other_m, |is_left| is_left != on.against);
    let away_m = wanted.wanted_m.map_or((on.offset_m - other_m).abs(), |wanted_m| wanted_m + widths_m);
    other_m + if is_left { away_m } else { -away_m }
}

/// The corners of a line where they are now; nothing where one of them is nowhere.
fn line(network: &RoadNetwork, before: &StoryState, path: &Path) -> Option<Vec<Spot>> {
    path.corners.iter().map(|(place, _)| relative::spot(network, before, place)).collect()
}

fn moves_aside(
    state: &mut StoryState,
    (role, number): (RoleId, usize),
    seen: &Seen<'_>,
    (from, to): (f32, f32),
    takes: f32,
) {
    let replaced = [state.actors[role].side_by.replace(number as u32), line_of(state, role, seen, false)];
    let deed = &mut state.deeds[number];
    (deed.from, deed.to, deed.takes) = (from, to, takes);
    replaced.into_iter().for_each(|deed| replace(state, deed, number, seen.tick));
}

/// The deed whose line a role follows, only one with times if `timed`: that decides how fast it is, too.
fn line_of(state: &StoryState, role: RoleId, seen: &Seen<'_>, timed: bool) -> Option<u32> {
    let of = |deed: &u32| &*seen.plan.deeds[*deed as usize].action;
    let is_line = |deed: &u32| matches!(of(deed), Action::Follow(path) if path.timed || !timed);
    state.actors[role].way_by.filter(is_line)
}

/// Ends all that a role does.
pub fn end_all(state: &mut StoryState, role: RoleId, tick: Tick) {
    let actor = &state.actors[role];
    for deed in [actor.speed_by, actor.side_by, actor.way_by].into_iter().flatten() {
        end(state, deed as usize, Change::Stopped, tick);
    }
}

/// Ends where across its lane and along which way a role goes: it is taken elsewhere. A line that begins in the same tick is where
/// it is taken then.
fn leaves_its_way(state: &mut StoryState, role: RoleId, tick: Tick) {
    let actor = &state.actors[role];
    let way = actor.way_by.filter(|deed| state.deeds[*deed as usize].mark.at < tick);
    for deed in [actor.side_by, way].into_iter().flatten() {
        end(state, deed as usize, Change::Stopped, tick);
    }
}

/// Ends the deed that another replaces.
fn replace(state: &mut StoryState, replaced: Option<u32>, by: usize, tick: Tick) {
    if let Some(replaced) = replaced.map(|deed| deed as usize).filter(|deed| *deed != by) {
        end(state, replaced, Change::Stopped, tick);
    }
}

/// The lane that a change leads to, at the place of who changes; nothing where its road has none beside it.
fn lane_of(network: &RoadNetwork, before: &StoryState, role: RoleId, target: LaneTarget) -> Option<OnLane> {
    let spot = before.actors[role].spot;
    let (road, _) = network.lanes[spot.on?.lane as usize].name.rsplit_once('/')?;
    let (id, offset_m) = match target {
        LaneTarget::Absolute(id) => (id.to_string(), 0.0),
        LaneTarget::Relative(other, count) => {
            let of_other = relative::beside(network, before.actors[other].spot, count)?;
            let (_, id) = network.lanes[of_other.lane as usize].name.rsplit_once('/')?;
            (id.to_owned(), of_other.offset_m)
        }
    };
    let found = places::nearest(network, &format!("{road}/{id}"), spot.position)?;
    let middle = network.lane_point(found.lane, found.s_m);
    let along_m = (spot.position - middle.position).truncate().dot(direction(middle.heading_rad));
    let there = relative::facing(network, found.lane, found.s_m, offset_m, spot.heading_rad);
    (along_m.abs() < BESIDE_M).then_some(there)
}

/// A deed comes to its end.
pub fn end(state: &mut StoryState, number: usize, change: Change, tick: Tick) {
    let deed = &mut state.deeds[number];
    deed.mark.turn(Progress::Complete, change, tick);
    deed.line = Vec::new();
    let by = Some(number as u32);
    for actor in &mut state.actors {
        for held in [&mut actor.speed_by, &mut actor.side_by, &mut actor.way_by] {
            if *held == by {
                *held = None;
            }
        }
    }
}
