//! Crosswalks: from the file's objects, or made where a junction with lights has none.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;

use super::notes::{Notes, Passed};
use super::rounding::{snap, snap3};
use super::shapes::{least_rectangle, point};
use super::signs::Governed;
use super::source::{Approach, Source};
use crate::geometry::direction;
use crate::map_data::{Crosswalk, Junction, Lane, LaneId, LaneKind};
use crate::places::Roads;

/// Half extent along the road of a crosswalk that is made up, metres.
const HALF_WIDTH_M: f32 = 1.75;
/// From the mouth of a junction to the middle of a crosswalk that is made up, metres.
const SETBACK_M: f32 = 3.0;
/// A crosswalk belongs to a junction that its lanes reach within this distance, metres.
const REACH_M: f32 = 20.0;
/// What claims to be larger is no crosswalk, metres.
const LONGEST_M: f32 = 60.0;
/// A rectangle this much longer than wide is crossed along its length, whatever lies below.
const SLENDER: f32 = 1.8;

/// The crosswalks, not yet told which junction's lights they have.
pub(super) fn bake(
    source: &Source,
    roads: &Roads<'_>,
    junctions: &[Junction],
    governed: &[Governed],
    notes: &mut Notes,
) -> Vec<Crosswalk> {
    let mut found: Vec<Crosswalk> = Vec::new();
    let objects = source.net.objects().iter().enumerate();
    for (index, object) in objects.filter(|(_, o)| o.kind == xodr::ObjectType::Crosswalk) {
        match named(roads, &object.shape) {
            Ok(crosswalk) => found.push(crosswalk),
            Err(why) => notes.pass(Passed::Object, why, || "type crosswalk".into(), || source.place_of_object(index)),
        }
    }
    let lit: BTreeSet<u32> = governed.iter().filter(|g| g.is_light()).map(|g| g.junction).collect();
    let mut crossed: BTreeSet<u32> = found.iter().flat_map(|c| junctions_of(roads.lanes, c)).collect();
    for id in lit {
        if !crossed.contains(&id) {
            let made = invented(source, roads, id, &junctions[id as usize]);
            crossed.extend(made.iter().flat_map(|c| junctions_of(roads.lanes, c)));
            found.extend(made);
        }
    }
    found
}

/// The crosswalk of an object, or why there is none.
fn named(roads: &Roads<'_>, shape: &xodr::Shape) -> Result<Crosswalk, &'static str> {
    let outline = footprint(shape).ok_or("has no area")?;
    let (ends, half_width_m) = axis(roads, &outline).ok_or("lies at no driving lane")?;
    crosswalk(roads, ends, half_width_m).ok_or("crosses no driving lane, or is of an odd size")
}

/// The junctions that the lanes of a crosswalk reach.
fn junctions_of<'a>(lanes: &'a [Lane], crosswalk: &'a Crosswalk) -> impl Iterator<Item = u32> + 'a {
    crosswalk.lanes.iter().filter_map(|&(lane, s)| reached(lanes, lane, s))
}

/// Corners of a flat shape, in order.
fn footprint(shape: &xodr::Shape) -> Option<Vec<Vec3>> {
    match shape {
        xodr::Shape::Outline { corners, .. } => {
            let mut points: Vec<Vec3> = corners.iter().map(|c| point(c.base)).collect();
            points.dedup_by(|a, b| a.distance(*b) < 0.01);
            (points.len() >= 3).then_some(points)
        }
        xodr::Shape::Solid { position, heading, extent: Some(xodr::Extent::Box { length, width, .. }), .. } => {
            let along = direction(*heading).extend(0.0) * (length / 2.0);
            let across = direction(*heading).perp().extend(0.0) * (width / 2.0);
            let p = point(*position);
            let corners = [p - along - across, p + along - across, p + along + across, p - along + across];
            (*length > 0.1 && *width > 0.1).then(|| corners.map(snap3).to_vec())
        }
        _ => None,
    }
}

/// The rectangle of least area around an outline, as the axis that people walk and half its width.
fn axis(roads: &Roads<'_>, outline: &[Vec3]) -> Option<([Vec3; 2], f32)> {
    let (center, along, half) = least_rectangle(outline)?;
    let near = roads.nearest(center, LaneKind::Driving, None, 15.0)?;
    let road = direction(roads.lanes[near.lane as usize].at(near.s_m).heading_rad);
    let slender = half.max_element() > SLENDER * half.min_element();
    let first = if slender { half.x > half.y } else { along.dot(road).abs() < along.perp().dot(road).abs() };
    let (walk, length, width) = if first { (along, half.x, half.y) } else { (along.perp(), half.y, half.x) };
    let step = (walk * length).extend(0.0);
    Some(([snap3(center - step), snap3(center + step)], snap(width)))
}

/// A crosswalk between two ends; none of an odd size, or where there is no lane to cross.
fn crosswalk(roads: &Roads<'_>, ends: [Vec3; 2], half_width_m: f32) -> Option<Crosswalk> {
    let center = (ends[0] + ends[1]) / 2.0;
    let radius = ends[0].distance(ends[1]) / 2.0 + 1.0;
    if !(1.0..LONGEST_M).contains(&radius) || half_width_m > LONGEST_M {
        return None;
    }
    let near = roads.around(center, LaneKind::Driving, radius);
    let crossed =
        near.iter().filter_map(|p| crossed_at(&roads.lanes[p.lane as usize], ends).map(|s| (p.lane, snap(s))));
    let lanes: Vec<(LaneId, f32)> = crossed.collect();
    (!lanes.is_empty()).then_some(Crosswalk { ends, half_width_m, lanes, junction: None })
}

/// Where the centre line of `lane` crosses the segment between `ends`.
fn crossed_at(lane: &Lane, ends: [Vec3; 2]) -> Option<f32> {
    let (a, along) = (ends[0].truncate(), (ends[1] - ends[0]).truncate());
    lane.points.windows(2).find_map(|pair| {
        let (p, step) = (pair[0].position.truncate(), (pair[1].position - pair[0].position).truncate());
        let area = along.perp_dot(step);
        let u = (p - a).perp_dot(step) / area;
        let v = (p - a).perp_dot(along) / area;
        let hit = area.abs() > 1e-6 && (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v);
        hit.then(|| pair[0].s_m + (pair[1].s_m - pair[0].s_m) * v)
    })
}

/// One crosswalk over each approach that has a sidewalk on both sides.
fn invented(source: &Source, roads: &Roads<'_>, id: u32, junction: &Junction) -> Vec<Crosswalk> {
    let mut made = Vec::new();
    for before in approaches(source, roads.lanes, id, junction).into_values() {
        let Some(&first) = before.first() else { continue };
        let lane = &roads.lanes[first as usize];
        let setback = SETBACK_M.min(lane.length_m / 2.0);
        let here = lane.at(lane.length_m - setback);
        let left = direction(here.heading_rad).perp();
        if let Some((right_m, left_m)) = kerbs(source, roads.lanes, first, here.position) {
            let at = |offset: f32| snap3(here.position + (left * offset).extend(0.0));
            made.extend(crosswalk(roads, [at(right_m), at(left_m)], HALF_WIDTH_M));
        }
    }
    made
}

/// The lanes that lead into a junction, by approach.
fn approaches(source: &Source, lanes: &[Lane], id: u32, junction: &Junction) -> BTreeMap<Approach, Vec<LaneId>> {
    let mut found: BTreeMap<Approach, Vec<LaneId>> = BTreeMap::new();
    for &inside in &junction.lanes {
        for &before in &lanes[inside as usize].predecessors {
            if lanes[before as usize].junction != Some(id) {
                let leading = found.entry(source.origins[before as usize].approach()).or_default();
                if !leading.contains(&before) {
                    leading.push(before);
                }
            }
        }
    }
    found
}

/// Offsets to the left of the inner edges of the sidewalks beside a road, (right, left).
fn kerbs(source: &Source, lanes: &[Lane], lane: LaneId, position: Vec3) -> Option<(f32, f32)> {
    let (along_m, ..) = lanes[lane as usize].project(position);
    let travel = direction(lanes[lane as usize].at(along_m).heading_rad);
    let (mut right, mut left): (Option<f32>, Option<f32>) = (None, None);
    let section = source.section_of(lane).iter().map(|&l| &lanes[l as usize]);
    for walk in section.filter(|l| l.kind == LaneKind::Sidewalk) {
        let (s, _, distance) = walk.project(position);
        let there = walk.at(s);
        let side = travel.perp_dot((there.position - position).truncate());
        let gap = distance - there.half_width_m;
        let slot = if side > 0.0 { &mut left } else { &mut right };
        let offset = if side > 0.0 { gap } else { -gap };
        *slot = Some(slot.map_or(offset, |o: f32| if o.abs() < gap { o } else { offset }));
    }
    Some((right?, left?))
}

/// Tells each crosswalk near a junction with lights which one it is.
pub(super) fn lit(mut crosswalks: Vec<Crosswalk>, lanes: &[Lane], junctions: &[Junction]) -> Vec<Crosswalk> {
    for crosswalk in &mut crosswalks {
        let junction = crosswalk.lanes.iter().find_map(|&(lane, s)| reached(lanes, lane, s));
        crosswalk.junction = junction.filter(|&j| !junctions[j as usize].light_groups.is_empty());
    }
    crosswalks
}

/// The junction that lies shortly ahead of or behind a place, or around it.
fn reached(lanes: &[Lane], lane: LaneId, s_m: f32) -> Option<u32> {
    let here = &lanes[lane as usize];
    let of = |ids: &[LaneId]| ids.iter().find_map(|&l| lanes[l as usize].junction);
    here.junction
        .or_else(|| if here.length_m - s_m < REACH_M { of(&here.successors) } else { None })
        .or_else(|| if s_m < REACH_M { of(&here.predecessors) } else { None })
}
