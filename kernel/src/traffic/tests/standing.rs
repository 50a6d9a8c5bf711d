//! Nobody drives into what stands, wherever and however it stands.

use proptest::prelude::*;

use super::*;
use crate::actor::ActorKind;
use crate::map_data::{LaneKind, Turn};
use crate::traffic::manoeuvre::Manoeuvre;

/// Who is so near to it has met it, metres between the middles.
const NEAR_M: f32 = 8.0;

/// A car that stands beside the middle of a lane of the city, turned against it.
fn badly_parked(network: &RoadNetwork, share: f32, aside_m: f32, turned_rad: f32) -> Obstacle {
    let lanes: Vec<_> = network.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving).collect();
    let at = share * lanes.len() as f32;
    let lane = lanes[at as usize];
    let s_m = at.fract() * lane.length_m;
    let place = lane.straight_on(s_m);
    car_at(place.beside(aside_m), lane.at(s_m).heading_rad + turned_rad)
}

pub(super) fn body_of(car: &Obstacle) -> Body {
    Body {
        id: 0,
        kind: ActorKind::Car,
        variant: 0,
        position: car.position,
        rotation: crate::geometry::rotation(car.heading_rad),
        velocity_mps: Vec3::ZERO,
        phase_rad: 0.0,
        lamps: 0,
    }
}

/// How near to a car that stands there, metres, traffic comes within three minutes; none if somebody drives into it.
fn least_m_to(ego: Obstacle, network: &Arc<RoadNetwork>, seed: u64) -> Option<f32> {
    let car = body_of(&ego);
    let mut traffic = Traffic::spawn(&counts(120), seed, network.ways(), ego.position);
    let mut least_m = f32::MAX;
    for tick in 1..=3 * MINUTE {
        let conditions = Conditions::default();
        traffic.step(&Surroundings { conditions, ..Surroundings::calm(tick, ego) });
        let vehicles = &traffic.bodies()[..traffic.state().vehicles.len()];
        let near = |b: &&Body| b.position.distance_squared(ego.position) < 169.0;
        if vehicles.iter().filter(near).any(|body| boxes_meet(body, &car)) {
            return None;
        }
        least_m = vehicles.iter().map(|b| b.position.distance(ego.position)).fold(least_m, f32::min);
    }
    Some(least_m)
}

#[test]
fn nobody_drives_into_a_car_that_stands_anywhere() {
    let network = bundled("city").expect("it is bundled");
    let config = ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() };
    let cases = (0.0f32..0.999, -2.5f32..2.5, -3.0f32..3.0, 1000u64..2000);
    let came_near = std::cell::Cell::new(0);
    let run = proptest::test_runner::TestRunner::new(config).run(&cases, |(share, aside_m, turned_rad, seed)| {
        let ego = badly_parked(&network, share, aside_m, turned_rad);
        let least_m = least_m_to(ego, &network, seed);
        prop_assert!(least_m.is_some(), "somebody drove into {ego:?}");
        came_near.set(came_near.get() + u32::from(least_m.is_some_and(|m| m < NEAR_M)));
        Ok(())
    });
    run.unwrap_or_else(|failure| panic!("{failure}"));
    assert!(came_near.get() >= 4, "vehicles came near {} of 12", came_near.get());
}

/// Whoever is beside something on the right of it, where the pavement is, does not mount that to have more room.
#[test]
fn who_passes_beside_the_pavement_stays_on_the_road() {
    let network = crossroads(Signs::Yield);
    for k in 0..=5 {
        let left_m = 1.4 + 0.1 * k as f32;
        let mut traffic = lone_car(&network);
        let car = &mut traffic.actors.state.vehicles[0];
        (car.manoeuvre, car.s_m, car.offset_m, car.speed_mps) = (Manoeuvre::PassRight, 80.0, -0.65, 2.0);
        let stands = car_at(network.lanes[0].points[42].position - Vec3::Y * left_m, 0.0);
        for tick in 1..600 {
            let conditions = Conditions::default();
            traffic.step(&Surroundings { conditions, ..Surroundings::calm(tick, stands) });
            let car = &traffic.state().vehicles[0];
            let border_m = network.lanes[car.lane as usize].at(car.s_m).half_width_m;
            let over_m = car.kind.size_m().y * 0.5 - car.offset_m - border_m;
            assert!(over_m < 0.1, "{left_m} m beside it, tick {tick}: {over_m} m over the border, {car:?}");
        }
        assert!(traffic.state().vehicles[0].s_m > 90.0, "{left_m} m: {:?}", traffic.state().vehicles[0]);
    }
}

/// Width of the post, metres.
const POST_M: f32 = 0.3;

/// A bus right before its way turns, with a post beside its tail, which will swing out to there.
#[test]
fn the_tail_of_a_bus_that_turns_stays_off_what_is_beside_it() {
    let network = bundled("city").expect("it is bundled");
    let lanes = &network.lanes;
    let mut moved_m = [Vec::new(), Vec::new()];
    for (turn, outer) in [(Turn::Left, -1.0), (Turn::Right, 1.0)] {
        let turning = (0..lanes.len() as u32).filter(|id| lanes[*id as usize].turn == turn);
        for lane in turning.take(8) {
            let Some(&before) = lanes[lane as usize].predecessors.first() else { continue };
            for (gap_m, moved_m) in [0.05, 1.0].into_iter().zip(&mut moved_m) {
                let (touched, by_m) = turn_beside_a_post(&network, lane, before, outer, gap_m);
                assert!(!touched, "lane {lane}, {gap_m} m beside it");
                moved_m.push(by_m);
            }
        }
    }
    let goes = |moved_m: &[f32]| moved_m.iter().filter(|m| **m >= 4.0).count();
    let [near, far] = &moved_m;
    assert!(goes(near) < goes(far) && goes(far) > 0, "{moved_m:?}");
}

/// Cars that stand beside the inner side of a lorry's turn, ever nearer to it.
#[test]
fn who_leaves_a_standing_car_little_room_creeps_by() {
    let network = bundled("city").expect("it is bundled");
    let lanes = &network.lanes;
    let turning = || (0..lanes.len() as u32).filter(|id| lanes[*id as usize].turn == Turn::Right);
    let mut fastest_mps = [0.0_f32; 2];
    for lane in turning().take(6) {
        for step in 0..12 {
            for (room_m, mps) in turn_beside_a_car(&network, lane, 0.2 * step as f32) {
                let fastest = &mut fastest_mps[usize::from(room_m > 0.5)];
                *fastest = fastest.max(mps);
            }
        }
    }
    let [narrow, wide] = fastest_mps;
    assert!(narrow > 0.0 && narrow < 1.5 && wide > 4.0, "{fastest_mps:?} m/s");
}

/// Nearer, physics takes it for about to be hit, and it stands for ever.
#[test]
fn who_creeps_by_a_standing_car_keeps_clear_of_it() {
    let network = bundled("city").expect("it is bundled");
    let turning = (0..network.lanes.len() as u32).filter(|id| network.lanes[*id as usize].turn == Turn::Right);
    for lane in turning.take(6) {
        for step in 0..24 {
            for (room_m, mps) in turn_beside_a_car(&network, lane, 0.1 * step as f32) {
                assert!(room_m > 0.06 || mps == 0.0, "lane {lane}: {room_m} m beside it at {mps} m/s");
            }
        }
    }
}

/// The room that a lorry leaves to a car beside the end of its turn, tick by tick, and how fast it is then.
fn turn_beside_a_car(network: &Arc<RoadNetwork>, lane: u32, aside_m: f32) -> Vec<(f32, f32)> {
    let (inside, before) = (&network.lanes[lane as usize], network.lanes[lane as usize].predecessors[0]);
    let flags = Vehicle::CROSSING;
    let lorry = Vehicle { id: 1, kind: ActorKind::Truck, flags, lane, before, speed_mps: 4.0, ..Vehicle::standing() };
    let mut traffic = with_vehicles(network, vec![lorry]);
    let place = inside.straight_on(inside.length_m);
    let ego = car_at(place.beside(2.4 + aside_m), inside.at(inside.length_m).heading_rad + core::f32::consts::PI);
    let car = crate::traffic::hazard::Hazard::of(&ego);
    let look = |tick| {
        traffic.step(&Surroundings::calm(tick, ego));
        let lorry = crate::traffic::hazard::Hazard::of_body(&traffic.bodies()[0]);
        let room_m = (0..=100).map(|step| 0.01 * step as f32).find(|m| lorry.is_within(&car, *m));
        (room_m.unwrap_or(f32::MAX), lorry.velocity.length())
    };
    let looks: Vec<_> = (1..=360).map(look).collect();
    // Where the turn is too short it begins beside the car.
    let comes = looks[0].0 > 1.0;
    looks.into_iter().filter(|(room_m, _)| comes && (*room_m <= 0.15 || (0.8..=1.0).contains(room_m))).collect()
}

/// Whether a bus touches the post within ten seconds, and how far it comes.
fn turn_beside_a_post(network: &Arc<RoadNetwork>, lane: u32, before: u32, outer: f32, gap_m: f32) -> (bool, f32) {
    let flags = Vehicle::CROSSING;
    let bus = Vehicle { id: 1, kind: ActorKind::Bus, flags, lane, before, s_m: 1.0, ..Vehicle::standing() };
    let mut traffic = with_vehicles(network, vec![bus]);
    let body = traffic.bodies()[0];
    let half = body.kind.size_m() * 0.5;
    let size_m = Vec3::new(POST_M, POST_M, 1.0);
    let place = body.position + body.rotation * Vec3::new(0.4 - half.x, outer * (half.y + gap_m + POST_M * 0.5), 0.0);
    let ahead = body.rotation * Vec3::X;
    let heading_rad = crate::ops::atan2(ahead.y, ahead.x);
    let post = Obstacle { id: 0, position: place, heading_rad, velocity_mps: Vec3::ZERO, size_m, on_foot: false };
    let from = body.position;
    for tick in 1..=600 {
        traffic.step(&Surroundings::calm(tick, post));
        let body = &traffic.bodies()[0];
        let local = (body.rotation.inverse() * (place - body.position)).abs();
        if local.x < half.x + POST_M * 0.5 && local.y < half.y + POST_M * 0.5 {
            return (true, 0.0);
        }
    }
    (false, traffic.bodies()[0].position.distance(from))
}

/// The lanes before and behind one that goes straight over a crossroads.
fn straight_over(network: &RoadNetwork) -> [u32; 2] {
    let goes = |lane: &&crate::map_data::Lane| lane.junction.is_some() && lane.turn == Turn::Straight;
    let inside = network.lanes.iter().find(goes).expect("there is one");
    [inside.predecessors[0], inside.successors[0]]
}

#[test]
fn who_waits_for_room_behind_a_junction_has_the_reason_of_the_queue_there() {
    let network = crossroads(Signs::Yield);
    let [before, beyond] = straight_over(&network);
    let to = network.lanes[beyond as usize].straight_on(10.0);
    let heading_rad = crate::ops::atan2(to.forward.y, to.forward.x);
    let ego = car_at(to.position, heading_rad);
    // Nobody passes it on the other lane.
    let loose = [Obstacle { id: 9, ..car_at(to.beside(3.5), heading_rad) }];
    let waits_at_m = network.lanes[before as usize].length_m - 4.0;
    let on = |id, lane, s_m| Vehicle { id, lane, before: lane, s_m, ..Vehicle::standing() };
    let mut waited = 0;
    // Some of its journeys lead straight on.
    for trips in 0..40 {
        let mut traffic =
            with_vehicles(&network, vec![Vehicle { trips, ..on(1, before, waits_at_m) }, on(2, beyond, 3.0)]);
        for tick in 1..=10 * 60 {
            traffic.step(&Surroundings { loose: &loose, ..Surroundings::calm(tick, ego) });
        }
        let waits = traffic.state().vehicles[0];
        if waits.lane == before && waits.wait_ticks > 5 * 60 {
            assert_eq!(waits.stuck_s, 0, "{waits:?}");
            waited += 1;
        }
    }
    assert!(waited > 0);
}

pub(super) fn with_vehicles(network: &Arc<RoadNetwork>, vehicles: Vec<Vehicle>) -> Traffic {
    let mut traffic = Traffic::spawn(&TrafficCounts::NONE, 7, network.ways(), Vec3::new(1e4, 0.0, 0.0));
    traffic.actors.state.vehicles = vehicles;
    traffic.actors.know_drivers();
    traffic.actors.place_bodies();
    traffic
}

/// Of somebody who rolls over the place where he should wait in a narrow street, so that others can turn into it, while
/// somebody stands across his way: how far he goes, metres, if he waits.
fn rolls_on_m(network: &Arc<RoadNetwork>, lane: u32, trips: u16) -> Option<f32> {
    let lanes = &network.lanes;
    let inside = lanes[lane as usize].successors[0];
    let across = network.ways().lanes[inside as usize]
        .conflicts
        .iter()
        .find(|c| !lanes[inside as usize].predecessors.iter().any(|b| lanes[c.lane as usize].predecessors.contains(b)))?
        .lane;
    let end_m = lanes[lane as usize].stop.map_or(lanes[lane as usize].length_m, |stop| stop.s_m);
    let s_m = end_m - 2.25 - 6.5;
    let rolls = Vehicle { id: 1, lane, before: lane, s_m, speed_mps: 0.4, trips, ..Vehicle::standing() };
    let s_m = lanes[across as usize].length_m * 0.5;
    let crosses = Vehicle { id: 2, lane: across, before: across, s_m, flags: Vehicle::CROSSING, ..Vehicle::standing() };
    let mut traffic = with_vehicles(network, vec![rolls, crosses]);
    let place = lanes[across as usize].straight_on(s_m + 5.0);
    let ego = car_at(place.position, crate::ops::atan2(place.forward.y, place.forward.x));
    for tick in 1..=5 * 60 {
        traffic.step(&Surroundings::calm(tick, ego));
    }
    let now = traffic.state().vehicles[0];
    (now.lane == lane && now.flags & Vehicle::GRANTED == 0).then_some(now.s_m - rolls.s_m)
}

#[test]
fn who_rolls_over_where_it_should_wait_in_a_narrow_street_stands_there() {
    let network = bundled("suburb").expect("it is bundled");
    let narrow = (0..network.lanes.len() as u32).filter(|lane| network.ways().lanes[*lane as usize].narrow);
    let rolled: Vec<f32> = narrow
        .flat_map(|lane| (0..4).map(move |trips| (lane, trips)))
        .filter_map(|(lane, trips)| rolls_on_m(&network, lane, trips))
        .collect();
    assert!(rolled.len() > 4 && rolled.iter().all(|m| *m < 1.0), "{rolled:?}");
}

#[test]
fn a_bus_that_waits_where_the_map_ends_is_not_passed_by_all_others() {
    let network = crossroads(Signs::Yield);
    let ends = (0..network.lanes.len() as u32).filter(|lane| network.ways().lanes[*lane as usize].onward.is_empty());
    let [first, second] = ends.take(2).collect::<Vec<_>>()[..] else { panic!("two lanes end") };
    let at_end = |id: u16, kind: ActorKind, lane: u32, stuck_s: u8| {
        let s_m = network.lanes[lane as usize].length_m - kind.size_m().x * 0.5 - 1.0;
        Vehicle { id, kind, lane, before: lane, s_m, stuck_s, ..Vehicle::standing() }
    };
    let enters = |tick: Tick, bus_waits_s: u8| {
        let car = at_end(1, ActorKind::Car, first, 2);
        let traffic = with_vehicles(&network, vec![car, at_end(2, ActorKind::Bus, second, bus_waits_s)]);
        let mut actors = traffic.actors.clone();
        let before = actors.state.vehicles.clone();
        actors.return_to_map(&before, &Surroundings::calm(tick, nowhere()), &mut Vec::new());
        [0, 1].map(|i| actors.state.vehicles[i].lane != before[i].lane)
    };
    // At times both draw the same entry.
    let tick = (60..120).find(|tick| enters(*tick, 2) == [true, true]).expect("both have just come");
    assert_eq!(enters(tick, 20), [false, true], "the bus goes first");
    assert_eq!(enters(tick, 160), [true, true], "who finds no room for so long holds nobody up");
}
