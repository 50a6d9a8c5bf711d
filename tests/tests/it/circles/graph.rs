//! Circles of a graph: the groups of nodes that reach each other, and a shortest way around.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// To which nodes each node leads.
pub type Graph = BTreeMap<String, BTreeSet<String>>;

/// A group of nodes each of which reaches all others.
#[derive(Debug, PartialEq)]
pub struct Circle {
    pub members: BTreeSet<String>,
    /// A shortest way around that passes a node of the kind asked for; its end is not told again.
    pub way: Vec<String>,
}

pub fn graph(arrows: impl IntoIterator<Item = (String, String)>) -> Graph {
    let mut graph = Graph::new();
    for (from, to) in arrows {
        graph.entry(from).or_default().insert(to);
    }
    graph
}

/// All circles that pass a node of a kind; nodes of different ones do not reach each other both ways.
pub fn circles(graph: &Graph, kind: impl Fn(&str) -> bool) -> Vec<Circle> {
    let reach: BTreeMap<&str, BTreeSet<&str>> =
        graph.keys().map(|node| (node.as_str(), reached(graph, node))).collect();
    let mut found: Vec<Circle> = Vec::new();
    for (node, forth) in reach.iter().filter(|(node, forth)| kind(node) && forth.contains(*node)) {
        if found.iter().any(|circle| circle.members.contains(*node)) {
            continue;
        }
        let back = |other: &&str| reach.get(other).is_some_and(|reached| reached.contains(node));
        let members: BTreeSet<String> = forth.iter().copied().filter(back).map(str::to_owned).collect();
        let ways = members.iter().filter(|member| kind(member)).filter_map(|start| way_around(graph, start));
        let way = ways.min_by_key(Vec::len).expect("each member reaches itself");
        found.push(Circle { members, way });
    }
    found
}

/// Nodes at the end of one arrow or more.
fn reached<'a>(graph: &'a Graph, start: &str) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&str> = next(graph, start).collect();
    while let Some(node) = open.pop() {
        if reached.insert(node) {
            open.extend(next(graph, node));
        }
    }
    reached
}

fn next<'a>(graph: &'a Graph, node: &str) -> impl Iterator<Item = &'a str> {
    graph.get(node).into_iter().flatten().map(String::as_str)
}

/// A shortest way from a node back to it.
fn way_around(graph: &Graph, start: &str) -> Option<Vec<String>> {
    let mut from: BTreeMap<&str, &str> = BTreeMap::new();
    let mut open = VecDeque::from([start]);
    while let Some(node) = open.pop_front() {
        for after in next(graph, node) {
            if after == start {
                let before = |node: &&str| from.get(*node).copied();
                let mut way: Vec<String> = std::iter::successors(Some(node), before).map(str::to_owned).collect();
                way.reverse();
                return Some(way);
            }
            if !from.contains_key(after) {
                from.insert(after, node);
                open.push_back(after);
            }
        }
    }
    None
}
