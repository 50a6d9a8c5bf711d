//! Speed limits by signs, which go before those of roads and lanes (ASAM OpenDRIVE 1.8, "Speed limits").

use super::catalogue::{self, Meaning, meaning};
use super::notes::{Notes, Passed};
use super::shapes::point;
use super::source::Source;
use crate::map_data::{Lane, LaneId, LaneKind};

/// Where a sign stands before this share of a lane, the whole lane has its limit; else it begins with the lanes after.
const EARLY: f32 = 0.5;
/// A sign farther than this from a lane stands elsewhere, metres.
const BESIDE_M: f32 = 30.0;

/// Gives the lanes after signs their limits: up to the next junction or sign, or where the file tells of another road
/// type or limit.
pub(super) fn bake(source: &Source, mut lanes: Vec<Lane>, notes: &mut Notes) -> Vec<Lane> {
    let told: Vec<f32> = lanes.iter().map(|lane| lane.speed_limit_mps).collect();
    let mut signs: Vec<Option<(f32, f32)>> = vec![None; lanes.len()];
    for (index, signal) in source.net.signals().iter().enumerate() {
        let Some(Meaning::Limit(mps)) = meaning(signal) else { continue };
        let at = point(signal.applies_at.first().copied().unwrap_or(signal.position));
        let signalled = signal.lanes.iter().filter_map(|l| source.ids.get(&l.0).copied());
        let driven: Vec<LaneId> = signalled.filter(|&id| lanes[id as usize].kind == LaneKind::Driving).collect();
        if driven.is_empty() {
            let (said, place) = (|| catalogue::said(signal), || source.place_of_signal(index));
            notes.pass(Passed::Signal, "is for no driving lane", said, place);
        }
        for id in driven {
            let (along_m, _, away_m) = lanes[id as usize].project(at);
            // Referred to from another road it is for all of that.
            let s_m = if away_m < BESIDE_M { along_m } else { 0.0 };
            // Of several signs the last one holds on.
            let sign = &mut signs[id as usize];
            *sign = sign.filter(|(before_m, _)| *before_m > s_m).or(Some((s_m, mps)));
        }
    }
    for (id, sign) in signs.iter().enumerate() {
        let Some((s_m, mps)) = *sign else { continue };
        if s_m < EARLY * lanes[id].length_m {
            lanes[id].speed_limit_mps = mps;
        }
        let mut at = id as LaneId;
        while let Some(next) = onward(source, &lanes, at) {
            if signs[next as usize].is_some() || told[next as usize] != told[id] || next as usize == id {
                break;
            }
            lanes[next as usize].speed_limit_mps = mps;
            at = next;
        }
    }
    lanes
}

/// The lane that alone follows another, outside junctions.
fn onward(source: &Source, lanes: &[Lane], at: LaneId) -> Option<LaneId> {
    let &[next] = lanes[at as usize].successors.as_slice() else { return None };
    let road = source.net.road(xodr::RoadId(source.origins[next as usize].road));
    let is_inside = road.is_some_and(|road| road.junction().is_some());
    (!is_inside && lanes[next as usize].predecessors.len() == 1).then_some(next)
}
