//! Where people go on at the end of a way.

use crate::map_data::{MapData, WalkEdgeId};
use crate::rng::{self, Stream};

use super::walker::Walker;
use super::ways::Ways;

/// What people turn by.
#[derive(Clone, Copy)]
pub(super) struct Turns<'a> {
    pub map: &'a MapData,
    pub ways: &'a Ways,
    pub seed: u64,
}

impl Turns<'_> {
    /// The edge a walker takes at the end of its own: drawn, and the more likely the more there is to go for.
    pub fn next_edge(&self, walker: &Walker) -> WalkEdgeId {
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
    pub fn wanted_crosswalk(&self, walker: &Walker) -> Option<u32> {
        let next = self.next_edge(walker);
        self.map.walk_edges[next as usize].crosswalk.filter(|_| next != walker.edge)
    }
}

/// The node to which a walker goes.
pub(super) fn end_node(map: &MapData, walker: &Walker) -> u32 {
    map.walk_edges[walker.edge as usize].nodes[usize::from(walker.forward)]
}
