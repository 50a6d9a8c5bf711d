//! Nobody drives into what stands, wherever and however it stands.

use proptest::prelude::*;

use super::*;
use crate::map_data::LaneKind;

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
        kind: crate::actor::ActorKind::Car,
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
