//! The ways of pedestrians: sidewalks, crosswalks, and what joins them.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;

use super::rounding::{snap, snap3};
use super::source::Source;
use crate::map_data::{Crosswalk, LaneId, LaneKind, WalkEdge, WalkEdgeId, WalkNode};
use crate::ops;
use crate::places::Roads;

/// Ends of sidewalks nearer than this are one place, metres.
const MERGE_M: f32 = 0.8;
/// A crosswalk is joined to a sidewalk this near to its end, metres.
const JOIN_M: f32 = 6.0;
/// Loose ends of sidewalks this near to each other are joined across a corner, metres.
const CORNER_M: f32 = 15.0;
/// Walkers keep this far from the edge of a sidewalk, where poles stand, metres.
const KEEP_M: f32 = 0.5;

/// The ways of pedestrians and where they meet.
pub(super) fn bake(source: &Source, roads: &Roads<'_>, crosswalks: &[Crosswalk]) -> (Vec<WalkNode>, Vec<WalkEdge>) {
    let mut graph = Graph::default();
    for id in 0..roads.lanes.len() as LaneId {
        let lane = &roads.lanes[id as usize];
        if lane.kind != LaneKind::Sidewalk || lane.length_m < 0.3 {
            continue;
        }
        let rise = Vec3::Z * source.rise(id);
        let points: Vec<Vec3> = lane.points.iter().map(|p| snap3(p.position + rise)).collect();
        let width = lane.points.iter().map(|p| p.half_width_m).fold(f32::MAX, f32::min);
        graph.add(points, (width - KEEP_M).max(0.4), None, beside(roads, id));
    }
    for (k, crosswalk) in crosswalks.iter().enumerate() {
        let ends = crosswalk.ends.map(|end| graph.reach(end));
        if let [Some(a), Some(b)] = ends
            && a != b
        {
            let points = vec![graph.nodes[a as usize], crosswalk.ends[0], crosswalk.ends[1], graph.nodes[b as usize]];
            graph.add(points, crosswalk.half_width_m - KEEP_M, Some(k as u32), None);
        }
    }
    graph.join_corners(roads);
    graph.finish()
}

/// The driving lane beside a sidewalk.
fn beside(roads: &Roads<'_>, sidewalk: LaneId) -> Option<LaneId> {
    let lane = &roads.lanes[sidewalk as usize];
    let middle = lane.at(lane.length_m / 2.0).position;
    let near = roads.around(middle, LaneKind::Driving, 8.0);
    near.into_iter().min_by(|a, b| roads.beyond_edge(a).total_cmp(&roads.beyond_edge(b))).map(|p| p.lane)
}

#[derive(Default)]
struct Graph {
    nodes: Vec<Vec3>,
    /// Nodes by the square metre they lie in.
    cells: BTreeMap<(i32, i32), Vec<u32>>,
    edges: Vec<WalkEdge>,
    /// Corners of the box around each edge outside of which nothing is joined to it.
    boxes: Vec<(Vec3, Vec3)>,
}

impl Graph {
    fn node(&mut self, position: Vec3) -> u32 {
        let cell = |v: f32| ops::floor(v) as i32;
        let (x, y) = (cell(position.x), cell(position.y));
        let around = (x - 1..=x + 1).flat_map(|i| (y - 1..=y + 1).map(move |j| (i, j)));
        let near = around.filter_map(|c| self.cells.get(&c)).flatten();
        let distance = |n: u32| self.nodes[n as usize].distance(position);
        let found =
            near.copied().filter(|&n| distance(n) < MERGE_M).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        found.unwrap_or_else(|| {
            self.nodes.push(position);
            let id = self.nodes.len() as u32 - 1;
            self.cells.entry((x, y)).or_default().push(id);
            id
        })
    }

    fn add(&mut self, mut points: Vec<Vec3>, half_width_m: f32, crosswalk: Option<u32>, beside: Option<LaneId>) {
        let last = points.len() - 1;
        let nodes = [self.node(points[0]), self.node(points[last])];
        points[0] = self.nodes[nodes[0] as usize];
        points[last] = self.nodes[nodes[1] as usize];
        points.dedup();
        let length_m = length(&points);
        if points.len() > 1 && length_m > 0.1 {
            let half_width_m = snap(half_width_m);
            self.boxes.push(reachable(&points));
            self.edges.push(WalkEdge { nodes, points, half_width_m, length_m, crosswalk, beside });
        }
    }

    /// The node of a sidewalk nearest to `place`; splits the sidewalk where it has none there.
    fn reach(&mut self, place: Vec3) -> Option<u32> {
        let mut best: Option<(f32, usize, usize, Vec3)> = None;
        let near = |e: usize| self.boxes[e].0.cmple(place).all() && self.boxes[e].1.cmpge(place).all();
        let sidewalks = self.edges.iter().enumerate().filter(|(_, e)| e.crosswalk.is_none());
        for (e, edge) in sidewalks.filter(|(e, _)| near(*e)) {
            for (k, pair) in edge.points.windows(2).enumerate() {
                let along = pair[1] - pair[0];
                let share = ((place - pair[0]).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
                let foot = pair[0] + along * share;
                let distance = foot.distance(place);
                if distance < best.map_or(JOIN_M, |b| b.0) {
                    best = Some((distance, e, k, foot));
                }
            }
        }
        let (_, e, k, foot) = best?;
        Some(self.split(e, k, snap3(foot)))
    }

    /// Splits edge `e` at `foot`, which lies after its point `k`.
    fn split(&mut self, e: usize, k: usize, foot: Vec3) -> u32 {
        let edge = &self.edges[e];
        if let Some(&end) = edge.nodes.iter().find(|&&n| self.nodes[n as usize].distance(foot) < MERGE_M) {
            return end;
        }
        let mut head = edge.points[..=k].to_vec();
        head.push(foot);
        let mut tail = vec![foot];
        tail.extend_from_slice(&edge.points[k + 1..]);
        let (half_width_m, beside) = (edge.half_width_m, edge.beside);
        self.edges.swap_remove(e);
        self.boxes.swap_remove(e);
        self.add(head, half_width_m, None, beside);
        self.add(tail, half_width_m, None, beside);
        self.node(foot)
    }

    /// Joins loose ends where a file leaves the corner between two sidewalks out.
    fn join_corners(&mut self, roads: &Roads<'_>) {
        let mut degree = vec![0; self.nodes.len()];
        self.edges.iter().flat_map(|e| e.nodes).for_each(|n| degree[n as usize] += 1);
        let mut loose = Loose::new(&self.nodes, (0..self.nodes.len() as u32).filter(|&n| degree[n as usize] == 1));
        while let Some(a) = loose.pop() {
            let from = self.nodes[a as usize];
            let dry = loose.near(from).into_iter().find(|&b| is_dry(roads, from, self.nodes[b as usize]));
            if let Some(b) = dry {
                loose.remove(b);
                self.add(vec![from, self.nodes[b as usize]], 0.6, None, None);
            }
        }
    }

    fn finish(self) -> (Vec<WalkNode>, Vec<WalkEdge>) {
        let mut nodes: Vec<WalkNode> =
            self.nodes.into_iter().map(|position| WalkNode { position, edges: Vec::new() }).collect();
        for (id, edge) in self.edges.iter().enumerate() {
            for n in edge.nodes {
                nodes[n as usize].edges.push(id as WalkEdgeId);
            }
        }
        (nodes, self.edges)
    }
}

/// The box around some points with [`JOIN_M`] on all sides, and a little for rounding.
fn reachable(points: &[Vec3]) -> (Vec3, Vec3) {
    let low = points.iter().fold(Vec3::MAX, |m, p| m.min(*p));
    let high = points.iter().fold(Vec3::MIN, |m, p| m.max(*p));
    (low - (JOIN_M + 0.1), high + (JOIN_M + 0.1))
}

/// Nodes at which one sidewalk ends.
struct Loose {
    places: BTreeMap<u32, Vec3>,
    /// By square of [`CORNER_M`].
    cells: BTreeMap<(i32, i32), BTreeSet<u32>>,
}

impl Loose {
    fn new(nodes: &[Vec3], loose: impl Iterator<Item = u32>) -> Self {
        let places: BTreeMap<u32, Vec3> = loose.map(|n| (n, nodes[n as usize])).collect();
        let mut cells: BTreeMap<(i32, i32), BTreeSet<u32>> = BTreeMap::new();
        places.iter().for_each(|(&n, &p)| _ = cells.entry(Self::cell(p)).or_default().insert(n));
        Self { places, cells }
    }

    fn cell(p: Vec3) -> (i32, i32) {
        let at = |v: f32| ops::floor(v / CORNER_M) as i32;
        (at(p.x), at(p.y))
    }

    /// The last of them, which it is then no more.
    fn pop(&mut self) -> Option<u32> {
        let last = *self.places.last_key_value()?.0;
        self.remove(last);
        Some(last)
    }

    fn remove(&mut self, n: u32) {
        if let Some(p) = self.places.remove(&n) {
            self.cells.get_mut(&Self::cell(p)).map(|cell| cell.remove(&n));
        }
    }

    /// Those nearer than [`CORNER_M`], the nearest first.
    fn near(&self, place: Vec3) -> Vec<u32> {
        let (x, y) = Self::cell(place);
        let around = (x - 1..=x + 1).flat_map(|i| (y - 1..=y + 1).map(move |j| (i, j)));
        let found = around.filter_map(|c| self.cells.get(&c)).flatten();
        let mut near: Vec<(f32, u32)> = found.map(|n| (self.places[n].distance(place), *n)).collect();
        near.retain(|(distance, _)| *distance < CORNER_M);
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        near.into_iter().map(|(_, n)| n).collect()
    }
}

fn length(points: &[Vec3]) -> f32 {
    snap(points.windows(2).map(|p| p[0].distance(p[1])).sum())
}

/// Whether one can walk straight from `a` to `b` without stepping on a driving lane.
fn is_dry(roads: &Roads<'_>, a: Vec3, b: Vec3) -> bool {
    let steps = a.distance(b) as u32 + 1;
    (0..=steps).all(|k| !roads.on_road(a + (b - a) * (k as f32 / steps as f32)))
}
