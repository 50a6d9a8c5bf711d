//! A map from above, as the report and the control centre draw it.

use glam::{Vec2, Vec3Swizzles};
use kernel::RoadNetwork;
use kernel::geometry::direction;
use kernel::map::{LaneKind, LanePoint, Prop, PropKind};

/// Room around the roads, metres.
const MARGIN_M: f32 = 15.0;
/// Points of a lane that are closer than this are left out, metres.
const STEP_M: f32 = 3.0;

/// The lines and areas of a map, metres, x east and y north.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Centre lines of the driving lanes, thinned out.
    pub lanes: Vec<Vec<Vec2>>,
    /// Corners of the houses near the roads, counter-clockwise.
    pub houses: Vec<[Vec2; 4]>,
    /// South-west corner.
    pub low: Vec2,
    /// North-east corner.
    pub high: Vec2,
}

impl Chart {
    /// That of a map.
    pub fn of(network: &RoadNetwork) -> Self {
        let driving = network.lanes.iter().filter(|lane| lane.kind == LaneKind::Driving);
        let lanes: Vec<_> = driving.map(|lane| thinned(&lane.points)).collect();
        let (low, high) = bounds(lanes.iter().flatten());
        let inside = |prop: &&Prop| {
            let place = prop.position.xy();
            prop.kind == PropKind::Building && place.cmpge(low).all() && place.cmple(high).all()
        };
        let houses = network.props.iter().filter(inside).map(corners).collect();
        Self { lanes, houses, low, high }
    }
}

fn thinned(points: &[LanePoint]) -> Vec<Vec2> {
    let mut kept: Vec<Vec2> = Vec::new();
    for (i, point) in points.iter().enumerate() {
        let place = point.position.xy();
        let is_far = kept.last().is_none_or(|last| last.distance(place) >= STEP_M);
        if is_far || i + 1 == points.len() {
            kept.push(place);
        }
    }
    kept
}

fn bounds<'a>(points: impl Iterator<Item = &'a Vec2>) -> (Vec2, Vec2) {
    let grow = |(low, high): (Vec2, Vec2), p: &Vec2| (low.min(*p), high.max(*p));
    let (low, high) = points.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), grow);
    if low.is_finite() { (low - MARGIN_M, high + MARGIN_M) } else { (Vec2::ZERO, Vec2::ONE) }
}

fn corners(prop: &Prop) -> [Vec2; 4] {
    let forward = direction(prop.heading_rad);
    let (forward, left) = (forward * (0.5 * prop.size.x), forward.perp() * (0.5 * prop.size.y));
    [forward + left, left - forward, -forward - left, forward - left].map(|corner| prop.position.xy() + corner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::Map;

    #[test]
    fn lanes_and_houses_of_the_bundled_maps_are_within_bounds() {
        for name in kernel::map::BUNDLED {
            let chart = Chart::of(&Map::find(name).expect("bundled").network);
            assert!(chart.lanes.iter().map(Vec::len).sum::<usize>() > 50, "{name}");
            let inside = |p: &Vec2| p.cmpge(chart.low).all() && p.cmple(chart.high).all();
            assert!(chart.lanes.iter().flatten().all(inside), "{name}");
            let area = |[a, b, c, d]: [Vec2; 4]| 0.5 * (c - a).perp_dot(d - b);
            assert!(chart.houses.iter().all(|house| area(*house) > 1.0), "{name}: counter-clockwise");
        }
    }
}
