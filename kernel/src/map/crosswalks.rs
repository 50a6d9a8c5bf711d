//! Zebra crossings: from the file's objects, or made where a signalised junction has none.

use glam::{Vec2, Vec3};

use super::bake::{Source, direction, snap, snap3};
use super::{Crosswalk, Lane, LaneId, LaneKind, RoadNetwork, junctions};
use crate::ops;

/// Half extent along the road of a crossing that is made up, metres.
const HALF_WIDTH_M: f32 = 1.75;
/// From the mouth of a junction to the middle of a crossing that is made up, metres.
const SETBACK_M: f32 = 3.0;
/// A crossing belongs to a junction that its lanes reach within this distance, metres.
const REACH_M: f32 = 20.0;
/// What claims to be larger is no crossing, metres.
const LONGEST_M: f32 = 60.0;
/// A rectangle this much longer than wide is crossed along its length, whatever lies below.
const SLENDER: f32 = 1.8;

pub(super) fn bake(source: &Source, map: &mut RoadNetwork) {
    let objects = source.net.objects().iter().filter(|o| o.kind == xodr::ObjectType::Crosswalk);
    let outlines: Vec<Vec<Vec3>> = objects.filter_map(|o| footprint(&o.shape)).collect();
    for outline in outlines {
        if let Some((ends, half_width_m)) = axis(map, &outline) {
            add(map, ends, half_width_m);
        }
    }
    for junction in 0..map.junctions.len() as u32 {
        if is_signalised(source, map, junction) && !has_crosswalk(map, junction) {
            invent(source, map, junction);
        }
    }
}

fn has_crosswalk(map: &RoadNetwork, junction: u32) -> bool {
    let lanes = map.crosswalks.iter().flat_map(|c| &c.lanes);
    lanes.into_iter().any(|&(lane, s)| reached(map, lane, s) == Some(junction))
}

/// Corners of a flat shape, in order.
fn footprint(shape: &xodr::Shape) -> Option<Vec<Vec3>> {
    match shape {
        xodr::Shape::Outline { corners, .. } => {
            let mut points: Vec<Vec3> = corners.iter().map(|c| super::bake::point(c.base)).collect();
            points.dedup_by(|a, b| a.distance(*b) < 0.01);
            (points.len() >= 3).then_some(points)
        }
        xodr::Shape::Solid { position, heading, extent: Some(xodr::Extent::Box { length, width, .. }), .. } => {
            let along = direction(*heading).extend(0.0) * (length / 2.0);
            let across = direction(*heading).perp().extend(0.0) * (width / 2.0);
            let p = super::bake::point(*position);
            let corners = [p - along - across, p + along - across, p + along + across, p - along + across];
            (*length > 0.1 && *width > 0.1).then(|| corners.map(snap3).to_vec())
        }
        _ => None,
    }
}

/// The rectangle of least area around an outline, as the axis that people walk and half its width.
fn axis(map: &RoadNetwork, outline: &[Vec3]) -> Option<([Vec3; 2], f32)> {
    let (center, along, half) = least_rectangle(outline)?;
    let near = map.nearest_lane(center, LaneKind::Driving, None, 15.0)?;
    let road = direction(map.lane_point(near.lane, near.s_m).heading_rad);
    let slender = half.max_element() > SLENDER * half.min_element();
    let first = if slender { half.x > half.y } else { along.dot(road).abs() < along.perp().dot(road).abs() };
    let (walk, length, width) = if first { (along, half.x, half.y) } else { (along.perp(), half.y, half.x) };
    let step = (walk * length).extend(0.0);
    Some(([snap3(center - step), snap3(center + step)], snap(width)))
}

pub(super) fn least_rectangle(outline: &[Vec3]) -> Option<(Vec3, Vec2, Vec2)> {
    let z = outline.iter().map(|p| p.z).sum::<f32>() / outline.len() as f32;
    let mut best: Option<(f32, Vec3, Vec2, Vec2)> = None;
    for k in 0..outline.len() {
        let edge = (outline[(k + 1) % outline.len()] - outline[k]).truncate();
        let along = edge / edge.length().max(1e-6);
        if along.length_squared() < 0.5 {
            continue;
        }
        let (mut low, mut high) = (Vec2::splat(f32::MAX), Vec2::splat(f32::MIN));
        for p in outline {
            let local = Vec2::new(p.truncate().dot(along), p.truncate().dot(along.perp()));
            (low, high) = (low.min(local), high.max(local));
        }
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let area = half.x * half.y;
        if best.is_none_or(|b| area < b.0 - 1e-3) {
            best = Some((area, (along * middle.x + along.perp() * middle.y).extend(z), along, half));
        }
    }
    best.filter(|b| b.0 > 0.1).map(|(_, center, along, half)| (center, along, half))
}

fn add(map: &mut RoadNetwork, ends: [Vec3; 2], half_width_m: f32) {
    let center = (ends[0] + ends[1]) / 2.0;
    let radius = ends[0].distance(ends[1]) / 2.0 + 1.0;
    if !(1.0..LONGEST_M).contains(&radius) || half_width_m > LONGEST_M {
        return;
    }
    let near = map.lanes_around(center, LaneKind::Driving, radius);
    let lanes: Vec<(LaneId, f32)> =
        near.iter().filter_map(|p| crossing(&map.lanes[p.lane as usize], ends).map(|s| (p.lane, snap(s)))).collect();
    if !lanes.is_empty() {
        map.crosswalks.push(Crosswalk { ends, half_width_m, lanes, junction: None });
    }
}

/// Where the centre line of `lane` crosses the segment between `ends`.
fn crossing(lane: &Lane, ends: [Vec3; 2]) -> Option<f32> {
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

fn is_signalised(source: &Source, map: &RoadNetwork, junction: u32) -> bool {
    super::lights::governed(source, map).iter().any(|g| g.junction == junction && g.is_light)
}

/// One crossing over each approach that has a sidewalk on both sides.
fn invent(source: &Source, map: &mut RoadNetwork, junction: u32) {
    for lanes in junctions::approaches(source, map, junction).into_values() {
        let Some(&lane) = lanes.first() else { continue };
        let setback = SETBACK_M.min(map.lanes[lane as usize].length_m / 2.0);
        let here = map.lanes[lane as usize].at(map.lanes[lane as usize].length_m - setback);
        let left = direction(here.heading_rad).perp();
        let kerbs = kerbs(source, map, lane, here.position);
        if let Some((right_m, left_m)) = kerbs {
            let at = |offset: f32| snap3(here.position + (left * offset).extend(0.0));
            add(map, [at(right_m), at(left_m)], HALF_WIDTH_M);
        }
    }
}

/// Offsets to the left of the inner edges of the sidewalks beside a road, (right, left).
fn kerbs(source: &Source, map: &RoadNetwork, lane: LaneId, position: Vec3) -> Option<(f32, f32)> {
    let own = source.origins[lane as usize];
    let heading = map.project(lane, position);
    let travel = direction(map.lane_point(lane, heading.s_m).heading_rad);
    let (mut right, mut left): (Option<f32>, Option<f32>) = (None, None);
    for (id, origin) in source.origins.iter().enumerate() {
        let walk = &map.lanes[id];
        if walk.kind != LaneKind::Sidewalk || origin.road != own.road || origin.section != own.section {
            continue;
        }
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

/// Tells each crossing near a signalised junction which one it is.
pub(super) fn assign_junctions(map: &mut RoadNetwork) {
    for k in 0..map.crosswalks.len() {
        let junction = map.crosswalks[k].lanes.iter().find_map(|&(lane, s)| reached(map, lane, s));
        map.crosswalks[k].junction = junction.filter(|&j| !map.junctions[j as usize].light_groups.is_empty());
    }
}

/// The junction that lies shortly ahead of or behind a place, or around it.
fn reached(map: &RoadNetwork, lane: LaneId, s_m: f32) -> Option<u32> {
    let here = &map.lanes[lane as usize];
    let of = |ids: &[LaneId]| ids.iter().find_map(|&l| map.lanes[l as usize].junction);
    here.junction
        .or_else(|| if here.length_m - s_m < REACH_M { of(&here.successors) } else { None })
        .or_else(|| if s_m < REACH_M { of(&here.predecessors) } else { None })
}

/// Side of the stripes of a zebra crossing, metres.
pub(super) fn stripes(crosswalk: &Crosswalk) -> Vec<[Vec3; 4]> {
    let [a, b] = crosswalk.ends;
    let length = (b - a).truncate().length();
    let along = (b - a) / length.max(1e-3);
    let aside = along.truncate().perp().extend(0.0) * crosswalk.half_width_m;
    let count = (ops::floor(length) as u32).max(1);
    let pitch = length / count as f32;
    (0..count)
        .map(|k| {
            let (from, to) = (a + along * (pitch * (k as f32 + 0.25)), a + along * (pitch * (k as f32 + 0.75)));
            [from - aside, to - aside, to + aside, from + aside].map(snap3)
        })
        .collect()
}
