//! Traffic expects the ego car, which does not hear of grants.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::Vec3;

use super::crossroads::{Signs, crossroads};
use super::{MINUTE, car_at, nowhere, start};
use crate::map::{LaneId, MapData, RoadNetwork};
use crate::ops;
use crate::signals::{LightPhase, phase};
use crate::time::Tick;
use crate::traffic::{Obstacle, Surroundings, Vehicle};
use crate::weather::Conditions;

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
        traffic.step(&Surroundings { tick, ego, ego_flags: 0, loose: &[], conditions: Conditions::default() });
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
