//! Bus stops, by their signs.

use super::catalogue::{self, Meaning, meaning};
use super::notes::{Notes, Passed};
use super::rounding::snap;
use super::shapes::point;
use super::source::Source;
use crate::map_data::{BusStop, Lane, LaneId, LaneKind};

/// A stop nearer than this to the start or end of its lane is served by nobody: the bus would stand in a junction or keep
/// others from it, metres.
const CLEAR_M: [f32; 2] = [15.0, 20.0];
/// A sign farther than this from a lane stands elsewhere, metres.
const BESIDE_M: f32 = 15.0;

/// The stops of the lanes at the kerb.
pub(super) fn bake(source: &Source, lanes: &[Lane], notes: &mut Notes) -> Vec<BusStop> {
    let mut found = Vec::new();
    let signals = source.net.signals().iter().enumerate();
    for (index, signal) in signals.filter(|(_, signal)| meaning(signal) == Some(Meaning::BusStop)) {
        let at = point(signal.position);
        let signalled = signal.lanes.iter().filter_map(|l| source.ids.get(&l.0).copied());
        let beside = |&id: &LaneId| {
            let lane = &lanes[id as usize];
            let (s_m, _, away_m) = lane.project(at);
            let clear = s_m > CLEAR_M[0] && s_m < lane.length_m - CLEAR_M[1] && away_m < BESIDE_M;
            (lane.kind == LaneKind::Driving && lane.junction.is_none() && clear).then_some((away_m, id, snap(s_m)))
        };
        let nearest = signalled.filter_map(|id| beside(&id)).min_by(|a, b| a.0.total_cmp(&b.0));
        if nearest.is_none() {
            let (said, place) = (|| catalogue::said(signal), || source.place_of_signal(index));
            notes.pass(Passed::Signal, "no bus can halt there", said, place);
        }
        found.extend(nearest.map(|(_, lane, s_m)| BusStop { lane, s_m }));
    }
    found.sort_by(|a, b| a.lane.cmp(&b.lane).then(a.s_m.total_cmp(&b.s_m)));
    found
}
