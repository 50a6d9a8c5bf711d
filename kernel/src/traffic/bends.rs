//! Stretches of narrow streets in which two long vehicles that come towards each other would touch, as in bends, where the
//! middle of one is inside of its way and its corners are outside. Of two the one that is farther away waits before it.

use crate::geometry::rectangles_overlap;
use crate::map_data::{LaneId, LaneKind, MapData};
use crate::ops;
use crate::places::Places;

use super::drive::View;
use super::lane_way::LaneWay;
use super::lists::Entry;
use super::plan::{braking_needed, stopping_speed};
use super::poses::on_axles;
use super::step::{LINE_MARGIN_M, Step};
use super::vehicle::Vehicle;

/// Half the length and half the width of the longest vehicle, metres.
const LONGEST: glam::Vec2 = glam::Vec2::new(5.5, 1.25);
/// Streets whose lanes are farther apart than this have room, metres.
const NEAR_M: f32 = 5.0;
/// Places on both lanes are tried so far from each other, metres.
const PROBE_M: f32 = 1.0;
/// Two that have less room than this between them touch, metres.
const TOUCH_M: f32 = 0.02;
/// Who waits stands where it leaves the other so much, metres.
const CLEAR_M: f32 = 0.2;
/// In a longer narrow street waiting would not help, metres.
const LONGEST_STRETCH_M: f32 = 60.0;
/// Who is no farther away counts as coming, metres.
const COMES_M: f32 = 40.0;
/// Who stands nearer than this to the bend is about to enter it, metres.
const AT_BEND_M: f32 = 3.0;
/// Braking before a bend, m/s², and time in which that speed is taken up, s.
const BRAKE_MPS2: f32 = 1.2;
const ADAPT_S: f32 = 0.3;
/// Who would have to brake harder than this goes first, m/s².
const COMMITTED_MPS2: f32 = 3.0;

/// A bend, for those who come to it along the lane that has it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bend {
    /// Places of a vehicle's middle in it, metres from the start of the lane on which it begins.
    here: [f32; 2],
    /// The lanes on which others come towards it, and the same on each of them.
    there: Vec<(LaneId, [f32; 2])>,
}

#[cfg(test)]
impl Bend {
    /// Where it begins, and the lane on which others come to it with the same there.
    pub fn begins(&self) -> (f32, (LaneId, f32)) {
        let (lane, there) = *self.there.iter().rev().find(|(_, there)| there[0] > 0.0).unwrap_or(&self.there[0]);
        (self.here[0], (lane, there[0]))
    }
}

/// Lanes that follow each other outside junctions, each with its start, metres.
struct Street(Vec<(LaneId, f32)>);

/// Adds the bends to the lanes on which they begin.
pub(super) fn add_bends(places: &Places, ways: &mut [LaneWay]) {
    let map = &*places.map;
    let streets = streets(map);
    let mut street_of = vec![None; map.lanes.len()];
    for (index, street) in streets.iter().enumerate() {
        street.0.iter().for_each(|(lane, start_m)| street_of[*lane as usize] = Some((index, *start_m)));
    }
    for (index, street) in streets.iter().enumerate() {
        let mut found = touching(places, ways, &streets, &street_of, index);
        found.sort_by(|a, b| (a.other, a.s_m).partial_cmp(&(b.other, b.s_m)).expect("numbers"));
        // A bend ends where two places have none between them.
        for bend in found.chunk_by(|a, b| a.other == b.other && b.s_m - a.s_m < 2.5 * PROBE_M) {
            let span = |of: fn(&Touch) -> f32| {
                let (least_m, most_m) =
                    bend.iter().map(of).fold((f32::MAX, f32::MIN), |(l, m), v| (l.min(v), m.max(v)));
                [least_m - PROBE_M, most_m + PROBE_M]
            };
            let (here, there) = (span(|t| t.s_m), span(|t| t.there_m));
            let is_short = [here, there].iter().all(|[from_m, to_m]| to_m - from_m < LONGEST_STRETCH_M);
            if is_short && bend.iter().any(|touch| touch.harder) {
                let (one, other) = (street, &streets[bend[0].other]);
                one.add_bend(ways, here, other.before(map, there));
                other.add_bend(ways, there, one.before(map, here));
            }
        }
    }
}

impl Street {
    /// The lane on which a place is, and where that begins.
    fn lane_at(&self, s_m: f32) -> (LaneId, f32) {
        *self.0.iter().rev().find(|(_, start_m)| *start_m <= s_m).unwrap_or(&self.0[0])
    }

    fn add_bend(&self, ways: &mut [LaneWay], here: [f32; 2], there: Vec<(LaneId, [f32; 2])>) {
        let (lane, start_m) = self.lane_at(here[0]);
        ways[lane as usize].bends.push(Bend { here: here.map(|m| m - start_m), there });
    }

    /// The lanes on which who comes to a stretch of it may be, and the stretch as seen from their starts.
    fn before(&self, map: &MapData, [from_m, to_m]: [f32; 2]) -> Vec<(LaneId, [f32; 2])> {
        let reaches = |lane: LaneId, start_m: f32| {
            start_m < to_m && start_m + map.lanes[lane as usize].length_m > from_m - COMES_M
        };
        let lanes = self.0.iter().filter(|(lane, start_m)| reaches(*lane, *start_m));
        lanes.map(|(lane, start_m)| (*lane, [from_m - start_m, to_m - start_m])).collect()
    }
}

/// All driving lanes outside junctions, in the order in which they follow each other.
fn streets(map: &MapData) -> Vec<Street> {
    let is_street = |id: LaneId| {
        let lane = &map.lanes[id as usize];
        lane.kind == LaneKind::Driving && lane.junction.is_none()
    };
    let only = |ids: &[LaneId]| if let [id] = *ids { Some(id).filter(|id| is_street(*id)) } else { None };
    let after = |id: LaneId| only(&map.lanes[id as usize].successors);
    let before = |id: LaneId| only(&map.lanes[id as usize].predecessors).filter(|b| after(*b) == Some(id));
    let mut found = Vec::new();
    let mut seen = vec![false; map.lanes.len()];
    // A ring has no first lane: it is begun anywhere, once all others are told.
    let all = 0..map.lanes.len() as LaneId;
    let firsts = all.clone().filter(|id| before(*id).is_none()).chain(all).filter(|id| is_street(*id));
    for first in firsts {
        let (mut lanes, mut next, mut start_m) = (Vec::new(), Some(first), 0.0);
        while let Some(id) = next.filter(|id| !std::mem::replace(&mut seen[*id as usize], true)) {
            lanes.push((id, start_m));
            start_m += map.lanes[id as usize].length_m;
            next = after(id).filter(|next| before(*next) == Some(id));
        }
        if !lanes.is_empty() {
            found.push(Street(lanes));
        }
    }
    found
}

/// Two places, along two streets, at which long vehicles are too near each other.
struct Touch {
    s_m: f32,
    other: usize,
    there_m: f32,
    /// Whether they touch.
    harder: bool,
}

/// Where along a street a long vehicle is too near to another that comes towards it on one told later.
fn touching(
    places: &Places,
    ways: &[LaneWay],
    streets: &[Street],
    street_of: &[Option<(usize, f32)>],
    index: usize,
) -> Vec<Touch> {
    let lanes = &places.map.lanes;
    let mut found = Vec::new();
    for (lane, start_m) in &streets[index].0 {
        let length_m = lanes[*lane as usize].length_m;
        for k in 0..=(length_m / PROBE_M) as u32 {
            let s_m = (k as f32 * PROBE_M).min(length_m);
            let here = lanes[*lane as usize].at(s_m);
            for near in places.roads().around(here.position, LaneKind::Driving, NEAR_M) {
                let there = lanes[near.lane as usize].at(near.s_m);
                let oncoming = ops::cos(here.heading_rad - there.heading_rad) < -0.5;
                let Some((other, other_start_m)) = street_of[near.lane as usize].filter(|_| oncoming) else { continue };
                if other <= index || near.distance_m > NEAR_M {
                    continue;
                }
                let me = pose(places, ways, &streets[index], start_m + s_m);
                let (near_m, reach) = (other_start_m + near.s_m, 2.0 * LONGEST.x / PROBE_M);
                for there_m in (-reach as i32..=reach as i32).map(|k| near_m + k as f32 * PROBE_M) {
                    let you = pose(places, ways, &streets[other], there_m);
                    if too_near(me, you, CLEAR_M) {
                        let harder = too_near(me, you, TOUCH_M);
                        found.push(Touch { s_m: start_m + s_m, other, there_m, harder });
                    }
                }
            }
        }
    }
    found
}

/// Middle and direction of a long vehicle.
type Pose = (glam::Vec3, glam::Vec3);

fn pose(places: &Places, ways: &[LaneWay], street: &Street, at_m: f32) -> Pose {
    on_axles(2.0 * LONGEST.x, |from_middle_m| {
        let s_m = at_m + from_middle_m;
        let (lane, start_m) = street.lane_at(s_m);
        ways[lane as usize].pose(&places.map.lanes[lane as usize], s_m - start_m).position
    })
}

fn too_near((a, ahead): Pose, (b, other): Pose, room_m: f32) -> bool {
    let forward = ahead.truncate().normalize_or(glam::Vec2::X);
    let turned = |v: glam::Vec2| glam::Vec2::new(v.dot(forward), forward.perp_dot(v));
    let axis = turned(other.truncate().normalize_or(glam::Vec2::X));
    rectangles_overlap(LONGEST + room_m, turned((b - a).truncate()), axis, LONGEST)
}

impl View<'_> {
    /// The greatest acceleration that bends leave a long vehicle before which another goes through them, m/s².
    pub(super) fn heed_bends(&self, index: usize, steps: &[Step], next: &Vehicle) -> f32 {
        let waits = self.bend_to_wait_at(index, steps, next);
        waits.map_or(f32::MAX, |(bend_m, _)| {
            (stopping_speed(bend_m - LINE_MARGIN_M, BRAKE_MPS2) - next.speed_mps) / ADAPT_S
        })
    }

    /// The nearest bend through which another goes first: the way there, metres, and the other.
    pub(super) fn bend_to_wait_at(&self, index: usize, steps: &[Step], me: &Vehicle) -> Option<(f32, usize)> {
        let is_long = |index: usize| self.drivers[index].is_long();
        let bends =
            steps.iter().flat_map(|step| self.ways.lanes[step.lane as usize].bends.iter().map(move |b| (step, b)));
        let ahead = bends.filter(|_| is_long(index)).filter_map(|(step, bend)| {
            let bend_m = step.start_m + bend.here[0];
            let mine = (way_to(bend_m, me.speed_mps), me.id);
            let others =
                bend.there.iter().flat_map(|(lane, there)| self.lists.on(*lane).iter().map(move |e| (e, *there)));
            let mut others =
                others.filter(|(entry, _)| entry.vehicle as usize != index && is_long(entry.vehicle as usize));
            let first = others.find(|(entry, there)| goes_first(entry, *there, mine))?;
            (bend_m > 0.0).then_some((bend_m, first.0.vehicle as usize))
        });
        ahead.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The way to a bend; none for who is in it, or can hardly stop before it.
fn way_to(bend_m: f32, speed_mps: f32) -> f32 {
    if braking_needed(speed_mps, bend_m) > COMMITTED_MPS2 { 0.0 } else { bend_m.max(0.0) }
}

/// Whether another, whose bend lies there, goes through it before one so far away with that id.
fn goes_first(other: &Entry, [from_m, to_m]: [f32; 2], mine: (f32, u16)) -> bool {
    let bend_m = from_m - other.s_m;
    let comes = other.speed_mps > 0.5 || bend_m < AT_BEND_M;
    other.s_m < to_m && bend_m < COMES_M && comes && (way_to(bend_m, other.speed_mps), other.id) < mine
}
