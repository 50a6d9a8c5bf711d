//! The land between and around the roads.

use glam::{Vec2, Vec3};

use super::flat::Pool;
use super::rounding::snap;
use crate::map_data::{Surface, SurfaceKind};
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

/// Where land would reach into a bridge, its corners are looked at so far around, as a share of a cell.
const CELL_REACH: f32 = 1.5;

/// The land of a map: how high it is anywhere.
pub(super) struct Land {
    from: Vec2,
    columns: usize,
    rows: usize,
    pitch: Vec2,
    /// Its height where all of it is flat.
    flat_m: Option<f32>,
    roads: Heights,
    below: Below,
    pools: Vec<Pool>,
}

impl Land {
    /// Within some bounds, around roads at `footing`; it stays below the places `below` bridges, and below water.
    pub fn new(footing: Vec<Vec3>, below: Vec<Vec3>, pools: Vec<Pool>, bounds: [Vec3; 2]) -> Self {
        let heights = footing.iter().map(|p| p.z);
        let (low, high) = heights.fold((f32::MAX, f32::MIN), |(a, b), z| (a.min(z), b.max(z)));
        let is_flat = high - low < FLAT_M && below.is_empty() && pools.is_empty();
        let from = bounds[0].truncate();
        let extent = bounds[1].truncate() - from;
        let wanted = if is_flat { FLAT_CELL_M } else { HILLY_CELL_M };
        let cells = |length: f32| (length / wanted).clamp(1.0, MAX_CELLS) as usize;
        let (columns, rows) = (cells(extent.x), cells(extent.y));
        let pitch = Vec2::new(snap(extent.x / columns as f32), snap(extent.y / rows as f32));
        let flat_m = is_flat.then_some(low - BELOW_FLAT_M);
        let reach_m = (CELL_REACH * pitch.max_element()).min(FOLLOW_M);
        Self {
            from,
            columns,
            rows,
            pitch,
            flat_m,
            roads: Heights::new(footing),
            below: Below::new(below, reach_m),
            pools,
        }
    }

    /// How high it is at a place.
    pub fn height_m(&self, p: Vec2) -> f32 {
        if let Some(flat_m) = self.flat_m {
            return flat_m;
        }
        let beds = self.pools.iter().filter_map(|pool| pool.bed_m(p));
        beds.chain(self.below.lowest_m(p)).fold(self.roads.height(p), f32::min)
    }

    /// Its surface.
    pub fn bake(&self) -> Surface {
        let (columns, rows) = (self.columns, self.rows);
        let mut surface = Surface { kind: SurfaceKind::Terrain, positions: Vec::new(), triangles: Vec::new() };
        for j in 0..=rows {
            for i in 0..=columns {
                let p = self.from + self.pitch * Vec2::new(i as f32, j as f32);
                surface.positions.push(Vec3::new(snap(p.x), snap(p.y), snap(self.height_m(p))));
            }
        }
        let at = |i: usize, j: usize| (j * (columns + 1) + i) as u32;
        for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
            surface.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            surface.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
        surface
    }
}

/// Places that land does not reach up to.
struct Below {
    places: Vec<Vec3>,
    grid: Grid,
    reach_m: f32,
}

impl Below {
    fn new(places: Vec<Vec3>, reach_m: f32) -> Self {
        let boxes: Vec<_> = places.iter().map(|p| (p.truncate(), p.truncate())).collect();
        Self { grid: Grid::new(&boxes, reach_m), places, reach_m }
    }

    fn lowest_m(&self, p: Vec2) -> Option<f32> {
        let near = self.grid.around(p, self.reach_m).map(|k| self.places[k as usize]);
        near.filter(|place| place.truncate().distance(p) < self.reach_m).map(|place| place.z).reduce(f32::min)
    }
}

/// Heights of the roads by place.
struct Heights {
    samples: Vec<Vec3>,
    grid: Grid,
    mean: f32,
}

impl Heights {
    fn new(samples: Vec<Vec3>) -> Self {
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
