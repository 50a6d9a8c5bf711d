//! Where vehicles go on at the end of each lane.

use crate::map_data::{Lane, LaneId, LaneKind, Turn};
use crate::ops;
use crate::places::Places;

/// A lane that ends goes on in one beside it that comes within this of its end, edge to middle, metres.
const BESIDE_M: f32 = 2.0;
/// Such a lane leads on for at least this, metres.
const ROOM_M: f32 = 10.0;
/// Half the width at which a lane is wide enough for any vehicle, metres.
pub(super) const LEAST_HALF_M: f32 = 1.2;
/// Lanes that run more aslant than this do not go on in each other, radians.
const ASLANT_RAD: f32 = 0.5;

/// A lane that follows, and where on it a vehicle arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onward {
    /// The lane.
    pub lane: LaneId,
    /// Metres from its start: 0 but where a lane ends beside one that goes on.
    pub at_m: f32,
}

/// For each lane where to go on, and where long vehicles do: these turn to the kerb only where there is no
/// other way, or to leave a roundabout, which `circle` tells for each lane. Ways into a junction that never leave it again
/// are left out.
pub(super) fn onward(places: &Places, kerb: i8, circle: &[Option<u32>]) -> Vec<[Vec<Onward>; 2]> {
    let lanes = &places.map.lanes;
    let mut all: Vec<Vec<Onward>> = lanes.iter().map(|lane| successors(lanes, lane)).collect();
    for (id, lane) in lanes.iter().enumerate() {
        if lane.kind == LaneKind::Driving && all[id].is_empty() {
            all[id].extend(beside_end(places, id as LaneId));
        }
    }
    leave_out_dead_ends(lanes, &mut all);
    let long = |onward: Vec<Onward>, circle: &Option<u32>| match circle {
        Some(_) => onward,
        None => wide(lanes, onward, kerb),
    };
    all.into_iter().zip(circle).map(|(onward, circle)| [onward.clone(), long(onward, circle)]).collect()
}

/// Whether a lane comes to an end beside another: it becomes too narrow, or leads on into the middle of that.
pub(super) fn ends_beside(lane: &Lane, onward: &[Onward]) -> bool {
    lane.end().half_width_m < LEAST_HALF_M && !onward.is_empty() || onward.iter().any(|next| next.at_m > 0.0)
}

fn successors(lanes: &[Lane], lane: &Lane) -> Vec<Onward> {
    let drivable = lane.successors.iter().filter(|next| lanes[**next as usize].kind == LaneKind::Driving);
    drivable.map(|next| Onward { lane: *next, at_m: 0.0 }).collect()
}

/// The lane beside the end of one without a successor, in the same direction.
fn beside_end(places: &Places, id: LaneId) -> Option<Onward> {
    let lanes = &places.map.lanes;
    let end = lanes[id as usize].end();
    let goes_on = |lane: LaneId, s_m: f32| {
        let other = &lanes[lane as usize];
        let aslant = ops::wrap_angle(other.at(s_m).heading_rad - end.heading_rad).abs() > ASLANT_RAD;
        lane != id && other.junction.is_none() && !aslant && other.length_m - s_m > ROOM_M
    };
    let near = places.roads().around(end.position, LaneKind::Driving, BESIDE_M);
    let beside = near.into_iter().filter(|p| goes_on(p.lane, p.s_m));
    let nearest = beside.min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))?;
    Some(Onward { lane: nearest.lane, at_m: nearest.s_m })
}

/// Leaves out lanes of junctions that end inside, and those that lead to nothing else.
fn leave_out_dead_ends(lanes: &[Lane], onward: &mut [Vec<Onward>]) {
    loop {
        let leads_on: Vec<bool> =
            lanes.iter().zip(&*onward).map(|(lane, next)| lane.junction.is_none() || !next.is_empty()).collect();
        let before: usize = onward.iter().map(Vec::len).sum();
        onward.iter_mut().for_each(|next| next.retain(|n| leads_on[n.lane as usize]));
        if onward.iter().map(Vec::len).sum::<usize>() == before {
            return;
        }
    }
}

fn wide(lanes: &[Lane], onward: Vec<Onward>, kerb: i8) -> Vec<Onward> {
    let tight = if kerb > 0 { Turn::Left } else { Turn::Right };
    let easy: Vec<_> = onward.iter().copied().filter(|n| lanes[n.lane as usize].turn != tight).collect();
    if easy.is_empty() { onward } else { easy }
}
