//! Traffic lights: their groups and heads.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;

use super::rounding::snap;
use super::shapes::{beside_lanes, point};
use super::signs::Governed;
use super::source::{Approach, Source};
use crate::map_data::{Junction, Lane, LightGroup, LightGroupId, LightHead};
use crate::ops;
use crate::places::Roads;

/// Height of the lamps where the file gives no sensible one, metres.
const LAMPS_M: f32 = 3.2;

/// The light group of each approach to a junction that has one.
pub(super) type Groups = BTreeMap<(u32, Approach), LightGroupId>;

/// One group for each approach with a light, counter-clockwise around its junction.
pub(super) fn groups(
    lanes: &[Lane],
    mut junctions: Vec<Junction>,
    governed: &[Governed],
) -> (Vec<Junction>, Vec<LightGroup>, Groups) {
    let mut lights: BTreeMap<(u32, Approach), f32> = BTreeMap::new();
    for g in governed.iter().filter(|g| g.is_light) {
        let heading = lanes[g.lane as usize].end().heading_rad;
        lights.entry((g.junction, g.approach)).or_insert(heading);
    }
    let mut order: Vec<_> = lights.into_iter().collect();
    order.sort_by(|a, b| a.0.0.cmp(&b.0.0).then(a.1.total_cmp(&b.1)).then(a.0.1.cmp(&b.0.1)));
    let (mut groups, mut ids) = (Vec::new(), BTreeMap::new());
    for (key, _) in order {
        let id = groups.len() as LightGroupId;
        let places = &mut junctions[key.0 as usize].light_groups;
        groups.push(LightGroup { junction: key.0, place: places.len() as u32 });
        places.push(id);
        ids.insert(key, id);
    }
    (junctions, groups, ids)
}

/// One head for each pole and approach.
pub(super) fn heads(source: &Source, roads: &Roads<'_>, governed: &[Governed], groups: &Groups) -> Vec<LightHead> {
    let (mut heads, mut placed) = (Vec::new(), BTreeSet::<(usize, LightGroupId)>::new());
    for g in governed.iter().filter(|g| g.is_light) {
        let group = groups[&(g.junction, g.approach)];
        if !placed.insert((g.signal, group)) {
            continue;
        }
        let lane_end = *roads.lanes[g.lane as usize].end();
        let stands = point(source.net.signals()[g.signal].position);
        let height = stands.z - lane_end.position.z;
        let height_m = if height > 2.0 { snap(height) } else { LAMPS_M };
        let position = beside_lanes(roads, Vec3::new(stands.x, stands.y, lane_end.position.z));
        let facing_rad = snap(ops::wrap_angle(lane_end.heading_rad + std::f32::consts::PI));
        heads.push(LightHead { group, position, facing_rad, height_m });
    }
    heads
}
