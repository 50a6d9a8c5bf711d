//! What a drive brings about, on the ring road: events, HUD and route.

mod common;
#[path = "common/roundabout.rs"]
mod roundabout;

use common::{RING_M, on_ring, ring, script};
use kernel::events::{Event, EventKind};
use kernel::map::Turn;
use kernel::scenario::{Scenario, driving_lanes};
use kernel::signals::{self, LightPhase};
use kernel::{Controls, TickInput, World};
use roundabout::Roundabout;

/// The ring without anyone else, the car on the outer lane, seven arcs before the light.
fn alone() -> Scenario {
    let mut scenario = on_ring(1);
    let traffic = &mut scenario.traffic;
    (traffic.cars, traffic.motorcycles, traffic.bicycles, traffic.pedestrians) = (0, 0, 0, 0);
    (scenario.ego.lane, scenario.ego.s_m) = (Some(5), 10.0);
    scenario
}

fn start(scenario: &Scenario) -> World {
    World::new(scenario, &ring()).expect("the scenario fits")
}

/// Drives counter-clockwise at a distance from the middle of the ring.
fn circle(world: &World, radius_m: f32, speed_mps: f32) -> TickInput {
    let ego = world.scene().ego;
    let (at, forward) = (ego.position, ego.rotation * glam::Vec3::X);
    let out = at.normalize();
    let drift = forward.dot(out) * 1.5 + (at.length() - radius_m).clamp(-3.0, 3.0) * 0.15;
    let steer = -0.055 - drift * 0.6;
    let gap = speed_mps - ego.speed_mps;
    let semantic = Controls::from_fractions(steer, gap * 0.4, -gap * 0.2);
    TickInput { semantic, safety: Controls::default() }
}

/// Events of a drive at a distance from the middle of the ring.
fn drive(world: &mut World, seconds: u32, radius_m: f32, speed_mps: f32) -> Vec<Event> {
    let mut events = Vec::new();
    for _ in 0..seconds * 60 {
        let input = circle(world, radius_m, speed_mps);
        events.extend(world.step(&input).events);
    }
    events
}

fn kinds(events: &[Event]) -> Vec<EventKind> {
    events.iter().map(|event| event.kind).collect()
}

#[test]
fn a_calm_drive_brings_nothing_but_arming() {
    let mut world = start(&alone());
    let events = drive(&mut world, 10, RING_M + 1.75, 10.0);
    assert_eq!(kinds(&events), [EventKind::Armed]);
    assert!(world.odometer_mm() > 80_000, "{}", world.odometer_mm());
}

#[test]
fn breaches_are_noted_once_when_they_begin() {
    for (radius_m, speed_mps, kind) in [
        (RING_M - 1.75, 8.0, EventKind::WrongWay),
        (RING_M + 5.0, 8.0, EventKind::OffRoad),
        (RING_M + 1.75, 16.0, EventKind::Speeding),
    ] {
        let mut world = start(&alone());
        let events = drive(&mut world, 12, radius_m, speed_mps);
        assert_eq!(events.iter().filter(|event| event.kind == kind).count(), 1, "{kind:?} in {events:?}");
    }
}

#[test]
fn a_tree_ends_the_run_as_missed() {
    let mut world = start(&alone());
    drive(&mut world, 4, RING_M + 1.75, 8.0);
    let events = drive(&mut world, 12, RING_M + 10.5, 8.0);
    let collision = events.iter().position(|event| event.kind == EventKind::CollisionScenery);
    let ended = events.iter().position(|event| event.kind == EventKind::Ended);
    assert!(collision.is_some() && collision < ended, "{events:?}");
    assert_eq!(world.arbiter().outcome, Some(kernel::arbiter::Outcome::Missed));
}

#[test]
fn only_a_red_light_is_an_offence() {
    let (mut passed, mut offences) = (0, 0);
    for seed in 0..12 {
        let mut world = start(&Scenario { seed, ..alone() });
        let mut before = world.hud();
        for _ in 0..60 * 60 {
            let input = circle(&world, RING_M + 1.75, 12.0);
            let events = kinds(&world.step(&input).events);
            let hud = world.hud();
            let crossed = before.light.is_some() && before.light_distance_m == 0 && hud.light.is_none();
            let phase = signals::phase(world.network(), seed, 0, world.tick()).0;
            let offence = events.contains(&EventKind::RedLight);
            assert_eq!(offence, crossed && phase == LightPhase::Red, "seed {seed} tick {}", world.tick());
            (passed, offences) = (passed + u32::from(crossed), offences + u32::from(offence));
            before = hud;
        }
    }
    assert!(offences > 2 && passed > offences + 2, "{offences} of {passed}");
}

#[test]
fn the_hud_leads_to_the_light_and_shows_it() {
    let mut world = start(&Scenario { ego: kernel::scenario::EgoStart { lane: Some(3), s_m: 5.0 }, ..alone() });
    let mut hud = world.hud();
    assert_eq!(hud.arrow.turn, Turn::Left);
    assert!(hud.light.is_none() || hud.light_distance_m <= 85, "{hud:?}");
    assert_eq!(hud.limit_mps, 50.0 / 3.6);
    let mut shown = 0;
    while world.hud().arrow.distance_m > 0 {
        let input = circle(&world, RING_M + 1.75, 10.0);
        world.step(&input);
        let next = world.hud();
        assert!(next.arrow.distance_m <= hud.arrow.distance_m);
        assert!(next.arrow.bearing_deg % 5 == 0 && next.arrow.bearing_deg.abs() <= 15, "{next:?}");
        if next.light.is_some() && next.light_distance_m > 0 {
            assert!(next.light_distance_m <= 85 && next.arrow.distance_m.abs_diff(next.light_distance_m) <= 3);
            shown += 1;
        }
        hud = next;
    }
    assert!(shown > 100, "{shown}");
}

#[test]
fn the_route_lies_ahead_a_metre_apart_and_comes_back_to_a_stray_car() {
    let mut world = start(&alone());
    let check = |world: &World| {
        let route = world.route_ahead(60.0);
        assert_eq!(route.len(), 61);
        let apart = route.windows(2).map(|pair| pair[0].distance(pair[1]));
        assert!(apart.into_iter().all(|d| (0.9..1.1).contains(&d)));
        route
    };
    let first = check(&world)[0];
    let middle = world.scene().ego.position + world.scene().ego.rotation * glam::Vec3::X * 1.35;
    assert!(first.distance(middle) < 0.1, "{first} {middle}");
    // The inner lane leads the other way. A car that turned around is led along it.
    let around = TickInput { semantic: Controls::from_fractions(-1.0, 0.3, 0.0), ..Default::default() };
    while facing(&world) > -0.9 {
        world.step(&around);
    }
    for _ in 0..300 {
        let semantic = script::follow(&world, 5.0);
        world.step(&TickInput { semantic, ..Default::default() });
    }
    let route = check(&world);
    assert!(route[0].cross(route[30]).z < 0.0, "{} {}", route[0], route[30]);
    assert!((route[0].length() - (RING_M - 1.75)).abs() < 0.1, "{}", route[0]);
    assert!(facing(&world) < -0.95);
}

/// 1 when the car faces counter-clockwise around the ring, -1 when clockwise.
fn facing(world: &World) -> f32 {
    let ego = world.scene().ego;
    ego.position.normalize().cross(ego.rotation * glam::Vec3::X).z
}

#[test]
fn a_button_is_noted_when_it_goes_down() {
    let mut world = start(&alone());
    let pressed = TickInput { safety: Controls { flags: Controls::SEEN, ..Default::default() }, ..Default::default() };
    let seen = |world: &mut World, input: &TickInput| kinds(&world.step(input).events).contains(&EventKind::Seen);
    assert!(seen(&mut world, &pressed));
    assert!(!seen(&mut world, &pressed));
    assert!(!seen(&mut world, &TickInput::default()));
    assert!(seen(&mut world, &pressed));
}

#[test]
fn who_is_hit_is_pushed_away_and_stays_where_it_comes_to_rest() {
    let mut scenario = alone();
    scenario.traffic.cars = 8;
    let mut world = start(&scenario);
    let mut hit = None;
    for _ in 0..60 * 60 {
        let input = circle(&world, RING_M + 1.75, 16.0);
        let output = world.step(&input);
        if let Some(event) = output.events.iter().find(|event| event.kind == EventKind::CollisionActor) {
            hit = Some(event.actor);
            break;
        }
    }
    let hit = hit.expect("someone drives slower");
    let place = |world: &World| world.scene().actors.iter().find(|a| a.id == hit).expect("it is there").position;
    let brake = TickInput { semantic: Controls::from_fractions(0.0, 0.0, 1.0), ..Default::default() };
    let at_hit = place(&world);
    for _ in 0..12 * 60 {
        world.step(&brake);
    }
    let rest = place(&world);
    assert!(rest.distance(at_hit) > 1.0, "it was pushed from {at_hit} to {rest}");
    for _ in 0..120 {
        world.step(&brake);
    }
    assert_eq!(place(&world), rest);
}

#[test]
fn a_scenario_that_does_not_fit_is_refused_in_one_sentence() {
    let refused = |lane, s_m| {
        let mut scenario = alone();
        (scenario.ego.lane, scenario.ego.s_m) = (Some(lane), s_m);
        World::new(&scenario, &ring()).err().expect("it is refused").to_string()
    };
    let lane = refused(99, 0.0);
    let expected = "scenario does not fit map ring: ego.lane is 99, expected a driving lane of ring: ";
    assert_eq!(lane, format!("{expected}{}", driving_lanes(&ring()).join(", ")));
    assert!(refused(0, 500.0).starts_with("scenario does not fit map ring: ego.s_m is 500, expected at most 64"));
}

/// The arms of a roundabout end outside.
#[test]
fn no_drive_starts_right_before_a_dead_end() {
    let text = Roundabout { arm_m: 100.0, ..Roundabout::default() }.open_drive();
    let network = kernel::map::bake("roundabout", &text).expect("it bakes");
    let mut outward = 0;
    for seed in 0..100 {
        let (lane, s_m) = Scenario::default_for("roundabout", seed).start_on(&network).expect("a start");
        let lane = &network.lanes[lane as usize];
        outward += u32::from(lane.successors.is_empty());
        assert!(!lane.successors.is_empty() || lane.length_m - s_m >= 40.0, "{seed}: {s_m} m on {}", lane.name);
    }
    assert!(outward > 20, "{outward}");
}

#[test]
fn the_lanes_that_a_refusal_names_are_those_on_which_a_car_starts() {
    let network = ring();
    let named = driving_lanes(&network).into_iter().flat_map(|range| {
        let ends: Vec<u32> = range.split(" to ").map(|lane| lane.parse().expect("a number")).collect();
        ends[0]..=ends[ends.len() - 1]
    });
    let starts = (0..network.lanes.len() as u32).filter(|lane| {
        let mut scenario = alone();
        scenario.ego.lane = Some(*lane);
        World::new(&scenario, &network).is_ok()
    });
    assert_eq!(named.collect::<Vec<_>>(), starts.collect::<Vec<_>>());
}

#[test]
fn a_scenario_of_another_map_is_neither_started_nor_resumed() {
    let (mut scenario, network) = (alone(), ring());
    let keyframe = start(&scenario).initial_keyframe();
    scenario.map = "city".to_owned();
    let refused = "scenario does not fit map ring: its map is \"city\", expected \"ring\"";
    let started = World::new(&scenario, &network).err().expect("it is refused");
    assert_eq!(started.to_string(), refused);
    let resumed = World::resume(&scenario, &network, &keyframe).err().expect("it is refused");
    assert_eq!(resumed.to_string(), refused);
}
