//! Stop lines.

use std::collections::BTreeMap;

use super::catalogue::Meaning;
use super::lights::Groups;
use super::rounding::snap;
use super::signs::Governed;
use crate::map_data::{Crosswalk, Lane, LaneId, StopKind, StopLine};

/// From a stop line to the end of the lane or the edge of a crosswalk, metres.
pub(super) const SETBACK_M: f32 = 1.0;
/// Depth of a stop line along the road, metres.
pub(super) const STOP_LINE_M: f32 = 0.4;
/// A crosswalk this near to the junction moves the stop line before itself, metres.
const CROSSWALK_M: f32 = 15.0;

/// Gives the lanes before junctions the stop lines of their lights and signs, and those inside the lights of their own.
pub(super) fn bake(mut lanes: Vec<Lane>, crossed: &Crossed, governed: &[Governed], groups: &Groups) -> Vec<Lane> {
    for g in governed {
        let kind = match g.meaning {
            Meaning::Stop => StopKind::Stop,
            Meaning::Yield => StopKind::Yield,
            Meaning::Light(_) | Meaning::Priority | Meaning::Limit(_) | Meaning::BusStop => continue,
        };
        let s_m = crossed.stop_place(&lanes, g.lane);
        lanes[g.lane as usize].stop.get_or_insert(StopLine { s_m, kind });
    }
    for (&lane, lights) in &groups.before {
        let s_m = crossed.stop_place(&lanes, lane);
        let stop = &mut lanes[lane as usize].stop;
        let kind = lights.line.map(StopKind::Light).or(stop.map(|stop| stop.kind));
        *stop = Some(StopLine { s_m, kind: kind.unwrap_or(StopKind::Yield) });
        for &(inside, light) in &lights.own {
            lanes[inside as usize].light = Some(light);
        }
    }
    lanes
}

/// Where crosswalks begin on each lane, metres from its start.
pub(super) struct Crossed(BTreeMap<LaneId, Vec<f32>>);

impl Crossed {
    pub fn new(crosswalks: &[Crosswalk]) -> Self {
        let mut edges: BTreeMap<LaneId, Vec<f32>> = BTreeMap::new();
        for crosswalk in crosswalks {
            for &(lane, s) in &crosswalk.lanes {
                edges.entry(lane).or_default().push(s - crosswalk.half_width_m);
            }
        }
        Self(edges)
    }

    /// Where to stop on a lane before a junction: short of its end, or of a crosswalk there.
    pub fn stop_place(&self, lanes: &[Lane], lane: LaneId) -> f32 {
        let length = lanes[lane as usize].length_m;
        let edges = self.0.get(&lane).into_iter().flatten().copied();
        let before = edges.filter(|s| length - s < CROSSWALK_M).fold(length, f32::min);
        snap((before - SETBACK_M).max(0.0))
    }
}
