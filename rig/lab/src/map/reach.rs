//! Which lanes lead to which, and where people can walk.

use kernel::map::{LaneId, LaneKind, MapData};

use super::figures::{Reach, Walkways};
use super::measure::km;

/// How many lanes are named.
pub(super) const NAMED: usize = 8;

/// Whether every driving lane leads to every other.
pub(super) fn of(map: &MapData) -> Reach {
    let driving = |id: LaneId| map.lanes[id as usize].kind == LaneKind::Driving;
    let onward: Vec<Vec<LaneId>> = (0..map.lanes.len() as LaneId)
        .map(|id| {
            let lane = &map.lanes[id as usize];
            let beside = [lane.left, lane.right].into_iter().flatten();
            let all = lane.successors.iter().copied().chain(beside);
            if driving(id) { all.filter(|next| driving(*next)).collect() } else { Vec::new() }
        })
        .collect();
    let mut parts = parts(&onward);
    parts.retain(|part| driving(part[0]));
    let length_m = |part: &Vec<LaneId>| part.iter().map(|id| f64::from(map.lanes[*id as usize].length_m)).sum::<f64>();
    parts.sort_by(|a, b| length_m(b).total_cmp(&length_m(a)).then(a.cmp(b)));
    let mut outside: Vec<LaneId> = parts.iter().skip(1).flatten().copied().collect();
    outside.sort_unstable();
    let dead_ends: Vec<LaneId> =
        (0..map.lanes.len() as LaneId).filter(|id| driving(*id) && leads_nowhere(map, *id)).collect();
    let named = |ids: &[LaneId]| {
        let mut names: Vec<String> = Vec::new();
        for id in ids {
            let name = &map.lanes[*id as usize].name;
            if names.len() < NAMED && !names.contains(name) {
                names.push(name.clone());
            }
        }
        names
    };
    Reach {
        km: km(parts.iter().map(length_m).sum()),
        parts: parts.len(),
        outside_km: km(parts.iter().skip(1).map(length_m).sum()),
        outside_lanes: outside.len(),
        outside: named(&outside),
        dead_ends: dead_ends.len(),
        dead_end_lanes: named(&dead_ends),
    }
}

/// Whether nobody can drive on from a lane, nor from one that can be changed to.
fn leads_nowhere(map: &MapData, id: LaneId) -> bool {
    let (mut seen, mut open) = (vec![id], vec![id]);
    while let Some(at) = open.pop() {
        let lane = &map.lanes[at as usize];
        if !lane.successors.is_empty() {
            return false;
        }
        for beside in [lane.left, lane.right].into_iter().flatten() {
            if !seen.contains(&beside) {
                seen.push(beside);
                open.push(beside);
            }
        }
    }
    true
}

/// Largest sets of nodes that all lead to each other, each in ascending order (Kosaraju's two passes).
fn parts(onward: &[Vec<LaneId>]) -> Vec<Vec<LaneId>> {
    let mut back: Vec<Vec<LaneId>> = vec![Vec::new(); onward.len()];
    for (from, next) in onward.iter().enumerate() {
        next.iter().for_each(|to| back[*to as usize].push(from as LaneId));
    }
    let mut seen = vec![false; onward.len()];
    let mut order = Vec::new();
    for root in 0..onward.len() as LaneId {
        order.extend(visited(root, onward, &mut seen));
    }
    let mut seen = vec![false; onward.len()];
    let mut parts = Vec::new();
    for &root in order.iter().rev() {
        let mut part = visited(root, &back, &mut seen);
        if !part.is_empty() {
            part.sort_unstable();
            parts.push(part);
        }
    }
    parts
}

/// What can be reached from a node and was not seen before, in the order in which a walk leaves it for good.
fn visited(root: LaneId, onward: &[Vec<LaneId>], seen: &mut [bool]) -> Vec<LaneId> {
    let mut left = Vec::new();
    let mut way = Vec::new();
    if !std::mem::replace(&mut seen[root as usize], true) {
        way.push((root, 0));
    }
    while let Some((at, next)) = way.last_mut() {
        match onward[*at as usize].get(*next) {
            Some(&to) => {
                *next += 1;
                if !std::mem::replace(&mut seen[to as usize], true) {
                    way.push((to, 0));
                }
            }
            None => {
                left.push(*at);
                way.pop();
            }
        }
    }
    left
}

/// How far people can walk, and in how many parts.
pub(super) fn walkways(map: &MapData) -> Walkways {
    let mut beside: Vec<Vec<LaneId>> = vec![Vec::new(); map.walk_nodes.len()];
    for edge in &map.walk_edges {
        let [a, b] = edge.nodes;
        beside[a as usize].push(b);
        beside[b as usize].push(a);
    }
    let lonely = beside.iter().filter(|nodes| nodes.is_empty()).count();
    let length_m = map.walk_edges.iter().map(|edge| f64::from(edge.length_m)).sum();
    Walkways { km: km(length_m), parts: parts(&beside).len() - lonely }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leads_to_each_other_is_one_part() {
        let mut found = parts(&[vec![1], vec![2], vec![0, 3], vec![4], vec![3], vec![0]]);
        found.sort();
        assert_eq!(found, [vec![0, 1, 2], vec![3, 4], vec![5]]);
        assert_eq!(parts(&[]), Vec::<Vec<LaneId>>::new());
        assert_eq!(parts(&[vec![0], vec![]]).len(), 2);
    }

    #[test]
    fn a_way_of_many_lanes_needs_no_stack() {
        let onward: Vec<Vec<LaneId>> = (0..200_000).map(|k| vec![(k + 1) % 200_000]).collect();
        assert_eq!(parts(&onward).len(), 1);
    }
}
