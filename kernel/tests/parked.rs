//! Parked cars that are run into: they are pushed as any other vehicle, and nothing of that is lost.

mod common;

use std::f32::consts::TAU;
use std::sync::Arc;

use common::{RING_M, on_ring, ring};
use glam::Vec3;
use kernel::ego::MASS_KG;
use kernel::events::{Event, EventKind};
use kernel::map::{MapData, Prop, PropKind, RoadNetwork};
use kernel::ops;
use kernel::scenario::Scenario;
use kernel::scene::{ActorKind, ActorScene, FIRST_PARKED_ID};
use kernel::{Controls, Keyframe, TickInput, World};

/// Radius of the middle of the outer lane, metres.
const LANE_RADIUS_M: f32 = RING_M + 1.75;
/// Where the first car stands in the ego car's lane, metres along it.
const FIRST_M: f32 = 100.0;
/// 30 km/h.
const SPEED_MPS: f32 = 30.0 / 3.6;

/// A car across the ego car's lane so far along it, counted from where the ego car starts.
fn parked(along_m: f32, aside_m: f32) -> Prop {
    let angle = TAU * 5.0 / 8.0 + (10.0 + along_m) / LANE_RADIUS_M;
    let radius_m = LANE_RADIUS_M + aside_m;
    Prop {
        kind: PropKind::ParkedCar,
        position: Vec3::new(radius_m * ops::cos(angle), radius_m * ops::sin(angle), 0.0),
        heading_rad: ops::wrap_angle(angle + TAU / 4.0),
        size: Vec3::new(4.5, 1.85, 1.5),
        variant: 77,
    }
}

/// The ring with parked cars, and a tree between them in the list.
fn street(cars: &[Prop]) -> Arc<RoadNetwork> {
    let mut map = MapData::clone(&ring());
    let mut cars = cars.iter();
    map.props.splice(3..3, cars.next().copied());
    map.props.extend(cars);
    Arc::new(map.into())
}

fn alone(network: &Arc<RoadNetwork>) -> World {
    World::new(&scenario(0), network).expect("the scenario fits")
}

fn scenario(cars: u16) -> Scenario {
    let mut scenario = on_ring(1);
    let traffic = &mut scenario.traffic;
    (traffic.cars, traffic.motorcycles, traffic.bicycles, traffic.pedestrians) = (cars, 0, 0, 0);
    (scenario.ego.lane, scenario.ego.s_m) = (Some(5), 10.0);
    scenario
}

/// Keeps the lane at 30 km/h until something is hit, then leaves the car to its brakes.
fn drive(world: &World, hit: bool) -> TickInput {
    let ego = world.scene().ego;
    let (at, forward) = (ego.position, ego.rotation * Vec3::X);
    let drift = forward.dot(at.normalize()) * 1.5 + (at.length() - LANE_RADIUS_M).clamp(-3.0, 3.0) * 0.15;
    let gap = SPEED_MPS - ego.speed_mps;
    let semantic = match hit {
        true => Controls::from_fractions(0.0, 0.0, 1.0),
        false => Controls::from_fractions(-0.055 - drift * 0.6, gap * 0.4, -gap * 0.2),
    };
    TickInput { semantic, safety: Controls::default() }
}

fn pushed(world: &World) -> Vec<ActorScene> {
    world.scene().actors.into_iter().filter(|actor| actor.id >= FIRST_PARKED_ID).collect()
}

/// Drives on until something is hit; what that was, and the speed just before.
fn until_hit(world: &mut World) -> (Event, f32) {
    loop {
        let before_mps = world.scene().ego.speed_mps;
        let output = world.step(&drive(world, false));
        if let Some(hit) = output.events.iter().find(|e| e.kind as u8 <= EventKind::CollisionScenery as u8) {
            return (*hit, before_mps);
        }
        assert!(world.tick() < 60 * 60, "nothing was hit");
    }
}

#[test]
fn a_parked_car_that_is_run_into_is_pushed_and_slides_to_rest() {
    let mut world = alone(&street(&[parked(FIRST_M, 0.0), parked(0.0, 8.0)]));
    let (hit, before_mps) = until_hit(&mut world);
    assert!((before_mps - SPEED_MPS).abs() < 0.5, "{before_mps}");
    assert_eq!((hit.kind, hit.actor), (EventKind::CollisionActor, FIRST_PARKED_ID));
    let first = pushed(&world);
    assert_eq!(first.len(), 1, "the other one stays where it is: {first:?}");
    let mass_kg = ActorKind::Car.mass_kg();
    let of = |world: &World| (world.scene().ego.speed_mps, pushed(world)[0].speed_mps);
    let mut fastest_mps: f32 = 0.0;
    let (mut slides, mut events) = (Vec::new(), 0);
    for tick in 0..12 * 60 {
        let (_, was_mps) = of(&world);
        let output = world.step(&drive(&world, true));
        events += output.events.iter().filter(|event| event.actor > 0).count();
        let (ego_mps, car_mps) = of(&world);
        fastest_mps = fastest_mps.max(car_mps);
        let momentum = MASS_KG * ego_mps + mass_kg * car_mps;
        assert!(momentum < MASS_KG * before_mps * 1.02, "tick {tick}: {momentum} of {}", MASS_KG * before_mps);
        if car_mps > ego_mps + 0.5 && car_mps > 1.0 {
            slides.push((was_mps - car_mps) * 60.0);
        }
    }
    assert_eq!(events, 0, "it is told once");
    // Between one push for both and a hit without loss.
    let (least, most) = (MASS_KG / (MASS_KG + mass_kg), 2.0 * MASS_KG / (MASS_KG + mass_kg));
    assert!((0.8 * least..most).contains(&(fastest_mps / before_mps)), "{fastest_mps} after {before_mps}");
    // Once it is free of the ego car.
    slides.sort_unstable_by(f32::total_cmp);
    let braking = slides[slides.len() / 2];
    assert!((0.68 * 9.81..0.72 * 9.81).contains(&braking), "{braking} of {slides:?}");
    let [rest] = pushed(&world)[..] else { panic!("one car was pushed") };
    assert!(rest.position.distance(first[0].position) > 1.0 && rest.speed_mps == 0.0, "{rest:?}");
    assert_eq!((rest.kind, rest.variant), (ActorKind::Car, 77));
}

#[test]
fn one_that_is_pushed_pushes_the_next() {
    let cars = [parked(FIRST_M, 0.0), parked(FIRST_M + 4.9, 0.0), parked(FIRST_M + 14.0, 0.0)];
    let mut world = alone(&street(&cars));
    let (hit, _) = until_hit(&mut world);
    assert_eq!(hit.actor, FIRST_PARKED_ID);
    for _ in 0..5 * 60 {
        world.step(&drive(&world, true));
    }
    let ids: Vec<u32> = pushed(&world).iter().map(|car| car.id).collect();
    assert_eq!(ids, [FIRST_PARKED_ID, FIRST_PARKED_ID + 1], "the third is too far away");
    let moved_m = pushed(&world)[1].position.distance(cars[1].position);
    assert!(moved_m > 0.2, "{moved_m}");
}

#[test]
fn one_that_is_pushed_away_leaves_its_place_free() {
    let place = parked(FIRST_M, 0.0);
    let mut world = alone(&street(&[place]));
    until_hit(&mut world);
    let (mut events, mut nearest_m) = (Vec::new(), f32::MAX);
    // Pushing on through where it stood.
    for _ in 0..6 * 60 {
        let ahead = drive(&world, false).semantic;
        let semantic = Controls { throttle: u16::MAX, brake: 0, ..ahead };
        events.extend(world.step(&TickInput { semantic, ..Default::default() }).events);
        nearest_m = nearest_m.min(world.scene().ego.position.distance(place.position));
    }
    assert!(events.iter().all(|event| event.kind != EventKind::CollisionScenery), "{events:?}");
    assert!(nearest_m < 1.0, "{nearest_m}");
}

#[test]
fn nothing_changes_while_nobody_touches_them() {
    let (bare, lined) = (street(&[]), street(&[parked(FIRST_M, 3.2), parked(FIRST_M + 6.0, 3.2)]));
    let (mut bare, mut lined) = (alone(&bare), alone(&lined));
    for _ in 0..30 * 60 {
        let input = drive(&bare, false);
        bare.step(&input);
        lined.step(&input);
        assert_eq!(bare.scene(), lined.scene());
    }
    assert_eq!(bare.part_hashes()[1..], lined.part_hashes()[1..]);
}

/// Drives into a car and on for so many seconds; the world, and its last keyframe with the inputs and hashes since.
fn pushed_world(cars: u16, seconds: u32) -> (World, Keyframe, Vec<(TickInput, kernel::StateHash)>) {
    let network = street(&[parked(FIRST_M, 0.6), parked(FIRST_M + 12.0, 0.6)]);
    let mut world = World::new(&scenario(cars), &network).expect("the scenario fits");
    let (mut keyframe, mut since) = (world.initial_keyframe(), Vec::new());
    let mut hit = false;
    for _ in 0..seconds * 60 {
        let input = drive(&world, hit);
        let output = world.step(&input);
        hit |= output.events.iter().any(|event| event.actor >= FIRST_PARKED_ID);
        since.push((input, output.hash));
        if let Some(taken) = output.keyframe {
            (keyframe, since) = (taken, Vec::new());
        }
    }
    assert!(hit);
    (world, keyframe, since)
}

#[test]
fn a_pushed_car_resumes_from_every_keyframe() {
    let network = street(&[parked(FIRST_M, 0.6), parked(FIRST_M + 6.0, 0.6)]);
    let mut world = World::new(&scenario(6), &network).expect("the scenario fits");
    let (mut others, mut hits) = (Vec::new(), 0);
    let mut rewound: Option<World> = None;
    for tick in 0..60 * 60 {
        let input = drive(&world, (1000..1400).contains(&tick));
        let output = world.step(&input);
        hits += output.events.iter().filter(|event| event.actor >= FIRST_PARKED_ID).count();
        for other in others.iter_mut().chain(&mut rewound) {
            let again: kernel::TickOutput = World::step(other, &input);
            assert_eq!(again.hash, output.hash, "tick {tick}: {:?}", world.difference(other));
            assert_eq!(other.scene(), world.scene());
        }
        if let Some(keyframe) = &output.keyframe {
            others.truncate(1);
            others.push(World::resume(world.scenario(), &network, keyframe).expect("it resumes"));
        }
        if tick == 800 {
            rewound = Some(world.clone());
        }
    }
    assert!(hits >= 1 && !pushed(&world).is_empty(), "{hits}");
}

#[test]
fn every_byte_of_a_pushed_car_is_hashed_restored_and_named() {
    let (world, keyframe, since) = pushed_world(0, 31);
    assert_eq!(pushed(&world).len(), 1);
    let resume = |keyframe: &Keyframe| World::resume(world.scenario(), world.network(), keyframe);
    let mut again = resume(&keyframe).expect("it resumes");
    for (input, hash) in &since {
        assert_eq!(again.step(input).hash, *hash);
    }
    let original = resume(&keyframe).expect("it resumes");
    // The state of the car begins with its id.
    let id = FIRST_PARKED_ID.to_le_bytes();
    let at = keyframe.bytes.windows(4).rposition(|bytes| bytes == id).expect("it is in the keyframe");
    let (mut named, length) = (0, 4 + 1 + 13 * 4 + 2 + 1);
    for at in at..at + length {
        let mut changed = keyframe.clone();
        changed.bytes[at] ^= 1;
        let Ok(other) = resume(&changed) else { continue };
        assert_ne!(other.hash(), original.hash(), "byte {at} is not hashed");
        assert_eq!(other.initial_keyframe(), changed, "byte {at} is not restored");
        let difference = original.difference(&other).expect("a difference has a name");
        assert_eq!(difference.part, "bodies", "{difference}");
        named += 1;
    }
    assert!(named > length / 2, "{named} of {length}");
    // A car that the map does not have.
    let mut foreign = keyframe.clone();
    foreign.bytes[at + 1] ^= 1;
    let said = resume(&foreign).err().expect("it is refused").to_string();
    assert!(said.ends_with("expected a parked car of map ring"), "{said}");
}

#[test]
fn others_pass_or_wait_for_a_car_that_was_pushed_into_their_lane() {
    let (mut world, ..) = pushed_world(8, 31);
    let car = pushed(&world)[0];
    let clear = |scene: &kernel::SceneSnapshot| {
        let others = scene.actors.iter().filter(|actor| actor.id < FIRST_PARKED_ID);
        others.map(|actor| actor.position.distance(car.position)).fold(f32::MAX, f32::min)
    };
    let mut nearest_m = f32::MAX;
    for _ in 0..60 * 60 {
        world.step(&drive(&world, true));
        nearest_m = nearest_m.min(clear(&world.scene()));
    }
    assert!((2.0..30.0).contains(&nearest_m), "{nearest_m}");
}
