//! A crossroads built in code: four arms, sidewalks around each corner, a crosswalk over each arm.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::map::{
    Conflict, Crosswalk, Junction, Lane, LaneId, LaneKind, LanePoint, LightGroup, MapData, RoadNetwork, StopKind,
    StopLine, Turn, WalkEdge, WalkNode,
};
use crate::{map, ops};

/// Length of an arm, metres.
pub const ARM_M: f32 = 180.0;
/// From the middle to where the arms begin, metres.
const BOX_M: f32 = 14.0;
/// Width of a lane, metres.
const LANE_M: f32 = 3.5;
/// From the middle of the road to the middle of its sidewalk, metres.
const WALK_M: f32 = 5.0;

/// What stands at the stop lines.
#[derive(Clone, Copy, PartialEq)]
pub enum Signs {
    Lights,
    StopOnTwo,
    Yield,
}

fn turned(p: Vec2, arm: usize) -> Vec2 {
    [p, p.perp(), -p, -p.perp()][arm]
}

fn lane(points: &[Vec2], name: String) -> Lane {
    let mut s_m = 0.0;
    let direction = |i: usize| (points[(i + 1).min(points.len() - 1)] - points[i.min(points.len() - 2)]).normalize();
    let points: Vec<LanePoint> = (0..points.len())
        .map(|i| {
            s_m += if i > 0 { points[i].distance(points[i - 1]) } else { 0.0 };
            let d = direction(i);
            LanePoint {
                position: points[i].extend(0.0),
                heading_rad: ops::atan2(d.y, d.x),
                half_width_m: LANE_M / 2.0,
                s_m,
            }
        })
        .collect();
    Lane {
        kind: LaneKind::Driving,
        name,
        points,
        length_m: s_m,
        successors: Vec::new(),
        predecessors: Vec::new(),
        left: None,
        right: None,
        speed_limit_mps: 50.0 / 3.6,
        junction: None,
        turn: Turn::Straight,
        stop: None,
        light: None,
        conflicts: Vec::new(),
    }
}

fn line(from: Vec2, to: Vec2) -> Vec<Vec2> {
    let n = (from.distance(to) / 2.0).ceil() as usize;
    (0..=n).map(|i| from.lerp(to, i as f32 / n as f32)).collect()
}

/// A cubic curve with the given ends and directions.
fn curve(from: Vec2, out: Vec2, to: Vec2, into: Vec2) -> Vec<Vec2> {
    let reach = from.distance(to) * 0.4;
    let (a, b) = (from + out * reach, to - into * reach);
    let at = |t: f32| {
        let u = 1.0 - t;
        from * (u * u * u) + a * (3.0 * u * u * t) + b * (3.0 * u * t * t) + to * (t * t * t)
    };
    (0..=16).map(|i| at(i as f32 / 16.0)).collect()
}

/// Stretch of `lane` that is nearer than a lane's width to `other`.
fn overlap(lane: &Lane, other: &Lane) -> Option<(f32, f32)> {
    let near = |p: &&LanePoint| other.points.iter().any(|q| q.position.distance(p.position) < LANE_M * 0.8);
    let mut inside = lane.points.iter().filter(near).map(|p| p.s_m);
    let first = inside.next()?;
    Some((first, inside.next_back().unwrap_or(first)))
}

/// The crossroads with the given signs.
pub fn crossroads(signs: Signs) -> Arc<RoadNetwork> {
    let mut lanes = Vec::new();
    let offset = LANE_M / 2.0;
    for arm in 0..4 {
        let inward = line(Vec2::new(BOX_M + ARM_M, offset), Vec2::new(BOX_M, offset));
        let outward = line(Vec2::new(BOX_M, -offset), Vec2::new(BOX_M + ARM_M, -offset));
        // Seen from the middle an arm runs along +x: traffic towards it keeps to its right, y > 0.
        let turn_all = |points: Vec<Vec2>| points.into_iter().map(|p| turned(p, arm)).collect::<Vec<_>>();
        lanes.push(lane(&turn_all(inward), format!("in{arm}")));
        lanes.push(lane(&turn_all(outward), format!("out{arm}")));
    }
    for (i, l) in lanes.iter_mut().enumerate().filter(|(i, _)| i % 2 == 0) {
        let kind = match signs {
            Signs::Lights => StopKind::Light((i / 2) as u32),
            Signs::StopOnTwo if (i / 2) % 2 == 1 => StopKind::Stop,
            _ => StopKind::Yield,
        };
        l.stop = Some(StopLine { s_m: l.length_m - 6.0, kind });
    }
    add_turns(&mut lanes);
    add_conflicts(&mut lanes, signs);
    let junction_lanes: Vec<LaneId> = (8..lanes.len() as u32).collect();
    let lights = if signs == Signs::Lights { (0..4).collect() } else { Vec::new() };
    // One approach after the other: green 10 s, yellow 3 s, then 2 s in which all are red.
    let cycle_ticks = 900 * lights.len() as u32;
    let light = |g: &u32| LightGroup { junction: 0, green_from_ticks: 900 * g, green_ticks: 600, yellow_ticks: 180 };
    let light_groups = lights.iter().map(light).collect();
    let (name, center) = ("1".into(), Vec3::ZERO);
    let junction = Junction { name, lanes: junction_lanes, light_groups: lights, cycle_ticks, center };
    let (crosswalks, walk_nodes, walk_edges) = walks(signs);
    let map = MapData {
        name: "crossroads".into(),
        digest: 0,
        lanes,
        junctions: vec![junction],
        light_groups,
        light_heads: Vec::new(),
        bus_stops: Vec::new(),
        crosswalks,
        walk_nodes,
        walk_edges,
        surfaces: Vec::new(),
        props: Vec::new(),
        bounds: [Vec3::splat(-250.0), Vec3::splat(250.0)],
        origin_m: [0.0; 2],
    };
    Arc::new(map.into())
}

fn add_turns(lanes: &mut Vec<Lane>) {
    for from in 0..4 {
        for (k, turn) in [(1, Turn::Left), (2, Turn::Straight), (3, Turn::Right)] {
            let to = (from + 4 - k) % 4;
            let (a, b) = (lanes[from * 2].points.clone(), lanes[to * 2 + 1].points.clone());
            let (start, end) = (a[a.len() - 1].position.truncate(), b[0].position.truncate());
            let points = curve(start, turned(-Vec2::X, from), end, turned(Vec2::X, to));
            let id = lanes.len() as LaneId;
            let mut l = lane(&points, format!("{from}->{to}"));
            (l.junction, l.turn) = (Some(0), turn);
            (l.predecessors, l.successors) = (vec![from as u32 * 2], vec![to as u32 * 2 + 1]);
            lanes[from * 2].successors.push(id);
            lanes[to * 2 + 1].predecessors.push(id);
            lanes.push(l);
        }
    }
}

fn add_conflicts(lanes: &mut [Lane], signs: Signs) {
    for a in 8..lanes.len() {
        for b in (8..lanes.len()).filter(|b| *b != a) {
            let Some((from_m, to_m)) = overlap(&lanes[a], &lanes[b]) else { continue };
            let (mine, theirs) = ((a - 8) / 3, (b - 8) / 3);
            let minor = |arm: usize| signs == Signs::StopOnTwo && arm % 2 == 1;
            let right = (mine + 1) % 4 == theirs;
            let opposed = (mine + 2) % 4 == theirs && lanes[a].turn == Turn::Left && lanes[b].turn != Turn::Left;
            let equal = minor(mine) == minor(theirs);
            let other_first = if equal { right || opposed } else { minor(mine) };
            lanes[a].conflicts.push(Conflict { lane: b as LaneId, from_m, to_m, other_first });
        }
    }
}

fn walks(signs: Signs) -> (Vec<Crosswalk>, Vec<WalkNode>, Vec<WalkEdge>) {
    let mut nodes = Vec::new();
    let mut edges: Vec<WalkEdge> = Vec::new();
    let mut crosswalks = Vec::new();
    let x = BOX_M + 3.0;
    for arm in 0..4 {
        for p in [
            Vec2::new(x, WALK_M),
            Vec2::new(x, -WALK_M),
            Vec2::new(x + ARM_M - 5.0, WALK_M),
            Vec2::new(x + ARM_M - 5.0, -WALK_M),
        ] {
            nodes.push(WalkNode { position: turned(p, arm).extend(0.0), edges: Vec::new() });
        }
    }
    let at = |n: u32| nodes[n as usize].position;
    let mut add = |a: u32, b: u32, via: &[Vec3], crosswalk, beside| {
        let points: Vec<Vec3> = [&[at(a)], via, &[at(b)]].concat();
        let length_m = points.windows(2).map(|w| w[0].distance(w[1])).sum();
        edges.push(WalkEdge { nodes: [a, b], points, half_width_m: 1.0, length_m, crosswalk, beside });
    };
    for arm in 0..4u32 {
        let n = arm * 4;
        add(n, n + 1, &[], Some(arm), None);
        add(n, n + 2, &[], None, Some(arm * 2));
        add(n + 3, n + 1, &[], None, Some(arm * 2 + 1));
        let corner = turned(Vec2::new(WALK_M + 3.0, WALK_M + 3.0), arm as usize).extend(0.0);
        add(n, (n + 4) % 16 + 1, &[corner], None, None);
        let kerb = |y: f32| turned(Vec2::new(x, y), arm as usize).extend(0.0);
        crosswalks.push(Crosswalk {
            ends: [kerb(LANE_M), kerb(-LANE_M)],
            half_width_m: 1.5,
            lanes: vec![(arm * 2, ARM_M - 3.0), (arm * 2 + 1, 3.0)],
            junction: (signs == Signs::Lights).then_some(0),
        });
    }
    for (i, e) in edges.iter().enumerate() {
        for n in e.nodes {
            nodes[n as usize].edges.push(i as map::WalkEdgeId);
        }
    }
    (crosswalks, nodes, edges)
}
