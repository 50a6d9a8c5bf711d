//! The lanes around a place.

use glam::{Vec2, Vec3};

use super::grid::{Bounds, Grid};
use crate::map_data::{Lane, LaneId, LaneKind, LanePoint, Projection};
use crate::ops;

/// Vertices of a lane that share a box in the grid.
const STRETCH: usize = 8;
/// Of lanes of more vertices than this the boxes of all stretches are looked at first, and of those of more than that only
/// the stretches around.
const SHORT: usize = 2 * STRETCH;
const LONG: usize = 256;
/// Rounding moves distances by less than this, metres.
const ROUNDING_M: f32 = 0.1;
/// Side of a cell, metres.
const CELL_M: f32 = 10.0;
/// Distances that differ by less tie, and direction decides, metres.
const TIE_M: f32 = 0.5;
/// A lane leads where one looks up to this cosine of the angle between them.
const LEADS_COS: f32 = 0.5;

/// A grid over the lines of lanes.
#[derive(Debug)]
pub(crate) struct LaneGrid {
    grid: Grid,
    /// Lane and first vertex of each item of the grid.
    stretches: Vec<(LaneId, u32)>,
    /// Their boxes, and the first one of each lane.
    boxes: Vec<Bounds>,
    firsts: Vec<u32>,
}

impl LaneGrid {
    pub fn new(lanes: &[Lane]) -> Self {
        let (boxes, stretches) = boxes(lanes);
        let firsts = (0..=lanes.len()).map(|id| stretches.partition_point(|s| (s.0 as usize) < id) as u32);
        Self { grid: Grid::new(&boxes, CELL_M), firsts: firsts.collect(), stretches, boxes }
    }

    /// A lane in the cell that the most stretches touch, and how many do.
    pub fn most_crowded(&self) -> Option<(LaneId, usize)> {
        let (item, crowd) = self.grid.most_crowded()?;
        Some((self.stretches[item as usize].0, crowd))
    }

    /// With the lanes it was made of; all but their lines may have changed.
    pub fn over<'a>(&'a self, lanes: &'a [Lane]) -> Roads<'a> {
        Roads { lanes, grid: self }
    }
}

/// Lanes with a grid over them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roads<'a> {
    pub lanes: &'a [Lane],
    grid: &'a LaneGrid,
}

impl Roads<'_> {
    fn point(&self, p: &Projection) -> LanePoint {
        self.lanes[p.lane as usize].at(p.s_m)
    }

    /// The lane of `kind` nearest to `position` among those within `radius_m`; lanes that overlap
    /// in a junction tie at distance, then the one whose direction is nearer to `heading_rad` wins.
    pub fn nearest(
        &self,
        position: Vec3,
        kind: LaneKind,
        heading_rad: Option<f32>,
        radius_m: f32,
    ) -> Option<Projection> {
        self.best(self.around(position, kind, radius_m), heading_rad)
    }

    /// The driving lane nearest to `position` within `radius_m` that leads about where `heading_rad` does.
    pub fn leading(&self, position: Vec3, heading_rad: f32, radius_m: f32) -> Option<Projection> {
        let mut found = self.around(position, LaneKind::Driving, radius_m);
        found.retain(|p| ops::cos(self.point(p).heading_rad - heading_rad) >= LEADS_COS);
        self.best(found, Some(heading_rad))
    }

    fn best(&self, found: Vec<Projection>, heading_rad: Option<f32>) -> Option<Projection> {
        let nearest = found.iter().map(|p| self.beyond_edge(p)).fold(f32::MAX, f32::min);
        let misfit = |p: &Projection| match heading_rad {
            Some(h) => ops::wrap_angle(self.point(p).heading_rad - h).abs(),
            None => p.distance_m,
        };
        found
            .into_iter()
            .filter(|p| self.beyond_edge(p) <= nearest + TIE_M)
            .min_by(|a, b| misfit(a).total_cmp(&misfit(b)).then(a.distance_m.total_cmp(&b.distance_m)))
    }

    /// The lanes of `kind` whose area holds `position`, in ascending order of their ids.
    pub fn at(&self, position: Vec3, kind: LaneKind) -> Vec<Projection> {
        let mut found = self.around(position, kind, 0.0);
        found.retain(|p| self.beyond_edge(p) <= 0.0);
        found
    }

    /// Whether `position` lies on a driving lane (by its area seen from above).
    pub fn on_road(&self, position: Vec3) -> bool {
        !self.at(position, LaneKind::Driving).is_empty()
    }

    /// Lanes of `kind` whose area comes within `radius_m` of `position`, by id.
    pub fn around(&self, position: Vec3, kind: LaneKind, radius_m: f32) -> Vec<Projection> {
        let mut ids: Vec<LaneId> = self.near(position, radius_m).map(|(lane, _)| lane).collect();
        ids.sort_unstable();
        ids.dedup();
        ids.retain(|&id| self.lanes[id as usize].kind == kind);
        let mut found: Vec<_> = ids.into_iter().map(|id| self.onto(id, position, radius_m)).collect();
        found.retain(|p| self.beyond_edge(p) <= radius_m && self.on_level(p, position));
        found
    }

    /// Whether the area of any lane comes within `radius_m` of `position`.
    pub fn is_near(&self, position: Vec3, radius_m: f32) -> bool {
        let mut ids: Vec<LaneId> = self.near(position, radius_m).map(|(lane, _)| lane).collect();
        ids.sort_unstable();
        ids.dedup();
        let within = |p: Projection| self.beyond_edge(&p) <= radius_m && self.on_level(&p, position);
        ids.into_iter().any(|id| within(self.onto(id, position, radius_m)))
    }

    /// Whether any lane of `kind` may come within `radius_m` of `position`: the answer no is certain.
    pub fn may_be_near(&self, position: Vec3, kind: LaneKind, radius_m: f32) -> bool {
        self.near(position, radius_m).any(|(lane, _)| self.lanes[lane as usize].kind == kind)
    }

    /// Stretches that may come within `radius_m` of `position`, as their lane and first vertex; some come twice.
    fn near(&self, position: Vec3, radius_m: f32) -> impl Iterator<Item = (LaneId, u32)> + '_ {
        self.grid.grid.around(position.truncate(), radius_m).map(|i| self.grid.stretches[i as usize])
    }

    /// [`Projection::onto`] a lane near `position`; of one that is not short only stretches that may be nearest are looked at.
    fn onto(&self, id: LaneId, position: Vec3, near_m: f32) -> Projection {
        let lane = &self.lanes[id as usize];
        let (s_m, lateral_m, distance_m) = match lane.points.len() {
            vertices if vertices <= SHORT => lane.project(position),
            vertices if vertices <= LONG => self.onto_by_boxes(id, position),
            _ => self.onto_by_cells(id, position, near_m),
        };
        Projection { lane: id, s_m, lateral_m, distance_m }
    }

    /// By the stretches whose boxes are no farther than the line in the nearest box.
    fn onto_by_boxes(&self, id: LaneId, position: Vec3) -> (f32, f32, f32) {
        let (lane, p) = (&self.lanes[id as usize], position.truncate());
        let stretches = self.grid.firsts[id as usize] as usize..self.grid.firsts[id as usize + 1] as usize;
        let away2_m2 = |&i: &usize| {
            let (low, high) = self.grid.boxes[i];
            p.distance_squared(p.max(low).min(high))
        };
        let vertices = |i: usize| {
            let first = self.grid.stretches[i].1 as usize;
            first..(first + STRETCH).min(lane.points.len() - 1)
        };
        let Some(nearest) = stretches.clone().min_by(|a, b| away2_m2(a).total_cmp(&away2_m2(b))) else {
            return lane.project(position);
        };
        let (.., within_m) = lane.project_onto(std::iter::once(vertices(nearest)), position);
        let within2_m2 = (within_m + ROUNDING_M) * (within_m + ROUNDING_M);
        lane.project_onto(stretches.filter(|i| away2_m2(i) <= within2_m2).map(vertices), position)
    }

    /// By the stretches in the cells around, within `near_m` or as far as there is one.
    fn onto_by_cells(&self, id: LaneId, position: Vec3, near_m: f32) -> (f32, f32, f32) {
        let lane = &self.lanes[id as usize];
        let within = |reach_m: f32| {
            let near = self.near(position, reach_m + ROUNDING_M).filter(|s| s.0 == id);
            let mut firsts: Vec<usize> = near.map(|s| s.1 as usize).collect();
            firsts.sort_unstable();
            firsts.dedup();
            let stretches = firsts.into_iter().map(|k| k..(k + STRETCH).min(lane.points.len() - 1));
            lane.project_onto(stretches, position)
        };
        match within(near_m) {
            // A stretch beyond may be nearer, but none farther than this.
            (.., distance_m) if distance_m > near_m => within(distance_m),
            found => found,
        }
    }

    /// Distance from the lane's edge, negative inside its area.
    pub fn beyond_edge(&self, p: &Projection) -> f32 {
        p.distance_m - self.point(p).half_width_m
    }

    /// Whether a lane passes at about the height of `position`, not on a bridge above or below it.
    fn on_level(&self, p: &Projection, position: Vec3) -> bool {
        (self.point(p).position.z - position.z).abs() < 4.0
    }
}

/// The box of each stretch of a lane, its lane and its first vertex.
fn boxes(lanes: &[Lane]) -> (Vec<Bounds>, Vec<(LaneId, u32)>) {
    let mut boxes = Vec::new();
    let mut owners = Vec::new();
    for (id, lane) in lanes.iter().enumerate() {
        let mut first = 0;
        while first + 1 < lane.points.len() {
            let end = (first + STRETCH).min(lane.points.len() - 1);
            let part = &lane.points[first..=end];
            let low = part.iter().fold(Vec2::splat(f32::MAX), |m, p| m.min(p.position.truncate() - p.half_width_m));
            let high = part.iter().fold(Vec2::splat(f32::MIN), |m, p| m.max(p.position.truncate() + p.half_width_m));
            boxes.push((low, high));
            owners.push((id as LaneId, first as u32));
            first = end;
        }
    }
    (boxes, owners)
}
