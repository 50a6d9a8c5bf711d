//! Junctions that are so near each other that no vehicle can wait between them are one: a zone.

use crate::map_data::{LaneId, LaneKind, MapData, StopKind};

/// Lanes between junctions that are shorter than this hold no vehicle, metres.
const SHORT_M: f32 = 10.0;

/// For each lane its zone: that of its junction, or of those that it connects; none outside.
/// Roundabouts stay apart, where everybody drives on: `circle` tells for each lane its own.
pub(super) fn zones(map: &MapData, circle: &[Option<u32>]) -> Vec<Option<u32>> {
    let mut parent: Vec<u32> = (0..map.junctions.len() as u32).collect();
    let bridges: Vec<Option<[u32; 2]>> =
        (0..map.lanes.len()).map(|id| bridge(map, id as LaneId).filter(|_| circle[id].is_none())).collect();
    for [a, b] in bridges.iter().flatten() {
        let (a, b) = (root(&parent, *a), root(&parent, *b));
        parent[a.max(b) as usize] = a.min(b);
    }
    let lanes = map.lanes.iter().zip(&bridges);
    lanes.map(|(lane, bridge)| lane.junction.or(bridge.map(|b| b[0])).map(|j| root(&parent, j))).collect()
}

fn root(parent: &[u32], mut of: u32) -> u32 {
    while parent[of as usize] != of {
        of = parent[of as usize];
    }
    of
}

/// The junctions before and behind a lane that is too short to wait on; none where a light or a stop
/// sign tells to wait there all the same.
fn bridge(map: &MapData, id: LaneId) -> Option<[u32; 2]> {
    let lane = &map.lanes[id as usize];
    let waits = lane.stop.is_some_and(|stop| !matches!(stop.kind, StopKind::Yield));
    if lane.junction.is_some() || lane.kind != LaneKind::Driving || lane.length_m >= SHORT_M || waits {
        return None;
    }
    let of = |ids: &[LaneId]| ids.iter().find_map(|l| map.lanes[*l as usize].junction);
    Some([of(&lane.predecessors)?, of(&lane.successors)?])
}
