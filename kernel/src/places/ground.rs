//! The ground below a place.

use glam::{Vec2, Vec3};

use super::grid::{Bounds, Grid};
use crate::map_data::{Surface, SurfaceKind};

/// The ground below a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Material; paint counts as [`SurfaceKind::Road`].
    pub kind: SurfaceKind,
    /// Height of the ground, metres.
    pub height_m: f32,
    /// Unit normal, upwards.
    pub normal: Vec3,
}

/// Side of a cell, metres.
const CELL_M: f32 = 4.0;
/// Ground up to so much above a place still counts as below it, metres.
const STEP_M: f32 = 1.0;

/// A grid over the triangles of a map's ground.
#[derive(Debug)]
pub(super) struct GroundGrid {
    grid: Grid,
    /// Surface and triangle of each item of the grid.
    triangles: Vec<(u32, u32)>,
}

impl GroundGrid {
    pub fn new(surfaces: &[Surface]) -> Self {
        let (boxes, triangles) = boxes(surfaces);
        Self { grid: Grid::new(&boxes, CELL_M), triangles }
    }

    /// The highest ground at most 1 m above `position` and below it; `None` beyond the map.
    pub fn below(&self, surfaces: &[Surface], position: Vec3) -> Option<Ground> {
        let hits = self.grid.around(position.truncate(), 0.0).filter_map(|i| {
            let (surface, triangle) = self.triangles[i as usize];
            let surface = &surfaces[surface as usize];
            let corners = surface.triangles[triangle as usize].map(|v| surface.positions[v as usize]);
            let (height_m, normal) = height_at(corners, position.truncate())?;
            (height_m <= position.z + STEP_M).then_some(Ground { kind: surface.kind, height_m, normal })
        });
        hits.fold(None, |best: Option<Ground>, g| match best {
            Some(b) if b.height_m >= g.height_m => Some(b),
            _ => Some(g),
        })
    }
}

/// Height and upward normal of a triangle at `p`, if it lies below or above `p`.
fn height_at([a, b, c]: [Vec3; 3], p: Vec2) -> Option<(f32, Vec3)> {
    let (u, v, w) = ((b - a).truncate(), (c - a).truncate(), p - a.truncate());
    let area = u.perp_dot(v);
    if area < 1e-7 {
        return None;
    }
    let (s, t) = (w.perp_dot(v) / area, u.perp_dot(w) / area);
    let slack = 1e-4;
    if s < -slack || t < -slack || s + t > 1.0 + slack {
        return None;
    }
    Some((a.z + s * (b.z - a.z) + t * (c.z - a.z), (b - a).cross(c - a).normalize()))
}

/// The box of each triangle, and which it is.
fn boxes(surfaces: &[Surface]) -> (Vec<Bounds>, Vec<(u32, u32)>) {
    let mut boxes = Vec::new();
    let mut owners = Vec::new();
    for (k, surface) in surfaces.iter().enumerate().filter(|(_, s)| !s.kind.lies_on_ground()) {
        for (t, triangle) in surface.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|v| surface.positions[v as usize].truncate());
            boxes.push((a.min(b).min(c), a.max(b).max(c)));
            owners.push((k as u32, t as u32));
        }
    }
    (boxes, owners)
}
