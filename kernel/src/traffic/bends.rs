//! Stretches of narrow streets in which two long vehicles that come towards each other would touch, as in bends, where the
//! middle of one is inside of its way and its corners are outside. Of two the one that is farther away waits before it.
//!
//! All distances are those of the middles of vehicles: a bend is where the one must not be while the other is in it.

use glam::{Vec2, Vec3};

use crate::geometry::rectangles_overlap;
use crate::map_data::{LaneId, LaneKind, MapData};
use crate::ops;
use crate::places::Places;

use super::axles::on_axles;
use super::step::LINE_MARGIN_M;

/// Half the length and half the width of the longest vehicle, metres.
const LONGEST: Vec2 = Vec2::new(5.5, 1.25);
/// Lanes that are farther apart than this have room for both, metres.
const NEAR_M: f32 = 5.0;
/// Places on both lanes are tried so far from each other, metres.
const PROBE_M: f32 = 1.0;
/// Two that have less room than this between them touch, metres.
const TOUCH_M: f32 = 0.02;
/// Who waits leaves the other so much, metres; a bend becomes longer by that at either end, at most by so much.
const CLEAR_M: f32 = 0.2;
const WIDEN_M: f32 = 15.0;
/// Between two bends there is room for one who waits, and for another behind, metres; else they are one.
const BETWEEN_M: f32 = 13.0;
/// In a longer narrow street waiting would not help, metres.
const LONGEST_STRETCH_M: f32 = 60.0;
/// Who is farther away does not count as coming, metres.
pub(super) const COMES_M: f32 = 40.0;
/// Who waits nearer than this to a junction is in it with its tail, metres.
const CLOSE_M: f32 = 9.0;

/// A bend, for those who come to it along the lane that has it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bend {
    /// From where to where it is, metres from the start of the lane; it may end beyond that of the lane.
    pub here: [f32; 2],
    /// Whether nobody can wait between a junction and it.
    pub is_close: bool,
    /// The lanes on which others come towards it.
    pub there: Vec<Coming>,
    /// Whether those cannot wait.
    pub there_is_close: bool,
}

/// A lane on which others come towards a bend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coming {
    pub lane: LaneId,
    /// From where to where the bend is, metres from the start of the lane; mostly beyond its end.
    pub bend: [f32; 2],
    /// Whether a junction is between, so that only those come who may enter that.
    pub before_junction: bool,
}

/// Middle and direction of a vehicle.
type Pose = (Vec3, Vec3);

/// Lanes that follow each other outside junctions.
struct Street {
    /// Each with its start, metres.
    lanes: Vec<(LaneId, f32)>,
    /// The longest vehicle every [`PROBE_M`].
    poses: Vec<Pose>,
    /// Whether it begins at a junction.
    leaves_junction: bool,
}

/// Two places, numbers of poses, at which long vehicles are too near each other.
struct Touch {
    here: usize,
    street: usize,
    there: usize,
    /// They touch; else they leave each other less than [`CLEAR_M`].
    touches: bool,
}

/// For each lane the bends that begin on it; `place` tells where on a lane so many metres from its start are.
pub(super) fn bends(places: &Places, place: impl Fn(LaneId, f32) -> Vec3) -> Vec<Vec<Bend>> {
    let map = &*places.map;
    let mut found = vec![Vec::new(); map.lanes.len()];
    let streets = streets(map, &place);
    let mut street_of = vec![None; map.lanes.len()];
    for (index, street) in streets.iter().enumerate() {
        street.lanes.iter().for_each(|(lane, start_m)| street_of[*lane as usize] = Some((index, *start_m)));
    }
    for index in 0..streets.len() {
        let near = near_each_other(places, &streets, &street_of, index);
        let touches: Vec<&Touch> = near.iter().filter(|t| t.touches).collect();
        for bend in touches.chunk_by(|a, b| a.street == b.street && (b.here - a.here) as f32 * PROBE_M < BETWEEN_M) {
            let (one, other) = (&streets[index], &streets[bend[0].street]);
            let [here, there] = widened(bend, &near);
            if [here, there].iter().all(|[from_m, to_m]| to_m - from_m < LONGEST_STRETCH_M) {
                one.add_bend(map, &mut found, here, (other, there));
                other.add_bend(map, &mut found, there, (one, here));
            }
        }
    }
    found
}

/// The stretches of two streets in which vehicles touch, and those around them in which they leave each other little room,
/// metres.
fn widened(bend: &[&Touch], near: &[Touch]) -> [[f32; 2]; 2] {
    let span = |touches: &mut dyn Iterator<Item = &Touch>, of: fn(&Touch) -> usize| {
        let (least, most) = touches.map(of).fold((usize::MAX, 0), |(l, m), v| (l.min(v), m.max(v)));
        [least as f32 * PROBE_M, most as f32 * PROBE_M]
    };
    let spans = [|t: &Touch| t.here, |t: &Touch| t.there].map(|of| span(&mut bend.iter().copied(), of));
    let is_within = |number: usize, [from_m, to_m]: [f32; 2]| {
        (from_m - WIDEN_M..=to_m + WIDEN_M).contains(&(number as f32 * PROBE_M))
    };
    let is_about =
        |t: &&Touch| t.street == bend[0].street && is_within(t.here, spans[0]) && is_within(t.there, spans[1]);
    [|t: &Touch| t.here, |t: &Touch| t.there].map(|of| {
        let [from_m, to_m] = span(&mut near.iter().filter(is_about), of);
        [from_m - PROBE_M, to_m + PROBE_M]
    })
}

impl Street {
    /// The lane on which a place is, and where that begins.
    fn lane_at(&self, s_m: f32) -> (LaneId, f32) {
        self.lanes[self.lanes.partition_point(|(_, start_m)| *start_m <= s_m).saturating_sub(1)]
    }

    /// Whether nobody can wait between the junction and a place.
    fn is_close(&self, s_m: f32) -> bool {
        self.leaves_junction && s_m - LINE_MARGIN_M < CLOSE_M
    }

    fn add_bend(&self, map: &MapData, found: &mut [Vec<Bend>], here: [f32; 2], (other, there): (&Self, [f32; 2])) {
        let (lane, start_m) = self.lane_at(here[0]);
        found[lane as usize].push(Bend {
            here: here.map(|m| m - start_m),
            is_close: self.is_close(here[0]),
            there: other.comes(map, there),
            there_is_close: other.is_close(there[0]),
        });
    }

    /// The lanes on which those are who are in a stretch or come to it, and of a junction right before it those that lead there.
    fn comes(&self, map: &MapData, [from_m, to_m]: [f32; 2]) -> Vec<Coming> {
        let first = self.lane_at(from_m);
        let inside = self.lanes.iter().filter(|(_, start_m)| *start_m == first.1 || (from_m..to_m).contains(start_m));
        let on = |(lane, start_m): &(LaneId, f32)| Coming {
            lane: *lane,
            bend: [from_m - start_m, to_m - start_m],
            before_junction: false,
        };
        let mut found: Vec<Coming> = inside.map(on).collect();
        let mut back = vec![found[0]];
        while let Some(coming) = back.pop() {
            let lane = &map.lanes[coming.lane as usize];
            let in_junction = lane.junction.is_some();
            let is_last = coming.before_junction || in_junction && !self.is_close(from_m);
            if is_last || !in_junction && coming.bend[0] > COMES_M {
                continue;
            }
            for before in &lane.predecessors {
                let bend = coming.bend.map(|m| m + map.lanes[*before as usize].length_m);
                if found.iter().all(|known| known.lane != *before) {
                    let coming = Coming { lane: *before, bend, before_junction: in_junction };
                    found.push(coming);
                    back.push(coming);
                }
            }
        }
        found
    }
}

/// All driving lanes outside junctions, in the order in which they follow each other.
fn streets(map: &MapData, place: &impl Fn(LaneId, f32) -> Vec3) -> Vec<Street> {
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
            found.push(street(map, place, lanes, start_m));
        }
    }
    found
}

fn street(map: &MapData, place: &impl Fn(LaneId, f32) -> Vec3, lanes: Vec<(LaneId, f32)>, length_m: f32) -> Street {
    let before = &map.lanes[lanes[0].0 as usize].predecessors;
    let leaves_junction = before.iter().any(|lane| map.lanes[*lane as usize].junction.is_some());
    let mut street = Street { lanes, poses: Vec::new(), leaves_junction };
    let at = |s_m: f32| {
        let (lane, start_m) = street.lane_at(s_m);
        place(lane, s_m - start_m)
    };
    let pose = |k: u32| on_axles(2.0 * LONGEST.x, |ahead_m| at(k as f32 * PROBE_M + ahead_m));
    street.poses = (0..=(length_m / PROBE_M) as u32).map(pose).collect();
    street
}

/// Where along a street a long vehicle is too near to another that comes towards it, on a street that is told later.
fn near_each_other(
    places: &Places,
    streets: &[Street],
    street_of: &[Option<(usize, f32)>],
    index: usize,
) -> Vec<Touch> {
    let lanes = &places.map.lanes;
    let reach = (2.0 * LONGEST.x / PROBE_M) as usize;
    let mut found = Vec::new();
    for (here, me) in streets[index].poses.iter().enumerate() {
        for near in places.roads().around(me.0, LaneKind::Driving, NEAR_M) {
            let Some((street, start_m)) = street_of[near.lane as usize].filter(|(street, _)| *street > index) else {
                continue;
            };
            let heading_rad = lanes[near.lane as usize].at(near.s_m).heading_rad;
            let ahead = Vec2::new(ops::cos(heading_rad), ops::sin(heading_rad)).dot(me.1.truncate());
            if ahead > -0.5 || near.distance_m > NEAR_M {
                continue;
            }
            let middle = ((start_m + near.s_m) / PROBE_M) as usize;
            let (poses, first) = (&streets[street].poses, middle.saturating_sub(reach));
            for (there, you) in poses.iter().enumerate().skip(first).take(2 * reach + 1) {
                if too_near(me, you, CLEAR_M) {
                    found.push(Touch { here, street, there, touches: too_near(me, you, TOUCH_M) });
                }
            }
        }
    }
    found.sort_by_key(|touch| (touch.street, touch.here, touch.there));
    found
}

fn too_near((a, ahead): &Pose, (b, other): &Pose, room_m: f32) -> bool {
    let forward = ahead.truncate().normalize_or(Vec2::X);
    let turned = |v: Vec2| Vec2::new(v.dot(forward), forward.perp_dot(v));
    let axis = turned(other.truncate().normalize_or(Vec2::X));
    rectangles_overlap(LONGEST + room_m, turned((*b - *a).truncate()), axis, LONGEST)
}

#[cfg(test)]
impl Bend {
    /// Where it begins, and the lane on which others come to it with the same there.
    pub fn begins(&self) -> (f32, (LaneId, f32)) {
        let Coming { lane, bend, .. } = self.there[0];
        (self.here[0], (lane, bend[0]))
    }
}
