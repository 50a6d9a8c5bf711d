//! The land between and around the roads.

use glam::{Vec2, Vec3};

use super::rounding::snap;
use crate::map_data::{Lane, Surface, SurfaceKind};
use crate::places::Grid;

/// Side of a cell where the land is flat, metres.
const FLAT_CELL_M: f32 = 40.0;
/// Side of a cell where the roads rise and fall, metres.
const HILLY_CELL_M: f32 = 6.0;
/// At most this many cells along a side of the map.
const MAX_CELLS: f32 = 180.0;
/// The land lies this far below the roads, so that it shows nowhere through them, metres.
const BELOW_FLAT_M: f32 = 64.0 / 1024.0;
/// The same on hills, where a cell is straight and a road is not.
const BELOW_HILLY_M: f32 = 160.0 / 1024.0;
/// Roads differing by less in height are flat.
const FLAT_M: f32 = 0.05;
/// The land follows the nearest road up to this distance, then levels out.
const FOLLOW_M: f32 = 40.0;

/// The land of a map with some bounds.
pub(super) fn bake(lanes: &[Lane], bounds: [Vec3; 2]) -> Surface {
    let heights = lanes.iter().flat_map(|l| &l.points).map(|p| p.position.z);
    let (low, high) = heights.fold((f32::MAX, f32::MIN), |(a, b), z| (a.min(z), b.max(z)));
    let is_flat = high - low < FLAT_M;
    let from = bounds[0].truncate();
    let extent = bounds[1].truncate() - from;
    let wanted = if is_flat { FLAT_CELL_M } else { HILLY_CELL_M };
    let cells = |length: f32| (length / wanted).clamp(1.0, MAX_CELLS) as usize;
    let (columns, rows) = (cells(extent.x), cells(extent.y));
    let pitch = Vec2::new(snap(extent.x / columns as f32), snap(extent.y / rows as f32));
    let roads = Heights::new(lanes);
    let mut surface = Surface { kind: SurfaceKind::Terrain, positions: Vec::new(), triangles: Vec::new() };
    for j in 0..=rows {
        for i in 0..=columns {
            let p = from + pitch * Vec2::new(i as f32, j as f32);
            let z = if is_flat { low - BELOW_FLAT_M } else { roads.height(p) };
            surface.positions.push(Vec3::new(snap(p.x), snap(p.y), snap(z)));
        }
    }
    let at = |i: usize, j: usize| (j * (columns + 1) + i) as u32;
    for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
        surface.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        surface.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    surface
}

/// Heights of the roads by place.
struct Heights {
    samples: Vec<Vec3>,
    grid: Grid,
    mean: f32,
}

impl Heights {
    fn new(lanes: &[Lane]) -> Self {
        let samples: Vec<Vec3> = lanes.iter().flat_map(|l| &l.points).map(|p| p.position).collect();
        let boxes: Vec<_> = samples.iter().map(|p| (p.truncate(), p.truncate())).collect();
        let mean = samples.iter().map(|p| p.z).sum::<f32>() / samples.len() as f32;
        Self { grid: Grid::new(&boxes, HILLY_CELL_M), samples, mean }
    }

    /// The height of the land at `p`: below every road near it, level far from all.
    fn height(&self, p: Vec2) -> f32 {
        let (mut weight, mut sum, mut lowest, mut nearest) = (0.0, 0.0, f32::MAX, f32::MAX);
        for k in self.grid.around(p, FOLLOW_M) {
            let sample = self.samples[k as usize];
            let distance = sample.truncate().distance(p);
            let w = 1.0 / (distance * distance * distance + 0.5);
            (weight, sum) = (weight + w, sum + w * sample.z);
            nearest = nearest.min(distance);
            if distance < HILLY_CELL_M * 1.5 {
                lowest = lowest.min(sample.z);
            }
        }
        let far = (nearest / FOLLOW_M).min(1.0);
        let near = if weight > 0.0 { sum / weight } else { self.mean };
        near.min(lowest) * (1.0 - far * far) + self.mean * far * far - BELOW_HILLY_M
    }
}
