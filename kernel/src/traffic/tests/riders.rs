//! People get on and off buses, and nobody is lost or hurt by it.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::buses::{only, ring, with_buses};
use super::crossroads::{Signs, crossroads};
use super::{MINUTE, car_at, nowhere, overlaps, run};
use crate::actor::ActorKind;
use crate::map::RoadNetwork;
use crate::state::State;
use crate::time::{Tick, seconds};
use crate::traffic::outline::half_m;
use crate::traffic::{Body, Lapse, Obstacle, Surroundings, Traffic, TrafficState, Walker, WalkerMode};

/// Radius of a person, metres.
const PERSON_M: f32 = 0.2;

/// A place in the axes of a body.
fn local(body: &Body, place: Vec3) -> Vec2 {
    (body.rotation.conjugate() * (place - body.position)).truncate()
}

/// Persons in sight who overlap a person or a vehicle.
fn hurt(traffic: &Traffic) -> Vec<(u32, u32)> {
    let (driven, walked) = traffic.bodies().split_at(traffic.state().vehicles.len());
    let meets = |a: &Body, b: &Body| {
        let to = local(a, b.position);
        let half = a.kind.size_m().truncate() * 0.5 - 0.025;
        (to - to.clamp(-half, half)).length() < PERSON_M
    };
    let mut found = Vec::new();
    for (i, person) in walked.iter().enumerate() {
        let near = |b: &&Body| b.position.distance_squared(person.position) < 100.0;
        found.extend(driven.iter().filter(near).filter(|b| meets(b, person)).map(|b| (b.id, person.id)));
        let touches = |b: &&Body| b.position.distance(person.position) < 2.0 * PERSON_M;
        found.extend(walked[i + 1..].iter().filter(touches).map(|b| (person.id, b.id)));
    }
    found
}

/// The body of an actor that stands in the world.
fn body(traffic: &Traffic, id: u16) -> Option<&Body> {
    traffic.bodies().iter().find(|b| b.id == u32::from(id))
}

/// How many got on and off in so many minutes, while all is checked that must hold.
fn exchange(network: &Arc<RoadNetwork>, counts: (u16, u16), seed: u64, minutes: Tick, kerb: f32) -> [u32; 2] {
    let mut traffic = with_buses(network, only(counts.0, counts.1), seed);
    let all: Vec<u16> = traffic.state().walkers.iter().map(|w| w.id).collect();
    let (mut on, mut off) = (0, 0);
    let mut before = traffic.clone();
    let mut at_door: BTreeMap<u16, Tick> = BTreeMap::new();
    run(&mut traffic, 1..minutes * MINUTE, |t, tick| {
        let walkers = &t.state().walkers;
        assert!(walkers.iter().map(|w| w.id).eq(all.iter().copied()), "tick {tick}: somebody is lost");
        let seen = t.bodies()[t.state().vehicles.len()..].iter().map(|b| b.id);
        let out = walkers.iter().filter(|w| !w.rides()).map(|w| u32::from(w.id));
        assert!(seen.eq(out), "tick {tick}: who rides is not seen, and everybody else is");
        for (was, is) in before.state().walkers.iter().zip(walkers) {
            let bus = body(t, is.bus);
            let stands = t.state().vehicles.iter().any(|v| v.id == is.bus && v.lapse == Lapse::Boards);
            match (was.mode, is.mode) {
                (WalkerMode::Boards, WalkerMode::Rides) => {
                    on += 1;
                    let rider = body(&before, is.id).expect("it stood there");
                    let place = local(bus.expect("a bus"), rider.position);
                    let gap_m = place.y * kerb - 1.25 - half_m(rider.kind);
                    assert!(stands && (0.2..1.2).contains(&gap_m), "tick {tick}: {place} {is:?}");
                    assert!((3.0..5.2).contains(&place.x), "at the front door: {place}");
                }
                (WalkerMode::Rides, WalkerMode::Alights) => {
                    off += 1;
                    let rider = body(t, is.id).expect("it got off");
                    let place = local(bus.expect("a bus"), rider.position);
                    let gap_m = place.y * kerb - 1.25 - half_m(rider.kind);
                    assert!(stands && (gap_m - 0.5).abs() < 0.05, "tick {tick}: {place} {is:?}");
                    assert!((-1.1..-0.9).contains(&place.x), "at the door in the middle: {place}");
                }
                (WalkerMode::Boards, WalkerMode::Boards) if is.bus == 0 => {
                    assert!(is.wait_ticks <= 150 * 60, "waits for ever {is:?}");
                }
                (WalkerMode::Boards, WalkerMode::Boards) => {
                    let since = *at_door.entry(is.id).or_insert(tick);
                    assert!(tick - since < seconds(30), "tick {tick}: waits for ever {is:?}");
                    continue;
                }
                (WalkerMode::Rides, WalkerMode::Rides) => assert!(is.wait_ticks < 10 * 3600, "{is:?}"),
                (_, WalkerMode::Rides) | (WalkerMode::Rides, _) => panic!("tick {tick}: {was:?} {is:?}"),
                _ => {}
            }
            at_door.remove(&is.id);
        }
        if tick.is_multiple_of(6) {
            assert_eq!((hurt(t), overlaps(t)), (vec![], vec![]), "tick {tick}");
        }
        assert!(t.told().is_empty(), "tick {tick}: {:?}", t.told());
        before.clone_from(t);
    });
    [on, off]
}

#[test]
fn people_get_on_and_off_buses_and_nobody_is_lost_or_hurt() {
    for (lanes, right, counts) in [(1, true, (16, 80)), (2, true, (16, 300)), (1, false, (12, 80))] {
        let network = ring(lanes, right);
        assert!(network.ways().stop_ways.iter().all(|ways| ways.len() == 1), "{:?}", network.ways().stop_ways);
        let [on, off] = exchange(&network, counts, 7, 20, if right { -1.0 } else { 1.0 });
        assert!(on > 15 && off > 10 && on >= off, "{lanes} lanes: {on} got on, {off} got off");
    }
}

#[test]
fn a_ride_resumes_where_it_was() {
    let (network, counts) = (ring(1, true), only(16, 200));
    let mut traffic = with_buses(&network, counts, 3);
    let (mut tick, mut resumed) = (1, 0);
    while resumed < 3 {
        run(&mut traffic, tick..tick + 60, |_, _| {});
        tick += 60;
        assert!(tick < 20 * MINUTE, "{resumed}");
        let has = |mode: WalkerMode| traffic.state().walkers.iter().any(|w| w.mode == mode);
        if has(WalkerMode::Rides) && has(WalkerMode::Boards) {
            let state = TrafficState::from_bytes(&traffic.state().to_bytes()).expect("own bytes are read back");
            let mut other = Traffic::resume(&counts, 3, network.ways(), state).expect("own state fits the map");
            assert_eq!(traffic.bodies(), other.bodies());
            run(&mut traffic, tick..tick + MINUTE, |_, _| {});
            run(&mut other, tick..tick + MINUTE, |_, _| {});
            assert_eq!(traffic.state(), other.state());
            assert_eq!(traffic.bodies(), other.bodies());
            (tick, resumed) = (tick + MINUTE, resumed + 1);
        }
    }
}

#[test]
fn who_rides_in_a_bus_that_comes_to_no_stop_is_set_down_at_last() {
    let network = crossroads(Signs::Yield);
    let counts = only(4, 3);
    let mut state = Traffic::spawn(&counts, 5, network.ways(), nowhere().position).state().clone();
    let bus = state.vehicles[0].id;
    state.vehicles[0].kind = ActorKind::Bus;
    let rides = Walker { mode: WalkerMode::Rides, bus, wait_ticks: 0, ..state.walkers[0] };
    state.walkers[0] = rides;
    // Whether the bus drives, or physics holds it.
    let lies = Obstacle { id: u32::from(bus), ..car_at(Vec3::new(0.0, 300.0, 0.0), 0.0) };
    for loose in [&[][..], &[lies]] {
        let mut traffic = Traffic::with(&counts, 5, network.ways(), state.clone());
        for tick in 1..11 * MINUTE {
            let around = Surroundings { loose, ..Surroundings::calm(tick, nowhere()) };
            traffic.step(&around);
            let walker = traffic.state().walkers[0];
            assert_eq!(walker.rides(), body(&traffic, walker.id).is_none());
            assert!(tick > 10 * MINUTE || walker.rides(), "tick {tick}: {walker:?}");
        }
        assert!(!traffic.state().walkers[0].rides() && traffic.state().walkers[0].bus == 0);
    }
}
