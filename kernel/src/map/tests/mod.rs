//! What must hold for maps: any map, each feature, the bundled ones, and broken files.

mod broken;
mod bundled;
mod far;
mod features;
mod notes;
mod paint;
mod places;
mod signals;
mod structures;

use glam::Vec3;

use super::*;
use crate::geometry::direction;

/// What holds for every baked map.
fn check_sound(map: &RoadNetwork) {
    map.lanes.iter().enumerate().for_each(|(id, lane)| check_lane(map, id as LaneId, lane));
    map.surfaces.iter().for_each(check_surface);
    map.walk_edges.iter().for_each(|e| check_walk(map, e));
    // Decks and piers are below the road.
    let carries = |p: &Prop| p.kind == PropKind::Bridge && p.size.y > 0.5;
    for prop in map.props.iter().filter(|p| p.kind != PropKind::SignalPole && !carries(p)) {
        assert!(prop.size.is_finite() && prop.size.min_element() > 0.0, "{prop:?} has a size");
        check_rounded(prop.position);
        let on_sidewalk =
            map.lanes_at(prop.position, LaneKind::Sidewalk).iter().any(|p| map.places().roads().beyond_edge(p) < -0.05);
        assert!(!map.on_road(prop.position) && !on_sidewalk, "{prop:?} stands in the way");
    }
    for crosswalk in &map.crosswalks {
        assert!(!crosswalk.lanes.is_empty());
        crosswalk.lanes.iter().for_each(|&(l, s)| assert!(s <= map.lanes[l as usize].length_m));
    }
}

fn check_lane(map: &RoadNetwork, id: LaneId, lane: &Lane) {
    let name = &lane.name;
    assert!(lane.points.len() >= 2, "lane {name} has a line");
    assert_eq!(lane.end().s_m, lane.length_m, "lane {name} ends at its length");
    for pair in lane.points.windows(2) {
        let step = pair[1].position.distance(pair[0].position);
        assert!(step <= 2.02 && pair[1].s_m > pair[0].s_m, "lane {name}: {pair:?}");
        check_rounded(pair[0].position);
        let along = (pair[1].position - pair[0].position).truncate();
        let ahead = direction(pair[0].heading_rad);
        assert!(step < 0.2 || along.dot(ahead) > 0.9 * along.length(), "lane {name} is driven forwards: {pair:?}");
    }
    for &next in &lane.successors {
        let to = &map.lanes[next as usize];
        assert!(to.predecessors.contains(&id) && to.kind == lane.kind, "lane {name} is known to its successor");
    }
    for side in [lane.left, lane.right].into_iter().flatten() {
        assert_eq!(map.lanes[side as usize].kind, LaneKind::Driving, "beside lane {name} one can drive");
    }
    if let Some(stop) = lane.stop {
        assert!((0.0..=lane.length_m).contains(&stop.s_m));
    }
    for conflict in &lane.conflicts {
        let other = &map.lanes[conflict.lane as usize];
        assert!(conflict.from_m <= conflict.to_m && conflict.to_m <= lane.length_m);
        if let Some(back) = other.conflicts.iter().find(|c| c.lane == id) {
            assert!(!(back.other_first && conflict.other_first), "lanes {name} and {} wait for each other", other.name);
        }
    }
}

fn check_surface(surface: &Surface) {
    surface.positions.iter().for_each(|&p| check_rounded(p));
    for t in &surface.triangles {
        let [a, b, c] = t.map(|v| surface.positions[v as usize]);
        let normal = (b - a).cross(c - a);
        assert!(normal.z > -1e-3, "{:?} faces up: {a} {b} {c}", surface.kind);
    }
}

fn check_walk(map: &RoadNetwork, edge: &WalkEdge) {
    let ends = [edge.points[0], edge.points[edge.points.len() - 1]];
    for (node, end) in edge.nodes.iter().zip(ends) {
        assert_eq!(map.walk_nodes[*node as usize].position, end);
    }
    if edge.crosswalk.is_none() {
        edge.points.iter().for_each(|&p| assert!(!map.on_road(p), "a sidewalk runs beside the road at {p}"));
    }
}

fn check_rounded(p: Vec3) {
    let scaled = p * 1024.0;
    assert!(p.is_finite() && scaled == scaled.round(), "{p} is rounded to 2^-10 m");
}

/// Parts of the walk graph that hang together, largest first, by their count of nodes.
fn walkable_parts(map: &RoadNetwork) -> Vec<usize> {
    let mut seen = vec![false; map.walk_nodes.len()];
    let mut parts = Vec::new();
    for start in 0..map.walk_nodes.len() {
        let (mut open, mut count) = (vec![start], 0);
        while let Some(n) = open.pop() {
            if !std::mem::replace(&mut seen[n], true) {
                count += 1;
                let edges = map.walk_nodes[n].edges.iter().flat_map(|&e| map.walk_edges[e as usize].nodes);
                open.extend(edges.map(|n| n as usize));
            }
        }
        parts.push(count);
    }
    parts.sort_unstable_by(|a, b| b.cmp(a));
    parts.retain(|&n| n > 0);
    parts
}
