//! The lanes of a map, each with its own two edges, in the direction of travel.

use glam::Vec3;
use kernel::geometry::direction;
use kernel::map::{Lane as Known, LaneId, LaneKind, LanePoint, MapData};

use super::ids;
use super::messages::{
    BoundaryKind, BoundaryPoint, Identifier, Lane, LaneBoundary, LaneBoundaryClassification, LaneClassification,
    LanePairing, LaneSubtype, LaneType,
};
use super::place::Frame;

/// All lanes.
pub fn lanes(map: &MapData, frame: Frame) -> Vec<Lane> {
    (0..).zip(&map.lanes).map(|(id, lane)| of(id, lane, frame)).collect()
}

/// The left and the right edge of each lane.
pub fn boundaries(map: &MapData, frame: Frame) -> Vec<LaneBoundary> {
    (0..).zip(&map.lanes).flat_map(|(id, lane)| edges(id, lane, frame)).collect()
}

fn of(id: LaneId, lane: &Known, frame: Frame) -> Lane {
    let [left, right] = ids::boundaries(id);
    let (kind, subtype) = kinds(lane);
    let beside = |neighbour: Option<LaneId>| neighbour.map(ids::lane).into_iter().collect();
    Lane {
        id: ids::lane(id),
        classification: LaneClassification {
            r#type: kind as i32,
            centerline: lane.points.iter().map(|point| frame.place(point.position)).collect(),
            centerline_is_driving_direction: true,
            left_adjacent_lane_id: beside(lane.left),
            right_adjacent_lane_id: beside(lane.right),
            lane_pairing: pairings(lane),
            right_lane_boundary_id: vec![right],
            left_lane_boundary_id: vec![left],
            subtype: subtype as i32,
        },
    }
}

/// A way through a junction is a lane of its own, since the map knows ways, and not the area that they share.
fn kinds(lane: &Known) -> (LaneType, LaneSubtype) {
    let subtype = match lane.kind {
        LaneKind::Driving => LaneSubtype::Normal,
        LaneKind::Biking => LaneSubtype::Biking,
        LaneKind::Sidewalk => LaneSubtype::Sidewalk,
        LaneKind::Shoulder => LaneSubtype::Shoulder,
        LaneKind::Parking => LaneSubtype::Parking,
        LaneKind::Other => LaneSubtype::Other,
    };
    let kind = match (lane.kind, lane.junction) {
        (LaneKind::Driving, Some(_)) => LaneType::Intersection,
        (LaneKind::Driving, None) => LaneType::Driving,
        _ => LaneType::NonDriving,
    };
    (kind, subtype)
}

/// Every way over a lane; where it begins or ends one side is empty.
fn pairings(lane: &Known) -> Vec<LanePairing> {
    let ends = |lanes: &[LaneId]| -> Vec<Option<Identifier>> {
        let known = lanes.iter().map(|id| Some(ids::lane(*id)));
        if lanes.is_empty() { vec![None] } else { known.collect() }
    };
    let successors = ends(&lane.successors);
    let pair = |from: Option<Identifier>| {
        let to = successors.iter().copied();
        to.map(move |to| LanePairing { antecessor_lane_id: from, successor_lane_id: to })
    };
    let pairs = ends(&lane.predecessors).into_iter().flat_map(pair);
    pairs.filter(|pair| pair.antecessor_lane_id.is_some() || pair.successor_lane_id.is_some()).collect()
}

fn edges(id: LaneId, lane: &Known, frame: Frame) -> [LaneBoundary; 2] {
    let [left, right] = ids::boundaries(id);
    let edge = |id: Identifier, side: f32| LaneBoundary {
        id,
        boundary_line: lane.points.iter().map(|p| BoundaryPoint { position: frame.place(beside(p, side)) }).collect(),
        classification: LaneBoundaryClassification { r#type: BoundaryKind::Other as i32 },
    };
    [edge(left, 1.0), edge(right, -1.0)]
}

/// The place half a width to the left, or for -1 to the right.
fn beside(point: &LanePoint, side: f32) -> Vec3 {
    let to_left = direction(point.heading_rad).perp();
    point.position + (side * point.half_width_m * to_left).extend(0.0)
}

#[cfg(test)]
mod tests {
    use kernel::map::bundled;

    use super::*;

    #[test]
    fn a_lane_lies_between_its_edges_and_leads_on() {
        let map = bundled("city").expect("bundled");
        let frame = Frame { origin_m: [1000.0, 0.0] };
        let (lanes, edges) = (lanes(&map, frame), boundaries(&map, frame));
        assert_eq!((lanes.len(), edges.len()), (map.lanes.len(), 2 * map.lanes.len()));
        for ((known, lane), pair) in map.lanes.iter().zip(&lanes).zip(edges.chunks(2)) {
            let class = &lane.classification;
            assert_eq!(class.left_lane_boundary_id, [pair[0].id]);
            assert_eq!(class.right_lane_boundary_id, [pair[1].id]);
            let (at, left, right) = (class.centerline[0], pair[0].boundary_line[0], pair[1].boundary_line[0]);
            let middle = |a: f64, b: f64| 0.5 * (a + b);
            assert!((middle(left.position.x, right.position.x) - at.x).abs() < 1e-3);
            assert!((middle(left.position.y, right.position.y) - at.y).abs() < 1e-3);
            assert!((at.x - 1000.0 - f64::from(known.start().position.x)).abs() < 1e-9);
            let ways = known.predecessors.len().max(1) * known.successors.len().max(1);
            let expected = if known.predecessors.is_empty() && known.successors.is_empty() { 0 } else { ways };
            assert_eq!(class.lane_pairing.len(), expected, "{}", known.name);
        }
        let kinds: Vec<i32> = lanes.iter().map(|lane| lane.classification.r#type).collect();
        let all = [LaneType::Driving, LaneType::NonDriving, LaneType::Intersection];
        assert!(all.iter().all(|kind| kinds.contains(&(*kind as i32))));
    }
}
