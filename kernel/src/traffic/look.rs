//! What everybody sees in a tick, gathered once for all.

use crate::controls::Controls;
use crate::map_data::{LaneKind, Place, Projection, Turn};
use crate::signals::{self, LightPhase};
use crate::time::{Tick, seconds};

use super::actors::Actors;
use super::asking::{self, Asking};
use super::body::{Obstacle, Surroundings};
use super::calls::{self, Call};
use super::crosswalk::{Claim, Gaps};
use super::drive::View;
use super::hazard::Hazard;
use super::hazards::Hazards;
use super::horn::Horn;
use super::jaywalk;
use super::journey::Journey;
use super::junction::{EGO, Member, Members, swept_half_m};
use super::lists::{Entry, Lists};
use super::nearby::Nearby;
use super::pass;
use super::plan::{self, Plan, braking_needed};
use super::state::TrafficState;
use super::step::Step;
use super::turns::Turns;
use super::vehicle::Vehicle;
use super::walk::{ASTRAY_M, Streets};
use super::walker::{Walker, WalkerMode};

/// The ego car is expected at a junction from as near as it comes within this time, s, and so much farther, since it may
/// speed up, m.
const EGO_EXPECTED_S: f32 = 4.0;
const EGO_SPEEDS_UP_M: f32 = 8.0;
/// Slower than this it lets others go, m/s, but before a light that is green, at most so far before the line, m.
const EGO_WAITS_MPS: f32 = 1.0;
const EGO_STARTS_M: f32 = 12.0;
/// Braking with which the ego car is expected to stop before a junction if it has to, m/s².
const EGO_STOPS_MPS2: f32 = 3.5;

/// Buffers of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Sight {
    pub next: TrafficState,
    pub places: Vec<Place>,
    lights: Vec<(LightPhase, Tick)>,
    lists: Lists,
    steps: Vec<Step>,
    /// Of those who decide, and of those whom others have to know about.
    plans: Vec<Plan>,
    members: Members,
    pub hazards: Hazards,
    changing: Vec<Hazard>,
    claims: Vec<Claim>,
    asking: Vec<Asking>,
    horn: Option<Horn>,
    /// As in [`View`].
    ego_enters: bool,
    crowd: Nearby,
    /// Buses whose doors are open.
    pub calls: Vec<Call>,
    jaywalker: Option<usize>,
    tick: Tick,
}

impl Sight {
    /// Looks at the state of the previous tick.
    pub fn look(&mut self, actors: &Actors, around: &Surroundings<'_>) {
        let map = actors.map();
        self.tick = around.tick;
        let groups = 0..map.light_groups.len() as u32;
        self.lights.clear();
        self.lights.extend(groups.map(|g| signals::shown(map, actors.seed, around.lights, g, around.tick)));
        let next = |v: &Vehicle| Journey::of(&actors.ways, actors.seed, v).next_lane(v.lane);
        let vehicles = &actors.state.vehicles;
        self.lists.rebuild(map, vehicles, &actors.drivers, next, |v| !v.is_aside() && !around.holds(v.id));
        let people = &actors.bodies[actors.state.vehicles.len()..];
        let walkers = &actors.state.walkers;
        let stands = |w: &Walker| !w.rides() && !around.holds(w.id);
        self.crowd.rebuild(people.len(), |i| stands(&walkers[i]).then_some(people[i].position));
        calls::gather(actors, around, &mut self.calls);
        self.plan(actors);
        self.gather_hazards(actors, around);
        self.gather_claims(actors, around);
        asking::gather(actors, around, &mut self.asking);
        self.horn = Horn::of(around);
        self.gather_members(actors, around);
        self.ego_enters = ego_enters(actors, around);
        self.jaywalker = jaywalk::starter(actors, around);
    }

    pub fn view<'a>(&'a self, actors: &'a Actors) -> View<'a> {
        View {
            map: actors.map(),
            ways: &actors.ways,
            seed: actors.seed,
            politeness: actors.counts.drivers.politeness,
            rates: &actors.rates,
            lights: &self.lights,
            vehicles: &actors.state.vehicles,
            drivers: &actors.drivers,
            bodies: &actors.bodies,
            steps: &self.steps,
            plans: &self.plans,
            lists: &self.lists,
            members: &self.members,
            hazards: &self.hazards,
            crowd: &self.crowd,
            changing: &self.changing,
            claims: &self.claims,
            asking: &self.asking,
            horn: self.horn,
            ego_enters: self.ego_enters,
            calls: &self.calls,
            tick: self.tick,
        }
    }

    pub fn streets<'a>(&'a self, actors: &'a Actors) -> Streets<'a> {
        Streets {
            map: actors.map(),
            ways: &actors.ways,
            seed: actors.seed,
            walkers: &actors.state.walkers,
            walker_traits: &actors.walker_traits,
            groups: &actors.groups,
            places: &actors.places,
            bodies: &actors.bodies[actors.state.vehicles.len()..],
            driven: &actors.bodies[..actors.state.vehicles.len()],
            crowd: &self.crowd,
            gaps: self.gaps(actors),
            hazards: &self.hazards,
            calls: &self.calls,
            tick: self.tick,
            jaywalker: self.jaywalker,
        }
    }

    fn gaps<'a>(&'a self, actors: &'a Actors) -> Gaps<'a> {
        Gaps {
            map: actors.map(),
            ways: &actors.ways,
            seed: actors.seed,
            lists: &self.lists,
            vehicles: &actors.state.vehicles,
            lights: &self.lights,
            free: self.hazards.free(),
            horn: self.horn,
        }
    }

    fn plan(&mut self, actors: &Actors) {
        self.steps.clear();
        self.plans.clear();
        let watched = self.tick.is_multiple_of(seconds(1));
        for (i, vehicle) in actors.state.vehicles.iter().enumerate() {
            let plan =
                match watched || vehicle.decides(self.tick) || vehicle.counts_at_junction() || vehicle.wants_room() {
                    true => self.plan_of(actors, i, vehicle),
                    false => Plan::default(),
                };
            self.plans.push(plan);
        }
    }

    fn plan_of(&mut self, actors: &Actors, i: usize, vehicle: &Vehicle) -> Plan {
        let driver = &actors.drivers[i];
        let plan = plan::plan(actors.map(), &actors.ways, actors.seed, vehicle, driver, &mut self.steps);
        let apart = |entry: &Entry| pass::apart(&actors.state.vehicles, &actors.drivers, i, entry);
        let horizon_m = plan::horizon_m(vehicle.speed_mps, driver);
        let leader = plan::leader(&self.lists, self.steps_of(&plan), i, driver, horizon_m, apart);
        Plan { leader, ..plan }
    }

    fn gather_hazards(&mut self, actors: &Actors, around: &Surroundings<'_>) {
        let vehicles = &actors.state.vehicles;
        let (driven, walked) = actors.bodies.split_at(vehicles.len());
        let loose = around.loose.iter().map(Hazard::of);
        let there = vehicles.iter().zip(driven).enumerate().filter(|(_, (v, _))| !around.holds(v.id));
        let aside = there.clone().filter(|(_, (v, _))| v.is_aside()).map(|(_, (_, body))| Hazard::of_body(body));
        let free = std::iter::once(Hazard::of(&around.ego)).chain(loose).chain(aside);
        let drives = there.filter(|(_, (v, _))| !v.is_aside());
        let drives = drives.map(|(i, (_, body))| Hazard { vehicle: Some(i as u32), ..Hazard::of_body(body) });
        let edge = |walker: &Walker| &actors.map().walk_edges[walker.edge as usize];
        let on_road = |w: &Walker| edge(w).crosswalk.is_some() || w.offset_m.abs() > edge(w).half_width_m + ASTRAY_M;
        let people =
            actors.state.walkers.iter().zip(walked).filter(|(w, _)| !w.rides() && !around.holds(w.id) && on_road(w));
        let people = people.map(|(_, body)| Hazard::of_body(body));
        self.hazards.rebuild(free.chain(actors.door_hazards(around)), people, drives);
        self.changing.clear();
        let changing = |h: &&Hazard| h.vehicle.is_some_and(|i| vehicles[i as usize].manoeuvre.is_between_lanes());
        self.changing.extend(self.hazards.driven().iter().filter(changing));
    }

    fn gather_claims(&mut self, actors: &Actors, around: &Surroundings<'_>) {
        let (walkers, walked) = (&actors.state.walkers, &actors.bodies[actors.state.vehicles.len()..]);
        self.claims.clear();
        let stands = |w: &Walker| !w.rides() && !around.holds(w.id);
        for (i, (walker, body)) in walkers.iter().zip(walked).enumerate().filter(|(_, (w, _))| stands(w)) {
            let crosswalk = actors.map().walk_edges[walker.edge as usize].crosswalk;
            let waits = walker.mode == WalkerMode::Wait;
            let claimed = if waits { self.wanted_unlit_crosswalk(actors, i, walker) } else { crosswalk };
            let (position, velocity) = (body.position.truncate(), body.velocity_mps.truncate());
            let claim = |crosswalk| Claim { crosswalk, position, velocity, waiting: waits };
            self.claims.extend(claimed.filter(|_| walker.mode != WalkerMode::Jaywalk).map(claim));
        }
        self.claims.sort_unstable_by_key(|c| c.crosswalk);
    }

    /// The crosswalk without lights at which a walker waits, if it could go when vehicles stopped.
    fn wanted_unlit_crosswalk(&self, actors: &Actors, index: usize, walker: &Walker) -> Option<u32> {
        let Actors { ways, seed, groups, state, .. } = actors;
        let (walkers, crowd) = (&state.walkers, &self.crowd);
        let turns = Turns { map: actors.map(), ways, seed: *seed, walkers, groups, crowd };
        let wanted = turns.wanted_crosswalk(index, walker);
        let unlit = wanted.filter(|c| actors.ways.crosswalk_lights[*c as usize].is_empty());
        unlit.filter(|c| !self.gaps(actors).is_blocked(*c))
    }

    fn gather_members(&mut self, actors: &Actors, around: &Surroundings<'_>) {
        let mut members = std::mem::take(&mut self.members);
        members.clear();
        for (i, vehicle) in actors.state.vehicles.iter().enumerate() {
            if !vehicle.is_aside() && !around.holds(vehicle.id) {
                self.add_inside(actors, i, &mut members);
                self.add_before_junction(actors, i, &mut members);
            }
        }
        self.add_ego(actors, around, &mut members);
        members.sort();
        self.members = members;
    }

    fn steps_of(&self, plan: &Plan) -> &[Step] {
        &self.steps[plan.steps.0 as usize..plan.steps.1 as usize]
    }

    fn add_inside(&self, actors: &Actors, i: usize, members: &mut Members) {
        let (vehicle, half_m) = (&actors.state.vehicles[i], swept_half_m(actors.drivers[i].size_m));
        if vehicle.flags & Vehicle::CROSSING == 0 {
            return;
        }
        let (lanes, ways) = (&actors.map().lanes, &actors.ways.lanes);
        let reaches_back = vehicle.s_m < half_m;
        let behind = lanes[vehicle.lane as usize].predecessors.iter().filter(|_| reaches_back).map(|&before| {
            let start_m = -vehicle.s_m - lanes[before as usize].length_m;
            Step { lane: before, start_m, from_m: 0.0 }
        });
        let inside = |step: &Step| ways[step.lane as usize].zone;
        let zone = ways[vehicle.lane as usize].zone.or_else(|| behind.clone().find_map(|s| inside(&s)));
        let Some(zone) = zone else { return };
        let here = self.steps_of(&self.plans[i]).iter().copied().take_while(|s| inside(s) == Some(zone));
        let member = Member { rounds: ways[vehicle.lane as usize].circle, ..self.member(actors, i, zone, true) };
        members.push(member, here.chain(behind.filter(|s| inside(s) == Some(zone))));
    }

    fn add_before_junction(&self, actors: &Actors, i: usize, members: &mut Members) {
        let plan = &self.plans[i];
        let Some(line) = &plan.line else { return };
        let vehicle = &actors.state.vehicles[i];
        let in_turn = vehicle.flags & (Vehicle::GRANTED | Vehicle::ASKING) != 0;
        let wants_room = !in_turn && vehicle.wants_room();
        if in_turn || wants_room {
            let steps = self.steps_of(plan);
            let inside = &steps[line.inside.0..line.inside.1];
            let holds = vehicle.flags & Vehicle::GRANTED != 0;
            let rounds = actors.ways.lanes[steps[line.approach].lane as usize].circle;
            let enters = line.enters(&actors.ways, steps);
            let member = Member { wants_room, rounds, enters, ..self.member(actors, i, line.zone, holds) };
            members.push(member, inside.iter().copied());
        }
    }

    fn member(&self, actors: &Actors, i: usize, zone: u32, holds: bool) -> Member {
        let vehicle = &actors.state.vehicles[i];
        let size_m = actors.drivers[i].size_m;
        let (half_m, swept_half_m) = (size_m.x * 0.5, swept_half_m(size_m));
        let wait_ticks = vehicle.waited_ticks(self.tick);
        Member { zone, vehicle: i as u32, id: vehicle.id, holds, half_m, swept_half_m, wait_ticks, ..Member::default() }
    }

    /// The ego car counts as crossing where it is, and as asking for every way it may take: those that it indicates.
    fn add_ego(&self, actors: &Actors, around: &Surroundings<'_>, members: &mut Members) {
        let (map, ego) = (actors.map(), &around.ego);
        let speed = ego.velocity_mps.truncate().length();
        let stands = speed < EGO_WAITS_MPS;
        let Some(place) = ego_place(actors, ego) else { return };
        let lane = &map.lanes[place.lane as usize];
        let half_m = ego.size_m.x * 0.5;
        let rounds = actors.ways.lanes[place.lane as usize].circle;
        let car = Member { vehicle: EGO, half_m, swept_half_m: half_m, rounds, ..Member::default() };
        let member = |zone, holds| Member { zone, holds, ..car };
        if let (Some(junction), Some(zone)) = (lane.junction, actors.ways.lanes[place.lane as usize].zone) {
            let near = |id: &u32| map.project(*id, ego.position);
            let lanes = map.junctions[junction as usize].lanes.iter().map(near);
            let step = |p: Projection| Step { lane: p.lane, start_m: -p.s_m, from_m: 0.0 };
            // Beside every lane it is on the nearest one.
            let is_on = |p: &Projection| p.lane == place.lane || p.distance_m < 1.8;
            if !stands {
                members.push(member(zone, true), lanes.filter(is_on).map(step));
            }
            return;
        }
        let to_line_m = lane.length_m - place.s_m - half_m;
        let light = |next| map.light_between(place.lane, next).map(|group| self.lights[group as usize].0);
        let starts = |next| light(next) == Some(LightPhase::Green) && to_line_m < EGO_STARTS_M;
        let open = |next| if stands { starts(next) } else { light(next) != Some(LightPhase::Red) };
        let expected = stands || to_line_m < EGO_SPEEDS_UP_M + speed * EGO_EXPECTED_S;
        let ways = &actors.ways.lanes;
        let next = ways[place.lane as usize].onward.iter();
        let next = next.filter_map(|onward| Some((onward.lane, ways[onward.lane as usize].zone?)));
        // Where it indicates, it goes nowhere else.
        let indicated = match around.ego_flags & Controls::INDICATORS {
            Controls::INDICATE_LEFT => Some(Turn::Left),
            Controls::INDICATE_RIGHT => Some(Turn::Right),
            _ => None,
        };
        let turns = |lane: u32| indicated.is_none_or(|turn| map.lanes[lane as usize].turn == turn);
        let none_turns = !next.clone().any(|(lane, _)| turns(lane));
        let taken = next.filter(|(lane, _)| (none_turns || turns(*lane)) && open(*lane));
        let lanes = taken.clone().map(|(lane, _)| Step { lane, start_m: to_line_m + half_m, from_m: 0.0 });
        if let Some((_, zone)) = taken.clone().next().filter(|_| expected) {
            members.push(member(zone, false), lanes);
        }
    }
}

/// Where the ego car is on the lanes, if it is on one.
fn ego_place(actors: &Actors, ego: &Obstacle) -> Option<Projection> {
    actors.ways.places.roads().nearest(ego.position, LaneKind::Driving, Some(ego.heading_rad), 4.0)
}

/// Whether the ego car is in a junction or on no lane, or cannot stop before a junction any more.
fn ego_enters(actors: &Actors, around: &Surroundings<'_>) -> bool {
    let ego = &around.ego;
    ego_place(actors, ego).is_none_or(|place| {
        let (lane, ways) = (&actors.map().lanes[place.lane as usize], &actors.ways.lanes);
        let mut onward = ways[place.lane as usize].onward.iter();
        let to_end_m = lane.length_m - place.s_m - ego.size_m.x * 0.5;
        let needed_mps2 = braking_needed(ego.velocity_mps.truncate().length(), to_end_m);
        let leads_in = onward.any(|next| ways[next.lane as usize].zone.is_some());
        lane.junction.is_some() || (leads_in && needed_mps2 > EGO_STOPS_MPS2)
    })
}
