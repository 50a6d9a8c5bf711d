//! Buses call at their stops, and get away again.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{MINUTE, counts, nowhere, overlaps, run};
use crate::actor::ActorKind;
use crate::map::{RoadNetwork, bake};
use crate::scene::lamps;
use crate::time::Tick;
use crate::traffic::{Lapse, Traffic, TrafficCounts, Vehicle};

/// A ring of so many lanes and sidewalks with two stops, driven on the right or on the left.
pub(super) fn ring(lanes: i32, right: bool) -> Arc<RoadNetwork> {
    let side = if right { -1 } else { 1 };
    let lane = |id: i32| {
        format!(
            "<lane id=\"{id}\" type=\"driving\"><link><predecessor id=\"{id}\"/><successor id=\"{id}\"/></link>\
             <width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
        )
    };
    let walk = |id: i32| lane(id).replace("driving", "sidewalk").replace("3.5", "2.5");
    // The lanes for the other direction tell on which side one drives.
    let right_of_it = (1..=lanes).map(|n| lane(-n)).collect::<String>() + &walk(-lanes - 1);
    let left = walk(lanes + 1) + &(1..=lanes).rev().map(lane).collect::<String>();
    let rule = if right { "RHT" } else { "LHT" };
    let stop = |s: u32| {
        let t = f64::from(side) * (3.5 * f64::from(lanes) + 1.0);
        format!("<signal id=\"{s}\" s=\"{s}\" t=\"{t}\" orientation=\"+\" dynamic=\"no\" country=\"DE\" type=\"224\"/>")
    };
    let length_m = 1000.0;
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\
         <road id=\"0\" length=\"{length_m}\" junction=\"-1\" rule=\"{rule}\">\
         <link><predecessor elementType=\"road\" elementId=\"0\" contactPoint=\"end\"/>\
         <successor elementType=\"road\" elementId=\"0\" contactPoint=\"start\"/></link><planView>\
         <geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"{length_m}\"><arc curvature=\"{}\"/></geometry></planView>\
         <lanes><laneSection s=\"0\"><left>{left}</left><center><lane id=\"0\" type=\"none\"/></center><right>{right_of_it}</right>\
         </laneSection></lanes><signals>{}{}</signals></road></OpenDRIVE>",
        std::f64::consts::TAU / length_m,
        stop(300),
        stop(700),
    );
    Arc::new(bake("ring", &text).expect("it bakes"))
}

/// Numbers of cars and people on foot, and of nobody else.
pub(super) fn only(cars: u16, pedestrians: u16) -> TrafficCounts {
    TrafficCounts { cars, motorcycles: 0, bicycles: 0, pedestrians, jaywalks_per_min: 0.0, ..counts(0) }
}

/// Traffic on which every second car with room for it is a bus.
pub(super) fn with_buses(network: &Arc<RoadNetwork>, counts: TrafficCounts, seed: u64) -> Traffic {
    let mut state = Traffic::spawn(&counts, seed, network.ways(), nowhere().position).state().clone();
    let others = state.vehicles.clone();
    for vehicle in &mut state.vehicles {
        let near = |v: &&Vehicle| v.lane == vehicle.lane && (v.s_m - vehicle.s_m).abs() < 30.0;
        let roomy = others.iter().filter(near).count() == 1;
        vehicle.kind = if roomy && vehicle.id.is_multiple_of(2) { ActorKind::Bus } else { ActorKind::Car };
    }
    Traffic::with(&counts, seed, network.ways(), state)
}

/// Ticks for which each bus stood at stops, one after the other.
type Halts = BTreeMap<u16, Vec<Tick>>;

fn watch(traffic: &mut Traffic, network: &RoadNetwork, minutes: Tick, kerb: f32) -> Halts {
    let mut halts = Halts::new();
    let mut before = traffic.state().clone();
    let [to_kerb, from_kerb] = if kerb < 0.0 { [lamps::RIGHT, lamps::LEFT] } else { [lamps::LEFT, lamps::RIGHT] };
    run(traffic, 1..minutes * MINUTE, |t, tick| {
        for (was, is) in before.vehicles.iter().zip(&t.state().vehicles) {
            let lit = t.bodies().iter().find(|b| b.id == u32::from(is.id)).expect("it is there").lamps;
            assert!(is.lapse <= Lapse::Crashed || is.kind == ActorKind::Bus, "only buses call: {is:?}");
            match (was.lapse, is.lapse) {
                (Lapse::Calls, Lapse::Boards) => {
                    let front_m = is.s_m + is.kind.size_m().x * 0.5;
                    let stop = network.bus_stops.iter().find(|s| s.lane == is.lane && (s.s_m - front_m).abs() < 1.6);
                    assert!(stop.is_some(), "at a stop: {is:?}");
                    assert!(is.offset_m * kerb > 0.3, "at the kerb: {is:?}");
                    halts.entry(is.id).or_default().push(0);
                }
                (Lapse::Boards, Lapse::Boards) => {
                    *halts.get_mut(&is.id).expect("it began").last_mut().expect("it began") += 1;
                    assert!(is.speed_mps == 0.0 && lit & to_kerb == 0, "stands: {is:?}");
                }
                (Lapse::Boards, _) => assert!(is.lapse == Lapse::Departs && lit & from_kerb != 0, "signals: {is:?}"),
                (Lapse::Calls, Lapse::Calls) => assert!(lit & to_kerb != 0, "signals: {is:?}"),
                (Lapse::Departs, Lapse::Departs) => assert!(lit & from_kerb != 0, "signals: {is:?}"),
                _ => {}
            }
        }
        before.clone_from(t.state());
        assert!(!tick.is_multiple_of(20) || overlaps(t).is_empty(), "tick {tick}: {:?}", overlaps(t));
        assert!(t.told().is_empty(), "tick {tick}: {:?}", t.told());
    });
    halts
}

#[test]
fn signs_tell_where_buses_halt() {
    let network = ring(2, true);
    let at: Vec<_> =
        network.bus_stops.iter().map(|s| (network.lanes[s.lane as usize].name.as_str(), s.s_m.round())).collect();
    assert_eq!(at.len(), 2);
    assert!(at.iter().all(|(lane, _)| *lane == "0/-2"), "the lane at the kerb: {at:?}");
}

#[test]
fn buses_halt_at_every_stop_on_their_lane() {
    for (lanes, right) in [(1, true), (2, true), (1, false)] {
        let network = ring(lanes, right);
        let mut traffic = with_buses(&network, only(16, 0), 7);
        let minutes = 8;
        let halts = watch(&mut traffic, &network, minutes, if right { -1.0 } else { 1.0 });
        let all: Vec<_> = halts.values().flatten().copied().collect();
        // A round of 1 km with two halts takes two minutes and a half.
        assert!(all.len() >= 4, "{lanes} lanes: {halts:?}");
        assert!(all.iter().all(|ticks| *ticks < 60 * 60), "{lanes} lanes: {halts:?}");
        // Those in the end may not be over.
        let over = all.iter().filter(|ticks| (9 * 60..30 * 60).contains(*ticks)).count();
        assert!(over + 2 * halts.len() >= all.len() && over >= 2, "{lanes} lanes: {halts:?}");
    }
}

#[test]
fn a_bus_calls_at_a_stop_once_a_round() {
    let network = ring(1, true);
    let mut called = 0;
    for seed in 1..=4 {
        let counts = only(1, 0);
        let mut state = Traffic::spawn(&counts, seed, network.ways(), nowhere().position).state().clone();
        state.vehicles[0].kind = ActorKind::Bus;
        let has_stops = network.bus_stops[0].lane == state.vehicles[0].lane;
        let mut traffic = Traffic::with(&counts, seed, network.ways(), state);
        let (mut calls, mut driven_m, mut before) = (0_u16, 0.0, Lapse::None);
        run(&mut traffic, 1..8 * MINUTE, |t, _| {
            let bus = &t.state().vehicles[0];
            calls += u16::from(bus.lapse == Lapse::Boards && before != Lapse::Boards);
            driven_m += bus.speed_mps / 60.0;
            before = bus.lapse;
        });
        let expected = if has_stops { driven_m / 500.0 } else { 0.0 };
        assert!((f32::from(calls) - expected).abs() <= 1.5, "seed {seed}: {calls} calls on {driven_m} m");
        called += calls;
    }
    assert!(called > 4, "{called}");
}
