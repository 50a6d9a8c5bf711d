//! Traffic expects the ego car, which does not hear of grants.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::Vec3;

use super::crossroads::{Signs, crossroads};
use super::standing::body_of;
use super::{MINUTE, boxes_meet, car_at, lone_car, nowhere, start};
use crate::map::{Lane, LaneId, MapData, RoadNetwork};
use crate::ops;
use crate::signals::{LightPhase, phase};
use crate::time::Tick;
use crate::traffic::{Body, Obstacle, Surroundings, Vehicle};

/// So many vehicles begin to drive a lane in some minutes beside an ego car, at ticks that count.
fn enter(
    network: &Arc<RoadNetwork>,
    ego: Obstacle,
    lanes: &[LaneId],
    minutes: Tick,
    counts_at: impl Fn(Tick) -> bool,
) -> usize {
    let mut traffic = start(network, 60, 3);
    let mut entered = BTreeSet::new();
    for tick in 1..minutes * MINUTE {
        traffic.step(&Surroundings::calm(tick, ego));
        let enters = |v: &&Vehicle| lanes.contains(&v.lane) && v.s_m < 2.0 && counts_at(tick);
        entered.extend(traffic.state().vehicles.iter().filter(enters).map(|v| (v.id, tick / 600)));
    }
    entered.len()
}

#[test]
fn who_turns_left_lets_the_car_start_that_stands_at_a_line_with_green() {
    let mut map = MapData::clone(&crossroads(Signs::Lights));
    map.light_groups[2].green_from_ticks = map.light_groups[0].green_from_ticks;
    let network = Arc::new(RoadNetwork::from(map));
    let left = network.lanes.iter().position(|lane| lane.name == "2->1").expect("it is there") as LaneId;
    let is_green = |tick: Tick| {
        phase(&network, 3, 0, tick).0 == LightPhase::Green && phase(&network, 3, 0, tick - 30).0 == LightPhase::Green
    };
    let turned = |ego| enter(&network, ego, &[left], 10, is_green);
    // Half a metre before the line of the arm along +x, and far behind it.
    let at_line = car_at(Vec3::new(23.0, 1.75, 0.0), core::f32::consts::PI);
    assert_eq!(turned(at_line), 0);
    assert!(turned(nowhere()) > 3, "{}", turned(nowhere()));
}

#[test]
fn who_enters_a_junction_sees_the_car_inside_beside_all_lanes() {
    let network = crossroads(Signs::Yield);
    let inside = &network.junctions[0].lanes;
    // Aside of the right turn of the arm along +x, in its direction.
    let (right, from) = inside
        .iter()
        .map(|id| (*id, &network.lanes[*id as usize]))
        .find(|(_, l)| l.name == "0->1")
        .expect("it is there");
    let middle = &from.points[from.points.len() / 2];
    let aside = Vec3::new(ops::sin(middle.heading_rad), -ops::cos(middle.heading_rad), 0.0);
    let place = middle.position + aside * 2.2;
    assert!(inside.iter().all(|id| network.project(*id, place).distance_m > 1.8));
    let ego = Obstacle { velocity_mps: 2.0 * Vec3::X, ..car_at(place, middle.heading_rad) };
    let crossed: Vec<LaneId> = network.lanes[right as usize].conflicts.iter().map(|c| c.lane).collect();
    let entered = |ego| enter(&network, ego, &crossed, 5, |_| true);
    assert_eq!(entered(ego), 0);
    assert!(entered(nowhere()) > 3, "{}", entered(nowhere()));
}

/// Where a car that has its grant is, tick by tick, beside an ego car.
fn goes_in(network: &Arc<RoadNetwork>, ego_at: impl Fn(Tick) -> Obstacle) -> Vec<Body> {
    let mut traffic = lone_car(network);
    let car = &mut traffic.actors.state.vehicles[0];
    (car.s_m, car.flags) = (network.lanes[0].length_m - 6.0, Vehicle::GRANTED);
    let step = |tick| {
        traffic.step(&Surroundings::calm(tick, ego_at(tick)));
        traffic.bodies()[0]
    };
    (1..600).map(step).collect()
}

/// The ego car comes out of the arm on the right or on the left, at 5 m/s, as if nobody else were there.
#[test]
fn who_has_a_grant_brakes_for_the_car_that_comes_across_all_the_same() {
    let network = crossroads(Signs::Yield);
    let alone = goes_in(&network, |_| nowhere());
    let middle = alone.iter().position(|b| b.position.distance(alone[0].position) > 16.0).expect("it goes in");
    let (place, ahead) = (alone[middle].position, alone[middle].rotation * Vec3::X);
    let mut meet_alone = 0;
    for side in [1.0, -1.0] {
        let across = side * Vec3::new(-ahead.y, ahead.x, 0.0);
        for late_ticks in (-90..=90).step_by(15) {
            let ego_at = |tick: Tick| {
                let way_m = 5.0 / 60.0 * (tick as f32 - (middle as i32 + late_ticks) as f32);
                let heading_rad = ops::atan2(across.y, across.x);
                Obstacle { velocity_mps: 5.0 * across, ..car_at(place + way_m * across, heading_rad) }
            };
            let meets = |bodies: &[Body]| (1..).zip(bodies).any(|(tick, car)| boxes_meet(car, &body_of(&ego_at(tick))));
            meet_alone += u32::from(meets(&alone));
            let with = goes_in(&network, ego_at);
            assert!(!meets(&with), "side {side}, {late_ticks} ticks late");
            let driven_m = with.last().map_or(0.0, |body| body.position.distance(with[0].position));
            assert!(driven_m > 20.0, "side {side}, {late_ticks} ticks late: {driven_m} m in ten seconds");
        }
    }
    assert!(meet_alone >= 10, "{meet_alone} of 26 would meet if nobody braked");
}

/// Before the line of an arm whose way crosses: one ego car brakes with 3 m/s² from 8 m/s, another one keeps its speed.
#[test]
fn who_has_a_grant_does_not_brake_for_the_car_that_can_still_stop() {
    let network = crossroads(Signs::Yield);
    let arms = network.lanes.iter().filter(|lane| lane.junction.is_none() && !lane.successors.is_empty());
    let across =
        |lane: &&Lane| ops::sin(lane.points[0].heading_rad - network.lanes[0].points[0].heading_rad).abs() > 0.9;
    let alone = goes_in(&network, |_| nowhere());
    let hinders = |arm: &Lane, brakes_mps2: f32| {
        let with = goes_in(&network, |tick| {
            let time_s = tick as f32 / 60.0;
            let stands_s = if brakes_mps2 > 0.0 { 8.0 / brakes_mps2 } else { f32::INFINITY };
            let mps = if time_s < stands_s { 8.0 - brakes_mps2 * time_s } else { 0.0 };
            let time_s = time_s.min(stands_s);
            let way_m = (8.0 - 0.5 * brakes_mps2 * time_s) * time_s;
            let place = arm.straight_on(arm.length_m - 3.25 - 64.0 / 6.0 + way_m);
            Obstacle { velocity_mps: mps * place.forward, ..car_at(place.position, arm.points[0].heading_rad) }
        });
        with.iter().zip(&alone).any(|(with, alone)| with.position != alone.position)
    };
    let found: Vec<[bool; 2]> = arms.filter(across).map(|arm| [3.0, 0.0].map(|mps2| hinders(arm, mps2))).collect();
    assert_eq!(found, [[false, true]; 2]);
}
