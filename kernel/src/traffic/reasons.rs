//! Where a map gives people a reason to be: at bus stops, where roads are crossed, before houses, at benches.
//!
//! Maps tell neither shops nor schools nor parks apart; the draws are assumptions.

use glam::{Vec2, Vec3};

use crate::geometry::direction;
use crate::map_data::{MapData, PropKind, WalkEdge};
use crate::places::Grid;
use crate::rng::{Stream, unit};

use super::walker::Walker;

/// Ways are looked at in pieces of about this length, metres.
const PIECE_M: f32 = 8.0;
/// A bus stop, the end of a crosswalk, a house and a bench, bin or box each draw so many more than a way with no reason to
/// be there does, if they are within so many metres.
const STOP: Reason = Reason { draw: 4.0, reach_m: 8.0 };
const CROSSING: Reason = Reason { draw: 1.0, reach_m: 8.0 };
const HOUSE: Reason = Reason { draw: 1.0, reach_m: 6.0 };
const BENCH: Reason = Reason { draw: 2.0, reach_m: 8.0 };
/// At stops and benches so many of those who come by take their time, and go at this share of their pace.
const IDLERS: f32 = 0.4;
const IDLE_PACE: f32 = 0.3;
/// Of a stop, from the edge of its lane to where people wait, metres.
const BESIDE_M: f32 = 2.0;
/// What draws that, as a key of random numbers.
const IDLE_KEY: u64 = 1 << 32;
/// Cells of the lookup, metres.
const CELL_M: f32 = 16.0;

/// Why people are somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reason {
    draw: f32,
    reach_m: f32,
}

/// How much a way draws people; 1 without a reason.
#[derive(Clone, Debug, Default)]
pub(super) struct Draw {
    /// Of its pieces, which are equally long.
    pub pieces: Vec<f32>,
    /// Bit set of the first of them at which people take their time.
    idle: u64,
    /// Of what lies on from its first and from its last point, which nobody sees in a crosswalk itself: of all the way up to
    /// where another one leaves it; over a crosswalk of those beyond.
    pub onward: [f32; 2],
}

impl Draw {
    /// The piece at a place on a way of this length.
    fn piece(&self, s_m: f32, length_m: f32) -> usize {
        let piece = (s_m / length_m * self.pieces.len() as f32) as usize;
        piece.min(self.pieces.len() - 1)
    }

    /// The draw at a place on a way of this length.
    #[cfg(test)]
    pub fn at(&self, s_m: f32, length_m: f32) -> f32 {
        self.pieces[self.piece(s_m, length_m)]
    }

    /// The pace of a walker at a place on a way of this length, as a share of the usual.
    pub fn pace(&self, seed: u64, walker: &Walker, length_m: f32) -> f32 {
        let idle =
            self.idle != 0 && self.idle.checked_shr(self.piece(walker.s_m, length_m) as u32).unwrap_or(0) & 1 != 0;
        let takes_time = || unit(seed, Stream::Walk, u64::from(walker.id) | IDLE_KEY, u64::from(walker.hops)) < IDLERS;
        if idle && takes_time() { IDLE_PACE } else { 1.0 }
    }
}

/// What draws people: a box on the ground.
struct Sight {
    reason: Reason,
    middle: Vec2,
    forward: Vec2,
    half: Vec2,
}

impl Sight {
    fn point(reason: Reason, place: Vec3) -> Self {
        Self { reason, middle: place.truncate(), forward: Vec2::X, half: Vec2::ZERO }
    }

    fn reaches(&self, place: Vec2) -> bool {
        let to = place - self.middle;
        let beyond = Vec2::new(to.dot(self.forward).abs(), self.forward.perp_dot(to).abs()) - self.half;
        beyond.max(Vec2::ZERO).length() < self.reason.reach_m
    }
}

/// What each way draws; the kerb is to the left (1) or right (-1) of lanes.
pub(super) fn draws(map: &MapData, kerb: i8) -> Vec<Draw> {
    let sights = sights(map, kerb);
    let bounds = |s: &Sight| {
        let reach = Vec2::splat(s.half.length() + s.reason.reach_m);
        (s.middle - reach, s.middle + reach)
    };
    let grid = Grid::new(&sights.iter().map(bounds).collect::<Vec<_>>(), CELL_M);
    let near = |place: Vec2, reason: Reason| {
        let mut of_kind = grid.around(place, 0.0).map(|i| &sights[i as usize]).filter(|s| s.reason == reason);
        of_kind.any(|s| s.reaches(place))
    };
    let draw_of = |way: &WalkEdge| {
        let count = (way.length_m / PIECE_M) as usize + 1;
        let middle = |k: usize| along(&way.points, (k as f32 + 0.5) / count as f32 * way.length_m);
        let mut draw = Draw { pieces: vec![1.0; count], idle: 0, onward: [1.0; 2] };
        let mut goals = 0.0;
        for k in 0..count {
            for reason in [STOP, CROSSING, HOUSE, BENCH].into_iter().filter(|reason| near(middle(k), *reason)) {
                draw.pieces[k] += reason.draw;
                goals += if reason == CROSSING { 0.0 } else { reason.draw };
                let idle = k < 64 && way.crosswalk.is_none() && (reason == STOP || reason == BENCH);
                draw.idle |= if idle { 1 << k } else { 0 };
            }
        }
        draw.onward = [1.0 + goals / count as f32; 2];
        draw
    };
    let mut draws: Vec<Draw> = map.walk_edges.iter().map(draw_of).collect();
    add_onward(map, &mut draws);
    draws
}

fn sights(map: &MapData, kerb: i8) -> Vec<Sight> {
    let mut sights = Vec::new();
    for stop in &map.bus_stops {
        let place = map.lanes[stop.lane as usize].straight_on(stop.s_m);
        let beside = place.beside(f32::from(kerb) * (place.half_width_m + BESIDE_M));
        sights.push(Sight::point(STOP, beside));
    }
    for edge in map.walk_edges.iter().filter(|e| e.crosswalk.is_some()) {
        sights.extend(edge.nodes.map(|n| Sight::point(CROSSING, map.walk_nodes[n as usize].position)));
    }
    for prop in &map.props {
        let reason = match prop.kind {
            PropKind::Building => HOUSE,
            PropKind::Furniture => BENCH,
            _ => continue,
        };
        let (middle, forward) = (prop.position.truncate(), direction(prop.heading_rad));
        sights.push(Sight { reason, middle, forward, half: prop.size.truncate() * 0.5 });
    }
    sights
}

/// The place so far along a line.
fn along(points: &[Vec3], mut left_m: f32) -> Vec2 {
    for pair in points.windows(2) {
        let [a, b] = [pair[0].truncate(), pair[1].truncate()];
        let length_m = a.distance(b);
        if left_m < length_m {
            return a.lerp(b, left_m / length_m);
        }
        left_m -= length_m;
    }
    points[points.len() - 1].truncate()
}

/// Adds what lies on, which is the same for all ways of one stretch without a choice.
fn add_onward(map: &MapData, draws: &mut [Draw]) {
    let mut seen = vec![false; draws.len()];
    for first in 0..draws.len() {
        if map.walk_edges[first].crosswalk.is_none() && !seen[first] {
            let stretch = stretch(map, first, &mut seen);
            let (mut total, mut length_m) = (0.0, 0.0);
            for &edge in &stretch {
                total += draws[edge].onward[0] * map.walk_edges[edge].length_m;
                length_m += map.walk_edges[edge].length_m;
            }
            stretch.iter().for_each(|&edge| draws[edge].onward = [total / length_m; 2]);
        }
    }
    for (edge, way) in map.walk_edges.iter().enumerate().filter(|(_, way)| way.crosswalk.is_some()) {
        let beyond = |node: u32| {
            let sidewalks = map.walk_nodes[node as usize].edges.iter().map(|e| *e as usize);
            let sidewalks = sidewalks.filter(|e| map.walk_edges[*e].crosswalk.is_none());
            let count = sidewalks.clone().count().max(1) as f32;
            sidewalks.map(|e| draws[e].onward[0]).sum::<f32>().max(1.0) / count
        };
        draws[edge].onward = [beyond(way.nodes[1]), beyond(way.nodes[0])];
    }
}

/// All sidewalks that lead on from one to the next where no other way leaves them.
fn stretch(map: &MapData, first: usize, seen: &mut [bool]) -> Vec<usize> {
    seen[first] = true;
    let (mut found, mut at) = (vec![first], 0);
    while at < found.len() {
        for node in map.walk_edges[found[at]].nodes {
            if let [a, b] = map.walk_nodes[node as usize].edges[..] {
                for next in [a as usize, b as usize] {
                    if !seen[next] && map.walk_edges[next].crosswalk.is_none() {
                        seen[next] = true;
                        found.push(next);
                    }
                }
            }
        }
        at += 1;
    }
    found
}
