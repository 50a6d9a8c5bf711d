//! Mistakes happen as often as a scenario says, and only then.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::crossroads::{Signs, crossroads};
use super::{MINUTE, counts, nowhere, overlaps};
use crate::actor::ActorKind;
use crate::events::EventKind;
use crate::map::{RoadNetwork, StopKind, bake, bundled};
use crate::signals::{LightPhase, phase};
use crate::state::State;
use crate::time::{Tick, seconds};
use crate::traffic::doors::CELL_TICKS;
use crate::traffic::drive::View;
use crate::traffic::look::Sight;
use crate::traffic::step::LINE_MARGIN_M;
use crate::traffic::{HazardLevel, HazardRates, Lapse, Surroundings, Traffic, TrafficCounts, TrafficState, Vehicle};
use crate::weather::Conditions;

fn start(network: &Arc<RoadNetwork>, actors: u16, seed: u64, rates: HazardRates) -> Traffic {
    super::start(network, actors, seed).with_hazards(&rates)
}

/// Steps through some minutes; `each` sees what everybody sees before a tick, and the traffic after it.
pub(super) fn watch(
    traffic: &mut Traffic,
    minutes: Tick,
    mut before: impl FnMut(&View<'_>),
    mut after: impl FnMut(&Traffic, Tick),
) {
    let mut sight = Sight::default();
    for tick in 1..=minutes * MINUTE {
        let around = Surroundings::calm(tick, nowhere());
        sight.look(&traffic.actors, &around);
        before(&sight.view(&traffic.actors));
        traffic.step(&around);
        after(traffic, tick);
    }
}

fn told(traffic: &Traffic, kind: EventKind) -> usize {
    traffic.told().iter().filter(|(told, _)| *told == kind).count()
}

/// The chance of at most `k` of `n` where each happens with the chance `p`.
fn at_most(k: u64, n: u64, p: f64) -> f64 {
    let (n, log) = (n as f64, |x: f64| libm::log(x));
    let choose = |k: f64| libm::lgamma(n + 1.0) - libm::lgamma(k + 1.0) - libm::lgamma(n - k + 1.0);
    (0..=k).map(|k| k as f64).map(|k| libm::exp(choose(k) + k * log(p) + (n - k) * log(1.0 - p))).sum()
}

/// The configured rate lies in the exact interval (Clopper and Pearson, 99 %) of what was counted.
fn agrees(what: &str, k: u64, n: u64, p: f64) {
    assert!(k >= 10, "{what}: {k} of {n} are too few to tell");
    let (low, high) = (at_most(k, n, p), 1.0 - at_most(k - 1, n, p));
    assert!(low > 0.005 && high > 0.005, "{what}: {k} of {n} where {p} is configured");
}

/// A ring of two lanes.
fn ring() -> Arc<RoadNetwork> {
    let lane = |id: i32| {
        format!(
            "<lane id=\"{id}\" type=\"driving\"><link><predecessor id=\"{id}\"/><successor id=\"{id}\"/></link>\
             <width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" d=\"0\"/></lane>"
        )
    };
    let length_m = 2000.0;
    let text = format!(
        "<?xml version=\"1.0\"?><OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>\
         <road id=\"0\" length=\"{length_m}\" junction=\"-1\">\
         <link><predecessor elementType=\"road\" elementId=\"0\" contactPoint=\"end\"/>\
         <successor elementType=\"road\" elementId=\"0\" contactPoint=\"start\"/></link><planView>\
         <geometry s=\"0\" x=\"0\" y=\"0\" hdg=\"0\" length=\"{length_m}\"><arc curvature=\"{}\"/></geometry></planView>\
         <lanes><laneSection s=\"0\"><center><lane id=\"0\" type=\"none\"/></center><right>{}{}</right></laneSection>\
         </lanes></road></OpenDRIVE>",
        std::f64::consts::TAU / length_m,
        lane(-1),
        lane(-2),
    );
    Arc::new(bake("ring", &text).expect("it bakes"))
}

fn on_ring(cars: u16, seed: u64, rates: HazardRates) -> Traffic {
    let counts = TrafficCounts { cars, motorcycles: 2, bicycles: 0, pedestrians: 0, ..counts(0) };
    Traffic::spawn(&counts, seed, ring().ways(), nowhere().position).with_hazards(&rates)
}

/// Whether a vehicle passed a line with a light in a tick, and whether that was red.
fn passed(network: &RoadNetwork, seed: u64, was: &Vehicle, is: &Vehicle, tick: Tick) -> Option<bool> {
    let stop = network.lanes[was.lane as usize].stop?;
    let StopKind::Light(group) = stop.kind else { return None };
    let half_m = was.kind.size_m().x * 0.5;
    let over = is.lane == was.lane && is.s_m + half_m > stop.s_m && was.s_m + half_m <= stop.s_m;
    over.then(|| phase(network, seed, group, tick).0 == LightPhase::Red)
}

#[test]
fn so_many_run_a_red_light_as_are_asked_for() {
    let network = crossroads(Signs::Lights);
    let share = 0.5;
    let (mut met, mut runs, mut at_red, mut lines) = (0, 0, 0, 0);
    for seed in 1..=4 {
        let rates = HazardRates { red_light_runners: share, ..HazardRates::NONE };
        let alone = TrafficCounts { cars: 24, motorcycles: 2, ..counts(0) };
        let traffic = Traffic::spawn(&alone, seed, network.ways(), nowhere().position);
        let mut traffic = traffic.with_hazards(&rates);
        let mut occasions = BTreeSet::new();
        let mut last = traffic.state().vehicles.clone();
        let before = |view: &View<'_>| {
            for (i, (vehicle, plan)) in view.vehicles.iter().zip(view.plans).enumerate() {
                let free = vehicle.lapse == Lapse::None && vehicle.decides(view.tick);
                let Some(line) = plan.line.filter(|_| free) else { continue };
                let red_at = view.meets_red(plan, &line, vehicle);
                if let Some(red_at) = red_at.filter(|_| view.has_room_beyond(i, plan, &line)) {
                    occasions.insert((vehicle.id, red_at));
                }
            }
        };
        watch(&mut traffic, 20, before, |t, tick| {
            runs += told(t, EventKind::HazardRedLight);
            assert_eq!(told(t, EventKind::HazardCollision), 0, "tick {tick}");
            for (was, is) in last.iter().zip(&t.state().vehicles) {
                let red = passed(&network, seed, was, is, tick);
                (lines, at_red) = (lines + usize::from(red.is_some()), at_red + usize::from(red == Some(true)));
            }
            last.clone_from(&t.state().vehicles);
        });
        met += occasions.len();
    }
    agrees("red lights", runs as u64, met as u64, f64::from(share));
    assert!(at_red <= runs && at_red * 10 >= runs * 8, "{at_red} passed at red where {runs} set out to");
}

#[test]
fn so_many_roll_over_the_line_of_a_stop_sign_as_are_asked_for() {
    let network = crossroads(Signs::StopOnTwo);
    let share = 0.4;
    let mut arrivals = BTreeSet::new();
    let (mut rolls, mut unhalted) = (0, 0);
    for seed in 1..=3 {
        let rates = HazardRates { rolling_stops: share, ..HazardRates::NONE };
        let mut traffic = start(&network, 40, seed, rates);
        let mut stood = BTreeSet::new();
        let mut last = traffic.state().vehicles.clone();
        let before = |view: &View<'_>| {
            for (vehicle, plan) in view.vehicles.iter().zip(view.plans) {
                let Some(line) = plan.line else { continue };
                let approach = view.steps_of(plan)[line.approach].lane;
                let sign = network.lanes[approach as usize].stop.is_some_and(|stop| stop.kind == StopKind::Stop);
                let fresh = vehicle.flags & Vehicle::HALTED == 0 && vehicle.speed_mps > 0.3;
                if sign && fresh && vehicle.lapse == Lapse::None && line.hold_m < LINE_MARGIN_M + 1.5 {
                    arrivals.insert((seed, vehicle.id, vehicle.trips, approach));
                }
            }
        };
        watch(&mut traffic, 20, before, |t, tick| {
            rolls += told(t, EventKind::HazardRollingStop);
            assert_eq!(told(t, EventKind::HazardCollision), 0, "tick {tick}");
            for (was, is) in last.iter().zip(&t.state().vehicles) {
                let stop = network.lanes[was.lane as usize].stop;
                let sign = stop.is_some_and(|stop| stop.kind == StopKind::Stop);
                if sign && was.speed_mps < 0.3 && stop.is_some_and(|stop| stop.s_m - was.s_m < 8.0) {
                    stood.insert(was.id);
                }
                let enters = sign && is.lane != was.lane;
                unhalted += usize::from(enters && !stood.contains(&was.id));
                if enters {
                    stood.remove(&was.id);
                }
            }
            last.clone_from(&t.state().vehicles);
        });
    }
    agrees("stop signs", rolls as u64, arrivals.len() as u64, f64::from(share));
    assert!(unhalted > 0 && unhalted <= rolls, "{unhalted} entered without having stood, {rolls} rolled");
}

/// Counts how often something began that is drawn once a second, and the seconds at which it could.
fn by_the_hour(traffic: &mut Traffic, minutes: Tick, lapse: Lapse, can: impl Fn(&View<'_>, usize) -> bool) -> [u64; 2] {
    let (mut began, mut could) = (0, 0);
    let mut last = traffic.state().vehicles.clone();
    let before = |view: &View<'_>| {
        let drawn = |v: &Vehicle| (view.tick + Tick::from(v.id)).is_multiple_of(seconds(1)) && v.lapse == Lapse::None;
        let free = view.vehicles.iter().enumerate().filter(|(_, v)| drawn(v));
        could += free.filter(|(i, _)| can(view, *i)).count() as u64;
    };
    watch(traffic, minutes, before, |t, tick| {
        assert_eq!(told(t, EventKind::HazardCollision), 0, "tick {tick}");
        if tick % 10 == 0 {
            assert_eq!(overlaps(t), [], "tick {tick}");
        }
        let now = &t.state().vehicles;
        began += last.iter().zip(now).filter(|(was, is)| was.lapse != lapse && is.lapse == lapse).count() as u64;
        last.clone_from(now);
    });
    [began, could]
}

#[test]
fn so_often_is_braked_for_no_reason_as_is_asked_for() {
    let rates = HazardRates { hard_brakings_per_h: 60.0, ..HazardRates::NONE };
    let mut traffic = on_ring(80, 1, rates);
    let [k, n] = by_the_hour(&mut traffic, 10, Lapse::BrakesHard, |view, i| view.can_brake_hard(&view.vehicles[i]));
    agrees("hard braking", k, n, 60.0 / 3600.0);
}

#[test]
fn so_often_is_cut_in_as_is_asked_for() {
    let rates = HazardRates { cut_ins_per_h: 360.0, ..HazardRates::NONE };
    let mut traffic = on_ring(100, 1, rates);
    let [k, n] = by_the_hour(&mut traffic, 12, Lapse::CutsIn, |view, i| view.cut_in(i, &view.plans[i]).is_some());
    agrees("cut-ins", k, n, 360.0 / 3600.0);
}

#[test]
fn who_cuts_in_takes_the_other_lane_at_once() {
    let rates = HazardRates { cut_ins_per_h: 360.0, ..HazardRates::NONE };
    let mut traffic = on_ring(100, 2, rates);
    let mut last = traffic.state().vehicles.clone();
    let mut began = 0;
    let cuts_in = |v: &Vehicle| v.lapse == Lapse::CutsIn;
    watch(
        &mut traffic,
        5,
        |_| {},
        |t, tick| {
            let now = &t.state().vehicles;
            for (was, is) in last.iter().zip(now).filter(|(was, is)| !cuts_in(was) && cuts_in(is)) {
                began += 1;
                assert!(is.manoeuvre.is_between_lanes() && is.lane != was.lane, "tick {tick}: {is:?}");
            }
            last.clone_from(now);
        },
    );
    assert!(began > 20, "{began}");
}

#[test]
fn nobody_halts_at_the_kerb_whose_way_there_ends_on_a_crosswalk() {
    let network = crossroads(Signs::Yield);
    let mut traffic = start(&network, 20, 2, HazardRates::NONE);
    let crosswalk = traffic.actors.ways.lanes[0].crosswalks[0];
    let mut can_halt = |speed_mps: f32, before_m: f32| {
        let vehicle = &mut traffic.actors.state.vehicles[0];
        let s_m = crosswalk.near_m - before_m;
        *vehicle = Vehicle { kind: ActorKind::Car, lane: 0, before: 0, s_m, speed_mps, ..*vehicle };
        traffic.actors.place_bodies();
        let mut sight = Sight::default();
        let conditions = Conditions::default();
        sight.look(&traffic.actors, &Surroundings { conditions, ..Surroundings::calm(60, nowhere()) });
        let view = sight.view(&traffic.actors);
        view.can_halt(&view.plans[0], &view.vehicles[0])
    };
    // From 14.5 m/s it needs 70 m.
    assert_eq!([can_halt(10.0, 65.0), can_halt(14.5, 65.0), can_halt(14.5, 95.0)], [true, false, true]);
}

#[test]
fn so_often_is_halted_at_the_kerb_as_is_asked_for() {
    let rates = HazardRates { pull_outs_per_h: 30.0, ..HazardRates::NONE };
    let mut traffic = start(&crossroads(Signs::Yield), 30, 1, rates);
    let can = |view: &View<'_>, i: usize| view.can_halt(&view.plans[i], &view.vehicles[i]);
    let [k, n] = by_the_hour(&mut traffic, 30, Lapse::Parks, can);
    agrees("halts", k, n, 30.0 / 3600.0);
}

#[test]
fn so_often_do_doors_open_as_is_asked_for() {
    let city = bundled("city").expect("a bundled map");
    let rates = HazardRates { doors_per_h: 9.0, ..HazardRates::NONE };
    let mut traffic = Traffic::spawn(&counts(0), 5, city.ways(), nowhere().position).with_hazards(&rates);
    let (mut opened, cells) = (0, 3 * 60);
    for cell in 0..cells {
        traffic.know_doors(cell * CELL_TICKS);
        let openings = &traffic.actors.doors.openings;
        let within = cell * CELL_TICKS..=(cell + 1) * CELL_TICKS;
        assert!(openings.iter().all(|o| within.contains(&o.ticks[0]) && within.contains(&o.ticks[1])));
        opened += openings.len() as u64;
    }
    let doors = city.ways().door_spots.len() as u64;
    assert!(doors > 150, "{doors} doors");
    agrees("doors", opened, doors * cells, 9.0 * 20.0 / 3600.0);
}

#[test]
fn doors_that_open_are_passed_and_hold_nobody_up_for_long() {
    let city = bundled("city").expect("a bundled map");
    let rates = HazardRates { doors_per_h: 60.0, ..HazardRates::NONE };
    let counts = TrafficCounts { cars: 60, bicycles: 10, ..counts(0) };
    let mut traffic = Traffic::spawn(&counts, 2, city.ways(), nowhere().position).with_hazards(&rates);
    let (mut open, mut wide) = (0, 0);
    watch(
        &mut traffic,
        6,
        |_| {},
        |t, tick| {
            assert_eq!(told(t, EventKind::Stuck) + told(t, EventKind::HazardCollision), 0, "tick {tick}");
            if tick % 10 == 0 {
                assert_eq!(overlaps(t), [], "tick {tick}");
                let (ego, conditions) = (nowhere(), Conditions::default());
                let around = Surroundings { conditions, ..Surroundings::calm(tick, ego) };
                open += t.actors.door_hazards(&around).count();
                wide += t.open_doors(tick, nowhere()).count();
            }
        },
    );
    // Who cannot keep off one any more is let by.
    assert!(open > 1000 && wide <= open && wide * 50 > open * 49, "{wide} of {open}");
}

#[test]
fn so_many_tailgate_as_are_asked_for() {
    let rates = HazardRates { tailgaters: 0.3, ..HazardRates::NONE };
    let drivers = &on_ring(200, 1, rates).actors.drivers;
    let close = drivers.iter().filter(|d| d.headway_s < 0.9).count();
    agrees("tailgaters", close as u64, drivers.len() as u64, 0.3);
}

#[test]
fn drivers_react_after_the_published_time_and_never_too_late() {
    let rates = HazardRates { inattention: 1.0, hard_brakings_per_h: 60.0, ..HazardRates::NONE };
    let mut traffic = on_ring(100, 3, rates);
    let mut ticks: Vec<u8> = traffic.actors.drivers.iter().map(|d| d.reaction_ticks).collect();
    ticks.sort_unstable();
    let [low, median, high] = [10, 50, 90].map(|pct| f32::from(ticks[ticks.len() * pct / 100]) / 60.0);
    // The quantiles of the lognormal distribution.
    assert!((low - 0.70).abs() < 0.05 && (median - 0.9).abs() < 0.05 && (high - 1.16).abs() < 0.08, "{ticks:?}");
    let (mut late, mut brakes) = (0, 0);
    watch(
        &mut traffic,
        10,
        |_| {},
        |t, tick| {
            assert_eq!(told(t, EventKind::HazardCollision), 0, "tick {tick}");
            assert_eq!(overlaps(t), [], "tick {tick}");
            late += t.state().vehicles.iter().filter(|v| v.late_ticks > 0).count();
            brakes += told(t, EventKind::HazardBraking);
        },
    );
    assert!(late > 100 && brakes > 100, "{late} ticks late, {brakes} brakings");
}

#[test]
fn nobody_makes_mistakes_where_none_are_asked_for() {
    for signs in [Signs::Lights, Signs::StopOnTwo] {
        let mut traffic = start(&crossroads(signs), 50, 2, HazardLevel::None.rates());
        let mut plain = super::start(&crossroads(signs), 50, 2);
        watch(
            &mut traffic,
            5,
            |_| {},
            |t, tick| {
                assert!(t.state().vehicles.iter().all(|v| v.lapse == Lapse::None && v.late_ticks == 0), "tick {tick}");
            },
        );
        watch(&mut plain, 5, |_| {}, |_, _| {});
        assert_eq!(traffic.state(), plain.state());
    }
}

#[test]
fn mistakes_depend_on_no_order_and_resume() {
    let network = crossroads(Signs::Lights);
    let rates = HazardLevel::Raised.rates();
    let mut traffic = start(&network, 60, 2, rates);
    let mut state = traffic.state().clone();
    state.vehicles.reverse();
    let mut shuffled = Traffic::with(&counts(60), 2, network.ways(), state).with_hazards(&rates);
    let mut seen = BTreeSet::new();
    watch(&mut traffic, 4, |_| {}, |t, _| seen.extend(t.state().vehicles.iter().map(|v| v.lapse as u8)));
    watch(&mut shuffled, 4, |_| {}, |_, _| {});
    shuffled.actors.state.vehicles.sort_by_key(|v| v.id);
    assert_eq!(traffic.state(), shuffled.state());
    assert!(seen.len() >= 4, "{seen:?}");
    let state = TrafficState::from_bytes(&traffic.state().to_bytes()).expect("own bytes are read back");
    let resumed = Traffic::resume(&counts(60), 2, network.ways(), state).expect("own state fits the map");
    let mut resumed = resumed.with_hazards(&rates);
    watch(&mut traffic, 2, |_| {}, |_, _| {});
    watch(&mut resumed, 2, |_| {}, |_, _| {});
    assert_eq!(traffic.state(), resumed.state());
}

#[test]
fn two_that_touch_because_of_a_mistake_stand_and_are_taken_off_the_road() {
    let network = crossroads(Signs::Yield);
    let mut traffic = start(&network, 20, 4, HazardRates::NONE);
    let vehicles = &mut traffic.actors.state.vehicles;
    let (first, second) = (vehicles[0], vehicles[1]);
    vehicles[0] =
        Vehicle { lane: 0, before: 0, s_m: 80.0, speed_mps: 8.0, lapse: Lapse::BrakesHard, lapse_left: 60, ..first };
    vehicles[1] = Vehicle { lane: 0, before: 0, s_m: 77.0, speed_mps: 9.0, ..second };
    traffic.actors.place_bodies();
    let mut collided = Vec::new();
    let mut gone_s = [0; 2];
    watch(
        &mut traffic,
        2,
        |_| {},
        |t, tick| {
            assert_eq!(told(t, EventKind::Dissolved), 0, "a collision is no failure");
            let found = t.told().iter().filter(|(kind, _)| *kind == EventKind::HazardCollision);
            collided.extend(found.map(|(_, id)| (tick, *id)));
            for (gone_s, vehicle) in gone_s.iter_mut().zip(&t.state().vehicles) {
                assert!(vehicle.lapse != Lapse::Crashed || tick == 1 || vehicle.speed_mps == 0.0, "tick {tick}");
                *gone_s = if vehicle.lapse != Lapse::Crashed && *gone_s == 0 { tick / 60 } else { *gone_s };
            }
        },
    );
    assert_eq!(collided, [(1, u32::from(first.id)), (1, u32::from(second.id))]);
    assert!(gone_s.iter().all(|s| (55..80).contains(s)), "{gone_s:?}");
}

/// Which of two collide that are so far behind each other, by their middles, and go so fast (m/s, who is ahead first); who is
/// behind accelerates.
fn who_collides(behind_m: f32, speeds_mps: [f32; 2], accel_cmps2: i16) -> [bool; 2] {
    let mut traffic = start(&crossroads(Signs::Yield), 20, 4, HazardRates::NONE);
    let vehicles = &mut traffic.actors.state.vehicles;
    let (first, second) = (vehicles[0], vehicles[1]);
    let s_m = 80.0 - behind_m;
    vehicles[0] = Vehicle { lane: 0, before: 0, s_m: 80.0, speed_mps: speeds_mps[0], ..first };
    vehicles[1] = Vehicle { lane: 0, before: 0, s_m, speed_mps: speeds_mps[1], accel_cmps2, ..second };
    traffic.actors.place_bodies();
    let mut collided = BTreeSet::new();
    let tell = |t: &Traffic, _| {
        let told = t.told().iter().filter(|(kind, _)| *kind == EventKind::HazardCollision);
        collided.extend(told.map(|(_, id)| *id));
    };
    watch(&mut traffic, 1, |_| {}, tell);
    let ids = [first.id, second.id].map(u32::from);
    assert!(collided.iter().all(|id| ids.contains(id)), "{collided:?}");
    ids.map(|id| collided.contains(&id))
}

#[test]
fn who_brakes_too_late_has_a_collision_too() {
    assert_eq!(who_collides(5.5, [0.0, 9.0], -800), [true; 2]);
}

#[test]
fn who_rolls_on_while_it_touches_somebody_has_a_collision_too() {
    assert_eq!(who_collides(4.0, [0.5, 0.0], 0), [true; 2]);
}
