//! The signal programme of each junction with lights.
//!
//! Where the file has controllers its phases are theirs, in ascending sequence, those of the same one together; other
//! groups go with a phase that they do not conflict with, else they get one of their own. So opposing approaches
//! are green together, and who turns off across oncoming traffic gives way to it, unless an arrow gives him the way.

use std::collections::{BTreeMap, BTreeSet};

use super::lights::{Group, Groups};
use super::stops::Crossed;
use crate::geometry::direction;
use crate::map_data::{Crosswalk, Junction, Lane, LaneId, LightGroup, LightGroupId, Turn};
use crate::ops;
use crate::time::TICK_HZ;

/// Green of a phase: this, and so much more for each approach that it serves, seconds.
const GREEN_S: [u32; 2] = [5, 5];
/// Yellow up to so many km/h, seconds: 1 s and braking with 3.05 m/s² (Institute of Transportation Engineers), in whole
/// seconds as in the Richtlinien für Lichtsignalanlagen.
const YELLOW_S: [(f32, u32); 3] = [(50.0, 3), (70.0, 4), (f32::MAX, 5)];
/// Who passes the line in the last moment of yellow clears the junction with this, going straight or turning, m/s
/// (Richtlinien für Lichtsignalanlagen).
const CLEARING_MPS: [f32; 2] = [10.0, 7.0];
/// Length that has to be clear behind his front, metres.
const CLEARED_M: f32 = 6.0;
/// Who passes his line as it turns green does so with this (the same), m/s.
const ENTERING_MPS: f32 = 40.0 / 3.6;
/// All-red is this at least, and a multiple of half of it, seconds.
const ALL_RED_S: f32 = 1.0;
/// The slowest walk so fast, m/s,
const WALK_MPS: f32 = 0.8;
/// beyond the kerbs by so much, metres,
const KERBS_M: f32 = 2.0;
/// and start only with so much red to spare, seconds.
const SPARE_S: f32 = 3.0;

/// What the lights of a map are baked from.
pub(super) struct Programmes<'a> {
    pub lanes: &'a [Lane],
    pub crosswalks: &'a [Crosswalk],
    pub crossed: &'a Crossed,
    pub groups: &'a Groups,
}

/// The groups that hold each lane inside a junction, with the distance from the line to its start, metres.
type Inside = BTreeMap<LaneId, Vec<(LightGroupId, f32)>>;

/// A part of a programme: who is green, and how long green, yellow and the all-red after it are, ticks.
struct Phase {
    sequence: Option<u32>,
    groups: Vec<LightGroupId>,
    green: u32,
    yellow: u32,
    all_red: u32,
}

impl Programmes<'_> {
    /// Gives the junctions their programmes.
    pub fn bake(&self, mut junctions: Vec<Junction>) -> (Vec<Junction>, Vec<LightGroup>) {
        let mut lights = Vec::new();
        for group in self.groups.list.chunk_by(|a, b| a.junction == b.junction) {
            let ids: Vec<_> = (lights.len() as u32..).take(group.len()).collect();
            let (phases, cycle_ticks) = self.programme(&ids);
            let junction = &mut junctions[group[0].junction as usize];
            junction.light_groups = phases.iter().flat_map(|(phase, _)| phase.groups.iter().copied()).collect();
            junction.cycle_ticks = cycle_ticks;
            for id in ids {
                let own = |(phase, from): &(Phase, u32)| phase.groups.contains(&id).then_some((phase.whole(), *from));
                // Every group is in one phase.
                let ((green, yellow), from) = phases.iter().find_map(own).unwrap_or_default();
                let yellow_ticks = self.yellow(id);
                lights.push(LightGroup {
                    junction: group[0].junction,
                    green_from_ticks: from,
                    green_ticks: green + yellow - yellow_ticks,
                    yellow_ticks,
                });
            }
        }
        (junctions, lights)
    }

    fn group(&self, id: LightGroupId) -> &Group {
        &self.groups.list[id as usize]
    }

    /// The phases of a junction with these groups, each with its start, and the length of all.
    fn programme(&self, ids: &[LightGroupId]) -> (Vec<(Phase, u32)>, u32) {
        let inside = self.inside(ids);
        let mut phases = self.phases(ids, &inside);
        for k in 0..phases.len() {
            let next = (k + 1) % phases.len();
            phases[k].all_red = self.all_red(&phases[k].groups, &phases[next].groups, &inside);
        }
        self.let_people_cross(&mut phases);
        let mut from = 0;
        let mut timed = Vec::new();
        for phase in phases {
            let length = phase.length();
            timed.push((phase, from));
            from += length;
        }
        (timed, from)
    }

    /// What these groups hold inside their junction.
    fn inside(&self, ids: &[LightGroupId]) -> Inside {
        let mut found = Inside::new();
        for &id in ids {
            for &(before, lane) in &self.group(id).ways {
                let line_m = self.lanes[before as usize].length_m - self.crossed.stop_place(self.lanes, before);
                let mut open = vec![(lane, line_m)];
                while let Some((lane, at_m)) = open.pop() {
                    let held = found.entry(lane).or_default();
                    if held.iter().any(|(other, _)| *other == id) {
                        continue;
                    }
                    held.push((id, at_m));
                    let here = &self.lanes[lane as usize];
                    let next = here.successors.iter().filter(|&&l| self.lanes[l as usize].junction == here.junction);
                    open.extend(next.map(|&l| (l, at_m + here.length_m)));
                }
            }
        }
        found
    }

    /// Who is green together.
    fn phases(&self, ids: &[LightGroupId], inside: &Inside) -> Vec<Phase> {
        let apart = self.apart(inside);
        let mut order = ids.to_vec();
        order.sort_by_key(|&id| {
            let group = self.group(id);
            (group.sequence.is_none(), group.sequence, group.is_arrow, id)
        });
        let mut phases: Vec<Phase> = Vec::new();
        for id in order {
            let sequence = self.group(id).sequence;
            let fits = |phase: &&mut Phase| {
                (sequence.is_none() || sequence == phase.sequence)
                    && !phase.groups.iter().any(|&other| apart.contains(&(id.min(other), id.max(other))))
            };
            match phases.iter_mut().find(fits) {
                Some(phase) => phase.groups.push(id),
                None => phases.push(Phase { sequence, groups: vec![id], green: 0, yellow: 0, all_red: 0 }),
            }
        }
        for phase in &mut phases {
            let approaches: BTreeSet<_> = phase.groups.iter().map(|&id| self.group(id).approach).collect();
            phase.green = (GREEN_S[0] + GREEN_S[1] * approaches.len() as u32) * TICK_HZ;
            phase.yellow = phase.groups.iter().map(|&id| self.yellow(id)).max().unwrap_or_default();
        }
        phases
    }

    /// Pairs of groups, the lesser first, that must not be green together.
    fn apart(&self, inside: &Inside) -> BTreeSet<(LightGroupId, LightGroupId)> {
        let mut found = BTreeSet::new();
        for (&lane, held) in inside {
            for conflict in &self.lanes[lane as usize].conflicts {
                let others = inside.get(&conflict.lane).into_iter().flatten();
                for ((a, _), (b, _)) in others.flat_map(|b| held.iter().map(move |a| (a, b))) {
                    let protected = self.group(*a).is_arrow || self.group(*b).is_arrow;
                    if a != b && (protected || !self.yields(lane, conflict.lane)) {
                        found.insert((*a.min(b), *a.max(b)));
                    }
                }
            }
        }
        found
    }

    /// Whether of two lanes that overlap one turns off across the oncoming traffic of the other.
    fn yields(&self, a: LaneId, b: LaneId) -> bool {
        let (one, other) = (&self.lanes[a as usize], &self.lanes[b as usize]);
        let opposite = direction(one.start().heading_rad).dot(direction(other.start().heading_rad)) < -0.5;
        opposite && (one.turn != Turn::Straight || other.turn != Turn::Straight)
    }

    /// Yellow of a group, for the fastest of its approach, ticks.
    fn yellow(&self, id: LightGroupId) -> u32 {
        let limits = self.group(id).ways.iter().map(|&(before, _)| self.lanes[before as usize].speed_limit_mps);
        yellow_s(limits.fold(0.0, f32::max)) * TICK_HZ
    }

    /// The time after yellow in which the last of those in a phase clear the way of the first of the next, ticks.
    fn all_red(&self, leave: &[LightGroupId], enter: &[LightGroupId], inside: &Inside) -> u32 {
        let mut longest_s = ALL_RED_S;
        for (&lane, held) in inside {
            let here = &self.lanes[lane as usize];
            let speed_mps = CLEARING_MPS[usize::from(here.turn != Turn::Straight)];
            for (_, at_m) in held.iter().filter(|(id, _)| leave.contains(id)) {
                for conflict in &here.conflicts {
                    let back = self.lanes[conflict.lane as usize].conflicts.iter().find(|back| back.lane == lane);
                    let from_m = back.map_or(0.0, |back| back.from_m);
                    let others = inside.get(&conflict.lane).into_iter().flatten();
                    for (_, other_m) in others.filter(|(id, _)| enter.contains(id)) {
                        let cleared_s = (at_m + conflict.to_m + CLEARED_M) / speed_mps;
                        longest_s = longest_s.max(cleared_s - (other_m + from_m) / ENTERING_MPS);
                    }
                }
            }
        }
        let halves = ops::floor(longest_s / (0.5 * ALL_RED_S) + 0.999) as u32;
        halves * TICK_HZ / 2
    }

    /// Lengthens what is red for traffic at a crosswalk so that the slowest get over it.
    fn let_people_cross(&self, phases: &mut [Phase]) {
        for crosswalk in self.crosswalks {
            let lights: BTreeSet<LightGroupId> = crosswalk.lanes.iter().flat_map(|(lane, _)| self.at(*lane)).collect();
            let holds = |phase: &Phase| phase.groups.iter().any(|id| lights.contains(id));
            if !phases.iter().any(holds) {
                continue;
            }
            let long_m = crosswalk.ends[0].distance(crosswalk.ends[1]) + KERBS_M;
            let needed = ((long_m / WALK_MPS + SPARE_S) * TICK_HZ as f32) as u32;
            let missing = needed.saturating_sub(longest_red(phases, holds));
            let some_free = phases.iter().any(|phase| !holds(phase));
            for phase in phases.iter_mut().filter(|phase| some_free && !holds(phase)) {
                phase.green += missing;
            }
            if let Some(last) = phases.last_mut().filter(|_| !some_free) {
                last.all_red += missing;
            }
        }
    }

    /// The lights that hold those on a lane before a junction.
    fn at(&self, before: LaneId) -> Vec<LightGroupId> {
        let lights = self.groups.before.get(&before);
        let all = lights.map(|lights| lights.line.into_iter().chain(lights.own.iter().map(|(_, light)| *light)));
        all.into_iter().flatten().collect()
    }
}

impl Phase {
    fn whole(&self) -> (u32, u32) {
        (self.green, self.yellow)
    }

    fn length(&self) -> u32 {
        self.green + self.yellow + self.all_red
    }
}

/// The longest time at a stretch in which no phase that `holds` is green or yellow, ticks.
fn longest_red(phases: &[Phase], holds: impl Fn(&Phase) -> bool) -> u32 {
    let (mut longest, mut red) = (0, 0);
    for phase in phases.iter().chain(phases) {
        red = if holds(phase) { phase.all_red } else { red + phase.length() };
        longest = longest.max(red);
    }
    longest
}

/// Yellow for a speed limit, seconds.
fn yellow_s(limit_mps: f32) -> u32 {
    // A limit in miles an hour is counted to the next whole kilometre.
    let limit_kmh = ops::floor(limit_mps * 3.6);
    YELLOW_S.iter().find(|(up_to_kmh, _)| limit_kmh <= *up_to_kmh).map_or(YELLOW_S[2].1, |(_, s)| *s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn yellow_is_that_of_the_kinematic_formula() {
        for kmh in [30, 40, 50, 60, 70, 80, 90, 100_u8] {
            let mps = f64::from(kmh) / 3.6;
            let ite_s = (1.0 + mps / (2.0 * 3.05)).max(3.0);
            let ours_s = f64::from(yellow_s(mps as f32));
            assert!((ours_s - ite_s).abs() < 0.75, "{kmh} km/h: {ours_s} s, {ite_s} s");
        }
        assert_eq!([50.0, 70.0, 100.0].map(|kmh: f32| yellow_s(kmh / 3.6)), [3, 4, 5]);
    }
}
