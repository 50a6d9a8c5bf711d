//! Where people go on at the end of a way.

use crate::map_data::{MapData, WalkEdgeId};
use crate::rng::{self, Stream};

use super::groups::Groups;
use super::nearby::Nearby;
use super::walker::{Walker, WalkerMode};
use super::ways::Ways;

/// Share of turns at which somebody who has lost the group does not head for it, and what draws that.
const ASTRAY: f32 = 0.3;
const ASTRAY_KEY: u64 = 1 << 33;

/// What people turn by.
#[derive(Clone, Copy)]
pub(super) struct Turns<'a> {
    pub map: &'a MapData,
    pub ways: &'a Ways,
    pub seed: u64,
    pub walkers: &'a [Walker],
    pub groups: &'a Groups,
    pub crowd: &'a Nearby,
}

impl Turns<'_> {
    /// The edge that walker `index` takes at the end of its own: with a group that which its leader takes.
    pub fn next_edge(&self, index: usize, walker: &Walker) -> WalkEdgeId {
        let leader = self.groups.leader(index).filter(|i| self.crowd.has(*i)).map(|i| &self.walkers[i]);
        let led = leader.filter(|led| led.mode != WalkerMode::Jaywalk);
        led.and_then(|led| self.edge_to(walker, led)).unwrap_or_else(|| self.drawn_edge(walker))
    }

    /// The edge on which a walker gets to whom it follows, if it finds one.
    fn edge_to(&self, walker: &Walker, led: &Walker) -> Option<WalkEdgeId> {
        let node = end_node(self.map, walker);
        let goals = self.map.walk_edges[led.edge as usize].nodes;
        if goals.contains(&node) {
            let comes = end_node(self.map, led) == node;
            return Some(if comes { self.drawn_edge(led) } else { led.edge });
        }
        let others = || self.map.walk_nodes[node as usize].edges.iter().copied().filter(|e| *e != walker.edge);
        let far_end = |edge: WalkEdgeId| {
            let [a, b] = self.map.walk_edges[edge as usize].nodes;
            if a == node { b } else { a }
        };
        if let Some(edge) = others().find(|edge| goals.contains(&far_end(*edge))) {
            return Some(edge);
        }
        // Towards it, but not always: that could be a dead end.
        let place = |node: u32| self.map.walk_nodes[node as usize].position;
        let goal = place(end_node(self.map, led));
        let astray =
            rng::unit(self.seed, Stream::Walk, u64::from(walker.id) | ASTRAY_KEY, u64::from(walker.hops)) < ASTRAY;
        let away_m = |edge: &WalkEdgeId| place(far_end(*edge)).distance(goal);
        others().min_by(|a, b| away_m(a).total_cmp(&away_m(b))).filter(|_| !astray)
    }

    /// The edge that somebody alone takes: drawn, and the more likely the more there is to go for.
    fn drawn_edge(&self, walker: &Walker) -> WalkEdgeId {
        let node = end_node(self.map, walker);
        let others = || self.map.walk_nodes[node as usize].edges.iter().copied().filter(|e| *e != walker.edge);
        let mut all = others();
        let first = match (all.next(), all.next()) {
            (None, _) => return walker.edge,
            (Some(only), None) => return only,
            (Some(first), _) => first,
        };
        let draw = |edge: WalkEdgeId| {
            let from_last = self.map.walk_edges[edge as usize].nodes[0] != node;
            self.ways.edges[edge as usize].draw.onward[usize::from(from_last)]
        };
        let drawn = rng::unit(self.seed, Stream::Walk, u64::from(walker.id), u64::from(walker.hops));
        let mut left = drawn * others().map(draw).sum::<f32>();
        let is_it = |edge: &WalkEdgeId| {
            left -= draw(*edge);
            left < 0.0
        };
        others().find(is_it).unwrap_or(first)
    }

    /// The crosswalk that a waiting walker wants to take.
    pub fn wanted_crosswalk(&self, index: usize, walker: &Walker) -> Option<u32> {
        let next = self.next_edge(index, walker);
        self.map.walk_edges[next as usize].crosswalk.filter(|_| next != walker.edge)
    }
}

/// The node to which a walker goes.
pub(super) fn end_node(map: &MapData, walker: &Walker) -> u32 {
    map.walk_edges[walker.edge as usize].nodes[usize::from(walker.forward)]
}
