//! Lookups of a map, made once: curve speeds, directions, what follows, where lanes conflict and meet.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::links::{LEAST_HALF_M, Onward, ends_beside, onward};
use super::meets::{Meet, meets};
use super::routes::{Class, Routes};
use super::walker::Walker;
use super::zones::zones;
use crate::actor::ActorKind;
use crate::map_data::{
    Conflict, Crosswalk, Lane, LaneId, LaneKind, LanePoint, LightGroupId, MapData, Place, StopKind, Turn, WalkEdgeId,
};
use crate::ops;
use crate::places::Places;

/// Sideways acceleration that drivers accept in curves, m/s² (comfort limit of road design).
const CURVE_ACCEL_MPS2: f32 = 2.0;
/// Braking before curves, m/s².
const CURVE_BRAKE_MPS2: f32 = 1.8;
/// Nobody drives slower than this because of a curve, m/s.
const CURVE_FLOOR_MPS: f32 = 2.5;
/// Sidewalks farther apart than this do not face each other across a road, metres.
const FACING_M: f32 = 32.0;

/// Long vehicles sweep into lanes whose middles come within this, metres.
const SWEPT_M: f32 = 5.0;
/// Lanes whose edges come within this of where another begins lie beside it, metres.
const FROM_BEFORE_M: f32 = 2.0;

/// How two lanes of a junction conflict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ConflictKind {
    /// They leave the same lane.
    Diverge,
    /// They enter the same lane.
    Merge,
    /// They cross.
    Cross,
}

/// A conflict seen from one lane, with the other lane's side of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneConflict {
    pub lane: LaneId,
    pub kind: ConflictKind,
    /// Stretch of this lane, metres.
    pub here: [f32; 2],
    /// Stretch of the other lane, metres.
    pub there: [f32; 2],
    /// 1 when traffic here goes first, -1 when the other does, 0 when neither has a right.
    pub precedence: i8,
}

/// A crosswalk on a lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct CrosswalkSpan {
    pub crosswalk: u32,
    /// Its near edge, metres from the lane's start.
    pub near_m: f32,
    /// Its far edge.
    pub far_m: f32,
}

#[derive(Clone, Debug, Default)]
pub(super) struct LaneWay {
    /// Highest speed at each point: curves, and braking for those ahead on the lane. m/s.
    pub speed_mps: Vec<f32>,
    /// Direction of travel from each point to the next.
    pub forward: Vec<Vec3>,
    /// Where vehicles go on.
    pub onward: Vec<Onward>,
    /// Where long vehicles do: no right turns, where there is another way.
    pub onward_wide: Vec<Onward>,
    /// Where it is wide enough no more, if it ends beside another lane, metres from its start.
    pub ends_m: Option<f32>,
    /// Lanes of the same junction that overlap it.
    pub conflicts: Vec<LaneConflict>,
    /// Lanes of the same junction beside it, into which a long vehicle sweeps.
    pub swept: Vec<LaneId>,
    /// Lanes that it meets outside junctions.
    pub meets: Vec<Meet>,
    /// Its zone: junctions without room to wait between them are one.
    pub zone: Option<u32>,
    /// Crosswalks on it, in the direction of travel.
    pub crosswalks: Vec<CrosswalkSpan>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct EdgeWay {
    /// Distance of each point from the first, metres.
    pub s_m: Vec<f32>,
    /// Direction from each point to the next.
    pub forward: Vec<Vec3>,
    /// Sidewalks that may lie across the road.
    pub facing: Vec<u32>,
}

/// What traffic looks up in a map.
#[derive(Debug)]
pub struct Ways {
    /// The map with its places.
    pub(super) places: Arc<Places>,
    pub(super) lanes: Vec<LaneWay>,
    pub(super) routes: Routes,
    pub(super) edges: Vec<EdgeWay>,
    /// Light groups that must be red for each crosswalk; empty for one without.
    pub(super) crosswalk_lights: Vec<Vec<LightGroupId>>,
    /// Lanes with which roads begin, where vehicles that leave the map come back.
    pub(super) entries: Vec<LaneId>,
    /// Those on which bicycles do; all where there is none.
    pub(super) bicycle_entries: Vec<LaneId>,
    /// The side of slow traffic: -1 (right) where one drives on the right, 1 (left) where on the left.
    pub(super) kerb: i8,
}

impl Ways {
    /// The lookups of a map.
    pub(crate) fn new(places: &Arc<Places>) -> Self {
        let map = &*places.map;
        let lanes = lane_ways(places);
        let mut ways = Self {
            places: places.clone(),
            routes: Routes::new(&map.lanes, &lanes),
            lanes,
            edges: (0..map.walk_edges.len()).map(|e| edge_way(map, e)).collect(),
            crosswalk_lights: map.crosswalks.iter().map(|c| crosswalk_lights(map, c)).collect(),
            entries: entries(places),
            bicycle_entries: Vec::new(),
            kerb: kerb(places),
        };
        let cycled = ways.entries.iter().copied().filter(|lane| ways.may_start(ActorKind::Bicycle, *lane));
        ways.bicycle_entries = cycled.collect();
        if ways.bicycle_entries.is_empty() {
            ways.bicycle_entries.clone_from(&ways.entries);
        }
        ways.add_crosswalks(map);
        ways
    }

    /// The place on an edge at `s_m`; beyond its ends the edge goes straight on.
    pub(super) fn edge_place(&self, edge: WalkEdgeId, s_m: f32) -> Place {
        let (way, edge) = (&self.edges[edge as usize], &self.places.map.walk_edges[edge as usize]);
        let last = edge.points.len() - 2;
        let i = way.s_m[1..=last].partition_point(|s| *s <= s_m);
        let along = (s_m - way.s_m[i]) / (way.s_m[i + 1] - way.s_m[i]).max(1e-3);
        let position = edge.points[i] + (edge.points[i + 1] - edge.points[i]) * along;
        Place { position, forward: way.forward[i], half_width_m: edge.half_width_m }
    }

    /// Where a walker stands.
    pub(super) fn walker_place(&self, walker: &Walker) -> Place {
        self.edge_place(walker.edge, walker.s_m)
    }

    /// Whether a vehicle of a kind may start on a lane: bicycles do at the kerb, and not on motorways.
    pub(super) fn may_start(&self, kind: ActorKind, lane: LaneId) -> bool {
        let lane = &self.places.map.lanes[lane as usize];
        let beside = if self.kerb > 0 { lane.left } else { lane.right };
        Class::of(kind).may_use(lane) && (kind != ActorKind::Bicycle || beside.is_none())
    }

    /// Whether a light holds traffic at the end of a lane.
    pub(super) fn is_lit(&self, lane: LaneId) -> bool {
        let stop = self.places.map.lanes[lane as usize].stop;
        stop.is_some_and(|stop| matches!(stop.kind, StopKind::Light(_)))
    }

    fn add_crosswalks(&mut self, map: &MapData) {
        for (i, crosswalk) in map.crosswalks.iter().enumerate() {
            for &(lane, s_m) in &crosswalk.lanes {
                let half = crosswalk.half_width_m;
                let span = CrosswalkSpan { crosswalk: i as u32, near_m: s_m - half, far_m: s_m + half };
                self.lanes[lane as usize].crosswalks.push(span);
            }
        }
        for lane in &mut self.lanes {
            lane.crosswalks.sort_by(|a, b| a.near_m.total_cmp(&b.near_m));
        }
    }
}

impl LaneWay {
    /// Like [`Lane::straight_on`], the direction turning smoothly between the points.
    pub fn pose(&self, lane: &Lane, s_m: f32) -> Place {
        lane.straight_on_facing(s_m, |i, share| {
            let here = self.forward[i];
            if share < 0.5 && i > 0 {
                self.forward[i - 1].lerp(here, (share + 0.5).max(0.0)).normalize_or(here)
            } else if share > 0.5 && i + 1 < self.forward.len() {
                here.lerp(self.forward[i + 1], (share - 0.5).min(0.5)).normalize_or(here)
            } else {
                here
            }
        })
    }

    /// The highest speed at `s_m`, interpolated between the points. m/s.
    pub fn curve_speed(&self, lane: &Lane, s_m: f32) -> f32 {
        let (i, t) = lane.segment(s_m);
        let (a, b) = (self.speed_mps[i], self.speed_mps[i + 1]);
        a + (b - a) * t.clamp(0.0, 1.0)
    }
}

fn lane_ways(places: &Places) -> Vec<LaneWay> {
    let map = &*places.map;
    let onward = onward(places);
    let (meets, zones) = (meets(places, &onward), zones(map));
    let ways = onward.into_iter().zip(meets).zip(zones).enumerate();
    ways.map(|(id, ((onward, meets), zone))| LaneWay { meets, zone, ..lane_way(map, id as LaneId, onward) }).collect()
}

fn lane_way(map: &MapData, id: LaneId, [onward, onward_wide]: [Vec<Onward>; 2]) -> LaneWay {
    let lane = &map.lanes[id as usize];
    let mut speed_mps = curve_speeds(lane);
    for i in (0..speed_mps.len().saturating_sub(1)).rev() {
        let ds = lane.points[i + 1].s_m - lane.points[i].s_m;
        let reachable = ops::sqrt(speed_mps[i + 1] * speed_mps[i + 1] + 2.0 * CURVE_BRAKE_MPS2 * ds.max(0.0));
        speed_mps[i] = speed_mps[i].min(reachable);
    }
    let swept = lane.junction.map_or_else(Vec::new, |junction| swept(map, id, junction));
    let conflicts = lane.conflicts.iter().filter_map(|c| lane_conflict(map, id, c)).collect();
    let forward = directions(lane.points.iter().map(|p| p.position));
    let ends_m = ends_beside(lane, &onward).then(|| wide_up_to_m(lane));
    LaneWay { speed_mps, forward, onward, onward_wide, ends_m, conflicts, swept, ..LaneWay::default() }
}

/// Where a lane becomes too narrow to drive on to its end, metres from its start.
fn wide_up_to_m(lane: &Lane) -> f32 {
    let narrow = lane.points.iter().rev().take_while(|p| p.half_width_m < LEAST_HALF_M).last();
    narrow.map_or(lane.length_m, |p| p.s_m)
}

/// Speed at which the curve through each point asks for [`CURVE_ACCEL_MPS2`]; curvature is taken
/// over 3 m each way, so that single bends of the baked line do not count.
fn curve_speeds(lane: &Lane) -> Vec<f32> {
    let heading = |s: f32| {
        let forward = lane.straight_on(s.clamp(0.0, lane.length_m)).forward;
        ops::atan2(forward.y, forward.x)
    };
    let at = |s: f32| {
        let (from, to) = ((s - 3.0).max(0.0), (s + 3.0).min(lane.length_m));
        let turned = ops::wrap_angle(heading(to) - heading(from)).abs();
        let curvature = turned / (to - from).max(3.0);
        ops::sqrt(CURVE_ACCEL_MPS2 / curvature.max(1e-4)).max(CURVE_FLOOR_MPS)
    };
    lane.points.iter().map(|p| at(p.s_m)).collect()
}

fn lane_conflict(map: &MapData, id: LaneId, conflict: &Conflict) -> Option<LaneConflict> {
    let lane = &map.lanes[id as usize];
    let other = &map.lanes[conflict.lane as usize];
    let mirrored = other.conflicts.iter().find(|c| c.lane == id);
    let shares = |a: &[LaneId], b: &[LaneId]| a.iter().any(|x| b.contains(x));
    let kind = if shares(&lane.successors, &other.successors) {
        ConflictKind::Merge
    } else if shares(&lane.predecessors, &other.predecessors) {
        ConflictKind::Diverge
    } else {
        ConflictKind::Cross
    };
    let there = mirrored.map_or([0.0, other.length_m], |c| [c.from_m, c.to_m]);
    let gives_way = mirrored.is_some_and(|c| c.other_first);
    let precedence = i8::from(gives_way) - i8::from(conflict.other_first);
    (other.kind == LaneKind::Driving).then_some(LaneConflict {
        lane: conflict.lane,
        kind,
        here: [conflict.from_m, conflict.to_m],
        there,
        precedence,
    })
}

/// Lanes of a junction that come near a lane without a conflict, where the way of one of them bends.
fn swept(map: &MapData, id: LaneId, junction: u32) -> Vec<LaneId> {
    let lane = &map.lanes[id as usize];
    let chained = |other: &Lane, o: LaneId| lane.successors.contains(&o) || other.successors.contains(&id);
    let shares = |a: &[LaneId], b: &[LaneId]| a.iter().any(|x| b.contains(x));
    let near = |other: &Lane| {
        let middle = |points: &[LanePoint]| points.iter().map(|p| p.position.truncate()).collect::<Vec<_>>();
        let (here, there) = (middle(&lane.points), middle(&other.points));
        here.iter().any(|p| there.iter().any(|q| p.distance_squared(*q) < SWEPT_M * SWEPT_M))
    };
    let others = map.junctions[junction as usize].lanes.iter().copied().filter(|o| *o != id);
    let others = others.map(|o| (o, &map.lanes[o as usize])).filter(|(o, other)| {
        let bends = lane.turn != Turn::Straight || other.turn != Turn::Straight;
        let together = shares(&lane.predecessors, &other.predecessors) || lane.conflicts.iter().any(|c| c.lane == *o);
        other.kind == LaneKind::Driving && bends && !together && !chained(other, *o)
    });
    others.filter(|(_, other)| near(other)).map(|(o, _)| o).collect()
}

fn crosswalk_lights(map: &MapData, crosswalk: &Crosswalk) -> Vec<LightGroupId> {
    let mut groups = Vec::new();
    if crosswalk.junction.is_some() {
        for &(lane, _) in &crosswalk.lanes {
            if let Some(StopKind::Light(group)) = map.lanes[lane as usize].stop.map(|stop| stop.kind) {
                groups.push(group);
            }
        }
    }
    groups.sort_unstable();
    groups.dedup();
    groups
}

/// Lanes with which roads begin; every lane where no road does.
fn entries(places: &Places) -> Vec<LaneId> {
    let map = &*places.map;
    let open = |lane: &Lane| lane.kind == LaneKind::Driving && lane.length_m > 15.0 && lane.junction.is_none();
    let lanes = || map.lanes.iter().enumerate().filter(|(_, lane)| open(lane)).map(|(id, _)| id as LaneId);
    let starts: Vec<_> = lanes().filter(|id| begins(places, *id)).collect();
    if starts.is_empty() { lanes().collect() } else { starts }
}

/// Whether a road begins with this lane, and not only the lane beside others that come from before.
fn begins(places: &Places, id: LaneId) -> bool {
    let lanes = &places.map.lanes;
    let lane = &lanes[id as usize];
    let start = lane.start();
    let comes_by = |other: LaneId, s_m: f32| {
        let along = ops::cos(lanes[other as usize].at(s_m).heading_rad - start.heading_rad) > 0.5;
        other != id && along && s_m > 5.0
    };
    let wide = start.half_width_m > LEAST_HALF_M;
    let near = || places.roads().around(start.position, LaneKind::Driving, FROM_BEFORE_M);
    lane.predecessors.is_empty() && wide && !near().iter().any(|p| comes_by(p.lane, p.s_m))
}

/// -1 where most lanes have those for the other direction to their left, 1 where to their right.
fn kerb(places: &Places) -> i8 {
    let lanes = &places.map.lanes;
    let oncoming = |lane: &Lane, side: f32| {
        let (heading_rad, place) = (lane.at(lane.length_m * 0.5).heading_rad, lane.straight_on(lane.length_m * 0.5));
        let there = place.beside(side * (place.half_width_m + FROM_BEFORE_M * 0.5));
        let beside = places.roads().at(there, LaneKind::Driving);
        beside.iter().any(|p| ops::cos(lanes[p.lane as usize].at(p.s_m).heading_rad - heading_rad) < -0.5)
    };
    let roads = || lanes.iter().filter(|lane| lane.kind == LaneKind::Driving && lane.junction.is_none());
    let count = |side: f32| roads().filter(|lane| oncoming(lane, side)).count();
    if count(-1.0) > count(1.0) { 1 } else { -1 }
}

fn edge_way(map: &MapData, index: usize) -> EdgeWay {
    let edge = &map.walk_edges[index];
    let mut s_m = vec![0.0];
    for pair in edge.points.windows(2) {
        s_m.push(s_m[s_m.len() - 1] + pair[0].truncate().distance(pair[1].truncate()));
    }
    let facing = if edge.crosswalk.is_none() && edge.beside.is_some() { facing(map, index) } else { Vec::new() };
    EdgeWay { s_m, forward: directions(edge.points.iter().copied()), facing }
}

fn directions(points: impl Iterator<Item = Vec3> + Clone) -> Vec<Vec3> {
    points.clone().zip(points.skip(1)).map(|(a, b)| (b - a).normalize_or(Vec3::X)).collect()
}

fn facing(map: &MapData, index: usize) -> Vec<u32> {
    let (low, high) = extent(&map.walk_edges[index].points);
    let near = |points: &[Vec3]| {
        let (l, h) = extent(points);
        l.cmple(high + FACING_M).all() && h.cmpge(low - FACING_M).all()
    };
    let others = map.walk_edges.iter().enumerate();
    others
        .filter(|(i, e)| *i != index && e.crosswalk.is_none() && e.beside.is_some() && near(&e.points))
        .map(|(i, _)| i as u32)
        .collect()
}

fn extent(points: &[Vec3]) -> (Vec2, Vec2) {
    let flat = || points.iter().map(|p| p.truncate());
    (flat().fold(Vec2::MAX, Vec2::min), flat().fold(Vec2::MIN, Vec2::max))
}
