//! Which signals and signs of the file are for which lanes.

use std::collections::BTreeSet;

use super::source::{Approach, Source};
use crate::map_data::{Lane, LaneId, LaneKind, StopKind};

/// Type of a three-light signal in the catalogue that OpenDRIVE files use when they name no country.
const LIGHT: &str = "1000001";
/// Stop sign, German catalogue.
const STOP: &str = "206";
/// Yield sign, German catalogue.
const YIELD: &str = "205";
/// A sign is followed this far to the junction that it is about, metres.
const AHEAD_M: f32 = 60.0;

/// A lane before a junction that a signal is for.
pub(super) struct Governed {
    pub junction: u32,
    pub approach: Approach,
    pub lane: LaneId,
    pub is_light: bool,
    /// Of a light without its group.
    pub kind: StopKind,
    /// Its index in the file.
    pub signal: usize,
}

/// Which signals govern which lanes.
pub(super) fn governed(source: &Source, lanes: &[Lane]) -> Vec<Governed> {
    let mut found = Vec::new();
    let mut known: BTreeSet<(usize, u32, LaneId)> = BTreeSet::new();
    for (signal, s) in source.net.signals().iter().enumerate() {
        let is_light = s.kind == LIGHT || (s.dynamic && s.kind.starts_with("10000"));
        let kind = match s.kind.as_str() {
            _ if is_light => StopKind::Light(0),
            STOP => StopKind::Stop,
            YIELD => StopKind::Yield,
            _ => continue,
        };
        let signalled = s.lanes.iter().filter_map(|l| source.ids.get(&l.0).copied());
        for lane in signalled.filter(|&l| lanes[l as usize].kind == LaneKind::Driving) {
            for (junction, before) in before_junction(lanes, lane) {
                let approach = source.origins[before as usize].approach();
                if known.insert((signal, junction, before)) {
                    found.push(Governed { junction, approach, lane: before, is_light, kind, signal });
                }
            }
        }
    }
    found
}

/// The junctions that a signal on `lane` is about, each with the lanes before it.
fn before_junction(lanes: &[Lane], lane: LaneId) -> Vec<(u32, LaneId)> {
    let here = &lanes[lane as usize];
    if let Some(junction) = here.junction {
        return here.predecessors.iter().map(|&p| (junction, p)).collect();
    }
    let (mut at, mut gone) = (lane, 0.0);
    loop {
        let next = &lanes[at as usize].successors;
        let entered = next.iter().find_map(|&n| lanes[n as usize].junction);
        match (entered, next.as_slice()) {
            (Some(junction), _) => return vec![(junction, at)],
            (None, &[only]) if gone < AHEAD_M => {
                gone += lanes[only as usize].length_m;
                at = only;
            }
            _ => return Vec::new(),
        }
    }
}
