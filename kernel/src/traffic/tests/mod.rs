//! Invariants of traffic, on a crossroads built in code and on the bundled maps.

mod bends;
mod buses;
mod crossroads;
mod ego_car;
mod encroachment;
mod free_road;
mod mistakes;
mod people;
mod riders;
mod standing;

use std::sync::Arc;

use glam::Vec3;

use super::{
    Body, Obstacle, Population, Surroundings, Traffic, TrafficCounts, TrafficState, Vehicle, WalkerMode, look, traits,
};
use crate::controls::Controls;
use crate::events::EventKind;
use crate::map::{RoadNetwork, StopKind, bundled};
use crate::signals::{LightPhase, phase};
use crate::state::State;
use crate::time::Tick;
use crate::traffic::vehicle::DECIDE_TICKS;
use crate::weather::Conditions;
use crossroads::{Signs, crossroads};

/// Ticks in a minute.
const MINUTE: Tick = 3600;

fn counts(actors: u16) -> TrafficCounts {
    let share = |pct: u16| actors * pct / 100;
    let (motorcycles, bicycles, pedestrians) = (share(5), share(10), share(40));
    let cars = actors - motorcycles - bicycles - pedestrians;
    TrafficCounts { cars, motorcycles, bicycles, pedestrians, jaywalks_per_min: 2.0, drivers: Population::USUAL }
}

fn car_at(position: Vec3, heading_rad: f32) -> Obstacle {
    let size_m = Vec3::new(4.5, 1.9, 1.5);
    Obstacle { id: 0, position, heading_rad, velocity_mps: Vec3::ZERO, size_m, on_foot: false }
}

/// The ego car, parked far away.
pub(super) fn nowhere() -> Obstacle {
    car_at(Vec3::new(1e4, 0.0, 0.0), 0.0)
}

fn start(network: &Arc<RoadNetwork>, actors: u16, seed: u64) -> Traffic {
    Traffic::spawn(&counts(actors), seed, network.ways(), nowhere().position)
}

fn run(traffic: &mut Traffic, ticks: std::ops::Range<Tick>, mut each: impl FnMut(&Traffic, Tick)) {
    for tick in ticks {
        traffic.step(&Surroundings::calm(tick, nowhere()));
        each(traffic, tick);
    }
}

/// Pairs of vehicles whose boxes overlap by more than 5 cm.
fn overlaps(traffic: &Traffic) -> Vec<(u32, u32)> {
    let bodies = &traffic.actors.bodies[..traffic.actors.state.vehicles.len()];
    let mut found = Vec::new();
    for (i, a) in bodies.iter().enumerate() {
        let near = |b: &&Body| a.position.distance_squared(b.position) < 169.0 && boxes_meet(a, b);
        found.extend(bodies[i + 1..].iter().filter(near).map(|b| (a.id, b.id)));
    }
    found
}

/// Separating axes of two boxes on the ground.
fn boxes_meet(a: &Body, b: &Body) -> bool {
    let axes = [a.rotation * Vec3::X, a.rotation * Vec3::Y, b.rotation * Vec3::X, b.rotation * Vec3::Y];
    let half = |body: &Body, axis: Vec3| {
        let size = body.kind.size_m() * 0.5 - 0.025;
        size.x * (body.rotation * Vec3::X).dot(axis).abs() + size.y * (body.rotation * Vec3::Y).dot(axis).abs()
    };
    axes.iter().all(|axis| (b.position - a.position).dot(*axis).abs() < half(a, *axis) + half(b, *axis))
}

fn mean_speed(traffic: &Traffic) -> f32 {
    let vehicles = &traffic.actors.state.vehicles;
    vehicles.iter().map(|v| v.speed_mps).sum::<f32>() / vehicles.len() as f32
}

fn on_crosswalks(traffic: &Traffic) -> usize {
    let on = |edge: u32| traffic.actors.map().walk_edges[edge as usize].crosswalk.is_some();
    traffic.actors.state.walkers.iter().filter(|w| on(w.edge)).count()
}

/// Nobody drives into anybody, nobody is stuck, and people get across; vehicles are so fast in every minute and
/// in all.
fn flows(network: &Arc<RoadNetwork>, actors: u16, minutes: Tick, [least_mps, mean_mps]: [f32; 2]) {
    flows_on(network, actors, 3, minutes, [least_mps, mean_mps]);
}

fn flows_on(network: &Arc<RoadNetwork>, actors: u16, seed: u64, minutes: Tick, [least_mps, mean_mps]: [f32; 2]) {
    let mut traffic = start(network, actors, seed);
    let (mut crossing, mut jaywalking, mut all) = (0, 0, 0.0);
    for minute in 0..minutes {
        let mut mean = 0.0;
        run(&mut traffic, minute * MINUTE + 1..(minute + 1) * MINUTE + 1, |t, tick| {
            mean += mean_speed(t) / MINUTE as f32;
            crossing += on_crosswalks(t);
            jaywalking += t.actors.state.walkers.iter().filter(|w| w.mode == WalkerMode::Jaywalk).count();
            if tick % 20 == 0 {
                assert_eq!(overlaps(t), [], "tick {tick}");
            }
        });
        assert!(mean > least_mps, "minute {minute}: mean speed {mean} m/s");
        all += mean / minutes as f32;
    }
    assert!(all > mean_mps, "mean speed {all} m/s");
    assert!(crossing > 0, "nobody used a crosswalk");
    assert!(jaywalking > 0, "nobody jaywalked");
}

#[test]
fn lights_keep_a_full_crossroads_flowing() {
    flows(&crossroads(Signs::Lights), 50, 10, [1.5, 2.0]);
}

#[test]
fn stop_signs_keep_a_full_crossroads_flowing() {
    // With people on all four crosswalks, one bad minute is no jam.
    flows(&crossroads(Signs::StopOnTwo), 50, 10, [1.2, 2.0]);
}

#[test]
fn who_passes_beside_a_queue_locks_no_junction() {
    // One that passed a bicycle stood beside it, and before a lorry that left the junction.
    flows_on(&crossroads(Signs::Yield), 50, 12, 10, [1.2, 2.0]);
}

#[test]
fn right_before_left_keeps_a_full_crossroads_flowing() {
    flows(&crossroads(Signs::Yield), 50, 10, [1.5, 2.0]);
}

#[test]
fn city_flows() {
    flows(&bundled("city").expect("city is bundled"), 100, 30, [3.0, 4.0]);
}

#[test]
fn rural_flows() {
    flows(&bundled("rural").expect("rural is bundled"), 60, 20, [4.0, 6.0]);
}

#[test]
fn most_actors_move() {
    let network = bundled("city").expect("city is bundled");
    let mut traffic = start(&network, 100, 5);
    assert!(traffic.bodies().len() >= 98, "{} actors found room", traffic.bodies().len());
    let mut moments = Vec::new();
    run(&mut traffic, 1..10 * MINUTE, |t, tick| {
        if tick % 300 == 0 {
            moments.push(t.bodies().iter().filter(|b| b.velocity_mps.length() > 0.1).count());
        }
    });
    moments.sort_unstable();
    let typical = moments[moments.len() / 2];
    assert!(typical >= 80, "{typical} of 100 move in the median");
}

#[test]
fn nobody_passes_a_line_at_red() {
    let network = crossroads(Signs::Lights);
    let mut traffic = start(&network, 50, 1);
    let mut passed = 0;
    let mut before = traffic.actors.state.clone();
    run(&mut traffic, 1..10 * MINUTE, |t, tick| {
        for (was, is) in before.vehicles.iter().zip(&t.actors.state.vehicles) {
            let Some(stop) = network.lanes[was.lane as usize].stop else { continue };
            let StopKind::Light(group) = stop.kind else { continue };
            let half_m = was.kind.size_m().x * 0.5;
            let over = is.lane == was.lane && is.s_m + half_m > stop.s_m && was.s_m + half_m <= stop.s_m;
            passed += u32::from(over);
            let red = phase(&network, t.actors.seed, group, tick).0 == LightPhase::Red;
            assert!(!(over && red), "vehicle {} at tick {tick}", is.id);
        }
        before.clone_from(&t.actors.state);
    });
    assert!(passed > 50, "only {passed} vehicles passed a line");
}

#[test]
fn the_order_of_actors_does_not_matter() {
    let network = crossroads(Signs::Yield);
    let mut traffic = start(&network, 60, 2);
    let mut state = traffic.actors.state.clone();
    state.vehicles.reverse();
    state.walkers.rotate_left(7);
    let mut shuffled = Traffic::with(&counts(60), 2, network.ways(), state);
    run(&mut traffic, 1..3 * MINUTE, |_, _| {});
    run(&mut shuffled, 1..3 * MINUTE, |_, _| {});
    shuffled.actors.state.vehicles.sort_by_key(|v| v.id);
    shuffled.actors.state.walkers.sort_by_key(|w| w.id);
    assert_eq!(traffic.actors.state, shuffled.actors.state);
}

#[test]
fn state_is_small_and_resumes() {
    let network = crossroads(Signs::StopOnTwo);
    let mut traffic = start(&network, 60, 4);
    run(&mut traffic, 1..MINUTE, |_, _| {});
    let bytes = traffic.actors.state.to_bytes();
    // So that a keyframe with 150 of them stays below 6 kB.
    let TrafficState { vehicles, walkers } = traffic.state();
    assert_eq!(bytes.len(), 40 * vehicles.len() + 30 * walkers.len() + 8);
    let state = TrafficState::from_bytes(&bytes).expect("own bytes are read back");
    let mut resumed = Traffic::resume(&counts(60), 4, network.ways(), state).expect("own state fits the map");
    assert_eq!(traffic.actors.bodies, resumed.actors.bodies);
    run(&mut traffic, MINUTE..2 * MINUTE, |_, _| {});
    run(&mut resumed, MINUTE..2 * MINUTE, |_, _| {});
    assert_eq!(traffic.actors.state, resumed.actors.state);
}

#[test]
fn states_of_other_maps_are_refused() {
    let network = crossroads(Signs::Yield);
    let good = start(&network, 20, 4).actors.state;
    let refused = |change: &dyn Fn(&mut TrafficState)| {
        let mut state = good.clone();
        change(&mut state);
        Traffic::resume(&counts(20), 4, network.ways(), state).is_err()
    };
    assert!(!refused(&|_| {}));
    assert!(refused(&|s| s.vehicles[3].lane = 9999));
    assert!(refused(&|s| s.vehicles[3].s_m = -1.0));
    assert!(refused(&|s| s.vehicles.swap(0, 1)));
    assert!(refused(&|s| s.walkers[0].edge = 9999));
    assert!(refused(&|s| s.walkers[0].mode = WalkerMode::Rides));
    assert!(refused(&|s| s.walkers[0].bus = s.walkers[1].id));
}

#[test]
fn everybody_starts_with_room() {
    let network = bundled("city").expect("city is bundled");
    let ego = network.lanes[0].points[0].position;
    for seed in 0..20 {
        let traffic = Traffic::spawn(&counts(150), seed, network.ways(), ego);
        assert_eq!(overlaps(&traffic), []);
        assert!(traffic.actors.bodies.iter().all(|b| b.position.distance(ego) >= 20.0));
        assert!(traffic.actors.bodies.len() > 140, "seed {seed}: {} actors", traffic.actors.bodies.len());
    }
}

/// A car on an arm of the crossroads, 100 m before the junction, at 8 m/s.
fn lone_car(network: &Arc<RoadNetwork>) -> Traffic {
    let mut traffic = start(network, 4, 1);
    let first = traffic.actors.state.vehicles[0];
    let vehicle = Vehicle { lane: 0, before: 0, s_m: 80.0, speed_mps: 8.0, ..first };
    traffic.actors.state = TrafficState { vehicles: vec![vehicle], walkers: Vec::new() };
    traffic.actors.drivers.truncate(1);
    traffic.actors.walker_traits.clear();
    traffic.actors.places.clear();
    traffic.actors.place_bodies();
    traffic
}

#[test]
fn vehicles_stop_behind_whatever_stands_in_their_lane() {
    let network = crossroads(Signs::Yield);
    let place = network.lanes[0].points[60].position;
    for (name, aside_m, ego) in [("ego", 0.0, true), ("loose", 0.5, false), ("aslant", 1.2, true)] {
        let mut traffic = lone_car(&network);
        let there = Obstacle { id: 2, ..car_at(place + Vec3::Y * aside_m, 0.9) };
        let loose = [there];
        for tick in 1..1200 {
            let (ego, loose) = if ego { (there, &loose[..0]) } else { (nowhere(), &loose[..]) };
            traffic.step(&Surroundings { loose, ..Surroundings::calm(tick, ego) });
        }
        let vehicle = traffic.actors.state.vehicles[0];
        let gap_m = 120.0 - vehicle.s_m - 2.25;
        assert!(vehicle.speed_mps == 0.0 && (3.0..12.0).contains(&gap_m), "{name}: {gap_m} m, {vehicle:?}");
    }
}

#[test]
fn who_stands_without_a_reason_is_told_and_then_taken_off_the_road() {
    let network = crossroads(Signs::Yield);
    let there = Obstacle { id: 2, ..car_at(network.lanes[0].points[60].position, 0.9) };
    let near = car_at(there.position + Vec3::Y * 30.0, 0.0);
    // Seconds after which it is told, and taken off: by where the ego car is.
    let told = |ego: Obstacle, loose: &[Obstacle]| {
        let mut traffic = lone_car(&network);
        let mut told = Vec::new();
        for tick in 1..4 * MINUTE {
            traffic.step(&Surroundings { loose, ..Surroundings::calm(tick, ego) });
            told.extend(traffic.told().iter().map(|(kind, id)| (*kind, *id, tick / 60)));
        }
        let id = u32::from(traffic.state().vehicles[0].id);
        assert!(told.iter().all(|(_, of, _)| *of == id), "{told:?}");
        told.into_iter().map(|(kind, _, second)| (kind, second)).collect::<Vec<_>>()
    };
    // It needs some seconds to get there.
    let unseen = told(nowhere(), &[there]);
    let [(EventKind::Stuck, stuck_s), (EventKind::Dissolved, off_s), ..] = unseen[..] else {
        panic!("{unseen:?}");
    };
    assert!((62..80).contains(&stuck_s) && off_s == stuck_s + 60, "{unseen:?}");
    let seen = told(near, &[there]);
    assert!(matches!(seen[..], [(EventKind::Stuck, s), (EventKind::Dissolved, off), ..] if off >= s + 100), "{seen:?}");
    // Whoever waits for the ego car has a reason.
    assert_eq!(told(there, &[]), []);
}

#[test]
fn who_stands_is_told_once() {
    let traffic = lone_car(&crossroads(Signs::Yield));
    let told = |before_s: u8, now_s: u8| {
        let (mut actors, mut told) = (traffic.actors.clone(), Vec::new());
        let vehicle = actors.state.vehicles[0];
        actors.state.vehicles[0] = Vehicle { stuck_s: now_s, ..vehicle };
        let before = [Vehicle { stuck_s: before_s, ..vehicle }];
        let conditions = Conditions::default();
        let around = Surroundings { conditions, ..Surroundings::calm(60, nowhere()) };
        actors.return_to_map(&before, &around, &mut told);
        told.len()
    };
    assert_eq!([told(59, 60), told(60, 60), told(60, 61)], [1, 0, 0]);
}

#[test]
fn who_waits_long_for_room_counts_in_every_tick() {
    let network = crossroads(Signs::Yield);
    let mut traffic = lone_car(&network);
    let vehicle = &mut traffic.actors.state.vehicles[0];
    (vehicle.s_m, vehicle.speed_mps, vehicle.wait_ticks) = (network.lanes[0].length_m - 12.0, 0.0, 1801);
    traffic.actors.place_bodies();
    let mut sight = look::Sight::default();
    for tick in 1..4 {
        let conditions = Conditions::default();
        sight.look(&traffic.actors, &Surroundings { conditions, ..Surroundings::calm(tick, nowhere()) });
        assert!(sight.view(&traffic.actors).plans[0].line.is_some(), "tick {tick}");
    }
}

/// A road into a junction, through it in so many lane sections, and out of it again.
fn in_sections(count: usize) -> Arc<RoadNetwork> {
    let lane = "<lane id=\"-1\" type=\"driving\"><link><predecessor id=\"-1\"/><successor id=\"-1\"/></link>\
                <width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>";
    let road = |id: u32, x: u32, junction: &str, link: &str, sections: usize| {
        let section = |k: usize| {
            let s_m = 100.0 / sections as f32 * k as f32;
            let center = "<center><lane id=\"0\" type=\"none\"/></center>";
            format!("<laneSection s=\"{s_m}\">{center}<right>{lane}</right></laneSection>")
        };
        let sections: String = (0..sections).map(section).collect();
        format!(
            "<road id=\"{id}\" length=\"100\" junction=\"{junction}\"><link>{link}</link><planView>\
             <geometry s=\"0\" x=\"{x}\" y=\"0\" hdg=\"0\" length=\"100\"><line/></geometry></planView>\
             <lanes>{sections}</lanes></road>"
        )
    };
    let to = |end: &str, kind: &str, id: u32, contact: &str| {
        format!("<{end} elementType=\"{kind}\" elementId=\"{id}\"{contact}/>")
    };
    let (at_start, at_end) = (" contactPoint=\"start\"", " contactPoint=\"end\"");
    let through = to("predecessor", "road", 1, at_end) + &to("successor", "road", 3, at_start);
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>{}{}{}\
         <junction id=\"9\"><connection id=\"0\" incomingRoad=\"1\" connectingRoad=\"2\" contactPoint=\"start\">\
         <laneLink from=\"-1\" to=\"-1\"/></connection></junction></OpenDRIVE>",
        road(1, 0, "-1", &to("successor", "junction", 9, ""), 1),
        road(2, 100, "9", &through, count),
        road(3, 200, "-1", &to("predecessor", "junction", 9, ""), 1),
    );
    Arc::new(crate::map::bake("sections", &text).expect("it bakes"))
}

#[test]
fn a_junction_of_many_sections_has_its_line() {
    for sections in [1, 20, 30, 300] {
        let network = in_sections(sections);
        let approach = network.lanes.iter().position(|l| l.junction.is_none() && !l.successors.is_empty());
        let approach = approach.expect("there is one") as u32;
        let traffic = Traffic::spawn(&TrafficCounts { cars: 1, ..TrafficCounts::NONE }, 1, network.ways(), Vec3::MAX);
        let mut actors = traffic.actors;
        let vehicle = &mut actors.state.vehicles[0];
        (vehicle.lane, vehicle.before, vehicle.s_m, vehicle.speed_mps) = (approach, approach, 90.0, 5.0);
        actors.place_bodies();
        let mut sight = look::Sight::default();
        let conditions = Conditions::default();
        sight.look(&actors, &Surroundings { conditions, ..Surroundings::calm(60, nowhere()) });
        let line = sight.view(&actors).plans[0].line.expect("it has one");
        assert_eq!(line.inside, (1, 1 + sections.min(255)), "{sections}");
    }
}

#[test]
fn who_finds_no_room_with_a_pram_leaves_it_to_others() {
    let network = bundled("rural").expect("it is bundled");
    let (mut skipped, mut placed) = (0, 0);
    for seed in 2101..2131 {
        let counts = TrafficCounts { pedestrians: 500, ..TrafficCounts::NONE };
        let traffic = Traffic::spawn(&counts, seed, network.ways(), nowhere().position);
        let walkers = &traffic.state().walkers;
        for pair in walkers.windows(2) {
            for id in pair[0].id + 1..pair[1].id {
                let kind = traits::walker_traits(seed, id).kind;
                assert!(kind.is_wheeled_on_foot(), "seed {seed}: {id} is a {kind:?}");
                skipped += 1;
            }
        }
        placed += walkers.len();
    }
    assert!(skipped > 0, "of {placed} nobody was left out");
}

#[test]
fn vehicles_pass_what_stands_beside_their_lane() {
    let network = crossroads(Signs::Yield);
    let mut traffic = lone_car(&network);
    let beside = network.lanes[0].points[60].position + Vec3::Y * 3.5;
    for tick in 1..1200 {
        traffic.step(&Surroundings::calm(tick, car_at(beside, 0.0)));
    }
    assert!(traffic.actors.state.vehicles[0].lane != 0, "{:?}", traffic.actors.state.vehicles[0]);
}

#[test]
fn vehicles_pass_within_their_lane_whatever_leaves_room_there() {
    let network = crossroads(Signs::Yield);
    for k in 0..=24 {
        let aside_m = 1.6 + 0.05 * k as f32;
        let mut traffic = lone_car(&network);
        let beside = network.lanes[0].points[60].position + Vec3::Y * aside_m;
        for tick in 1..1800 {
            traffic.step(&Surroundings::calm(tick, car_at(beside, 0.0)));
        }
        let vehicle = traffic.actors.state.vehicles[0];
        assert!(vehicle.lane != 0 || vehicle.s_m > 130.0, "{aside_m} m aside: {vehicle:?}");
    }
}

/// The ego car, standing so far behind a place that it looks at.
fn behind(place: Vec3, forward: Vec3, away_m: f32) -> Obstacle {
    car_at(place - forward * away_m, crate::ops::atan2(forward.y, forward.x))
}

#[test]
fn who_waits_at_an_open_line_hears_the_horn_of_the_car_behind() {
    let network = crossroads(Signs::Yield);
    let mut traffic = start(&network, 50, 2);
    let mut heard = 0;
    for tick in 1..5 * MINUTE {
        let waits = |v: &&Vehicle| (10..60).contains(&v.wait_ticks) && v.flags & Vehicle::GRANTED == 0;
        let waiting = traffic.state().vehicles.iter().filter(waits).map(|v| v.id).next().filter(|_| tick % 60 == 0);
        if let Some(id) = waiting {
            let body = traffic.bodies().iter().find(|b| b.id == u32::from(id)).expect("it is there");
            let ego = behind(body.position, body.rotation * Vec3::X, 9.0);
            let after = |ego_flags: u8| {
                let mut fork = traffic.clone();
                for tick in tick..tick + Tick::from(DECIDE_TICKS) {
                    fork.step(&Surroundings { ego_flags, ..Surroundings::calm(tick, ego) });
                }
                fork.state().vehicles.iter().find(|v| v.id == id).map_or(0, |v| v.wait_ticks)
            };
            let (silent, honked) = (after(0), after(Controls::HORN));
            assert!(silent < 62 && (honked == 0 || honked > 240), "{silent} {honked}");
            heard += usize::from(honked > 240);
        }
        traffic.step(&Surroundings::calm(tick, nowhere()));
    }
    assert!(heard > 3, "{heard}");
}

#[test]
fn who_is_about_to_step_before_the_car_waits_at_the_horn() {
    let network = crossroads(Signs::Yield);
    let mut traffic = start(&network, 50, 2);
    let (mut gone, mut asked) = (0, 0);
    for tick in 1..3 * MINUTE {
        let waiting = traffic.state().walkers.iter().find(|w| w.mode == WalkerMode::Wait).filter(|_| tick % 10 == 0);
        if let Some(id) = waiting.map(|w| w.id) {
            let body = traffic.bodies().iter().find(|b| b.id == u32::from(id)).expect("it is there");
            let ego = behind(body.position, body.rotation * Vec3::Y, 8.0);
            let goes = |ego_flags: u8| {
                let mut fork = traffic.clone();
                for tick in tick..tick + 600 {
                    fork.step(&Surroundings { ego_flags, ..Surroundings::calm(tick, ego) });
                    let walker = fork.state().walkers.iter().find(|w| w.id == id).expect("it is there");
                    let edge = &network.walk_edges[walker.edge as usize];
                    if walker.mode != WalkerMode::Wait && edge.crosswalk.is_some() {
                        return true;
                    }
                }
                false
            };
            asked += 1;
            gone += usize::from(goes(0));
            assert!(!goes(Controls::HORN), "walker {id} at tick {tick}");
        }
        traffic.step(&Surroundings::calm(tick, nowhere()));
    }
    assert!(asked > 20 && gone > 5, "{gone} of {asked}");
}

#[test]
fn loose_actors_keep_their_state() {
    let network = crossroads(Signs::Yield);
    let mut traffic = start(&network, 40, 6);
    let (vehicle, walker) = (traffic.actors.state.vehicles[2], traffic.actors.state.walkers[2]);
    let lie = |id: u16| Obstacle { id: u32::from(id), ..car_at(Vec3::new(0.0, 300.0, 0.0), 0.0) };
    let loose = [lie(vehicle.id), lie(walker.id)];
    for tick in 1..600 {
        traffic.step(&Surroundings { loose: &loose, ..Surroundings::calm(tick, nowhere()) });
    }
    assert_eq!((traffic.actors.state.vehicles[2], traffic.actors.state.walkers[2]), (vehicle, walker));
}
