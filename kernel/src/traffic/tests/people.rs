//! People on foot: where they are, and with whom.

use std::sync::Arc;

use super::crossroads::{Signs, crossroads};
use super::standing::body_of;
use super::{MINUTE, behind, car_at, counts, nowhere, run};
use glam::Vec3;

use crate::actor::ActorKind;
use crate::controls::Controls;
use crate::map::{RoadNetwork, WalkEdge, bundled};
use crate::time::Tick;
use crate::traffic::hazard::Hazard;
use crate::traffic::outline::Outline;
use crate::traffic::{
    Body, Lapse, Obstacle, Surroundings, Traffic, TrafficCounts, TrafficState, Vehicle, Walker, WalkerMode, cover,
    jaywalk,
};

/// So many people on foot and little traffic.
fn with_people(network: &Arc<RoadNetwork>, pedestrians: u16, seed: u64) -> Traffic {
    let counts = TrafficCounts { pedestrians, jaywalks_per_min: 0.0, ..counts(20) };
    Traffic::spawn(&counts, seed, network.ways(), nowhere().position)
}

/// People on each metre of sidewalks where there are so many reasons to be.
#[derive(Default)]
struct Density {
    people: [f32; 2],
    length_m: [f32; 2],
}

impl Density {
    /// How many times as dense people are where the draw is above this.
    fn ratio(&self) -> f32 {
        let [few, many] = [0, 1].map(|k| self.people[k] / self.length_m[k]);
        many / few
    }

    /// Adds who is on a sidewalk at this moment.
    fn add(&mut self, traffic: &Traffic, least: f32) {
        let (ways, map) = (&traffic.actors.ways, traffic.actors.map());
        for (edge, way) in map.walk_edges.iter().zip(&ways.edges).filter(|(edge, _)| edge.crosswalk.is_none()) {
            for draw in &way.draw.pieces {
                self.length_m[usize::from(*draw >= least)] += edge.length_m / way.draw.pieces.len() as f32;
            }
        }
        for walker in &traffic.state().walkers {
            let edge = &map.walk_edges[walker.edge as usize];
            if edge.crosswalk.is_none() {
                let draw = ways.edges[walker.edge as usize].draw.at(walker.s_m.max(0.0), edge.length_m);
                self.people[usize::from(draw >= least)] += 1.0;
            }
        }
    }
}

#[test]
fn people_are_where_there_is_a_reason_and_stay_there() {
    // In the city houses are everywhere.
    let (network, least) = (bundled("city").expect("it is bundled"), 3.0);
    let (mut first, mut last) = (Density::default(), Density::default());
    for seed in [2101, 2102] {
        let mut traffic = with_people(&network, 200, seed);
        first.add(&traffic, least);
        run(&mut traffic, 1..25 * MINUTE, |t, tick| {
            if tick > 20 * MINUTE && tick % 600 == 0 {
                last.add(t, least);
            }
        });
    }
    let (first, last) = (first.ratio(), last.ratio());
    assert!(first > 1.5 && last > 1.4, "{first} {last}");
}

/// How often people who walk together are within so many metres of who leads, and how many of them are so side by side.
fn together(traffic: &mut Traffic, minutes: Tick, near_m: f32) -> [f32; 2] {
    let (mut near, mut beside, mut all) = (0, 0, 0);
    run(traffic, 1..minutes * MINUTE, |t, tick| {
        if tick % 120 != 0 {
            return;
        }
        let people = &t.actors.bodies[t.state().vehicles.len()..];
        for index in 0..people.len() {
            let Some(leader) = t.actors.groups.leader(index) else { continue };
            let to = people[index].position - people[leader].position;
            let ahead = people[leader].rotation * Vec3::X;
            all += 1;
            near += u32::from(to.length() < near_m);
            beside += u32::from(to.length() < near_m && to.dot(ahead).abs() < 0.5 * to.length());
        }
    });
    [near, beside].map(|count| count as f32 / all as f32)
}

#[test]
fn who_walks_together_stays_together() {
    for (map, pedestrians, least) in [("city", 200, 0.8), ("rural", 60, 0.8)] {
        let network = bundled(map).expect("it is bundled");
        for seed in [2101, 2102] {
            let mut traffic = with_people(&network, pedestrians, seed);
            let [near, beside] = together(&mut traffic, 15, 5.0);
            assert!(near > least, "{map} {seed}: {near}, side by side {beside}");
        }
    }
}

#[test]
fn who_crosses_close_before_a_car_gets_past_it() {
    let network = crossroads(Signs::Yield);
    let mut state = with_people(&network, 1, 2101).state().clone();
    state.vehicles.clear();
    let crosswalk = network.walk_edges.iter().position(|e| e.crosswalk.is_some()).expect("there is one");
    let edge = &network.walk_edges[crosswalk];
    // Beside the crosswalk, so that it wants back to it, where the car stands that waits for it.
    let (s_m, offset_m) = (edge.length_m * 0.5, edge.half_width_m + 0.8);
    state.walkers[0] = Walker { edge: crosswalk as u32, s_m, offset_m, ..state.walkers[0] };
    let place = network.ways().walker_place(&state.walkers[0]);
    let left = place.left();
    let car = place.beside(offset_m) - left.extend(0.0) * (0.28 + 2.25);
    let mut traffic = Traffic::with(&counts(1), 2101, network.ways(), state);
    let ego = car_at(car, crate::ops::atan2(left.y, left.x));
    for tick in 1..10 * 60 {
        traffic.step(&Surroundings::calm(tick, ego));
    }
    let away_m = traffic.bodies()[0].position.distance(place.beside(offset_m));
    assert!(away_m > 4.0, "{away_m} m: {:?}", traffic.state().walkers[0]);
}

/// The speed a tick later of somebody on a crosswalk, before whom the front of a car is that moves along their way's left.
fn speed_before_mps(car_mps: f32) -> f32 {
    let network = crossroads(Signs::Yield);
    let mut state = with_people(&network, 1, 2101).state().clone();
    state.vehicles.clear();
    let crosswalk = network.walk_edges.iter().position(|e| e.crosswalk.is_some()).expect("there is one");
    let (s_m, offset_m, forward) = (network.walk_edges[crosswalk].length_m * 0.5, 0.0, true);
    let walker = Walker { edge: crosswalk as u32, s_m, offset_m, forward, speed_mps: 1.0, ..state.walkers[0] };
    state.walkers[0] = walker;
    let place = network.ways().walker_place(&walker);
    let left = place.left().extend(0.0);
    let ego = car_at(place.position + place.forward * 0.8 - left * (0.3 + 2.25), crate::ops::atan2(left.y, left.x));
    let mut traffic = Traffic::with(&counts(1), 2101, network.ways(), state);
    traffic.step(&Surroundings::calm(1, Obstacle { velocity_mps: left * car_mps, ..ego }));
    traffic.state().walkers[0].speed_mps
}

#[test]
fn nobody_steps_right_before_what_rolls() {
    assert_eq!(speed_before_mps(0.7), 0.0);
    assert!(speed_before_mps(-0.7) > 0.0, "it rolls away");
}

#[test]
fn who_stands_with_a_pram_half_off_the_kerb_looks_before_it_goes_on() {
    let network = crossroads(Signs::Yield);
    let spawned = with_people(&network, 1, 2101).state().clone();
    let crosswalk = network.walk_edges.iter().position(|e| e.crosswalk.is_some()).expect("there is one");
    // The speed a tick later of somebody of a kind whose middle is 1 m from the kerb, and whether a car behind it blows its horn.
    let speed_mps = |kind: ActorKind, ego_flags: u8| {
        let walker = |id: u16| Walker {
            id,
            edge: crosswalk as u32,
            s_m: 1.0,
            offset_m: 0.0,
            forward: true,
            mode: WalkerMode::Walk,
            speed_mps: 0.0,
            ..spawned.walkers[0]
        };
        let alone = |id: u16| {
            let state = TrafficState { vehicles: Vec::new(), walkers: vec![walker(id)] };
            Traffic::with(&counts(1), 2101, network.ways(), state)
        };
        let is_of_kind = |traffic: &Traffic| traffic.bodies()[0].kind == kind;
        let mut traffic = (100..1000).map(alone).find(is_of_kind).expect("there is one");
        let ego = behind(traffic.bodies()[0].position, Vec3::Y, 8.0);
        traffic.step(&Surroundings { ego_flags, ..Surroundings::calm(1, ego) });
        traffic.state().walkers[0].speed_mps
    };
    assert!(speed_mps(ActorKind::Pram, 0) > 0.0, "nothing comes");
    assert_eq!(speed_mps(ActorKind::Pram, Controls::HORN), 0.0, "its rear is not on the road yet");
    assert!(speed_mps(ActorKind::Pedestrian, Controls::HORN) > 0.0, "who is on the road goes on");
}

#[test]
fn so_often_is_jaywalked_as_is_asked_for_and_at_times_from_behind_a_parked_car() {
    let network = bundled("city").expect("it is bundled");
    let (minutes, a_minute) = (10, 6.0);
    let (mut all, mut hidden) = (0, 0);
    for seed in 2101..2105 {
        let counts = TrafficCounts { jaywalks_per_min: a_minute, ..counts(100) };
        let mut traffic = Traffic::spawn(&counts, seed, network.ways(), nowhere().position);
        let mut before = traffic.actors.clone();
        run(&mut traffic, 1..minutes * MINUTE, |t, tick| {
            let starts = |i: &usize| {
                t.state().walkers[*i].mode == WalkerMode::Jaywalk && before.state.walkers[*i].mode == WalkerMode::Walk
            };
            for i in (0..t.state().walkers.len()).filter(starts) {
                let walker = &before.state.walkers[i];
                let way = jaywalk::way_across(before.map(), &before.ways, walker).expect("it goes");
                all += 1;
                hidden += u32::from(cover::hides(&before, walker, way));
                assert!(
                    jaywalk::can_stop(&before.state.vehicles, &before.bodies, way[0], way[1]),
                    "walker {} at tick {tick}",
                    walker.id
                );
            }
            before.clone_from(&t.actors);
        });
    }
    let expected = 4.0 * minutes as f32 * a_minute;
    assert!((all as f32 - expected).abs() < 3.0 * expected.sqrt(), "{all} where {expected} are asked for");
    assert!(hidden as f32 > 0.25 * all as f32, "{hidden} of {all}");
}

/// A long sidewalk of the crossroads, and the lane beside it.
fn long_pavement(network: &RoadNetwork) -> (u32, u32) {
    let lane_of = |e: &WalkEdge| e.beside.filter(|lane| network.lanes[*lane as usize].length_m > 80.0);
    let is_long = |e: &WalkEdge| e.length_m > 80.0 && lane_of(e).is_some();
    let edge = network.walk_edges.iter().position(is_long).expect("there is one");
    (edge as u32, network.walk_edges[edge].beside.expect("it has one"))
}

/// Where a way is nearest to a place, metres along it.
fn nearest_m(network: &Arc<RoadNetwork>, edge: u32, place: Vec3) -> f32 {
    let ways = network.ways();
    let away_m = |s_m: &f32| ways.edge_place(edge, *s_m).position.distance(place);
    let all = (0..2000).map(|k| 0.1 * k as f32);
    all.min_by(|a, b| away_m(a).total_cmp(&away_m(b))).expect("there are some")
}

#[test]
fn who_sets_out_to_jaywalk_looks_again_while_on_the_pavement() {
    let network = crossroads(Signs::Yield);
    let spawned = with_people(&network, 1, 2101).state().clone();
    let (edge, lane) = long_pavement(&network);
    // The mode after a tick of somebody who jaywalks so far across, before a car at 12 m/s that is so far away.
    let mode = |offset_m: f32, away_m: f32| {
        let car = Vehicle {
            id: 9,
            lane,
            before: lane,
            s_m: 70.0 - away_m,
            offset_m: 0.0,
            speed_mps: 12.0,
            ..spawned.vehicles[0]
        };
        let s_m = nearest_m(&network, edge, network.lanes[lane as usize].straight_on(70.0).position);
        let walker = Walker { edge, s_m, mode: WalkerMode::Jaywalk, ..spawned.walkers[0] };
        let forward = jaywalk::road_is_left(&network, network.ways(), &walker);
        let sign = if forward { 1.0 } else { -1.0 };
        let walker = Walker { forward, offset_m: sign * offset_m, ..walker };
        let state = TrafficState { vehicles: vec![car], walkers: vec![walker] };
        let mut traffic = Traffic::with(&counts(1), 2101, network.ways(), state);
        run(&mut traffic, 1..2, |_, _| {});
        traffic.state().walkers[0].mode
    };
    assert_eq!(mode(0.0, 15.0), WalkerMode::Walk, "the car cannot stop any more");
    assert_eq!(mode(0.0, 60.0), WalkerMode::Jaywalk, "it can");
    assert_eq!(mode(2.5, 15.0), WalkerMode::Jaywalk, "who is on the road goes on");
}

#[test]
fn people_step_out_before_a_bus_that_stays_at_its_stop() {
    let network = crossroads(Signs::Yield);
    let ways = network.ways();
    let spawned = with_people(&network, 1, 2101).state().clone();
    let (mut bus, walker) = (spawned.vehicles[0], spawned.walkers[0]);
    let (edge, lane) = long_pavement(&network);
    let mut before = |ahead_m: f32, lapse_left: u8| {
        (bus.kind, bus.lane, bus.before, bus.s_m, bus.offset_m) = (ActorKind::Bus, lane, lane, 40.0, -0.4);
        (bus.lapse, bus.lapse_left, bus.speed_mps) = (Lapse::Boards, lapse_left, 0.0);
        // On the sidewalk, so far before the front of the bus.
        let place = network.lanes[lane as usize].straight_on(40.0 + 5.5 + ahead_m).position;
        let s_m = nearest_m(&network, edge, place);
        let walker = Walker { edge, s_m, offset_m: 0.0, ..walker };
        let state = TrafficState { vehicles: vec![bus], walkers: vec![walker] };
        let actors = Traffic::with(&counts(1), 2101, ways, state).actors;
        let way = jaywalk::way_across(actors.map(), &actors.ways, &walker).expect("one can cross");
        (cover::hides(&actors, &walker, way), jaywalk::can_stop(&actors.state.vehicles, &actors.bodies, way[0], way[1]))
    };
    // Hidden and free; too far; behind it, and through it; as long as it stays.
    assert_eq!(before(1.5, 150), (true, true));
    assert!(!before(8.0, 150).0);
    assert!(!before(-3.0, 150).1);
    assert_eq!(before(1.5, 20), (false, false));
}

#[test]
fn nobody_leaps_where_a_way_bends() {
    let network = bundled("suburb").expect("it is bundled");
    let ways = network.ways();
    for (edge, way) in network.walk_edges.iter().enumerate() {
        let half_m = way.half_width_m + 3.0;
        for offset_m in [-half_m, half_m] {
            let place = |k: u32| ways.edge_place(edge as u32, 0.01 * k as f32).beside(offset_m);
            for k in 0..(way.length_m * 100.0) as u32 {
                let moved_m = place(k).distance(place(k + 1));
                assert!(moved_m < 0.1, "{moved_m} m on edge {edge}, {offset_m} m beside it at {} m", 0.01 * k as f32);
            }
        }
    }
}

/// Jaywalkers close to where their way bends, almost across the road.
fn at_bends(network: &Arc<RoadNetwork>) -> Vec<Walker> {
    let ways = network.ways();
    let spawned = with_people(network, 1, 2101).state().walkers[0];
    let bends = |edge: usize| {
        let way = &ways.edges[edge];
        let is_bend = move |i: &usize| way.forward[i - 1].dot(way.forward[*i]) < 0.995;
        (1..way.forward.len()).filter(is_bend).flat_map(move |i| [-0.01, 0.01].map(|m| (edge as u32, way.s_m[i] + m)))
    };
    let jaywalks = |(edge, s_m)| {
        let walker = Walker { edge, s_m, mode: WalkerMode::Jaywalk, ..spawned };
        let walker = Walker { forward: jaywalk::road_is_left(network, ways, &walker), ..walker };
        let goal = jaywalk::goal(network, ways, &walker)?;
        let sign = if walker.forward { 1.0 } else { -1.0 };
        Some(Walker { offset_m: sign * (goal.distance_m - 3.0), ..walker })
    };
    (0..network.walk_edges.len()).flat_map(bends).filter_map(jaywalks).collect()
}

#[test]
fn a_jaywalker_beside_a_bend_gets_round_what_stands_before_it() {
    let network = bundled("suburb").expect("it is bundled");
    let walkers = at_bends(&network);
    assert!(walkers.len() > 10, "{}", walkers.len());
    for walker in walkers {
        let place = network.ways().walker_place(&walker);
        let (left, sign) = (place.left(), walker.offset_m.signum());
        let ego = car_at(place.beside(walker.offset_m + sign * 1.7), crate::ops::atan2(-left.x, left.y));
        let state = TrafficState { vehicles: Vec::new(), walkers: vec![walker] };
        let mut traffic = Traffic::with(&counts(1), 2101, network.ways(), state);
        let from = traffic.bodies()[0].position;
        for tick in 1..40 * 60 {
            traffic.step(&Surroundings::calm(tick, ego));
        }
        let away_m = traffic.bodies()[0].position.distance(from);
        assert!(away_m > 3.0, "{away_m} m: {walker:?} is {:?}", traffic.state().walkers[0]);
    }
}

/// Somebody with a pram on a pavement who turns round right beside a bus that sweeps over the kerb.
#[test]
fn prams_on_the_pavement_turn_into_nothing_that_stands_there() {
    let network = crossroads(Signs::Yield);
    let spawned = with_people(&network, 1, 2101).state().walkers[0];
    let (edge, _) = long_pavement(&network);
    let with = |walker: Walker| {
        Traffic::with(&counts(1), 2101, network.ways(), TrafficState { vehicles: Vec::new(), walkers: vec![walker] })
    };
    let pushes = |id: &u16| with(Walker { id: *id, ..spawned }).bodies()[0].kind == ActorKind::Pram;
    let id = (1..2000).find(pushes).expect("somebody has a pram");
    for beside_m in [0.45, 0.6, 0.75] {
        let mut traffic = with(Walker { id, edge, s_m: 40.0, offset_m: 0.0, forward: true, ..spawned });
        run(&mut traffic, 1..120, |_, _| {});
        let walker = traffic.state().walkers[0];
        traffic.actors.state.walkers[0].forward = !walker.forward;
        let place = network.ways().walker_place(&walker);
        let to = place.beside(walker.offset_m + beside_m + 1.25);
        let ego = Obstacle { size_m: Vec3::new(11.0, 2.5, 3.1), ..car_at(to, 0.0) };
        let ego = Obstacle { heading_rad: crate::ops::atan2(place.forward.y, place.forward.x), ..ego };
        let bus = Hazard::of_body(&Body { kind: ActorKind::Bus, ..body_of(&ego) });
        for tick in 120..600 {
            traffic.step(&Surroundings::calm(tick, ego));
            let outline = Outline::of(&traffic.bodies()[0]);
            let off_m = bus.nearest_from_any(outline.places()).length() - outline.radius_m;
            assert!(off_m > 0.0, "{beside_m} m beside it, tick {tick}: {off_m} m, {:?}", traffic.state().walkers[0]);
        }
    }
}
