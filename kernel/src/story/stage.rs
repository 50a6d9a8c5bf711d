//! A story on a map: how it goes on from tick to tick.

use std::sync::Arc;

use glam::{Quat, Vec3};

use crate::actor::FIRST_STORY_ID;
use crate::map::RoadNetwork;
use crate::map_data::{LaneId, LaneKind};
use crate::signals::HeldLight;
use crate::time::Tick;
use crate::traffic::{Body, Door, Obstacle};
use crate::weather::Weather;

use super::actor::{self, StoryActor};
use super::cues::Seen;
use super::facts::Outline;
use super::plan::{DeedPlan, GroupPlan, Plan};
use super::script::{Action, Priority, RoleId, Script};
use super::spot::Spot;
use super::state::{Change, Deed, Mark, Met, Progress, StoryState};
use super::text::Story;
use super::{deeds, doors, lights, moves, places, weather};

/// The ego car begins so near to a lane at least, metres.
const NEAR_ROAD_M: f32 = 10.0;

/// A story on a map.
#[derive(Clone, Debug)]
pub struct Stage {
    script: Arc<Script>,
    plan: Arc<Plan>,
    start: Arc<[StoryActor]>,
}

/// What a story sees of the world, as it was at the end of the tick before.
#[derive(Clone, Copy)]
pub struct Around<'a> {
    /// The tick that is computed.
    pub tick: Tick,
    /// The seed of the run.
    pub seed: u64,
    /// The map.
    pub network: &'a RoadNetwork,
    /// The ego car.
    pub ego: Obstacle,
    /// Actors that physics holds, by ascending id.
    pub loose: &'a [Obstacle],
    /// Actors that the ego car touches, by ascending id.
    pub touching: &'a [u32],
    /// Whether the ego car is on a road.
    pub ego_on_road: bool,
    /// Whether its safety driver takes over in this tick.
    pub taken_over: bool,
}

impl Stage {
    /// A story on a map, begun.
    ///
    /// # Errors
    /// When places are not on the map, or nobody says where somebody who plays begins.
    pub fn new(story: &Story, network: &RoadNetwork) -> Result<Self, String> {
        let mut script = story.script().clone();
        let said = |(at, reason)| story.refusal(at, reason).to_string();
        places::find(&mut script, network).map_err(said)?;
        lights::find(&mut script, network).map_err(said)?;
        let plan = Plan::of(&script);
        let start = deeds::begin(&script, network).map_err(said)?;
        if let Some(role) = start.iter().position(|actor| !actor.is_possible()) {
            let (of, at, mps) = (&script.cast[role], start[role].spot.position, start[role].speed_mps);
            return Err(said((of.at, format!("{} begins at {at} with {mps} m/s, where or as nobody can be", of.name))));
        }
        let outline = |role: RoleId| Outline::of(&start[role], &script.cast[role]);
        let is_in_ego =
            |role: &RoleId| *role != plan.ego && !start[*role].gone && outline(*role).touches(&outline(plan.ego));
        if let Some(role) = (0..start.len()).find(is_in_ego) {
            let [ego, other] = [plan.ego, role].map(|role| &script.cast[role]);
            return Err(said((other.at, format!("{} and {} begin in each other", other.name, ego.name))));
        }
        let ego_at = script.cast[plan.ego].at;
        let stage = Self { script: Arc::new(script), plan: Arc::new(plan), start: start.into() };
        stage.ego_road(network).map_err(|reason| said((ego_at, reason)))?;
        Ok(stage)
    }

    /// Where the ego car begins, and how fast it is, m/s.
    pub fn ego_start(&self) -> (Spot, f32) {
        let ego = &self.start[self.plan.ego];
        (ego.spot, ego.speed_mps)
    }

    /// The lanes that the story would have the ego car take next, as far as they follow each other.
    pub fn ego_way(&self, network: &RoadNetwork, from: LaneId) -> Vec<LaneId> {
        let mut before = from;
        let follows = |lane: &&LaneId| {
            let onward = network.ways().onward(std::mem::replace(&mut before, **lane));
            onward.iter().any(|next| next.lane == **lane)
        };
        self.start[self.plan.ego].route.iter().take_while(follows).copied().collect()
    }

    /// The lane that the ego car begins on or beside, and where along it, metres.
    ///
    /// # Errors
    /// When no road is near.
    pub fn ego_road(&self, network: &RoadNetwork) -> Result<(LaneId, f32), String> {
        let spot = self.ego_start().0;
        let road = network.nearest_lane(spot.position, LaneKind::Driving, Some(spot.heading_rad), NEAR_ROAD_M);
        let far = || format!("the ego car begins at {}, expected a place on a road", spot.position);
        road.map(|road| (road.lane, road.s_m)).ok_or_else(far)
    }

    /// Where the others begin.
    pub fn starts(&self) -> impl Iterator<Item = Vec3> + '_ {
        let others = self.start.iter().enumerate().filter(|(role, actor)| *role != self.plan.ego && !actor.gone);
        others.map(|(_, actor)| actor.spot.position)
    }

    /// Before the first tick.
    pub fn begin(&self) -> StoryState {
        let plan = &*self.plan;
        let (lights, cycles) = lights::begin(&self.script);
        StoryState {
            actors: self.start.to_vec(),
            acts: vec![Mark::NEW; plan.acts.len()],
            groups: vec![Mark::NEW; plan.groups.len()],
            events: vec![Mark::NEW; plan.events.len()],
            deeds: vec![Deed::NEW; plan.deeds.len()],
            conditions: vec![Met::default(); plan.conditions],
            lights,
            cycles,
            carries_ego: plan.carries_ego,
            over: false,
        }
    }

    /// Refuses a state that is none of this story on this map.
    pub fn check(&self, state: &StoryState, network: &RoadNetwork) -> Result<(), String> {
        let counts = |s: &StoryState| {
            let elements = [s.acts.len(), s.groups.len(), s.events.len(), s.deeds.len(), s.conditions.len()];
            (s.actors.len(), elements, s.cycles.len())
        };
        if counts(state) != counts(&self.begin()) {
            return Err("its story has other elements than that of the scenario".to_owned());
        }
        let phases = self.script.programmes.iter().map(|programme| programme.phases.len());
        if state.cycles.iter().zip(phases).any(|(cycle, phases)| usize::from(cycle.phase) >= phases) {
            return Err("a programme of its lights is in a phase that it has not".to_owned());
        }
        let is_there = |light: &HeldLight| (light.group as usize) < network.light_groups.len();
        if !state.lights.is_sorted_by(|a, b| a.group < b.group) || !state.lights.iter().all(is_there) {
            return Err("story.lights are not lights of the map in ascending order".to_owned());
        }
        let lane = |lane: &u32| (*lane as usize) < network.lanes.len();
        let deed = |deed: &Option<u32>| deed.is_none_or(|deed| (deed as usize) < state.deeds.len());
        let fits = |actor: &StoryActor| {
            let lanes = actor.spot.on.is_none_or(|on| lane(&on.lane)) && actor.route.iter().all(lane);
            let deeds = deed(&actor.speed_by) && deed(&actor.side_by) && deed(&actor.way_by);
            let doors =
                actor.doors.iter().all(|door| [door.from, door.to].iter().all(|share| (0.0..=1.0).contains(share)));
            lanes && deeds && doors && actor.is_possible()
        };
        let corners = |deed: &DeedPlan| if let Action::Follow(path) = &*deed.action { path.corners.len() } else { 0 };
        let fits_line = |(of, deed): (&DeedPlan, &Deed)| deed.line.is_empty() || deed.line.len() == corners(of);
        if !self.plan.deeds.iter().zip(&state.deeds).all(fits_line) {
            return Err("a line of its story has other corners than that of the scenario".to_owned());
        }
        match state.actors.iter().position(|actor| !fits(actor)) {
            Some(role) => {
                let (name, at) = (&self.script.cast[role].name, state.actors[role].spot.position);
                Err(format!("story.actors[{role}], {name} at {at}, is where or as nobody can be"))
            }
            None => Ok(()),
        }
    }

    /// Those who play, but the ego car and those who left, by ascending id.
    pub fn bodies<'a>(&'a self, state: &'a StoryState) -> impl Iterator<Item = Body> + 'a {
        let cast = self.script.cast.iter().zip(&state.actors).enumerate();
        cast.filter_map(|(role, (of, actor))| Some(actor.body(role, of.kind.filter(|_| !actor.gone)?)))
    }

    /// The same, as traffic sees them.
    pub fn obstacles<'a>(&'a self, state: &'a StoryState) -> impl Iterator<Item = Obstacle> + 'a {
        let heading = |id: u32| state.actors[(id - FIRST_STORY_ID) as usize].spot.heading_rad;
        self.bodies(state).map(move |body| actor::obstacle(&body, heading(body.id)))
    }

    /// Doors of those who play that stand open at a tick.
    pub fn open_doors<'a>(&'a self, state: &'a StoryState, tick: Tick) -> impl Iterator<Item = Door> + 'a {
        let cast = self.script.cast.iter().zip(&state.actors).enumerate();
        let plays = cast.filter(|(role, (_, actor))| *role != self.plan.ego && !actor.gone);
        plays.filter_map(move |(role, (of, actor))| doors::open(actor, (role, of), tick))
    }

    /// Names of the events that did not begin so far.
    pub fn waiting<'a>(&'a self, state: &'a StoryState) -> impl Iterator<Item = &'a str> + 'a {
        let groups = self.script.acts.iter().flat_map(|act| &act.groups);
        let events = groups.flat_map(|group| &group.events).zip(&state.events);
        events.filter(|(_, mark)| mark.began == 0).map(|(event, _)| event.name.as_str())
    }

    /// A weather as the story has changed it so far.
    pub fn weather(&self, state: &StoryState, from: Weather) -> Weather {
        weather::changed(&self.plan, state, from)
    }

    /// Where the ego car is at the end of this tick, as long as the story drives it: the middle of its footprint, and its
    /// rotation.
    pub fn carried(&self, state: &StoryState) -> Option<(Vec3, Quat)> {
        let ego = &state.actors[self.plan.ego];
        state.carries_ego.then(|| (ego.spot.position, ego.rotation()))
    }

    /// Goes on by one tick.
    pub fn step(&self, state: &mut StoryState, around: &Around<'_>) {
        let mut before = std::mem::take(state);
        // Who is hit, or is taken over, is driven by nobody else.
        before.carries_ego &= around.touching.is_empty() && !around.taken_over;
        self.mirror(&mut before, around);
        *state = before.clone();
        let touching: Vec<RoleId> = around.touching.iter().filter_map(|id| role_of(*id, &before)).collect();
        let (script, plan, network, tick) = (&*self.script, &*self.plan, around.network, around.tick);
        let seen = Seen { script, plan, network, before: &before, tick, seed: around.seed, touching: &touching };
        lights::go_on(state, &script.programmes, tick);
        self.go_on(state, &seen);
        for role in (0..script.cast.len()).filter(|role| *role != plan.ego || before.carries_ego) {
            let held = around.loose.binary_search_by_key(&(FIRST_STORY_ID + role as u32), |o| o.id).is_ok();
            if held {
                deeds::end_all(state, role, tick);
            } else if !state.actors[role].gone {
                moves::advance(state, role, &seen);
            }
        }
        // What its drivers do now is not the story's.
        if !state.carries_ego {
            deeds::end_all(state, plan.ego, tick);
        }
    }

    /// Takes over where the ego car is, and those that physics holds.
    fn mirror(&self, state: &mut StoryState, around: &Around<'_>) {
        let ego = (!state.carries_ego).then_some((self.plan.ego, &around.ego, around.ego_on_road));
        let loose = around.loose.iter().filter_map(|o| Some((role_of(o.id, state)?, o, true))).collect::<Vec<_>>();
        for (role, obstacle, on_road) in ego.into_iter().chain(loose) {
            let was = state.actors[role].clone();
            let actor = &mut state.actors[role];
            actor.spot = Spot::at(around.network, obstacle.position, obstacle.heading_rad);
            let ahead = crate::geometry::direction(obstacle.heading_rad);
            actor.speed_mps = obstacle.velocity_mps.truncate().dot(ahead);
            actor.came(&was, self.script.cast[role].kind, on_road, false);
            actor.velocity_mps = obstacle.velocity_mps;
        }
    }

    /// Begins and ends acts, groups and events.
    fn go_on(&self, state: &mut StoryState, seen: &Seen<'_>) {
        let (plan, tick) = (&*self.plan, seen.tick);
        if state.over {
            return;
        }
        if seen.is_met(&plan.stop, &mut state.conditions) {
            state.over = true;
            (0..plan.acts.len()).for_each(|act| self.stop_act(state, act, tick));
            return;
        }
        for (number, act) in plan.acts.iter().enumerate() {
            if state.acts[number].progress == Progress::Standby {
                if !act.start.is_empty() && !seen.is_met(&act.start, &mut state.conditions) {
                    continue;
                }
                state.acts[number].turn(Progress::Running, Change::Started, tick);
                let groups = act.groups.clone();
                groups.for_each(|group| state.groups[group].turn(Progress::Running, Change::Started, tick));
            }
            if !state.acts[number].runs() {
                continue;
            }
            if seen.is_met(&act.stop, &mut state.conditions) {
                self.stop_act(state, number, tick);
                continue;
            }
            act.groups.clone().for_each(|group| self.play(state, group, seen));
            if act.groups.clone().all(|group| state.groups[group].is_complete()) {
                state.acts[number].turn(Progress::Complete, Change::Ended, tick);
            }
        }
    }

    fn stop_act(&self, state: &mut StoryState, act: usize, tick: Tick) {
        let stop = |mark: &mut Mark| {
            if !mark.is_complete() {
                mark.turn(Progress::Complete, Change::Stopped, tick);
            }
        };
        stop(&mut state.acts[act]);
        for group in self.plan.acts[act].groups.clone() {
            stop(&mut state.groups[group]);
            for event in self.plan.groups[group].events.clone() {
                let goes_on = state.events[event].runs();
                stop(&mut state.events[event]);
                if goes_on {
                    self.end_deeds(state, event, tick);
                }
            }
        }
    }

    /// Ends what roles still do in an event.
    fn end_deeds(&self, state: &mut StoryState, event: usize, tick: Tick) {
        for deed in self.plan.events[event].deeds.clone() {
            if state.deeds[deed].mark.runs() {
                deeds::end(state, deed, Change::Stopped, tick);
            }
        }
    }

    fn play(&self, state: &mut StoryState, group: usize, seen: &Seen<'_>) {
        if !state.groups[group].runs() {
            return;
        }
        let (of, tick) = (&self.plan.groups[group], seen.tick);
        for event in of.events.clone() {
            match state.events[event].progress {
                Progress::Standby => self.stand_by(state, of, event, seen),
                Progress::Running => self.carry_on(state, event, tick),
                Progress::Complete => {}
            }
        }
        if !of.events.clone().all(|event| state.events[event].is_complete()) {
            return;
        }
        state.groups[group].turn(Progress::Complete, Change::Ended, tick);
        if state.groups[group].times < of.most && !of.events.is_empty() {
            state.groups[group].progress = Progress::Running;
            for event in of.events.clone() {
                (state.events[event].progress, state.events[event].times) = (Progress::Standby, 0);
                self.plan.events[event].start.rearm(&mut state.conditions);
            }
        }
    }

    fn stand_by(&self, state: &mut StoryState, group: &GroupPlan, event: usize, seen: &Seen<'_>) {
        let (of, tick) = (&self.plan.events[event], seen.tick);
        if !of.start.is_empty() && !seen.is_met(&of.start, &mut state.conditions) {
            return;
        }
        let beside = |other: &usize| *other != event && self.plan.events[*other].manoeuvre == of.manoeuvre;
        let going: Vec<usize> = group.events.clone().filter(beside).filter(|e| state.events[*e].runs()).collect();
        match of.priority {
            Priority::Skip if !going.is_empty() => {
                state.events[event].turn(Progress::Standby, Change::Skipped, tick);
                self.again_or_over(state, event);
                return;
            }
            Priority::Override => {
                for other in going {
                    self.end_deeds(state, other, tick);
                    state.events[other].turn(Progress::Complete, Change::Stopped, tick);
                }
            }
            Priority::Skip | Priority::Parallel => {}
        }
        state.events[event].turn(Progress::Running, Change::Started, tick);
        of.deeds.clone().for_each(|deed| deeds::start(state, deed, seen));
        self.carry_on(state, event, tick);
    }

    /// An event is over when all that is done in it is.
    fn carry_on(&self, state: &mut StoryState, event: usize, tick: Tick) {
        if self.plan.events[event].deeds.clone().all(|deed| state.deeds[deed].mark.is_complete()) {
            state.events[event].turn(Progress::Complete, Change::Ended, tick);
            self.again_or_over(state, event);
        }
    }

    fn again_or_over(&self, state: &mut StoryState, event: usize) {
        let of = &self.plan.events[event];
        let again = state.events[event].times < of.most;
        state.events[event].progress = if again { Progress::Standby } else { Progress::Complete };
        if again {
            of.start.rearm(&mut state.conditions);
        }
    }
}

/// The role of an actor.
fn role_of(id: u32, state: &StoryState) -> Option<RoleId> {
    let role = id.checked_sub(FIRST_STORY_ID)? as usize;
    (role < state.actors.len()).then_some(role)
}
