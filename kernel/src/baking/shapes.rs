//! Shapes on the ground.

use glam::{Vec2, Vec3};

use super::rounding::snap3;
use crate::geometry::direction;
use crate::map_data::{LaneKind, Prop};
use crate::places::Roads;

/// A point of xodr, rounded.
pub(super) fn point(p: xodr::Point) -> Vec3 {
    snap3(Vec3::new(p.x, p.y, p.z))
}

/// The rectangle of least area around an outline: its middle, the direction of its x axis, half its size.
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

/// Corners of a prop's footprint, counter-clockwise.
pub(super) fn corners(prop: &Prop) -> [Vec2; 4] {
    let along = direction(prop.heading_rad) * (prop.size.x / 2.0);
    let across = direction(prop.heading_rad).perp() * (prop.size.y / 2.0);
    let p = prop.position.truncate();
    [p - along - across, p + along - across, p + along + across, p - along + across]
}

/// Points that cover a prop's footprint, at most `step_m` apart.
pub(super) fn footprint(prop: &Prop, step_m: f32) -> Vec<Vec3> {
    let (nx, ny) = ((prop.size.x / step_m) as u32 + 1, (prop.size.y / step_m) as u32 + 1);
    let along = direction(prop.heading_rad) * prop.size.x;
    let across = direction(prop.heading_rad).perp() * prop.size.y;
    (0..=nx.min(200))
        .flat_map(|i| (0..=ny.min(200)).map(move |j| (i, j)))
        .map(|(i, j)| {
            let offset = along * (i as f32 / nx.min(200) as f32 - 0.5) + across * (j as f32 / ny.min(200) as f32 - 0.5);
            prop.position + offset.extend(0.0)
        })
        .collect()
}

/// A place moved out of the driving lane that holds it, to the right.
pub(super) fn beside_lanes(roads: &Roads<'_>, position: Vec3) -> Vec3 {
    let mut at = position;
    for _ in 0..8 {
        let Some(inside) = roads.at(at, LaneKind::Driving).first().copied() else { break };
        let lane = roads.lanes[inside.lane as usize].at(inside.s_m);
        let right = -direction(lane.heading_rad).perp();
        at += (right * (lane.half_width_m + inside.lateral_m + 0.4)).extend(0.0);
    }
    snap3(at)
}
