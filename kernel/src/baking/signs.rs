//! Which signals and signs of the file are for which lanes.

use std::collections::{BTreeMap, BTreeSet};

use super::catalogue::{self, Meaning};
use super::notes::{Notes, Passed};
use super::source::{Approach, Source};
use crate::map_data::{Lane, LaneId, LaneKind, Turn};

/// A sign is followed this far to the junction that it is about, metres.
const AHEAD_M: f32 = 60.0;
/// The same where it tells of the right of way, which is told of early outside towns, metres.
const PRIORITY_AHEAD_M: f32 = 300.0;

/// A lane before a junction that a signal is for.
pub(super) struct Governed {
    pub junction: u32,
    pub approach: Approach,
    pub lane: LaneId,
    /// The lanes after it through the junction that it is for.
    pub inside: Vec<LaneId>,
    pub meaning: Meaning,
    /// Its index in the file.
    pub signal: usize,
}

impl Governed {
    pub fn is_light(&self) -> bool {
        self.turns().is_some()
    }

    /// Of a light: those whom it holds.
    pub fn turns(&self) -> Option<&'static [Turn]> {
        if let Meaning::Light(turns) = self.meaning { Some(turns) } else { None }
    }
}

/// Which signals govern which lanes; notes those that mean nothing, and those that are for nobody.
pub(super) fn governed(source: &Source, lanes: &[Lane], notes: &mut Notes) -> Vec<Governed> {
    let mut found: Vec<Governed> = Vec::new();
    let mut known: BTreeMap<(usize, u32, LaneId), usize> = BTreeMap::new();
    for (signal, s) in source.net.signals().iter().enumerate() {
        let mut pass = |why| notes.pass(Passed::Signal, why, || catalogue::said(s), || source.place_of_signal(signal));
        let meaning = match catalogue::read(s) {
            Ok(Meaning::Limit(_) | Meaning::BusStop) => continue,
            Ok(meaning) => meaning,
            Err(why) => {
                pass(why);
                continue;
            }
        };
        let known_before = known.len();
        let signalled = s.lanes.iter().filter_map(|l| source.ids.get(&l.0).copied());
        for lane in signalled.filter(|&l| lanes[l as usize].kind == LaneKind::Driving) {
            for (junction, before, inside) in before_junction(lanes, lane, meaning) {
                let approach = source.origins[before as usize].approach();
                let at = *known.entry((signal, junction, before)).or_insert_with(|| {
                    found.push(Governed { junction, approach, lane: before, inside: Vec::new(), meaning, signal });
                    found.len() - 1
                });
                found[at].inside.extend(inside);
            }
        }
        if known.len() == known_before {
            pass("is for no lane before a junction");
        }
    }
    for g in &mut found {
        g.inside.retain(|&lane| g.meaning.holds(lanes[lane as usize].turn));
        g.inside.sort_unstable();
        g.inside.dedup();
    }
    found.retain(|g| !g.inside.is_empty());
    let holding: BTreeSet<usize> = found.iter().map(|g| g.signal).collect();
    let known: BTreeSet<usize> = known.into_keys().map(|(signal, ..)| signal).collect();
    for &signal in known.difference(&holding) {
        let said = || catalogue::said(&source.net.signals()[signal]);
        notes.pass(Passed::Signal, "holds a turn that there is not", said, || source.place_of_signal(signal));
    }
    found
}

/// The junctions that a signal on `lane` is about, each with the lanes before it and those that they lead to in it.
fn before_junction(lanes: &[Lane], lane: LaneId, meaning: Meaning) -> Vec<(u32, LaneId, Vec<LaneId>)> {
    let here = &lanes[lane as usize];
    if let Some(junction) = here.junction {
        return entrances(lanes, lane, junction);
    }
    let most_m = if meaning == Meaning::Priority { PRIORITY_AHEAD_M } else { AHEAD_M };
    let (mut at, mut gone) = (lane, 0.0);
    loop {
        let next = &lanes[at as usize].successors;
        let entered = next.iter().find_map(|&n| lanes[n as usize].junction);
        match (entered, next.as_slice()) {
            (Some(junction), _) => return vec![(junction, at, next.clone())],
            (None, &[only]) if gone < most_m => {
                gone += lanes[only as usize].length_m;
                at = only;
            }
            _ => return Vec::new(),
        }
    }
}

/// The lanes before a junction that lead to a lane inside, each with the first one inside.
fn entrances(lanes: &[Lane], lane: LaneId, junction: u32) -> Vec<(u32, LaneId, Vec<LaneId>)> {
    let (mut found, mut seen, mut open) = (Vec::new(), BTreeSet::new(), vec![lane]);
    while let Some(at) = open.pop() {
        for &before in &lanes[at as usize].predecessors {
            if lanes[before as usize].junction != Some(junction) {
                found.push((junction, before, vec![at]));
            } else if seen.insert(before) {
                open.push(before);
            }
        }
    }
    found
}
