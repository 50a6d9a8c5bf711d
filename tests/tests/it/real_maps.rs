//! Road networks that others made load and can be driven.

use kernel::map::{Lane, LaneKind, RoadNetwork, StopKind, bake};

/// The map of a file in the folder of real maps.
fn load(name: &str) -> RoadNetwork {
    let Some(folder) = option_env!("AEYE_REAL_MAPS") else { panic!("the folder of real maps is missing") };
    let text = std::fs::read_to_string(format!("{folder}/{name}.xodr")).expect("a readable map");
    bake(name, &text).expect("a map")
}

fn driving(map: &RoadNetwork) -> impl Iterator<Item = &Lane> {
    map.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving)
}

/// Follows first successors for `metres`, or until a lane that ends.
fn drive(map: &RoadNetwork, mut at: u32, metres: f32) -> f32 {
    let mut gone = 0.0;
    while gone < metres {
        let lane = &map.lanes[at as usize];
        gone += lane.length_m;
        match lane.successors.first() {
            Some(&next) => {
                let gap =
                    lane.points[lane.points.len() - 1].position.distance(map.lanes[next as usize].points[0].position);
                assert!(gap < 0.2, "{}: lane {} ends {gap} m before the next", map.name, lane.name);
                at = next;
            }
            None => break,
        }
    }
    gone
}

/// From some lane one can drive `metres`, on the road all the way.
fn check_drivable(map: &RoadNetwork, metres: f32) {
    let ids = (0..map.lanes.len() as u32).filter(|&id| map.lanes[id as usize].kind == LaneKind::Driving);
    let farthest = ids.map(|id| drive(map, id, metres)).fold(0.0, f32::max);
    assert!(farthest >= metres, "{}: {farthest} m", map.name);
    for lane in driving(map) {
        for p in lane.points.iter().step_by(5) {
            let ground = map.ground(p.position).unwrap_or_else(|| panic!("{}: no ground at {}", map.name, p.position));
            assert!(
                (ground.height_m - p.position.z).abs() < 0.25,
                "{} {}: {ground:?} below {p:?}",
                map.name,
                lane.name
            );
        }
        assert!((2.0..60.0).contains(&lane.speed_limit_mps));
    }
}

fn check_town(name: &str, junctions: usize) {
    let map = load(name);
    check_drivable(&map, 2000.0);
    assert_eq!(map.junctions.len(), junctions);
    assert!(driving(&map).all(|lane| !lane.successors.is_empty()), "no lane of {name} ends");
    for lane in driving(&map).filter(|lane| lane.junction.is_none()) {
        let enters = lane.successors.iter().any(|&next| map.lanes[next as usize].junction.is_some());
        let light = lane.stop.is_some_and(|stop| matches!(stop.kind, StopKind::Light(_)));
        assert_eq!(light, enters, "{name}: lane {} before a junction has its light", lane.name);
    }
    assert!(map.junctions.iter().all(|j| j.light_groups.len() == 3));
    assert_eq!(map.crosswalks.len(), 3 * junctions);
}

#[test]
#[cfg_attr(no_real_maps, ignore = "no real maps beside the repository")]
fn the_towns_of_carla_are_towns() {
    check_town("Town01", 12);
    check_town("Town02", 8);
}

#[test]
#[cfg_attr(no_real_maps, ignore = "no real maps beside the repository")]
fn the_roads_of_esmini_can_be_driven() {
    for (name, metres) in [
        ("esmini_e6mini", 1400.0),
        ("esmini_fabriksgatan", 300.0),
        ("esmini_simple_4way_intersection", 200.0),
        ("esmini_soderleden", 1000.0),
        ("esmini_straight_500m", 490.0),
    ] {
        check_drivable(&load(name), metres);
    }
}

#[test]
#[cfg_attr(no_real_maps, ignore = "no real maps beside the repository")]
fn a_junction_without_signs_asks_to_give_way() {
    for name in ["esmini_fabriksgatan", "esmini_simple_4way_intersection"] {
        let map = load(name);
        let stops: Vec<_> = driving(&map).filter_map(|lane| lane.stop).collect();
        assert!(stops.len() == 4 && stops.iter().all(|stop| stop.kind == StopKind::Yield), "{name}: {stops:?}");
    }
}
