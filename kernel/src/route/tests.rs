//! A missed turn on every junction of the bundled maps, and lights as they come into sight.

use std::f32::consts::PI;

use glam::{Quat, Vec3};

use super::*;
use crate::map::StopKind;
use crate::map::bundled;
use crate::motion::Motion;
use crate::signals;

/// A place on the way of a car, and its heading.
fn at(network: &RoadNetwork, lane: LaneId, s_m: f32, aside_m: f32) -> (Vec3, f32) {
    let point = network.lane_point(lane, s_m);
    let left = Vec3::new(-ops::sin(point.heading_rad), ops::cos(point.heading_rad), 0.0);
    (point.position + left * aside_m, point.heading_rad)
}

/// Drives along lanes, so far beside their middle; every metre the route follows.
fn drive(route: &mut Route, network: &RoadNetwork, lanes: &[LaneId], aside_m: impl Fn(usize) -> f32) {
    for (k, &lane) in lanes.iter().enumerate() {
        for s_m in 0..network.lanes[lane as usize].length_m.min(60.0) as u32 {
            let (middle, heading_rad) = at(network, lane, s_m as f32, aside_m(k));
            route.follow(network, 1, middle, heading_rad);
        }
    }
}

/// Every way over a junction that the route did not mean to take, with 20 m at least behind it.
fn missed_turns(network: &RoadNetwork) -> Vec<(LaneId, LaneId, LaneId, LaneId)> {
    let mut found = Vec::new();
    let lanes = &network.lanes;
    for (id, lane) in lanes.iter().enumerate().filter(|(_, lane)| lane.kind == LaneKind::Driving) {
        for &taken in &lane.successors {
            let meant = lane.successors.iter().find(|m| lanes[**m as usize].turn != lanes[taken as usize].turn);
            let leaves = |lane: LaneId| {
                let onward = &lanes[lane as usize].successors;
                onward.first().filter(|e| lanes[**e as usize].junction.is_none() && lanes[**e as usize].length_m > 20.0)
            };
            if let (Some(&meant), Some(&exit)) = (meant, leaves(taken)) {
                found.push((id as LaneId, meant, taken, exit));
            }
        }
    }
    found
}

#[test]
fn a_missed_turn_is_no_end_of_the_route() {
    for map in ["city", "rural"] {
        let network = bundled(map).expect("it is bundled");
        let turns = missed_turns(&network);
        assert!(turns.len() > 8, "{map}: {}", turns.len());
        for (from, meant, taken, exit) in turns {
            let start = || Route { lanes: vec![from, meant], s_m: 0.0, drawn: 0 };
            let width_m = 2.0 * network.lane_point(exit, 15.0).half_width_m;
            // In its lane, on the lane beside it to the right, and on the one to the left, where it may be for the other
            // direction: those that exist.
            for aside_m in [0.0, -width_m, width_m] {
                let mut route = start();
                drive(&mut route, &network, &[from, taken, exit], |k| if k == 2 { aside_m } else { 0.0 });
                let s_m = network.lanes[exit as usize].length_m.min(60.0) - 1.0;
                let (middle, heading_rad) = at(&network, exit, s_m, aside_m);
                let place = network.project(route.lanes[0], middle);
                let point = network.lane_point(place.lane, place.s_m);
                let name = format!("{map}, lanes {from}, {taken}, {exit}, {aside_m} m aside: {route:?}");
                assert!(place.distance_m < point.half_width_m + width_m + 0.7, "{} m off; {name}", place.distance_m);
                let angle = ops::wrap_angle(point.heading_rad - heading_rad).abs();
                assert!(angle < PI / 3.0, "{angle} rad off; {name}");
                assert!(aside_m != 0.0 || place.distance_m < 1.5, "{} m off; {name}", place.distance_m);
            }
        }
    }
}

#[test]
fn who_passes_on_the_lane_of_the_other_direction_keeps_the_route() {
    let network = bundled("rural").expect("it is bundled");
    let long = |(_, lane): &(usize, &crate::map::Lane)| {
        lane.kind == LaneKind::Driving && lane.junction.is_none() && lane.length_m > 60.0 && lane.left.is_none()
    };
    let mut tried = 0;
    for (id, lane) in network.lanes.iter().enumerate().filter(long) {
        let lane_id = id as LaneId;
        let (oncoming, heading_rad) = at(&network, lane_id, 30.0, 2.0 * lane.at(30.0).half_width_m);
        let beside = network.lanes_at(oncoming, LaneKind::Driving);
        let comes = |p: &Projection| ops::cos(network.lane_point(p.lane, p.s_m).heading_rad - heading_rad) < -0.5;
        if beside.is_empty() || !beside.iter().all(comes) {
            continue;
        }
        let mut route = Route::along(&network, 1, vec![lane_id], 20.0);
        let before = route.lanes.clone();
        assert!(!route.follow(&network, 1, oncoming, heading_rad), "lane {id}");
        assert_eq!(route.lanes[..before.len()], before, "lane {id}");
        tried += 1;
    }
    assert!(tried > 3, "{tried}");
}

#[test]
fn a_light_is_shown_as_soon_as_people_have_to_see_it() {
    let network = bundled("city").expect("it is bundled");
    let mut scenario = Scenario::default_for("city", 1);
    let (mut farthest_m, mut lit) = ([0.0_f32; 2], 0);
    for (id, lane) in network.lanes.iter().enumerate() {
        let Some(stop) = lane.stop.filter(|stop| matches!(stop.kind, StopKind::Light(_))) else { continue };
        lit += 1;
        for (k, max_speed_kmh) in [50.0, 20.0].into_iter().enumerate() {
            scenario.rules.max_speed_kmh = max_speed_kmh;
            for away_m in 1..=stop.s_m as u32 {
                let s_m = stop.s_m - away_m as f32;
                let (middle, heading_rad) = at(&network, id as LaneId, s_m, 0.0);
                let rotation = Quat::from_rotation_z(heading_rad);
                let position = middle - rotation * Vec3::new(ego::CENTRE_M.x, 0.0, 0.0);
                let motion = Motion { position, rotation, velocity_mps: Vec3::ZERO, spin_radps: Vec3::ZERO };
                let route = Route::along(&network, 1, vec![id as LaneId], s_m);
                let hud = route.hud(
                    &network,
                    &scenario,
                    |group| signals::phase(&network, scenario.seed, group, 5).0,
                    &ego::Ego::new(motion),
                );
                let to_line_m = away_m as f32 - NOSE_M;
                let phase = match stop.kind {
                    StopKind::Light(group) => signals::phase(&network, scenario.seed, group, 5).0,
                    _ => unreachable!("it has a light"),
                };
                assert!(hud.light.is_none_or(|light| light == phase || to_line_m < 0.0), "lane {id}, {away_m} m");
                if (0.0..=LIGHT_M).contains(&to_line_m) {
                    assert_eq!(hud.light, Some(phase), "lane {id}, {away_m} m");
                }
                if hud.light.is_some() && to_line_m > 0.0 {
                    farthest_m[k] = farthest_m[k].max(to_line_m);
                }
            }
        }
    }
    assert!(lit > 3, "{lit}");
    // MUTCD: 82 m at 48 km/h; slower than that no less than 50 m.
    assert!((82.0..90.0).contains(&farthest_m[0]) && (49.0..=50.0).contains(&farthest_m[1]), "{farthest_m:?}");
}

/// Two roads of one lane side by side: the left one goes on for 100 m, the right one ends.
fn lane_drop() -> RoadNetwork {
    let road = |id: u32, y_m: f64, length_m: f64| {
        format!(
            "<road id=\"{id}\" length=\"{length_m}\" junction=\"-1\"><planView><geometry s=\"0\" x=\"0\" y=\"{y_m}\" \
             hdg=\"0\" length=\"{length_m}\"><line/></geometry></planView><lanes><laneSection s=\"0\"><center><lane id=\"0\" \
             type=\"none\"/></center><right><lane id=\"-1\" type=\"driving\"><width sOffset=\"0\" a=\"3.5\" b=\"0\" c=\"0\" \
             d=\"0\"/></lane></right></laneSection></lanes></road>"
        )
    };
    let (goes_on, ends) = (road(1, 0.0, 200.0), road(2, -3.5, 100.0));
    let text = format!("<OpenDRIVE><header revMajor=\"1\" revMinor=\"6\"/>{goes_on}{ends}</OpenDRIVE>");
    crate::map::bake("lane_drop", &text).expect("it is a map")
}

#[test]
fn a_route_leaves_a_lane_that_ends_for_the_one_beside_it_and_tells_where_the_road_ends() {
    let network = lane_drop();
    let (mut beside, mut ended) = (0, 0);
    for (id, _) in network.lanes.iter().enumerate().filter(|(_, lane)| lane.kind == LaneKind::Driving) {
        let mut route = Route::along(&network, 1, vec![id as LaneId], 0.0);
        for (place, pair) in route.lanes.windows(2).enumerate() {
            let at_m = network.ways().enters_at_m(pair[0], pair[1]);
            beside += usize::from(at_m > 0.0);
            let starts: Vec<f32> = route.stretches(&network).map(|(_, start_m)| start_m).collect();
            let end_m = starts[place] + network.lanes[pair[0] as usize].length_m;
            assert!((starts[place + 1] + at_m - end_m).abs() < 1e-3, "lane {id}: {starts:?}");
        }
        // All the way to the end the point ahead is ahead, and the route is followed without a stray.
        let known_m = route.known_m(&network);
        let points: Vec<Vec3> = route.ahead(&network, known_m);
        for pair in points.windows(2) {
            let heading_rad = ops::atan2(pair[1].y - pair[0].y, pair[1].x - pair[0].x);
            assert!((pair[1] - pair[0]).length() < 5.0, "lane {id}: {pair:?}");
            assert!(!route.follow(&network, 1, pair[0], heading_rad), "lane {id}: {pair:?} {route:?} {heading_rad}");
        }
        ended += usize::from(route.ends_in_m(&network).is_some_and(|ends_in_m| ends_in_m < 2.0));
    }
    assert!(beside > 0 && ended > 0, "{beside} {ended}");
}
