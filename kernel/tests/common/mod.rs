//! A small map and a scripted pair of drivers, for tests that need a whole world.
#![allow(dead_code, reason = "each test file uses some of it")]

pub mod script;

use std::f32::consts::TAU;
use std::sync::Arc;

use glam::Vec3;
use kernel::map::{
    Junction, Lane, LaneId, LaneKind, LanePoint, LightGroup, MapData, Prop, PropKind, RoadNetwork, StopKind, StopLine,
    Surface, SurfaceKind, Turn, WalkEdge, WalkNode,
};
use kernel::ops;
use kernel::scenario::Scenario;

/// Radius of the ring road's middle, metres.
pub const RING_M: f32 = 80.0;
const LANE_M: f32 = 3.5;
/// Lanes in each direction around the ring.
const ARCS: u32 = 8;
/// The arc that is a junction with a light.
const LIT_ARC: u32 = 4;

/// A ring road: [`ARCS`] lanes counter-clockwise outside, as many clockwise inside, a light before
/// the lane [`LIT_ARC`], a footpath around it, grass, and trees beyond the path.
pub fn ring() -> Arc<RoadNetwork> {
    let mut network = MapData { name: String::from("ring"), ..MapData::default() };
    for inside in [false, true] {
        network.lanes.extend((0..ARCS).map(|arc| lane(arc, inside)));
    }
    network.junctions.push(Junction {
        lanes: vec![LIT_ARC],
        light_groups: vec![0, 1],
        cycle_ticks: 1800,
        ..Default::default()
    });
    let light = |k: u32| LightGroup { junction: 0, green_from_ticks: 900 * k, green_ticks: 600, yellow_ticks: 180 };
    network.light_groups = (0..2).map(light).collect();
    network.surfaces = vec![
        band(SurfaceKind::Road, RING_M - LANE_M, RING_M + LANE_M, 0.0),
        band(SurfaceKind::Sidewalk, RING_M + LANE_M, RING_M + 2.0 * LANE_M, 0.12),
        band(SurfaceKind::Terrain, RING_M + 2.0 * LANE_M, 300.0, 0.0),
        band(SurfaceKind::Terrain, 1.0, RING_M - LANE_M, 0.0),
    ];
    network.bounds = [Vec3::new(-300.0, -300.0, 0.0), Vec3::new(300.0, 300.0, 10.0)];
    let tree = |i: u32| Prop {
        kind: PropKind::Tree,
        position: on_circle(RING_M + 3.0 * LANE_M, TAU * i as f32 / 40.0),
        heading_rad: 0.0,
        size: Vec3::new(4.0, 4.0, 6.0),
        variant: 0,
    };
    network.props = (0..40).map(tree).collect();
    footpath(&mut network);
    Arc::new(network.into())
}

/// A scenario with traffic on the ring.
pub fn on_ring(seed: u64) -> Scenario {
    let mut scenario = Scenario::default_for("ring", seed);
    scenario.traffic.cars = 8;
    scenario.traffic.motorcycles = 2;
    scenario.traffic.bicycles = 2;
    scenario.traffic.pedestrians = 12;
    scenario.traffic.jaywalks_per_min = 6.0;
    scenario
}

fn on_circle(radius_m: f32, angle_rad: f32) -> Vec3 {
    Vec3::new(radius_m * ops::cos(angle_rad), radius_m * ops::sin(angle_rad), 0.0)
}

fn lane(arc: u32, inside: bool) -> Lane {
    let radius = if inside { RING_M - LANE_M / 2.0 } else { RING_M + LANE_M / 2.0 };
    let sense = if inside { -1.0 } else { 1.0 };
    let length_m = radius * TAU / ARCS as f32;
    let steps = 40;
    let point = |i: u32| {
        let along = i as f32 / steps as f32;
        let angle = sense * TAU * (arc as f32 + along) / ARCS as f32;
        LanePoint {
            position: on_circle(radius, angle),
            heading_rad: ops::wrap_angle(angle + sense * TAU / 4.0),
            half_width_m: LANE_M / 2.0,
            s_m: along * length_m,
        }
    };
    let id = |arc: u32| -> LaneId { arc % ARCS + if inside { ARCS } else { 0 } };
    let lit = !inside && arc == LIT_ARC;
    Lane {
        kind: LaneKind::Driving,
        name: format!("{arc}/{inside}"),
        points: (0..=steps).map(point).collect(),
        length_m,
        successors: vec![id(arc + 1)],
        predecessors: vec![id(arc + ARCS - 1)],
        left: None,
        right: None,
        speed_limit_mps: 50.0 / 3.6,
        junction: lit.then_some(0),
        turn: if lit { Turn::Left } else { Turn::Straight },
        stop: (!inside && arc + 1 == LIT_ARC).then_some(StopLine { s_m: length_m - 2.0, kind: StopKind::Light(0) }),
        light: None,
        conflicts: vec![],
    }
}

/// The area between two circles, with a step up of `height_m`.
fn band(kind: SurfaceKind, inner_m: f32, outer_m: f32, height_m: f32) -> Surface {
    let parts = 160;
    let corner = |i: u32| {
        let angle = TAU * (i / 2) as f32 / parts as f32;
        on_circle(if i.is_multiple_of(2) { inner_m } else { outer_m }, angle) + Vec3::Z * height_m
    };
    let quad = |i: u32| {
        let [a, b, c, d] = [2 * i, 2 * i + 1, (2 * i + 2) % (2 * parts), (2 * i + 3) % (2 * parts)];
        [[a, b, d], [a, d, c]]
    };
    Surface { kind, positions: (0..2 * parts).map(corner).collect(), triangles: (0..parts).flat_map(quad).collect() }
}

fn footpath(network: &mut MapData) {
    let radius = RING_M + 1.5 * LANE_M;
    for edge in 0..ARCS {
        let angle = |along: u32| TAU * (edge as f32 + along as f32 / 20.0) / ARCS as f32;
        let points: Vec<Vec3> = (0..=20).map(|along| on_circle(radius, angle(along)) + Vec3::Z * 0.12).collect();
        network.walk_nodes.push(WalkNode { position: points[0], edges: vec![edge, (edge + ARCS - 1) % ARCS] });
        network.walk_edges.push(WalkEdge {
            nodes: [edge, (edge + 1) % ARCS],
            length_m: points.windows(2).map(|pair| (pair[1] - pair[0]).length()).sum(),
            points,
            half_width_m: 1.2,
            crosswalk: None,
            beside: Some(edge),
        });
    }
}
