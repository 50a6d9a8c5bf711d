//! Doors of parked cars: who drives into one, and that they are the same after a keyframe.

mod common;

use std::f32::consts::TAU;
use std::sync::Arc;

use common::{RING_M, on_ring, ring};
use glam::Vec3;
use kernel::events::{Event, EventKind};
use kernel::map::{MapData, Prop, PropKind, RoadNetwork};
use kernel::ops;
use kernel::scenario::{HazardRates, Scenario};
use kernel::scene::{ActorKind, FIRST_DOOR_ID};
use kernel::{Controls, TickInput, World};

/// Radius of the middle of the outer lane, metres.
const LANE_RADIUS_M: f32 = RING_M + 1.75;
const CARS: u32 = 12;

/// Cars outside the outer lane, a hand's breadth from it, 7 m apart.
fn street() -> Arc<RoadNetwork> {
    let mut map = MapData::clone(&ring());
    let car = |i: u32| {
        let (angle, radius_m) = (TAU * 6.0 / 8.0 + 7.0 * i as f32 / LANE_RADIUS_M, LANE_RADIUS_M + 2.9);
        Prop {
            kind: PropKind::ParkedCar,
            position: Vec3::new(radius_m * ops::cos(angle), radius_m * ops::sin(angle), 0.0),
            heading_rad: ops::wrap_angle(angle + TAU / 4.0),
            size: Vec3::new(4.4, 1.8, 1.5),
            variant: i,
        }
    };
    map.props.extend((0..CARS).map(car));
    Arc::new(map.into())
}

fn world(seed: u64, doors_per_h: f32, cars: u16) -> World {
    let mut scenario = Scenario { seed, ..on_ring(1) };
    let traffic = &mut scenario.traffic;
    (traffic.cars, traffic.motorcycles, traffic.bicycles, traffic.pedestrians) = (cars, 0, 0, 0);
    (scenario.ego.lane, scenario.ego.s_m) = (Some(5), 10.0);
    scenario.hazards = HazardRates { doors_per_h, ..HazardRates::NONE };
    World::new(&scenario, &street()).expect("the scenario fits")
}

/// Keeps a distance from the middle of the lane, metres to the right.
fn drive(world: &World, right_m: f32, speed_mps: f32) -> TickInput {
    let ego = world.scene().ego;
    let (at, forward) = (ego.position, ego.rotation * Vec3::X);
    let aside_m = at.length() - LANE_RADIUS_M - right_m;
    let drift = forward.dot(at.normalize()) * 1.5 + aside_m.clamp(-3.0, 3.0) * 0.15;
    let gap = speed_mps - ego.speed_mps;
    let semantic = Controls::from_fractions(-0.055 - drift * 0.6, gap * 0.4, -gap * 0.2);
    TickInput { semantic, safety: Controls::default() }
}

/// Events of a drive past the cars.
fn events(seed: u64, doors_per_h: f32, right_m: f32, speed_mps: f32) -> Vec<Event> {
    let mut world = world(seed, doors_per_h, 0);
    let (mut events, mut seen) = (Vec::new(), 0);
    while world.scene().ego.position.distance(street().props[40 + CARS as usize - 1].position) > 8.0 {
        let output = world.step(&drive(&world, right_m, speed_mps));
        let doors: Vec<u32> = world.scene().actors.iter().map(|actor| actor.id).collect();
        for event in output.events.iter().filter(|event| event.actor > 0) {
            assert!(doors.contains(&event.actor), "{event:?} of {doors:?}");
        }
        assert!(world.scene().actors.iter().all(|actor| actor.kind == ActorKind::Door && actor.id >= FIRST_DOOR_ID));
        seen += doors.len();
        events.extend(output.events);
        assert!(world.tick() < 120 * 60, "it gets by");
    }
    assert_eq!(seen > 0, doors_per_h > 0.0);
    events
}

fn count(events: &[Event], kind: EventKind) -> usize {
    events.iter().filter(|event| event.kind == kind).count()
}

#[test]
fn who_drives_into_an_open_door_is_told_once_for_each_and_who_keeps_off_is_not() {
    let mut hits = 0;
    for seed in 1..=4 {
        let near = events(seed, 180.0, 0.55, 8.0);
        let opened = count(&near, EventKind::HazardDoor);
        assert!(opened >= 6, "seed {seed}: {opened}");
        let mut hit: Vec<u32> = near.iter().filter(|e| e.kind == EventKind::CollisionActor).map(|e| e.actor).collect();
        hits += hit.len();
        let all = hit.len();
        hit.sort_unstable();
        hit.dedup();
        assert_eq!(hit.len(), all, "seed {seed}: {near:?}");
        for right_m in [-0.4, 0.55] {
            let none = if right_m < 0.0 { events(seed, 180.0, right_m, 8.0) } else { events(seed, 0.0, right_m, 8.0) };
            assert_eq!(count(&none, EventKind::CollisionActor), 0, "seed {seed}: {none:?}");
        }
    }
    assert!(hits >= 4, "{hits}");
}

#[test]
fn no_door_opens_into_a_car_that_stands_beside_it() {
    for seed in 1..=6 {
        let mut world = world(seed, 180.0, 0);
        while world.scene().ego.position.distance(street().props[43].position) > 5.0 {
            world.step(&drive(&world, 0.3, 1.9));
        }
        let mut opened = 0;
        for _ in 0..40 * 60 {
            let output =
                world.step(&TickInput { semantic: Controls::from_fractions(0.0, 0.0, 1.0), ..Default::default() });
            opened += count(&output.events, EventKind::HazardDoor);
            assert_eq!(count(&output.events, EventKind::CollisionActor), 0, "seed {seed} tick {}", world.tick());
        }
        assert!(opened > 5, "{opened}");
    }
}

#[test]
fn doors_are_the_same_after_a_keyframe() {
    let mut world = world(2, 180.0, 4);
    let mut resumed: Option<World> = None;
    let mut seen = 0;
    for _ in 0..45 * 60 {
        let input = drive(&world, 0.2, 6.0);
        let output = world.step(&input);
        if let Some(other) = &mut resumed {
            assert_eq!(other.step(&input).hash, output.hash, "{:?}", world.difference(other));
        }
        if let Some(keyframe) = &output.keyframe {
            resumed = Some(World::resume(world.scenario(), world.network(), keyframe).expect("it resumes"));
        }
        if let Some(other) = &resumed {
            assert_eq!(other.scene(), world.scene());
            seen += other.scene().actors.iter().filter(|actor| actor.kind == ActorKind::Door).count();
        }
    }
    assert!(seen > 600, "{seen}");
}
