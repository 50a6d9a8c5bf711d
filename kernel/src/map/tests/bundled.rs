//! The maps that come with A-Eye.

use super::*;

/// What the bundled maps bake to; a change here changes every recording's map.
const DIGESTS: [(&str, u128); BUNDLED.len()] = [
    ("city", 0xdf1e_8bcc_faaa_2790_aae6_ee9e_afe2_cf57),
    ("rural", 0xece8_ae71_8593_be75_375b_f2e8_31a5_8a7a),
    ("old_town", 0xc725_397f_9dd1_5b5a_1ca1_9f05_7675_beae),
    ("suburb", 0xb5ea_d1b4_5895_7d55_47f4_afa8_f578_e358),
    ("ring", 0xd458_5fc5_ef3a_4faa_f873_87db_51f2_6417),
    ("motorway", 0xee4f_7583_0ba8_6154_48fb_40b5_f20b_3742),
    ("lakeside", 0x3b78_ba34_6c88_7c03_027e_54f2_36b7_d777),
];

#[test]
fn digests_are_golden() {
    let digests = DIGESTS.map(|(name, _)| (name, bundled(name).unwrap().digest));
    assert_eq!(digests, DIGESTS, "they bake to {digests:#034x?}");
}

#[test]
fn names_are_known() {
    assert!(BUNDLED.iter().all(|name| bundled(name).is_some_and(|m| m.name == *name)));
    assert!(bundled("atlantis").is_none());
}

#[test]
fn maps_are_sound() {
    for name in BUNDLED {
        let map = bundled(name).unwrap();
        check_sound(&map);
        super::signals::check_programmes(&map);
        let (asphalt, cobbles) = (SurfaceKind::Road, SurfaceKind::Setts);
        let paved: &[SurfaceKind] = if name == "old_town" { &[asphalt, cobbles] } else { &[asphalt] };
        super::features::check_ground(&map, paved);
    }
}

#[test]
fn no_road_ends() {
    for name in BUNDLED {
        let map = bundled(name).unwrap();
        for lane in map.lanes.iter().filter(|l| l.kind == LaneKind::Driving) {
            assert!(!lane.successors.is_empty() && !lane.predecessors.is_empty(), "{name}: {}", lane.name);
            for &next in &lane.successors {
                let gap = lane.end().position.distance(map.lanes[next as usize].start().position);
                assert!(gap < 0.01, "{name}: {} ends {gap} m before its successor", lane.name);
            }
        }
    }
}

#[test]
fn who_must_wait_has_a_stop_line() {
    for name in BUNDLED {
        let map = bundled(name).unwrap();
        for lane in map.lanes.iter().filter(|l| l.kind == LaneKind::Driving && l.junction.is_none()) {
            let enters = lane.successors.iter().filter_map(|&n| map.lanes[n as usize].junction);
            let lights = enters.into_iter().any(|j| !map.junctions[j as usize].light_groups.is_empty());
            let waits = |n: &LaneId| map.lanes[*n as usize].conflicts.iter().any(|c| c.other_first);
            match lane.stop {
                Some(stop) => assert!(lane.length_m - stop.s_m < 15.0, "{name}: {}", lane.name),
                None => assert!(!lights && !lane.successors.iter().any(waits), "{name}: {}", lane.name),
            }
        }
    }
}

#[test]
fn people_can_walk_everywhere() {
    for name in BUNDLED {
        assert_eq!(walkable_parts(&bundled(name).unwrap()).len(), 1, "{name}");
    }
}

#[test]
fn the_city_has_what_a_city_has() {
    let map = bundled("city").unwrap();
    let stops =
        |wanted: fn(StopKind) -> bool| map.lanes.iter().filter(|l| l.stop.is_some_and(|s| wanted(s.kind))).count();
    assert!(stops(|k| matches!(k, StopKind::Light(_))) >= 20);
    assert!(stops(|k| k == StopKind::Stop) >= 4 && stops(|k| k == StopKind::Yield) >= 10);
    let props = |kind| map.props.iter().filter(|p| p.kind == kind).count();
    assert!(props(PropKind::Building) > 300 && props(PropKind::ParkedCar) > 200 && props(PropKind::Tree) > 80);
    assert_eq!(map.bus_stops.len(), 12);
    let limits: Vec<f32> = map.lanes.iter().map(|l| (l.speed_limit_mps * 3.6).round()).collect();
    assert!(limits.contains(&30.0) && limits.contains(&50.0));
    assert!(map.lanes.iter().filter(|l| l.kind == LaneKind::Driving).map(|l| l.length_m).sum::<f32>() > 10_000.0);
}

#[test]
fn the_countryside_has_hills_bends_and_rails() {
    let map = bundled("rural").unwrap();
    let heights = || map.lanes.iter().flat_map(|l| &l.points).map(|p| p.position.z);
    assert!(heights().fold(0.0, f32::max) - heights().fold(0.0, f32::min) > 5.0);
    let props = |kind| map.props.iter().filter(|p| p.kind == kind).count();
    assert!(props(PropKind::GuardRail) > 40 && props(PropKind::Tree) > 200);
    assert!(map.crosswalks.len() == 2 && map.light_groups.is_empty());
    let fastest = map.lanes.iter().map(|l| l.speed_limit_mps).fold(0.0, f32::max);
    assert!((fastest - 100.0 / 3.6).abs() < 0.01);
}

#[test]
fn the_ring_has_roundabouts_lights_and_bus_stops() {
    let map = bundled("ring").unwrap();
    assert_eq!(crate::map_data::circles(&map.lanes).len(), 4);
    assert_eq!(map.junctions.iter().filter(|j| !j.light_groups.is_empty()).count(), 2);
    assert_eq!(map.bus_stops.len(), 16);
    let props = |kind| map.props.iter().filter(|p| p.kind == kind).count();
    assert!(props(PropKind::Building) > 100 && props(PropKind::Tree) > 300 && props(PropKind::Wall) > 20);
    let limits: Vec<f32> = map.lanes.iter().map(|l| (l.speed_limit_mps * 3.6).round()).collect();
    assert!([30.0, 50.0, 60.0, 70.0].iter().all(|kmh| limits.contains(kmh)));
}

#[test]
fn the_motorway_is_long_and_crossed_above() {
    let map = bundled("motorway").unwrap();
    let driven = || map.lanes.iter().filter(|l| l.kind == LaneKind::Driving);
    let limits: Vec<f32> = driven().map(|l| (l.speed_limit_mps * 3.6).round()).collect();
    assert!([50.0, 60.0, 80.0, 100.0, 120.0].iter().all(|kmh| limits.contains(kmh)));
    let fast = driven().filter(|l| l.speed_limit_mps > 110.0 / 3.6).map(|l| l.length_m).sum::<f32>();
    assert!(fast > 36_000.0, "two lanes each way for some ten kilometres: {fast} m");
    let points = || driven().flat_map(|l| &l.points).map(|p| p.position);
    let above = |p: Vec3| points().any(|q| p.z - q.z > 5.0 && (p - q).truncate().length() < 1.0);
    assert!(points().filter(|p| p.z > 13.0).any(above), "a bridge");
    assert_eq!(map.crosswalks.len(), 2);
}

#[test]
fn the_lakeside_has_water_bridges_a_tunnel_rails_and_a_steep_hill() {
    let map = bundled("lakeside").unwrap();
    let surface = |kind| map.surfaces.iter().find(|s| s.kind == kind).unwrap_or_else(|| panic!("{kind:?}"));
    for kind in [SurfaceKind::Water, SurfaceKind::Track, SurfaceKind::Ground] {
        assert!(surface(kind).triangles.len() > 1, "{kind:?}");
    }
    let rails = surface(SurfaceKind::Rail);
    let on_road = |p: Vec3| map.ground(p).is_some_and(|ground| ground.kind == SurfaceKind::Road);
    let crosses = |t: &[u32; 3]| {
        let [from, to, _] = t.map(|v| rails.positions[v as usize]);
        (0..=24).any(|k| on_road(from.lerp(to, k as f32 / 24.0)))
    };
    assert!(rails.triangles.iter().any(crosses), "a level crossing");
    let props = |kind| map.props.iter().filter(|p| p.kind == kind).count();
    assert!(props(PropKind::Bridge) > 150 && props(PropKind::Tunnel) > 80);
    assert!(props(PropKind::Movable) > 100 && props(PropKind::Sundry) > 20 && props(PropKind::Building) > 150);
    let driven = || map.lanes.iter().filter(|l| l.kind == LaneKind::Driving);
    let rise = |p: &[LanePoint]| ((p[4].position.z - p[0].position.z) / (p[4].s_m - p[0].s_m).max(1.0)).abs();
    let steepest = driven().flat_map(|l| l.points.windows(5)).map(rise).fold(0.0, f32::max);
    assert!((0.085..=0.101).contains(&steepest), "{steepest}");
    let limits: Vec<f32> = driven().map(|l| (l.speed_limit_mps * 3.6).round()).collect();
    assert!([30.0, 50.0, 70.0, 80.0, 100.0].iter().all(|kmh| limits.contains(kmh)));
}

#[test]
fn the_old_town_is_narrow_and_cobbled() {
    let map = bundled("old_town").unwrap();
    let driving = || map.lanes.iter().filter(|l| l.kind == LaneKind::Driving && l.junction.is_none());
    assert!(driving().all(|l| l.points.iter().all(|p| p.half_width_m <= 1.51)));
    let setts = |l: &&Lane| map.ground(l.at(l.length_m / 2.0).position).unwrap().kind == SurfaceKind::Setts;
    let (cobbled, all) = (driving().filter(setts).count(), driving().count());
    assert!(4 * cobbled > all && cobbled < all, "{cobbled} of {all} lanes");
    let props = |kind| map.props.iter().filter(|p| p.kind == kind).count();
    assert!(props(PropKind::Building) > 400 && props(PropKind::Wall) > 80 && props(PropKind::ParkedCar) < 150);
    let has = |kind| map.surfaces.iter().any(|s| s.kind == kind);
    assert!(has(SurfaceKind::Track) && has(SurfaceKind::Rail) && has(SurfaceKind::Ground), "a tramway and a market");
    let lit = map.crosswalks.iter().filter(|c| c.junction.is_some()).count();
    assert!(lit >= 12 && map.crosswalks.len() - lit >= 6);
    assert!(map.lanes.iter().all(|l| l.speed_limit_mps < 31.0 / 3.6));
}

#[test]
fn the_suburb_has_gardens_a_roundabout_and_loops_to_turn() {
    let map = bundled("suburb").unwrap();
    assert_eq!(crate::map_data::circles(&map.lanes).len(), 1);
    let props = |kind| map.props.iter().filter(|p| p.kind == kind).count();
    assert!(props(PropKind::Building) > 200 && props(PropKind::ParkedCar) > 200);
    assert!(props(PropKind::Hedge) > 300 && props(PropKind::Fence) > 150 && props(PropKind::Tree) > 400);
    assert!(
        map.lanes.iter().any(|l| l.kind == LaneKind::Biking) && map.lanes.iter().any(|l| l.kind == LaneKind::Parking)
    );
    assert_eq!(map.bus_stops.len(), 6);
    let limits: Vec<f32> = map.lanes.iter().map(|l| (l.speed_limit_mps * 3.6).round()).collect();
    assert!(limits.contains(&30.0) && limits.contains(&50.0));
}
