//! What everybody sees in a tick, gathered once for all.

use crate::map_data::{LaneKind, StopKind};
use crate::signals::{self, LightPhase};
use crate::time::Tick;

use super::actors::Actors;
use super::body::Surroundings;
use super::crosswalk::{Claim, Gaps};
use super::drive::View;
use super::edge_lists::EdgeLists;
use super::hazard::Hazard;
use super::jaywalk;
use super::junction::{self, EGO, Member, Members, Signal, swept_half_m};
use super::lists::Lists;
use super::plan::{self, Line, Plan, Step, next_lane};
use super::state::TrafficState;
use super::vehicle::Vehicle;
use super::walk::{Streets, wanted_crosswalk};
use super::walker::{Walker, WalkerMode};

/// The ego car is expected at a junction that it reaches within this time, s.
const EGO_EXPECTED_S: f32 = 4.0;
/// Slower than this it lets others go, m/s.
const EGO_WAITS_MPS: f32 = 1.0;

/// Buffers of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Sight {
    pub next: TrafficState,
    lights: Vec<(LightPhase, Tick)>,
    lists: Lists,
    steps: Vec<Step>,
    plans: Vec<Plan>,
    members: Members,
    /// The ego car and loose actors first, then people on the road.
    hazards: Vec<Hazard>,
    free: usize,
    /// Vehicles, the ego car and loose actors.
    blocks: Vec<Hazard>,
    claims: Vec<Claim>,
    edges: EdgeLists,
    jaywalker: Option<usize>,
}

impl Sight {
    /// Looks at the state of the previous tick.
    pub fn look(&mut self, actors: &Actors, around: &Surroundings<'_>) {
        let map = actors.map();
        let groups = 0..map.light_groups.len() as u32;
        self.lights.clear();
        self.lights.extend(groups.map(|g| signals::phase(map, actors.seed, g, around.tick)));
        let next = |v: &Vehicle| next_lane(&actors.ways, actors.seed, v, v.hops, v.lane);
        let vehicles = &actors.state.vehicles;
        self.lists.rebuild(map, vehicles, &actors.drivers, next, |id| !around.holds(id));
        self.edges.rebuild(&actors.state.walkers);
        self.plan(actors);
        self.gather_hazards(actors, around);
        self.gather_members(actors, around);
        let walkers = &actors.state.walkers;
        let rate = actors.jaywalks_per_min;
        self.jaywalker = jaywalk::starter(map, &actors.ways, actors.seed, rate, around.tick, walkers, &around.ego);
    }

    pub fn view<'a>(&'a self, actors: &'a Actors) -> View<'a> {
        View {
            map: actors.map(),
            ways: &actors.ways,
            seed: actors.seed,
            lights: &self.lights,
            vehicles: &actors.state.vehicles,
            drivers: &actors.drivers,
            bodies: &actors.bodies,
            steps: &self.steps,
            plans: &self.plans,
            lists: &self.lists,
            members: &self.members,
            hazards: &self.hazards,
            claims: &self.claims,
        }
    }

    pub fn streets<'a>(&'a self, actors: &'a Actors) -> Streets<'a> {
        Streets {
            map: actors.map(),
            ways: &actors.ways,
            seed: actors.seed,
            walkers: &actors.state.walkers,
            walker_traits: &actors.walker_traits,
            bodies: &actors.bodies[actors.state.vehicles.len()..],
            lists: &self.edges,
            gaps: Gaps {
                map: actors.map(),
                ways: &actors.ways,
                seed: actors.seed,
                lists: &self.lists,
                lights: &self.lights,
                free: &self.hazards[..self.free],
            },
            blocks: &self.blocks,
            jaywalker: self.jaywalker,
        }
    }

    fn plan(&mut self, actors: &Actors) {
        self.steps.clear();
        self.plans.clear();
        for (i, (vehicle, driver)) in actors.state.vehicles.iter().zip(&actors.drivers).enumerate() {
            let (map, ways) = (actors.map(), &actors.ways);
            let mut plan = plan::plan(map, ways, actors.seed, vehicle, driver, &mut self.steps);
            let steps = &self.steps[plan.steps.0 as usize..];
            plan.leader = plan::leader(&self.lists, steps, i, driver, plan::horizon_m(vehicle.speed_mps, driver));
            self.plans.push(plan);
        }
    }

    fn gather_hazards(&mut self, actors: &Actors, around: &Surroundings<'_>) {
        let (vehicles, walkers) = (&actors.state.vehicles, &actors.state.walkers);
        let first_walker = walkers.first().map_or(u32::MAX, |w| u32::from(w.id));
        let is_walker = |id: u32| id >= first_walker;
        self.hazards.clear();
        self.hazards.push(Hazard::of(&around.ego, false));
        self.hazards.extend(around.loose.iter().map(|o| Hazard::of(o, is_walker(o.id))));
        self.free = self.hazards.len();
        self.blocks.clear();
        self.blocks.extend(self.hazards.iter().filter(|h| !h.walker));
        let (driven, walked) = actors.bodies.split_at(vehicles.len());
        let present = vehicles.iter().zip(driven).filter(|(v, _)| !around.holds(v.id));
        self.blocks.extend(present.map(|(_, body)| Hazard::of_body(body)));
        self.claims.clear();
        for (walker, body) in walkers.iter().zip(walked).filter(|(w, _)| !around.holds(w.id)) {
            let crosswalk = actors.map().walk_edges[walker.edge as usize].crosswalk;
            let waits = walker.mode == WalkerMode::Wait;
            let claimed = if waits { self.wanted_unlit_crosswalk(actors, walker) } else { crosswalk };
            let astray = walker.offset_m.abs() > actors.map().walk_edges[walker.edge as usize].half_width_m + 0.3;
            if crosswalk.is_some() || astray {
                self.hazards.push(Hazard::of_body(body));
            }
            let (position, velocity) = (body.position.truncate(), body.velocity_mps.truncate());
            let claim = |crosswalk| Claim { crosswalk, position, velocity, waiting: waits };
            self.claims.extend(claimed.filter(|_| walker.mode != WalkerMode::Jaywalk).map(claim));
        }
        self.claims.sort_unstable_by_key(|c| c.crosswalk);
    }

    /// The crosswalk without lights at which a walker waits.
    fn wanted_unlit_crosswalk(&self, actors: &Actors, walker: &Walker) -> Option<u32> {
        let wanted = wanted_crosswalk(actors.map(), actors.seed, walker);
        wanted.filter(|c| actors.ways.crosswalk_lights[*c as usize].is_empty())
    }

    fn gather_members(&mut self, actors: &Actors, around: &Surroundings<'_>) {
        let mut members = std::mem::take(&mut self.members);
        members.clear();
        for (i, vehicle) in actors.state.vehicles.iter().enumerate() {
            if !around.holds(vehicle.id) {
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
        let lanes = &actors.map().lanes;
        let lane = &lanes[vehicle.lane as usize];
        let reaches_back = vehicle.s_m < half_m;
        let behind = lane
            .predecessors
            .iter()
            .filter(|_| reaches_back)
            .map(|&before| Step { lane: before, start_m: -vehicle.s_m - lanes[before as usize].length_m });
        let inside = |step: &Step| lanes[step.lane as usize].junction;
        let junction = lane.junction.or_else(|| behind.clone().find_map(|s| inside(&s)));
        let Some(junction) = junction else { return };
        let here = self.steps_of(&self.plans[i]).iter().copied().take_while(|s| inside(s) == Some(junction));
        let member = member(actors, i, junction, true);
        members.push(member, here.chain(behind.filter(|s| inside(s) == Some(junction))));
    }

    fn add_before_junction(&self, actors: &Actors, i: usize, members: &mut Members) {
        let plan = &self.plans[i];
        let Some(line) = &plan.line else { return };
        let granted = actors.state.vehicles[i].flags & Vehicle::GRANTED != 0;
        if granted || self.asks(actors, i, plan, line) {
            let inside = &self.steps_of(plan)[line.inside.0..line.inside.1];
            members.push(member(actors, i, line.junction, granted), inside.iter().copied());
        }
    }

    fn asks(&self, actors: &Actors, i: usize, plan: &Plan, line: &Line) -> bool {
        let (vehicle, steps) = (&actors.state.vehicles[i], self.steps_of(plan));
        let map = actors.map();
        let open = junction::signal(map, &self.lights, vehicle, steps[line.approach].lane) == Signal::Open;
        let free = plan.leader.is_none_or(|leader| {
            let ahead = &actors.state.vehicles[leader.vehicle as usize];
            leader.gap_m > line.ahead_m || ahead.flags & (Vehicle::GRANTED | Vehicle::CROSSING) != 0
        });
        let driver = &actors.drivers[i];
        let near = junction::near_enough(vehicle, line, 0.0);
        near && open && free && junction::has_room(map, &self.lists, plan, line, steps, i, driver)
    }

    /// The ego car counts as crossing where it is, and as asking for every way it may take.
    fn add_ego(&self, actors: &Actors, around: &Surroundings<'_>, members: &mut Members) {
        let (map, ego) = (actors.map(), &around.ego);
        let speed = ego.velocity_mps.truncate().length();
        if speed < EGO_WAITS_MPS {
            return;
        }
        let place = actors.ways.places.roads().nearest(ego.position, LaneKind::Driving, Some(ego.heading_rad), 4.0);
        let Some(place) = place else { return };
        let lane = &map.lanes[place.lane as usize];
        let half_m = ego.size_m.x * 0.5;
        let member =
            |junction, holds| Member { junction, vehicle: EGO, id: 0, holds, half_m, wait_ticks: 0, lanes: (0, 0) };
        if let Some(junction) = lane.junction {
            let near = |id: &u32| map.project(*id, ego.position);
            let lanes = map.junctions[junction as usize].lanes.iter().map(near);
            let here = lanes.filter(|p| p.distance_m < 1.8).map(|p| Step { lane: p.lane, start_m: -p.s_m });
            members.push(member(junction, true), here);
            return;
        }
        let ahead_m = lane.length_m - place.s_m;
        let expected = ahead_m - half_m < speed * EGO_EXPECTED_S;
        let closed = match lane.stop.map(|stop| stop.kind) {
            Some(StopKind::Light(group)) => self.lights[group as usize].0 == LightPhase::Red,
            _ => false,
        };
        let ways = actors.ways.lanes[place.lane as usize].onward.iter();
        let next = ways.filter_map(|id| Some((*id, map.lanes[*id as usize].junction?)));
        let lanes = next.clone().map(|(lane, _)| Step { lane, start_m: ahead_m });
        if let Some((_, junction)) = next.clone().next().filter(|_| expected && !closed) {
            members.push(member(junction, false), lanes);
        }
    }
}

fn member(actors: &Actors, i: usize, junction: u32, holds: bool) -> Member {
    let vehicle = &actors.state.vehicles[i];
    let half_m = swept_half_m(actors.drivers[i].size_m);
    Member { junction, vehicle: i as u32, id: vehicle.id, holds, half_m, wait_ticks: vehicle.wait_ticks, lanes: (0, 0) }
}
