//! Places on a map.

use glam::{Vec2, Vec3};

use crate::map::RoadNetwork;
use crate::map_data::{LaneId, LaneKind};
use crate::{ops, state};

/// Of what somebody may be on, what comes first where areas overlap.
const KINDS: [LaneKind; 6] =
    [LaneKind::Driving, LaneKind::Biking, LaneKind::Parking, LaneKind::Shoulder, LaneKind::Sidewalk, LaneKind::Other];
/// A lane that is higher or lower by more is on another level, metres.
const LEVEL_M: f32 = 2.5;

state! {
    /// A place on a lane.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct OnLane {
        /// The lane.
        pub lane: LaneId,
        /// Metres from its start.
        pub s_m: f32,
        /// Metres to the left of its middle, seen in its direction of travel.
        pub offset_m: f32,
        /// Whether who is there faces against that.
        pub against: bool,
    }
}

state! {
    /// A place on a map.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Spot {
        /// Metres.
        pub position: Vec3,
        /// Counter-clockwise from east, radians.
        pub heading_rad: f32,
        /// Where it is on the lane under it, if one is.
        pub on: Option<OnLane>,
    }
}

impl Spot {
    /// A place, with the lane under it that leads most nearly where who is there faces, one way or the other.
    pub fn at(network: &RoadNetwork, position: Vec3, heading_rad: f32) -> Self {
        let mut spot = Self { position, heading_rad, on: None };
        for kind in KINDS {
            let here = network.lanes_at(position, kind).into_iter().map(|p| {
                let point = network.lane_point(p.lane, p.s_m);
                let along = ops::cos(point.heading_rad - heading_rad);
                (p, point.position.z, along)
            });
            let level = here.filter(|(_, z, _)| (z - position.z).abs() < LEVEL_M);
            let best = level.max_by(|a, b| {
                let fit = |(p, _, along): &(crate::map::Projection, f32, f32)| along.abs() - 0.1 * p.lateral_m.abs();
                fit(a).total_cmp(&fit(b)).then(b.0.lane.cmp(&a.0.lane))
            });
            if let Some((p, _, along)) = best {
                let against = along < 0.0;
                spot.on = Some(OnLane { lane: p.lane, s_m: p.s_m, offset_m: p.lateral_m, against });
                break;
            }
        }
        spot
    }

    /// A place on a lane, facing along it or against it.
    pub fn on(network: &RoadNetwork, on: OnLane) -> Self {
        let place = network.lanes[on.lane as usize].straight_on(on.s_m);
        let forward = place.forward * if on.against { -1.0 } else { 1.0 };
        Self { position: place.beside(on.offset_m), heading_rad: ops::atan2(forward.y, forward.x), on: Some(on) }
    }

    /// The same, facing elsewhere.
    pub fn facing(self, heading_rad: f32) -> Self {
        Self { heading_rad: ops::wrap_angle(heading_rad), ..self }
    }

    /// On the ground below a place, or the place where there is none.
    pub fn grounded(network: &RoadNetwork, position: Vec3) -> Vec3 {
        network.ground(position).map_or(position, |ground| position.with_z(ground.height_m))
    }

    /// Seen from above.
    pub fn plan(&self) -> Vec2 {
        self.position.truncate()
    }
}
