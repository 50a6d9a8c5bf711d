//! Questions about places.

use super::*;

#[test]
fn a_lane_point_projects_onto_itself() {
    let map = bundled("city").unwrap();
    for (id, lane) in map.lanes.iter().enumerate().filter(|(_, l)| l.kind == LaneKind::Driving) {
        for share in [0.1, 0.5, 0.9] {
            let s = lane.length_m * share;
            let p = map.lane_point(id as LaneId, s);
            let back = map.project(id as LaneId, p.position);
            assert!((back.s_m - s).abs() < 0.02 && back.distance_m < 0.01, "{}: {back:?}", lane.name);
            let left = p.position + direction(p.heading_rad).perp().extend(0.0);
            assert!((map.project(id as LaneId, left).lateral_m - 1.0).abs() < 0.05);
        }
    }
}

#[test]
fn lane_points_are_clamped_to_the_lane() {
    let map = bundled("city").unwrap();
    assert_eq!(map.lane_point(0, -5.0), *map.lanes[0].start());
    assert_eq!(map.lane_point(0, 1e6).position, map.lanes[0].end().position);
}

#[test]
fn the_grid_finds_what_a_search_of_all_lanes_finds() {
    let map = bundled("rural").unwrap();
    for k in 0..200u64 {
        let draw = |n| crate::rng::unit(1, crate::rng::Stream::Dressing, k, n);
        let [low, high] = map.bounds;
        let mut p = Vec3::new(low.x + (high.x - low.x) * draw(0), low.y + (high.y - low.y) * draw(1), 0.0);
        let ids = (0..map.lanes.len() as LaneId).filter(|&id| map.lanes[id as usize].kind == LaneKind::Driving);
        let all = ids.map(|id| map.project(id, p));
        let nearest = all
            .min_by(|a, b| map.places().roads().beyond_edge(a).total_cmp(&map.places().roads().beyond_edge(b)))
            .unwrap();
        p.z = map.lane_point(nearest.lane, nearest.s_m).position.z;
        match map.nearest_lane(p, LaneKind::Driving, None, 80.0) {
            Some(found) => {
                assert!(map.places().roads().beyond_edge(&found) <= map.places().roads().beyond_edge(&nearest) + 0.5)
            }
            None => assert!(map.places().roads().beyond_edge(&nearest) > 80.0, "{p}: {nearest:?}"),
        }
    }
}

/// To the bit: what is left out of lanes could not be nearest.
#[test]
fn lanes_are_projected_onto_as_if_all_of_them_were_looked_at() {
    let mut seen = [0; 3];
    for name in ["old_town", "motorway"] {
        let map = bundled(name).unwrap();
        for (k, lane) in map.lanes.iter().enumerate().flat_map(|(id, lane)| [id; 12].map(|id| (id, lane))).enumerate() {
            let (id, lane) = lane;
            let draw = |n| crate::rng::unit(1, crate::rng::Stream::Dressing, k as u64, n);
            // Vertices are where stretches tie.
            let on = if k % 2 == 0 { lane.at(lane.length_m * draw(0)) } else { lane.points[k % lane.points.len()] };
            let off_m = [0.0, 0.3, 5.0, 40.0][k % 4];
            let p = on.position + off_m * Vec3::new(draw(1) - 0.5, draw(2) - 0.5, 0.0);
            for found in map.places().roads().around(p, lane.kind, 8.0) {
                let lane = &map.lanes[found.lane as usize];
                assert_eq!(found, Projection::onto(found.lane, lane, p), "{name}, lane {id}");
                seen[usize::from(lane.points.len() > 16) + usize::from(lane.points.len() > 256)] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&found| found > 1000), "{seen:?}");
}

#[test]
fn heading_chooses_among_lanes_that_overlap() {
    let map = bundled("city").unwrap();
    for (id, lane) in map.lanes.iter().enumerate().filter(|(_, l)| l.junction.is_some() && l.kind == LaneKind::Driving)
    {
        let p = lane.at(lane.length_m / 2.0);
        let found = map.nearest_lane(p.position, LaneKind::Driving, Some(p.heading_rad), 2.0).unwrap();
        let misfit = crate::ops::wrap_angle(map.lane_point(found.lane, found.s_m).heading_rad - p.heading_rad);
        assert!(misfit.abs() < 0.01, "{id}");
    }
}

#[test]
fn the_edge_of_the_road_is_its_edge() {
    let map = bundled("rural").unwrap();
    let lane = map.lanes.iter().find(|l| l.kind == LaneKind::Driving && l.junction.is_none()).unwrap();
    let p = lane.at(50.0);
    let right = -direction(p.heading_rad).perp().extend(0.0);
    assert!(map.on_road(p.position + right * (p.half_width_m - 0.05)));
    assert!(!map.on_road(p.position + right * (p.half_width_m + 0.05)));
    assert_eq!(map.ground(p.position + right * 12.0).unwrap().kind, SurfaceKind::Terrain);
    assert!(map.ground(map.bounds[1] + Vec3::splat(50.0)).is_none());
}
