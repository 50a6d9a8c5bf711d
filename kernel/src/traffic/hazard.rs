//! Whatever else stands or moves in a vehicle's way: the ego car, loose actors, people on the road.

use glam::Vec2;

use crate::geometry::direction;
use crate::map_data::{MapData, Place};

use super::body::{Body, Obstacle};
use super::step::Step;

/// Nothing farther than this from the middle of the way matters, metres.
pub(super) const REACH_M: f32 = 6.5;
/// Sideways distance kept, metres, and from bicycles: more than the 1.5 m of most road traffic acts.
const CLEARANCE_M: f32 = 0.35;
pub(super) const BICYCLE_M: f32 = 1.55;
/// Right before what is in the way one creeps by, metres, no faster than this, m/s.
const CREEP_M: f32 = 1.5;
const CREEP_MPS: f32 = 2.3;
/// Sideways distance at a walking pace, metres, and so much more for each m/s, s.
const CREEPING_M: f32 = 0.12;
const CREEPING_S: f32 = 0.1;
/// Before one who comes the other way over the border one drives so far onto the verge, metres.
const VERGE_M: f32 = 0.4;
/// What is passed within the lane is passed at so much more, metres.
const STEERED_M: f32 = 0.05;
/// How far ahead the crossing of a walker is expected to go on, seconds.
const WALKER_FORESIGHT_S: f32 = 2.5;
/// Who is faster takes no last look, m/s.
pub(super) const SLOW_MPS: f32 = 7.0;
/// The same for a vehicle.
const VEHICLE_FORESIGHT_S: f32 = 0.8;
/// What stands is passed from so far before it on, metres.
const PASS_M: f32 = 35.0;
/// Slower than this it stands, m/s.
const STANDS_MPS: f32 = 0.5;
/// Levels farther apart than this are different roads, metres.
const LEVEL_M: f32 = 3.0;

/// Something that moves freely.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hazard {
    /// Id of the actor, 0 of the ego car.
    pub id: u32,
    pub position: glam::Vec3,
    pub velocity: Vec2,
    pub forward: Vec2,
    /// Half of its length and width, metres.
    pub half: Vec2,
    pub walker: bool,
    /// Index of the vehicle that drives there.
    pub vehicle: Option<u32>,
    /// Sideways distance that vehicles keep from it, metres.
    pub clearance_m: f32,
}

impl Hazard {
    /// A box that physics moves.
    pub fn of(obstacle: &Obstacle) -> Self {
        Self {
            id: obstacle.id,
            position: obstacle.position,
            velocity: obstacle.velocity_mps.truncate(),
            forward: direction(obstacle.heading_rad),
            half: obstacle.size_m.truncate() * 0.5,
            walker: obstacle.on_foot,
            vehicle: None,
            clearance_m: CLEARANCE_M,
        }
    }

    /// An actor at its place on the map.
    pub fn of_body(body: &Body) -> Self {
        let forward = (body.rotation * glam::Vec3::X).truncate().normalize_or(Vec2::X);
        Self {
            id: body.id,
            position: body.position,
            velocity: body.velocity_mps.truncate(),
            forward,
            half: body.kind.size_m().truncate() * 0.5,
            walker: body.kind.is_on_foot(),
            vehicle: None,
            clearance_m: if body.kind.is_pedalled() { BICYCLE_M } else { CLEARANCE_M },
        }
    }

    /// Whether it is the ego car.
    pub fn is_ego(&self) -> bool {
        self.id == 0
    }

    /// Whether it is a vehicle that stands.
    pub fn stands(&self) -> bool {
        !self.walker && self.is_slower(STANDS_MPS)
    }

    /// Whether it is slower than so many m/s.
    pub fn is_slower(&self, mps: f32) -> bool {
        self.velocity.length_squared() < mps * mps
    }

    /// The same where it will be after so many seconds.
    pub fn after(&self, time_s: f32) -> Self {
        Self { position: self.position + (self.velocity * time_s).extend(0.0), ..*self }
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

/// A hazard as a vehicle sees it from its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sighted {
    /// From the vehicle's bumper to its near side, metres; negative beside it.
    pub gap_m: f32,
    /// Its extent along the way, metres.
    pub length_m: f32,
    /// Its speed along the way, m/s.
    pub speed_mps: f32,
    /// Its middle is before the vehicle's.
    pub ahead: bool,
    /// It faces the other way.
    comes: bool,
    /// Its middle to the left of that of the way, metres: least and greatest until the vehicle is there.
    aside_m: [f32; 2],
    /// Half of its extent across the way, metres.
    half_m: f32,
    /// Half of the way's width there, metres.
    way_half_m: f32,
    clearance_m: f32,
}

impl Sighted {
    /// Whether it is in the way of a vehicle `offset_m` to the left of the middle, half as wide as `half_m`.
    pub fn blocks(&self, offset_m: f32, half_m: f32) -> bool {
        let reach_m = self.half_m + half_m + self.clearance_m;
        self.ahead && self.aside_m[0] - offset_m < reach_m && self.aside_m[1] - offset_m > -reach_m
    }

    /// The same right before it, for those who come by each other this slowly: at a walking pace a hand's breadth is enough.
    pub fn blocks_at(&self, offset_m: f32, half_m: f32, speed_mps: f32) -> bool {
        if self.gap_m > CREEP_M || speed_mps > CREEP_MPS {
            return self.blocks(offset_m, half_m);
        }
        let clearance_m = self.clearance_m.min(CREEPING_M + CREEPING_S * speed_mps);
        Sighted { clearance_m, ..*self }.blocks(offset_m, half_m)
    }

    /// The same, also beside it, until the tail has passed.
    pub fn obstructs(&self, offset_m: f32, half_m: f32) -> bool {
        Sighted { ahead: true, ..*self }.blocks(offset_m, half_m)
    }

    /// Its middle, metres to the left of that of the way.
    pub fn middle_m(&self) -> f32 {
        0.5 * (self.aside_m[0] + self.aside_m[1])
    }

    /// Its outermost place to the left (`side` 1) or right (-1), metres to the left of the middle of the way.
    pub fn edge_m(&self, side: f32) -> f32 {
        if side > 0.0 { self.aside_m[1] + self.half_m } else { self.aside_m[0] - self.half_m }
    }

    /// Where to pass it within the lane, or right beside that in front of one who comes, if there is room: the place nearest
    /// to `offset_m`.
    fn passed_at(&self, offset_m: f32, half_m: f32) -> Option<f32> {
        // Steering comes close to its aim, not to the millimetre.
        let reach_m = self.half_m + half_m + self.clearance_m + STEERED_M;
        let room_m = self.way_half_m - half_m + if self.comes { VERGE_M } else { 0.0 };
        let sides = [self.aside_m[1] + reach_m, self.aside_m[0] - reach_m];
        let free = sides.into_iter().filter(|m| m.abs() <= room_m);
        free.min_by(|a, b| (a - offset_m).abs().total_cmp(&(b - offset_m).abs()))
    }
}

/// To the left of somebody who goes along `ahead` and stands before a vehicle: the side on which its front is, since whoever
/// goes round behind it is not seen.
pub(super) fn past_front_m(block: &Hazard, ahead: Vec2) -> f32 {
    ahead.perp_dot(block.forward).signum()
}

/// Where across its way a vehicle drives that keeps to `offset_m` otherwise: it passes what is in it, where its lane has
/// the room.
pub(super) fn side<'a>(
    map: &MapData,
    steps: &[Step],
    seeker: &Seeker,
    passed: impl Iterator<Item = &'a Hazard>,
    offset_m: f32,
) -> f32 {
    let mut aim_m = offset_m;
    for hazard in passed {
        let seen = sight(map, steps, seeker, hazard).filter(|seen| seen.gap_m < PASS_M);
        if let Some(seen) = seen.filter(|seen| seen.obstructs(aim_m, seeker.half.y)) {
            aim_m = seen.passed_at(seeker.offset_m, seeker.half.y).unwrap_or(aim_m);
        }
    }
    aim_m
}

/// How a hazard lies to a vehicle's way; `None` where it does not come near it.
#[inline]
pub(super) fn sight(map: &MapData, steps: &[Step], seeker: &Seeker, hazard: &Hazard) -> Option<Sighted> {
    // Most are far away.
    let reach = seeker.horizon_m + REACH_M;
    let apart = hazard.position - seeker.position;
    let far = apart.truncate().length_squared() > reach * reach || apart.z.abs() > LEVEL_M + 0.15 * reach;
    if far { None } else { sight_near(map, steps, seeker, hazard) }
}

fn sight_near(map: &MapData, steps: &[Step], seeker: &Seeker, hazard: &Hazard) -> Option<Sighted> {
    let (along_m, place) = nearest_on_way(map, steps, seeker.horizon_m, hazard)?;
    let (forward, left) = (place.forward.truncate().normalize_or(Vec2::X), place.left());
    let offset = (hazard.position - place.position).truncate();
    let at_m = along_m + offset.dot(forward);
    let half_along_m = hazard.half_along(forward);
    let gap_m = at_m - half_along_m - seeker.half.x;
    let gone = at_m < -(half_along_m + seeker.half.x + CLEARANCE_M);
    if gone || (hazard.position.z - place.position.z).abs() > LEVEL_M {
        return None;
    }
    let time_s = gap_m.max(0.0) / seeker.speed_mps.max(1.0);
    let foresight_s = match hazard.walker {
        // Nobody shall walk into the side of one who takes no last look.
        true if seeker.speed_mps > SLOW_MPS => {
            WALKER_FORESIGHT_S.min(time_s + 2.0 * (seeker.half.x + half_along_m) / seeker.speed_mps)
        }
        true => WALKER_FORESIGHT_S.min(time_s),
        false => VEHICLE_FORESIGHT_S.min(time_s),
    };
    let now_m = offset.dot(left);
    let then_m = now_m + hazard.velocity.dot(left) * foresight_s;
    Some(Sighted {
        gap_m,
        length_m: 2.0 * half_along_m,
        speed_mps: hazard.velocity.dot(forward),
        ahead: at_m > 0.0,
        comes: !hazard.walker && hazard.forward.dot(forward) < -0.3,
        aside_m: [now_m.min(then_m), now_m.max(then_m)],
        half_m: hazard.half_along(left),
        way_half_m: place.half_width_m,
        clearance_m: hazard.clearance_m,
    })
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
