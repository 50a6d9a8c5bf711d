//! Whatever else stands or moves in a vehicle's way: the ego car, loose actors, people on the road.

use glam::Vec2;

use crate::actor::ActorKind;
use crate::geometry::direction;
use crate::map_data::{MapData, Place};

use super::body::{Body, Obstacle};
use super::plan::Step;

/// Nothing farther than this from the middle of the way matters, metres.
const REACH_M: f32 = 6.5;
/// Sideways distance kept, metres.
const CLEARANCE_M: f32 = 0.35;
/// How far ahead the crossing of a walker is expected to go on, seconds.
const WALKER_FORESIGHT_S: f32 = 2.5;
/// The same for a vehicle.
const VEHICLE_FORESIGHT_S: f32 = 0.8;
/// Levels farther apart than this are different roads, metres.
const LEVEL_M: f32 = 3.0;

/// Something that moves freely.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hazard {
    pub position: glam::Vec3,
    pub velocity: Vec2,
    pub forward: Vec2,
    /// Half of its length and width, metres.
    pub half: Vec2,
    pub walker: bool,
}

impl Hazard {
    /// A box that physics moves.
    pub fn of(obstacle: &Obstacle, walker: bool) -> Self {
        Self {
            position: obstacle.position,
            velocity: obstacle.velocity_mps.truncate(),
            forward: direction(obstacle.heading_rad),
            half: obstacle.size_m.truncate() * 0.5,
            walker,
        }
    }

    /// An actor at its place on the map.
    pub fn of_body(body: &Body) -> Self {
        let forward = (body.rotation * glam::Vec3::X).truncate().normalize_or(Vec2::X);
        Self {
            position: body.position,
            velocity: body.velocity_mps.truncate(),
            forward,
            half: body.kind.size_m().truncate() * 0.5,
            walker: body.kind == ActorKind::Pedestrian,
        }
    }

    /// Half of its extent along a horizontal unit vector, metres.
    fn half_along(&self, axis: Vec2) -> f32 {
        self.half.x * self.forward.dot(axis).abs() + self.half.y * self.forward.perp_dot(axis).abs()
    }
}

/// A vehicle that looks for hazards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seeker {
    pub position: glam::Vec3,
    pub offset_m: f32,
    pub speed_mps: f32,
    /// Half of its length and width, metres.
    pub half: Vec2,
    pub horizon_m: f32,
}

/// Gap to a hazard in the way (bumper to its near side, metres) and its speed along the way (m/s);
/// `None` when it is not in the way and does not step into it.
pub(super) fn in_way(map: &MapData, steps: &[Step], seeker: &Seeker, hazard: &Hazard) -> Option<(f32, f32)> {
    let reach = seeker.horizon_m + REACH_M;
    let apart = hazard.position - seeker.position;
    if apart.truncate().length_squared() > reach * reach || apart.z.abs() > LEVEL_M + 0.15 * reach {
        return None;
    }
    let (along_m, place) = nearest_on_way(map, steps, seeker.horizon_m, hazard)?;
    let (forward, left) = (place.forward.truncate().normalize_or(Vec2::X), place.left());
    let offset = (hazard.position - place.position).truncate();
    let at_m = along_m + offset.dot(forward);
    let gap_m = at_m - hazard.half_along(forward) - seeker.half.x;
    if at_m <= 0.0 || (hazard.position.z - place.position.z).abs() > LEVEL_M {
        return None;
    }
    let time_s = gap_m.max(0.0) / seeker.speed_mps.max(1.0);
    let foresight_s = time_s.min(if hazard.walker { WALKER_FORESIGHT_S } else { VEHICLE_FORESIGHT_S });
    let now_m = offset.dot(left) - seeker.offset_m;
    let then_m = now_m + hazard.velocity.dot(left) * foresight_s;
    let half_m = hazard.half_along(left) + seeker.half.y + CLEARANCE_M;
    let in_way = now_m.min(then_m) < half_m && now_m.max(then_m) > -half_m;
    in_way.then(|| (gap_m, hazard.velocity.dot(forward)))
}

/// The first place on the way at which the distance to the hazard is least, if that is within
/// [`REACH_M`]. Strides over stretches that are farther away than they are long.
fn nearest_on_way(map: &MapData, steps: &[Step], horizon_m: f32, hazard: &Hazard) -> Option<(f32, Place)> {
    let target = hazard.position.truncate();
    let mut best: Option<(f32, f32, Place)> = None;
    let (mut at_m, mut k) = (0.0, 0);
    while at_m < horizon_m {
        while k + 1 < steps.len() && steps[k + 1].start_m <= at_m {
            k += 1;
        }
        let lane = &map.lanes[steps[k].lane as usize];
        if at_m - steps[k].start_m > lane.length_m + 2.0 {
            break;
        }
        let place = lane.straight_on(at_m - steps[k].start_m);
        let distance = place.position.truncate().distance(target);
        match best {
            Some((least, ..)) if distance > least + 1.0 => break,
            Some((least, ..)) if distance >= least => {}
            _ if distance < REACH_M => best = Some((distance, at_m, place)),
            _ => {}
        }
        at_m += (distance - REACH_M).max(1.0);
    }
    best.map(|(_, at_m, place)| (at_m, place))
}
