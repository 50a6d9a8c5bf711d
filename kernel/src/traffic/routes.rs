//! Where vehicles want to go: goals all over the map, and the time from every lane to each of them.
//!
//! A journey leads to a drawn goal, and then the next one begins. Everyone takes the quickest way from
//! where he is, so main roads carry more, and who misses a turn goes on from where that leads.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::actor::ActorKind;
use crate::map_data::{Lane, LaneId, LaneKind};

use super::lane_way::LaneWay;

/// Goals inside the map, and where roads leave it.
const GOALS: usize = 24;
const EXITS: usize = 16;
/// Goals inside times lanes are at most this, and exits times lanes, but for the least of four each.
const TABLE: usize = 1_000_000;
/// A change of lane is worth this detour, s.
pub(super) const CHANGE_S: f32 = 8.0;
/// Lanes shorter than this are none to change on, metres.
const CHANGE_M: f32 = 30.0;
/// Crossing a junction without the right of way takes this much longer, s.
const YIELD_S: f32 = 3.0;
/// Bicycles are not on roads with a higher limit, m/s.
const CYCLED_MPS: f32 = 28.5;

/// Who may go where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// Everywhere.
    Light = 0,
    /// Does not turn to the kerb where there is another way, but to leave a roundabout.
    Long = 1,
    /// Not on motorways.
    Bicycle = 2,
}

impl Class {
    const ALL: [Self; 3] = [Self::Light, Self::Long, Self::Bicycle];

    /// That of a kind of vehicle.
    pub fn of(kind: ActorKind) -> Self {
        match kind {
            heavy if heavy.is_heavy() => Self::Long,
            pedalled if pedalled.is_pedalled() => Self::Bicycle,
            _ => Self::Light,
        }
    }

    /// Whether it may be on a lane.
    pub fn may_use(self, lane: &Lane) -> bool {
        lane.kind == LaneKind::Driving && (self != Self::Bicycle || lane.speed_limit_mps < CYCLED_MPS)
    }
}

/// The goals of a map, and how far they are.
#[derive(Clone, Debug, Default)]
pub(super) struct Routes {
    /// How many there are.
    pub goals: usize,
    /// Seconds from the start of a lane to a goal, by class, goal and lane.
    pub seconds: [Vec<f32>; 3],
    pub lanes: usize,
}

impl Routes {
    /// Those of a map.
    pub fn new(lanes: &[Lane], ways: &[LaneWay], kerb: i8) -> Self {
        let goals = goals(lanes, ways);
        let times: Vec<f32> = lanes.iter().zip(ways).map(|(lane, way)| time_s(lane, way)).collect();
        let seconds = Class::ALL.map(|class| {
            let graph = Graph::new(lanes, ways, &times, class, kerb);
            let mut table = Vec::with_capacity(goals.len() * lanes.len());
            goals.iter().for_each(|goal| table.extend(graph.seconds_to(*goal)));
            table
        });
        Self { goals: goals.len(), seconds, lanes: lanes.len() }
    }
}

/// Lanes at equal distances along all of them, and those with which roads leave the map.
fn goals(lanes: &[Lane], ways: &[LaneWay]) -> Vec<LaneId> {
    let open = |(_, lane): &(usize, &Lane)| lane.kind == LaneKind::Driving && lane.junction.is_none();
    let roads = || lanes.iter().enumerate().filter(open);
    let total_m: f32 = roads().map(|(_, lane)| lane.length_m).sum();
    // Large maps have fewer, so that the tables stay small.
    let most = (TABLE / lanes.len().max(1)).max(4);
    let (inside, exits_most) = (GOALS.min(most), EXITS.min(most));
    let (mut found, mut passed_m, mut next) = (Vec::new(), 0.0, 0);
    for (id, lane) in roads() {
        passed_m += lane.length_m;
        let due = |next: usize| passed_m >= (next as f32 + 0.5) * total_m / inside as f32;
        if due(next) {
            found.push(id as LaneId);
        }
        while next < inside && due(next) {
            next += 1;
        }
    }
    let exits: Vec<LaneId> =
        roads().filter(|(id, _)| ways[*id].onward.is_empty()).map(|(id, _)| id as LaneId).collect();
    let stride = exits.len().div_ceil(exits_most).max(1);
    found.extend(exits.into_iter().step_by(stride));
    found.sort_unstable();
    found.dedup();
    found
}

/// How long a free drive along a lane takes, s.
fn time_s(lane: &Lane, way: &LaneWay) -> f32 {
    let pairs = lane.points.windows(2).zip(&way.speed_mps);
    let drive_s: f32 = pairs.map(|(p, v)| (p[1].s_m - p[0].s_m) / v.min(lane.speed_limit_mps).max(1.0)).sum();
    let yields = way.conflicts.iter().any(|conflict| conflict.precedence < 0);
    drive_s + if yields { YIELD_S } else { 0.0 }
}

/// From where each lane is reached, backwards.
struct Graph<'a> {
    lanes: &'a [Lane],
    /// For each lane those before it, and what the step costs beyond the drive along that one, s.
    before: Vec<Vec<(LaneId, f32)>>,
}

impl<'a> Graph<'a> {
    fn new(lanes: &'a [Lane], ways: &[LaneWay], times: &[f32], class: Class, kerb: i8) -> Self {
        let mut before = vec![Vec::new(); lanes.len()];
        let usable = |id: LaneId| class.may_use(&lanes[id as usize]);
        for (id, lane) in lanes.iter().enumerate().filter(|(id, _)| usable(*id as LaneId)) {
            let onward = if class == Class::Long { &ways[id].onward_wide } else { &ways[id].onward };
            for next in onward.iter().filter(|next| usable(next.lane)) {
                // Who comes to the end of a lane merges under pressure.
                let merge_s = if next.at_m > 0.0 { 2.0 * CHANGE_S } else { 0.0 };
                before[next.lane as usize].push((id as LaneId, times[id] + merge_s));
            }
            if ways[id].zone.is_none() && lane.length_m > CHANGE_M {
                // Bicycles change to the kerb alone.
                let to = |side: i8| class != Class::Bicycle || side == kerb;
                let sides = [(lane.left, 1), (lane.right, -1)].into_iter().filter(|(_, side)| to(*side));
                for beside in sides.filter_map(|(lane, _)| lane).filter(|beside| usable(*beside)) {
                    before[beside as usize].push((id as LaneId, CHANGE_S));
                }
            }
        }
        Self { lanes, before }
    }

    /// Dijkstra's shortest ways, from the goal and the lanes beside it. Times that are not negative
    /// have the order of their bits.
    fn seconds_to(&self, goal: LaneId) -> Vec<f32> {
        let mut seconds = vec![f32::INFINITY; self.lanes.len()];
        let mut open = BinaryHeap::new();
        for lane in beside(self.lanes, goal) {
            seconds[lane as usize] = 0.0;
            open.push(Reverse((0_u32, lane)));
        }
        while let Some(Reverse((bits, lane))) = open.pop() {
            let here_s = f32::from_bits(bits);
            if here_s > seconds[lane as usize] {
                continue;
            }
            for &(before, step_s) in &self.before[lane as usize] {
                let there_s = here_s + step_s;
                if there_s < seconds[before as usize] {
                    seconds[before as usize] = there_s;
                    open.push(Reverse((there_s.to_bits(), before)));
                }
            }
        }
        seconds
    }
}

/// A lane and all beside it in the same direction.
fn beside(lanes: &[Lane], lane: LaneId) -> Vec<LaneId> {
    let side = |step: fn(&Lane) -> Option<LaneId>| {
        let on = move |id: &LaneId| step(&lanes[*id as usize]);
        std::iter::successors(Some(lane), on).skip(1).take(16)
    };
    let mut all: Vec<LaneId> = side(|l| l.left).chain(side(|l| l.right)).chain([lane]).collect();
    all.sort_unstable();
    all.dedup();
    all
}
