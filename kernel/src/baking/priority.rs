//! Who goes first where lanes overlap.

use std::collections::BTreeSet;

use super::catalogue::Meaning;
use super::signs::Governed;
use super::source::Source;
use super::stops::Crossed;
use crate::geometry::direction;
use crate::map_data::{Lane, LaneId, LaneKind, StopKind, StopLine, Turn, circles};

/// Decides who goes first at every overlap, and adds the stop lines of those who wait without a sign.
pub(super) fn bake(source: &Source, mut lanes: Vec<Lane>, crossed: &Crossed, governed: &[Governed]) -> Vec<Lane> {
    let yields = Yields::new(source);
    let told = governed.iter().filter(|g| g.meaning == Meaning::Priority);
    let first: BTreeSet<LaneId> = told.map(|g| g.lane).collect();
    let round: BTreeSet<LaneId> = circles(&lanes).into_iter().flat_map(|circle| circle.lanes).collect();
    let known = Known { yields: &yields, first: &first, round: &round };
    for a in 0..lanes.len() as LaneId {
        for k in 0..lanes[a as usize].conflicts.len() {
            let b = lanes[a as usize].conflicts[k].lane;
            lanes[a as usize].conflicts[k].other_first = gives_way(source, &known, &lanes, a, b);
        }
    }
    for before in 0..lanes.len() {
        let lane = &lanes[before];
        let waits = |next: &LaneId| lanes[*next as usize].conflicts.iter().any(|c| c.other_first);
        if lane.kind == LaneKind::Driving
            && lane.stop.is_none()
            && lane.junction.is_none()
            && lane.successors.iter().any(waits)
        {
            let s_m = crossed.stop_place(&lanes, before as LaneId);
            lanes[before].stop = Some(StopLine { s_m, kind: StopKind::Yield });
        }
    }
    lanes
}

/// What tells who goes first, beside how lanes lie.
struct Known<'a> {
    yields: &'a Yields,
    /// Lanes before junctions with a sign that they go first.
    first: &'a BTreeSet<LaneId>,
    /// Lanes of roundabouts.
    round: &'a BTreeSet<LaneId>,
}

/// Whether traffic on junction lane `a` waits for traffic on `b`; never true both ways.
fn gives_way(source: &Source, known: &Known<'_>, lanes: &[Lane], a: LaneId, b: LaneId) -> bool {
    let (one, other) = (&lanes[a as usize], &lanes[b as usize]);
    if let Some(told) = priority(source, known.yields, lanes, a, b) {
        return told;
    }
    match (sign(lanes, known.first, one), sign(lanes, known.first, other)) {
        (x, y) if x != y => return x > y,
        _ => {}
    }
    // Who comes into a roundabout waits, with or without a sign.
    match (known.round.contains(&a), known.round.contains(&b)) {
        (x, y) if x != y => return y,
        _ => {}
    }
    let (from, towards) = (direction(one.start().heading_rad), direction(other.start().heading_rad));
    let opposite = from.dot(towards) < -0.5;
    let oncoming_left = (one.turn == Turn::Left, other.turn == Turn::Left);
    match (opposite, oncoming_left) {
        (true, (true, false)) => true,
        (true, (false, true)) => false,
        // Right before left: who comes from the right moves to our left.
        (false, _) if from.perp_dot(towards).abs() > 0.3 => from.perp_dot(towards) > 0.0,
        _ => a > b,
    }
}

/// 1 where a sign says to wait, -1 where one says to go first, 0 with a light or without a sign.
fn sign(lanes: &[Lane], first: &BTreeSet<LaneId>, lane: &Lane) -> i32 {
    let told = lane.predecessors.iter().map(|p| match lanes[*p as usize].stop.map(|stop| stop.kind) {
        Some(StopKind::Stop | StopKind::Yield) => 1,
        Some(StopKind::Light(_)) => 0,
        None => -i32::from(first.contains(p)),
    });
    told.max_by_key(|told| told.abs()).unwrap_or_default()
}

/// The `<priority>` records of the file: who waits, for whom.
struct Yields(BTreeSet<(usize, usize)>);

impl Yields {
    fn new(source: &Source) -> Self {
        Self(source.net.priorities().iter().map(|p| (p.low.0, p.high.0)).collect())
    }
}

/// What `<priority>` records say about two junction lanes, by their own or their incoming roads.
fn priority(source: &Source, yields: &Yields, lanes: &[Lane], a: LaneId, b: LaneId) -> Option<bool> {
    let roads = |id: LaneId| {
        let before = lanes[id as usize].predecessors.iter().map(|&p| source.origins[p as usize].road);
        std::iter::once(source.origins[id as usize].road).chain(before).collect::<Vec<_>>()
    };
    let (ours, theirs) = (roads(a), roads(b));
    let waits = |low: &[usize], high: &[usize]| low.iter().any(|&l| high.iter().any(|&h| yields.0.contains(&(l, h))));
    match (waits(&ours, &theirs), waits(&theirs, &ours)) {
        (true, false) => Some(true),
        (false, true) => Some(false),
        _ => None,
    }
}
