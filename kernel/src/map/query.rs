//! Questions about places: the nearest lane, the point at a distance, the ground below.

use glam::Vec3;

use super::{LaneId, LaneKind, LanePoint, RoadNetwork, SurfaceKind};

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

impl RoadNetwork {
    /// The point of `lane` at `s_m` from its start, interpolated; `s_m` is clamped to the lane.
    pub fn lane_point(&self, _lane: LaneId, _s_m: f32) -> LanePoint {
        todo!()
    }

    /// Where `position` is relative to `lane`.
    pub fn project(&self, _lane: LaneId, _position: Vec3) -> Projection {
        todo!()
    }

    /// The lane of `kind` nearest to `position` among those within `radius_m`; lanes that overlap
    /// in a junction tie at distance, then the one whose direction is nearer to `heading_rad` wins.
    pub fn nearest_lane(
        &self,
        _position: Vec3,
        _kind: LaneKind,
        _heading_rad: Option<f32>,
        _radius_m: f32,
    ) -> Option<Projection> {
        todo!()
    }

    /// The lanes of `kind` whose area holds `position`, in ascending order of their ids.
    pub fn lanes_at(&self, _position: Vec3, _kind: LaneKind) -> Vec<Projection> {
        todo!()
    }

    /// Whether `position` lies on a driving lane (by its area seen from above).
    pub fn on_road(&self, _position: Vec3) -> bool {
        todo!()
    }

    /// The highest ground at most 1 m above `position` and below it; `None` beyond the map.
    pub fn ground(&self, _position: Vec3) -> Option<Ground> {
        todo!()
    }
}
