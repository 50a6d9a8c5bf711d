//! Lookups of a map, made once: those of lanes and ways, where vehicles want to go and where they enter.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::doors::{DoorSpot, door_spots};
use super::lane_way::{CrosswalkSpan, LaneWay, directions, lane_ways};
use super::links::{LEAST_HALF_M, Onward};
use super::reasons::{Draw, draws};
use super::roundabout::{Roundabout, roundabouts};
use super::routes::{Class, Routes};
use super::walker::Walker;
use crate::actor::ActorKind;
use crate::map_data::{Crosswalk, Lane, LaneId, LaneKind, LightGroupId, MapData, Place, WalkEdge, WalkEdgeId};
use crate::ops;
use crate::places::{Grid, Places};

/// Sidewalks farther apart than this do not face each other across a road, metres.
const FACING_M: f32 = 32.0;

/// Distances beyond the border of a lane at which one for the other direction may lie, metres.
const MEDIANS_M: [f32; 4] = [1.0, 3.0, 6.0, 12.0];
/// So far before and behind a point of its line a way turns, metres, or half as far as the next point is away.
const BEND_M: f32 = 2.0;
/// Lanes whose edges come within this of where another begins lie beside it, metres.
const FROM_BEFORE_M: f32 = 2.0;

#[derive(Clone, Debug, Default)]
pub(super) struct EdgeWay {
    /// Distance of each point from the first, metres.
    pub s_m: Vec<f32>,
    /// Direction from each point to the next.
    pub forward: Vec<Vec3>,
    /// Sidewalks that may lie across the road.
    pub facing: Vec<u32>,
    /// How much it draws people.
    pub draw: Draw,
    /// Where buses halt beside it, at their front doors, metres along it.
    pub stops: Vec<f32>,
}

impl EdgeWay {
    /// The direction at `s_m`, which is on segment `i`.
    fn forward_at(&self, i: usize, s_m: f32) -> Vec3 {
        let [from_m, to_m] = [s_m - self.s_m[i], self.s_m[i + 1] - s_m];
        let within_m = (0.5 * (from_m + to_m)).min(BEND_M);
        let here = self.forward[i];
        let turned = |other: usize, away_m: f32| {
            here.lerp(self.forward[other], 0.5 - 0.5 * (away_m / within_m).max(0.0)).normalize_or(here)
        };
        if i > 0 && from_m < within_m {
            turned(i - 1, from_m)
        } else if i + 1 < self.forward.len() && to_m < within_m {
            turned(i + 1, to_m)
        } else {
            here
        }
    }
}

/// What traffic looks up in a map.
#[derive(Debug)]
pub struct Ways {
    /// The map with its places.
    pub(super) places: Arc<Places>,
    pub(super) lanes: Vec<LaneWay>,
    pub(super) roundabouts: Vec<Roundabout>,
    pub(super) routes: Routes,
    pub(super) edges: Vec<EdgeWay>,
    /// Light groups that must be red for each crosswalk; empty for one without.
    pub(super) crosswalk_lights: Vec<Vec<LightGroupId>>,
    /// Lanes with which roads begin, where vehicles that leave the map come back.
    pub(super) entries: Vec<LaneId>,
    /// Those on which bicycles do; all where there is none.
    pub(super) bicycle_entries: Vec<LaneId>,
    /// For each bus stop the sidewalks onto which the doors of a bus there open.
    pub(super) stop_ways: Vec<Vec<WalkEdgeId>>,
    /// Doors of parked cars that open into a lane.
    pub(super) door_spots: Vec<DoorSpot>,
    /// The side of slow traffic: -1 (right) where one drives on the right, 1 (left) where on the left.
    pub(super) kerb: i8,
}

impl Ways {
    /// Where the traffic of a lane goes on.
    pub(crate) fn onward(&self, lane: LaneId) -> &[Onward] {
        &self.lanes[lane as usize].onward
    }

    /// Where on a lane it comes from another, metres from its start.
    pub(crate) fn enters_at_m(&self, from: LaneId, to: LaneId) -> f32 {
        self.onward(from).iter().find(|next| next.lane == to).map_or(0.0, |next| next.at_m)
    }

    /// The lookups of a map.
    pub(crate) fn new(places: &Arc<Places>) -> Self {
        let map = &*places.map;
        let kerb = kerb(places);
        let (roundabouts, circle) = roundabouts(&map.lanes);
        let lanes = lane_ways(places, kerb, circle);
        let mut ways = Self {
            roundabouts,
            places: places.clone(),
            routes: Routes::new(&map.lanes, &lanes, kerb),
            lanes,
            edges: edge_ways(map, kerb),
            crosswalk_lights: map.crosswalks.iter().map(|c| crosswalk_lights(map, c)).collect(),
            entries: entries(places),
            bicycle_entries: Vec::new(),
            stop_ways: Vec::new(),
            door_spots: door_spots(places),
            kerb,
        };
        ways.add_stops();
        let cycled = ways.entries.iter().copied().filter(|lane| ways.may_start(ActorKind::Bicycle, *lane));
        ways.bicycle_entries = cycled.collect();
        if ways.bicycle_entries.is_empty() {
            ways.bicycle_entries.clone_from(&ways.entries);
        }
        ways.add_crosswalks(map);
        ways
    }

    /// The place on an edge at `s_m`; beyond its ends the edge goes straight on. Where it bends the direction turns smoothly:
    /// whoever is far beside it would leap there else.
    pub(super) fn edge_place(&self, edge: WalkEdgeId, s_m: f32) -> Place {
        let (way, edge) = (&self.edges[edge as usize], &self.places.map.walk_edges[edge as usize]);
        let last = edge.points.len() - 2;
        let i = way.s_m[1..=last].partition_point(|s| *s <= s_m);
        let along = (s_m - way.s_m[i]) / (way.s_m[i + 1] - way.s_m[i]).max(1e-3);
        let position = edge.points[i] + (edge.points[i + 1] - edge.points[i]) * along;
        Place { position, forward: way.forward_at(i, s_m), half_width_m: edge.half_width_m }
    }

    /// Where a walker stands.
    pub(super) fn walker_place(&self, walker: &Walker) -> Place {
        self.edge_place(walker.edge, walker.s_m)
    }

    /// Whether a vehicle of a kind may start on a lane: bicycles do at the kerb, and not on motorways.
    pub(super) fn may_start(&self, kind: ActorKind, lane: LaneId) -> bool {
        let lane = &self.places.map.lanes[lane as usize];
        let beside = if self.kerb > 0 { lane.left } else { lane.right };
        Class::of(kind).may_use(lane) && (!kind.is_pedalled() || beside.is_none())
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

fn crosswalk_lights(map: &MapData, crosswalk: &Crosswalk) -> Vec<LightGroupId> {
    let mut groups = Vec::new();
    if crosswalk.junction.is_some() {
        for &(lane, _) in &crosswalk.lanes {
            let next = &map.lanes[lane as usize].successors;
            groups.extend(next.iter().filter_map(|next| map.light_between(lane, *next)));
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
        let against = |id: LaneId, s_m: f32| ops::cos(lanes[id as usize].at(s_m).heading_rad - heading_rad) < -0.5;
        // Other lanes of this direction and a median may be between.
        MEDIANS_M.iter().any(|m| {
            let there = place.beside(side * (place.half_width_m + m));
            places.roads().at(there, LaneKind::Driving).iter().any(|p| against(p.lane, p.s_m))
        })
    };
    let roads = || lanes.iter().filter(|lane| lane.kind == LaneKind::Driving && lane.junction.is_none());
    let count = |side: f32| roads().filter(|lane| oncoming(lane, side)).count();
    if count(-1.0) > count(1.0) { 1 } else { -1 }
}

fn edge_ways(map: &MapData, kerb: i8) -> Vec<EdgeWay> {
    let with_facing = map.walk_edges.iter().zip(facing(map));
    with_facing.zip(draws(map, kerb)).map(|((edge, facing), draw)| edge_way(edge, facing, draw)).collect()
}

fn edge_way(edge: &WalkEdge, facing: Vec<u32>, draw: Draw) -> EdgeWay {
    let mut s_m = vec![0.0];
    for pair in edge.points.windows(2) {
        s_m.push(s_m[s_m.len() - 1] + pair[0].truncate().distance(pair[1].truncate()));
    }
    EdgeWay { s_m, forward: directions(edge.points.iter().copied()), facing, draw, stops: Vec::new() }
}

/// For each sidewalk beside a lane the others, ascending, that are near enough to face it.
fn facing(map: &MapData) -> Vec<Vec<u32>> {
    let edges = &map.walk_edges;
    let is_sidewalk = |i: usize| edges[i].crosswalk.is_none() && edges[i].beside.is_some();
    let extents: Vec<_> = edges.iter().map(|e| extent(&e.points)).collect();
    let grid = Grid::new(&extents, FACING_M);
    let near = |of: usize| {
        let (low, high) = extents[of];
        let reach_m = (high - low).max_element() * 0.5 + FACING_M;
        let touches = |(l, h): (Vec2, Vec2)| l.cmple(high + FACING_M).all() && h.cmpge(low - FACING_M).all();
        let faces = |i: &u32| *i as usize != of && is_sidewalk(*i as usize) && touches(extents[*i as usize]);
        let mut found: Vec<u32> = grid.around((low + high) * 0.5, reach_m).filter(faces).collect();
        found.sort_unstable();
        found.dedup();
        found
    };
    (0..edges.len()).map(|i| if is_sidewalk(i) { near(i) } else { Vec::new() }).collect()
}

fn extent(points: &[Vec3]) -> (Vec2, Vec2) {
    let flat = || points.iter().map(|p| p.truncate());
    (flat().fold(Vec2::MAX, Vec2::min), flat().fold(Vec2::MIN, Vec2::max))
}
