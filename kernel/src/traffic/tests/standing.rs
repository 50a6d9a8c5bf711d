//! Nobody drives into what stands, wherever and however it stands.

use proptest::prelude::*;

use super::*;
use crate::actor::ActorKind;
use crate::map_data::{LaneKind, Turn};

/// A car that stands beside the middle of a lane of the city, turned against it.
fn badly_parked(network: &RoadNetwork, share: f32, aside_m: f32, turned_rad: f32) -> Obstacle {
    let lanes: Vec<_> = network.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving).collect();
    let at = share * lanes.len() as f32;
    let lane = lanes[at as usize];
    let s_m = at.fract() * lane.length_m;
    let place = lane.straight_on(s_m);
    car_at(place.beside(aside_m), lane.at(s_m).heading_rad + turned_rad)
}

fn body_of(car: &Obstacle) -> Body {
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

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn nobody_drives_into_a_car_that_stands_anywhere(
        (share, aside_m, turned_rad) in (0.0f32..0.999, -2.5f32..2.5, -3.0f32..3.0),
        seed in 1000u64..2000,
    ) {
        let network = bundled("city").expect("it is bundled");
        let ego = badly_parked(&network, share, aside_m, turned_rad);
        let car = body_of(&ego);
        let mut traffic = Traffic::spawn(&counts(120), seed, network.ways(), ego.position);
        for tick in 1..=3 * MINUTE {
            let conditions = Conditions::default();
            traffic.step(&Surroundings { tick, ego, ego_flags: 0, loose: &[], conditions });
            let vehicles = &traffic.bodies()[..traffic.state().vehicles.len()];
            let near = |b: &&Body| b.position.distance_squared(ego.position) < 169.0;
            let hit = vehicles.iter().filter(near).find(|body| boxes_meet(body, &car));
            prop_assert!(hit.is_none(), "tick {tick}: {hit:?} in {ego:?}");
        }
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

/// Whether a bus touches the post within ten seconds, and how far it comes.
fn turn_beside_a_post(network: &Arc<RoadNetwork>, lane: u32, before: u32, outer: f32, gap_m: f32) -> (bool, f32) {
    let none = TrafficCounts {
        cars: 0,
        motorcycles: 0,
        bicycles: 0,
        pedestrians: 0,
        jaywalks_per_min: 0.0,
        drivers: Population::USUAL,
    };
    let mut traffic = Traffic::spawn(&none, 7, network.ways(), Vec3::new(1e4, 0.0, 0.0));
    let flags = Vehicle::CROSSING;
    let bus = Vehicle { id: 1, kind: ActorKind::Bus, flags, lane, before, s_m: 1.0, ..Vehicle::standing() };
    traffic.actors.state.vehicles = vec![bus];
    traffic.actors.know_drivers();
    traffic.actors.place_bodies();
    let body = traffic.bodies()[0];
    let half = body.kind.size_m() * 0.5;
    let size_m = Vec3::new(POST_M, POST_M, 1.0);
    let place = body.position + body.rotation * Vec3::new(0.4 - half.x, outer * (half.y + gap_m + POST_M * 0.5), 0.0);
    let ahead = body.rotation * Vec3::X;
    let heading_rad = crate::ops::atan2(ahead.y, ahead.x);
    let post = Obstacle { id: 0, position: place, heading_rad, velocity_mps: Vec3::ZERO, size_m };
    let from = body.position;
    for tick in 1..=600 {
        traffic.step(&Surroundings { tick, ego: post, ego_flags: 0, loose: &[], conditions: Conditions::default() });
        let body = &traffic.bodies()[0];
        let local = (body.rotation.inverse() * (place - body.position)).abs();
        if local.x < half.x + POST_M * 0.5 && local.y < half.y + POST_M * 0.5 {
            return (true, 0.0);
        }
    }
    (false, traffic.bodies()[0].position.distance(from))
}
