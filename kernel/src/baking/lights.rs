//! Traffic lights: their groups and heads.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;

use super::rounding::snap;
use super::shapes::{beside_lanes, point};
use super::signs::Governed;
use super::source::{Approach, Source};
use crate::map_data::{Junction, Lane, LaneId, LightGroupId, LightHead, Turn};
use crate::ops;
use crate::places::Roads;

/// Height of the lamps where the file gives no sensible one, metres.
const LAMPS_M: f32 = 3.2;

/// The lights of a map.
#[derive(Default)]
pub(super) struct Groups {
    pub list: Vec<Group>,
    /// The lanes before junctions that have one, and what holds whom there.
    pub before: BTreeMap<LaneId, Lights>,
    /// By the index of what governs a lane; none for a sign.
    of: Vec<Option<LightGroupId>>,
}

/// Signals that always show the same.
pub(super) struct Group {
    pub junction: u32,
    pub approach: Approach,
    /// Whether it holds only some turns, which then have the way for themselves.
    pub is_arrow: bool,
    /// Its place among the controllers of its junction; none without a controller.
    pub sequence: Option<u32>,
    /// The lanes before the junction that it holds, each with one that follows inside.
    pub ways: Vec<(LaneId, LaneId)>,
}

/// The lights for those on a lane before a junction.
#[derive(Default)]
pub(super) struct Lights {
    /// That of the line; none where only some turns are held.
    pub line: Option<LightGroupId>,
    /// Those of the lanes inside that have another.
    pub own: Vec<(LaneId, LightGroupId)>,
}

/// What the signals of a group share: junction, approach, turns, and the controller.
type Key = (u32, Approach, &'static [Turn], Option<usize>);

impl Groups {
    /// The groups of a file, counter-clockwise around their junctions.
    pub fn new(source: &Source, lanes: &[Lane], junctions: &[Junction], governed: &[Governed]) -> Self {
        let key = |g: &Governed| -> Option<Key> {
            let controller = controller(source, g.signal, &junctions[g.junction as usize].name);
            Some((g.junction, g.approach, g.turns()?, controller.map(|(id, _)| id)))
        };
        let mut first: BTreeMap<Key, (f32, Option<u32>)> = BTreeMap::new();
        for g in governed {
            let Some(key) = key(g) else { continue };
            let sequence = controller(source, g.signal, &junctions[g.junction as usize].name).map(|(_, at)| at);
            first.entry(key).or_insert((lanes[g.lane as usize].end().heading_rad, sequence));
        }
        let mut order: Vec<_> = first.into_iter().collect();
        order.sort_by(|(a, x), (b, y)| a.0.cmp(&b.0).then(x.0.total_cmp(&y.0)).then(a.cmp(b)));
        let ids: BTreeMap<Key, LightGroupId> = order.iter().zip(0..).map(|((key, _), id)| (*key, id)).collect();
        let list = order.iter().map(|(key, (_, sequence))| Group {
            junction: key.0,
            approach: key.1,
            is_arrow: key.2 != Turn::ALL,
            sequence: *sequence,
            ways: Vec::new(),
        });
        let of = governed.iter().map(|g| key(g).map(|key| ids[&key])).collect();
        let mut groups = Self { list: list.collect(), before: BTreeMap::new(), of };
        groups.hold(lanes, governed);
        groups
    }

    /// The group of each signal that governs a lane; none of a sign.
    pub fn each(&self) -> impl Iterator<Item = Option<LightGroupId>> + '_ {
        self.of.iter().copied()
    }

    /// Finds what holds whom before each junction.
    fn hold(&mut self, lanes: &[Lane], governed: &[Governed]) {
        let mut there: BTreeMap<LaneId, Vec<(&Governed, LightGroupId)>> = BTreeMap::new();
        for (g, group) in governed.iter().zip(&self.of) {
            if let Some(group) = group {
                there.entry(g.lane).or_default().push((g, *group));
            }
        }
        for (before, signals) in there {
            let junction = self.list[signals[0].1 as usize].junction;
            let inside = lanes[before as usize].successors.iter().copied();
            let inside: Vec<_> = inside.filter(|&l| lanes[l as usize].junction == Some(junction)).collect();
            let lights = Lights::of(lanes, &inside, &signals, &self.list);
            for lane in inside {
                let own = lights.own.iter().find(|(l, _)| *l == lane).map(|(_, light)| *light);
                if let Some(light) = own.or(lights.line) {
                    self.list[light as usize].ways.push((before, lane));
                }
            }
            self.before.insert(before, lights);
        }
    }
}

impl Lights {
    /// An arrow goes before a light for all turns, and a light that is referred to from a lane before one of another lane.
    fn of(lanes: &[Lane], inside: &[LaneId], signals: &[(&Governed, LightGroupId)], groups: &[Group]) -> Self {
        let is_arrow = |id: LightGroupId| groups[id as usize].is_arrow;
        let named = |lane: LaneId, arrow: bool| {
            let held = signals.iter().find(|(g, id)| is_arrow(*id) == arrow && g.inside.contains(&lane));
            held.map(|(_, id)| *id)
        };
        let own = |lane: LaneId| named(lane, true).or_else(|| named(lane, false));
        let full = signals.iter().find(|(_, id)| !is_arrow(*id)).map(|(_, id)| *id);
        let straight = inside.iter().copied().min_by_key(|l| (lanes[*l as usize].turn != Turn::Straight, *l));
        let all_held = inside.iter().all(|&lane| own(lane).is_some());
        let line = full.or_else(|| straight.filter(|_| all_held).and_then(own));
        let differs = |&lane: &LaneId| own(lane).filter(|light| Some(*light) != line).map(|light| (lane, light));
        Self { line, own: inside.iter().filter_map(differs).collect() }
    }
}

/// The controller of a signal at a junction, and its place in the order there: as the junction says, else as it says
/// itself; without either it is last.
fn controller(source: &Source, signal: usize, junction: &str) -> Option<(usize, u32)> {
    let controllers = &source.net.signals()[signal].controllers;
    let named = controllers.iter().find_map(|id| {
        let told = source.provenance.controllers.iter().find(|told| told.controller == *id)?;
        let here = told.junctions.iter().find(|at| at.junction_id == junction)?;
        Some((id, here.sequence))
    });
    let (id, here) = named.or(controllers.first().map(|id| (id, None)))?;
    let own = source.net.controller(*id).and_then(|controller| controller.sequence);
    Some((id.0, here.or(own).unwrap_or(u32::MAX)))
}

/// One head for each pole and approach.
pub(super) fn heads(source: &Source, roads: &Roads<'_>, governed: &[Governed], groups: &Groups) -> Vec<LightHead> {
    let (mut heads, mut placed) = (Vec::new(), BTreeSet::<(usize, LightGroupId)>::new());
    for (g, group) in governed.iter().zip(&groups.of) {
        let Some(group) = *group else { continue };
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
