//! Signals: stop lines, light groups and their heads.

use std::collections::BTreeMap;

use glam::Vec3;

use super::bake::{Approach, Source, direction, point, snap, snap3};
use super::{LaneId, LaneKind, LightGroup, LightHead, RoadNetwork, StopKind, StopLine, crosswalks};
use crate::ops;

/// Type of a three-light signal in the catalogue that OpenDRIVE files use when they name no country.
const LIGHT: &str = "1000001";
/// Stop sign, German catalogue.
const STOP: &str = "206";
/// Yield sign, German catalogue.
const YIELD: &str = "205";
/// A sign is followed this far to the junction that it is about, metres.
const AHEAD_M: f32 = 60.0;
/// From a stop line to the end of the lane or the edge of a zebra crossing, metres.
const SETBACK_M: f32 = 1.0;
/// A zebra crossing this far from the junction moves the stop line before itself, metres.
const ZEBRA_M: f32 = 15.0;
/// Height of the lamps where the file gives no sensible one, metres.
const LAMPS_M: f32 = 3.2;

/// A lane before a junction that a signal is for.
pub(super) struct Governed {
    pub junction: u32,
    pub approach: Approach,
    pub lane: LaneId,
    pub is_light: bool,
    kind: StopKind,
    signal: usize,
}

/// Which signals govern which lanes.
pub(super) fn governed(source: &Source, map: &RoadNetwork) -> Vec<Governed> {
    let mut found = Vec::new();
    for (signal, s) in source.net.signals().iter().enumerate() {
        let is_light = s.kind == LIGHT || (s.dynamic && s.kind.starts_with("10000"));
        let kind = match s.kind.as_str() {
            _ if is_light => StopKind::Light(0),
            STOP => StopKind::Stop,
            YIELD => StopKind::Yield,
            _ => continue,
        };
        let lanes = s.lanes.iter().filter_map(|l| source.ids.get(&l.0).copied());
        for lane in lanes.filter(|&l| map.lanes[l as usize].kind == LaneKind::Driving) {
            for (junction, before) in before_junction(map, lane) {
                let approach = source.origins[before as usize].approach();
                if !found.iter().any(|g: &Governed| g.lane == before && g.signal == signal && g.junction == junction) {
                    found.push(Governed { junction, approach, lane: before, is_light, kind, signal });
                }
            }
        }
    }
    found
}

/// The junctions that a signal on `lane` is about, each with the lanes before it.
fn before_junction(map: &RoadNetwork, lane: LaneId) -> Vec<(u32, LaneId)> {
    let here = &map.lanes[lane as usize];
    if let Some(junction) = here.junction {
        return here.predecessors.iter().map(|&p| (junction, p)).collect();
    }
    let (mut at, mut gone) = (lane, 0.0);
    loop {
        let next = &map.lanes[at as usize].successors;
        let entered = next.iter().find_map(|&n| map.lanes[n as usize].junction);
        match (entered, next.as_slice()) {
            (Some(junction), _) => return vec![(junction, at)],
            (None, &[only]) if gone < AHEAD_M => {
                gone += map.lanes[only as usize].length_m;
                at = only;
            }
            _ => return Vec::new(),
        }
    }
}

/// Stop lines from signs and lights, light groups, and the heads of the lights.
pub(super) fn bake(source: &Source, map: &mut RoadNetwork) {
    let governed = governed(source, map);
    let groups = groups(map, &governed);
    for g in &governed {
        let kind = match g.kind {
            StopKind::Light(_) => StopKind::Light(groups[&(g.junction, g.approach)]),
            sign => sign,
        };
        let s_m = stop_place(map, g.lane);
        let stop = &mut map.lanes[g.lane as usize].stop;
        if stop.is_none() || g.is_light {
            *stop = Some(StopLine { s_m, kind });
        }
    }
    heads(source, map, &governed, &groups);
    crosswalks::assign_junctions(map);
}

/// One group for each approach with a light, counter-clockwise around its junction.
fn groups(map: &mut RoadNetwork, governed: &[Governed]) -> BTreeMap<(u32, Approach), u32> {
    let mut lights: BTreeMap<(u32, Approach), f32> = BTreeMap::new();
    for g in governed.iter().filter(|g| g.is_light) {
        let heading = map.lanes[g.lane as usize].end().heading_rad;
        lights.entry((g.junction, g.approach)).or_insert(heading);
    }
    let mut order: Vec<_> = lights.into_iter().collect();
    order.sort_by(|a, b| a.0.0.cmp(&b.0.0).then(a.1.total_cmp(&b.1)).then(a.0.1.cmp(&b.0.1)));
    let mut ids = BTreeMap::new();
    for (key, _) in order {
        let id = map.light_groups.len() as u32;
        let places = &mut map.junctions[key.0 as usize].light_groups;
        map.light_groups.push(LightGroup { junction: key.0, place: places.len() as u32 });
        places.push(id);
        ids.insert(key, id);
    }
    ids
}

/// Where to stop on a lane before a junction: short of its end, or of a zebra crossing there.
pub(super) fn stop_place(map: &RoadNetwork, lane: LaneId) -> f32 {
    let length = map.lanes[lane as usize].length_m;
    let zebras = map.crosswalks.iter().flat_map(|c| c.lanes.iter().map(move |&(l, s)| (l, s - c.half_width_m)));
    let before = zebras.filter(|&(l, s)| l == lane && length - s < ZEBRA_M).map(|(_, s)| s).fold(length, f32::min);
    snap((before - SETBACK_M).max(0.0))
}

/// One head for each pole and approach.
fn heads(source: &Source, map: &mut RoadNetwork, governed: &[Governed], groups: &BTreeMap<(u32, Approach), u32>) {
    let mut placed: Vec<(usize, u32)> = Vec::new();
    for g in governed.iter().filter(|g| g.is_light) {
        let group = groups[&(g.junction, g.approach)];
        if placed.contains(&(g.signal, group)) {
            continue;
        }
        placed.push((g.signal, group));
        let signal = &source.net.signals()[g.signal];
        let lane_end = *map.lanes[g.lane as usize].end();
        let stands = point(signal.position);
        let height = stands.z - lane_end.position.z;
        let height_m = if height > 2.0 { snap(height) } else { LAMPS_M };
        let position = beside_lanes(map, Vec3::new(stands.x, stands.y, lane_end.position.z));
        let facing_rad = snap(ops::wrap_angle(lane_end.heading_rad + std::f32::consts::PI));
        map.light_heads.push(LightHead { group, position, facing_rad, height_m });
    }
}

/// A place moved out of the driving lane that holds it, to the right.
pub(super) fn beside_lanes(map: &RoadNetwork, position: Vec3) -> Vec3 {
    let mut at = position;
    for _ in 0..8 {
        let Some(inside) = map.lanes_at(at, LaneKind::Driving).first().copied() else { break };
        let lane = map.lane_point(inside.lane, inside.s_m);
        let right = -direction(lane.heading_rad).perp();
        at += (right * (lane.half_width_m + inside.lateral_m + 0.4)).extend(0.0);
    }
    snap3(at)
}
