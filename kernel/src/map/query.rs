//! Questions about places: the nearest lane, the point at a distance, the ground below.

use std::sync::{Arc, OnceLock};

use glam::{Vec2, Vec3};

use super::grid::Grid;
use super::{LaneId, LaneKind, LanePoint, RoadNetwork, SurfaceKind};
use crate::ops;

/// A place told relative to a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The lane.
    pub lane: LaneId,
    /// Nearest place on its centre line, metres from its start, within the lane's length.
    pub s_m: f32,
    /// Offset from the centre line in metres, positive to the left of the direction of travel.
    pub lateral_m: f32,
    /// Horizontal distance to that nearest place in metres (more than `lateral_m` beyond the ends).
    pub distance_m: f32,
}

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

/// Grids over lanes and ground, built on first use; start with `Index::default()`.
#[derive(Clone, Debug, Default)]
pub struct Index(OnceLock<Arc<Grids>>);

#[derive(Debug)]
struct Grids {
    lanes: Grid,
    /// Lane of each item of `lanes`.
    stretches: Vec<LaneId>,
    ground: Grid,
    /// Surface and triangle of each item of `ground`.
    triangles: Vec<(u32, u32)>,
}

/// Least and greatest corner of something seen from above.
type Bounds = (Vec2, Vec2);

/// Vertices of a lane that share a box in the grid.
const STRETCH: usize = 8;
const LANE_CELL_M: f32 = 10.0;
const GROUND_CELL_M: f32 = 4.0;
/// Distances that differ by less tie, and direction decides.
const TIE_M: f32 = 0.5;
/// Ground up to so much above a place still counts as below it.
const STEP_M: f32 = 1.0;

impl RoadNetwork {
    /// The point of `lane` at `s_m` from its start, interpolated; `s_m` is clamped to the lane.
    pub fn lane_point(&self, lane: LaneId, s_m: f32) -> LanePoint {
        self.lanes[lane as usize].at(s_m)
    }

    /// Where `position` is relative to `lane`.
    pub fn project(&self, lane: LaneId, position: Vec3) -> Projection {
        let (s_m, lateral_m, distance_m) = self.lanes[lane as usize].project(position);
        Projection { lane, s_m, lateral_m, distance_m }
    }

    /// The lane of `kind` nearest to `position` among those within `radius_m`; lanes that overlap
    /// in a junction tie at distance, then the one whose direction is nearer to `heading_rad` wins.
    pub fn nearest_lane(
        &self,
        position: Vec3,
        kind: LaneKind,
        heading_rad: Option<f32>,
        radius_m: f32,
    ) -> Option<Projection> {
        let found = self.lanes_around(position, kind, radius_m);
        let nearest = found.iter().map(|p| self.beyond_edge(p)).fold(f32::MAX, f32::min);
        let misfit = |p: &Projection| match heading_rad {
            Some(h) => ops::wrap_angle(self.lane_point(p.lane, p.s_m).heading_rad - h).abs(),
            None => p.distance_m,
        };
        found
            .into_iter()
            .filter(|p| self.beyond_edge(p) <= nearest + TIE_M)
            .min_by(|a, b| misfit(a).total_cmp(&misfit(b)).then(a.distance_m.total_cmp(&b.distance_m)))
    }

    /// The lanes of `kind` whose area holds `position`, in ascending order of their ids.
    pub fn lanes_at(&self, position: Vec3, kind: LaneKind) -> Vec<Projection> {
        let mut found = self.lanes_around(position, kind, 0.0);
        found.retain(|p| self.beyond_edge(p) <= 0.0);
        found
    }

    /// Whether `position` lies on a driving lane (by its area seen from above).
    pub fn on_road(&self, position: Vec3) -> bool {
        !self.lanes_at(position, LaneKind::Driving).is_empty()
    }

    /// Lanes of `kind` whose area comes within `radius_m` of `position`, by id.
    pub(super) fn lanes_around(&self, position: Vec3, kind: LaneKind, radius_m: f32) -> Vec<Projection> {
        let grids = self.grids();
        let near = grids.lanes.around(position.truncate(), radius_m);
        let mut ids: Vec<LaneId> = near.map(|i| grids.stretches[i as usize]).collect();
        ids.sort_unstable();
        ids.dedup();
        ids.retain(|&id| self.lanes[id as usize].kind == kind);
        let mut found: Vec<_> = ids.into_iter().map(|id| self.project(id, position)).collect();
        found.retain(|p| self.beyond_edge(p) <= radius_m && self.on_level(p, position));
        found
    }

    /// Distance from the lane's edge, negative inside its area.
    pub(super) fn beyond_edge(&self, p: &Projection) -> f32 {
        p.distance_m - self.lane_point(p.lane, p.s_m).half_width_m
    }

    /// Whether a lane passes at about the height of `position`, not on a bridge above or below it.
    fn on_level(&self, p: &Projection, position: Vec3) -> bool {
        (self.lane_point(p.lane, p.s_m).position.z - position.z).abs() < 4.0
    }

    /// The highest ground at most 1 m above `position` and below it; `None` beyond the map.
    pub fn ground(&self, position: Vec3) -> Option<Ground> {
        let grids = self.grids();
        let hits = grids.ground.around(position.truncate(), 0.0).filter_map(|i| {
            let (surface, triangle) = grids.triangles[i as usize];
            let surface = &self.surfaces[surface as usize];
            let corners = surface.triangles[triangle as usize].map(|v| surface.positions[v as usize]);
            let (height_m, normal) = height_at(corners, position.truncate())?;
            (height_m <= position.z + STEP_M).then_some(Ground { kind: surface.kind, height_m, normal })
        });
        hits.fold(None, |best: Option<Ground>, g| match best {
            Some(b) if b.height_m >= g.height_m => Some(b),
            _ => Some(g),
        })
    }

    fn grids(&self) -> &Grids {
        self.index.0.get_or_init(|| Arc::new(Grids::new(self)))
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

impl Grids {
    fn new(map: &RoadNetwork) -> Self {
        let (boxes, stretches) = lane_boxes(map);
        let (triangle_boxes, triangles) = ground_boxes(map);
        Self {
            lanes: Grid::new(&boxes, LANE_CELL_M),
            stretches,
            ground: Grid::new(&triangle_boxes, GROUND_CELL_M),
            triangles,
        }
    }
}

fn lane_boxes(map: &RoadNetwork) -> (Vec<Bounds>, Vec<LaneId>) {
    let mut boxes = Vec::new();
    let mut owners = Vec::new();
    for (id, lane) in map.lanes.iter().enumerate() {
        let mut first = 0;
        while first + 1 < lane.points.len() {
            let end = (first + STRETCH).min(lane.points.len() - 1);
            let part = &lane.points[first..=end];
            let low = part.iter().fold(Vec2::splat(f32::MAX), |m, p| m.min(p.position.truncate() - p.half_width_m));
            let high = part.iter().fold(Vec2::splat(f32::MIN), |m, p| m.max(p.position.truncate() + p.half_width_m));
            boxes.push((low, high));
            owners.push(id as LaneId);
            first = end;
        }
    }
    (boxes, owners)
}

fn ground_boxes(map: &RoadNetwork) -> (Vec<Bounds>, Vec<(u32, u32)>) {
    let mut boxes = Vec::new();
    let mut owners = Vec::new();
    for (k, surface) in map.surfaces.iter().enumerate().filter(|(_, s)| s.kind != SurfaceKind::RoadLine) {
        for (t, triangle) in surface.triangles.iter().enumerate() {
            let [a, b, c] = triangle.map(|v| surface.positions[v as usize].truncate());
            boxes.push((a.min(b).min(c), a.max(b).max(c)));
            owners.push((k as u32, t as u32));
        }
    }
    (boxes, owners)
}
