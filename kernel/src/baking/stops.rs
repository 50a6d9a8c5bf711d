//! Stop lines.

use super::lights::Groups;
use super::rounding::snap;
use super::signs::Governed;
use crate::map_data::{Crosswalk, Lane, LaneId, StopKind, StopLine};

/// From a stop line to the end of the lane or the edge of a crosswalk, metres.
const SETBACK_M: f32 = 1.0;
/// A crosswalk this near to the junction moves the stop line before itself, metres.
const CROSSWALK_M: f32 = 15.0;

/// Gives the lanes before junctions the stop lines of their lights and signs.
pub(super) fn bake(
    mut lanes: Vec<Lane>,
    crosswalks: &[Crosswalk],
    governed: &[Governed],
    groups: &Groups,
) -> Vec<Lane> {
    for g in governed {
        let kind = match g.kind {
            StopKind::Light(_) => StopKind::Light(groups[&(g.junction, g.approach)]),
            sign => sign,
        };
        let s_m = stop_place(&lanes, crosswalks, g.lane);
        let stop = &mut lanes[g.lane as usize].stop;
        if stop.is_none() || g.is_light {
            *stop = Some(StopLine { s_m, kind });
        }
    }
    lanes
}

/// Where to stop on a lane before a junction: short of its end, or of a crosswalk there.
pub(super) fn stop_place(lanes: &[Lane], crosswalks: &[Crosswalk], lane: LaneId) -> f32 {
    let length = lanes[lane as usize].length_m;
    let edges = crosswalks.iter().flat_map(|c| c.lanes.iter().map(move |&(l, s)| (l, s - c.half_width_m)));
    let near = edges.filter(|&(l, s)| l == lane && length - s < CROSSWALK_M);
    let before = near.map(|(_, s)| s).fold(length, f32::min);
    snap((before - SETBACK_M).max(0.0))
}
