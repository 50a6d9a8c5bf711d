//! Somebody who plays.

use glam::{Mat3, Quat, Vec3};

use crate::actor::{ActorKind, FIRST_STORY_ID};
use crate::ego;
use crate::scene::lamps;
use crate::state;
use crate::time::{TICK_S, Tick};
use crate::traffic::{Body, Obstacle};

use super::places::MOST_M;
use super::script;
use super::spot::Spot;

/// Slower than this somebody stands, m/s.
const STANDS_MPS: f32 = 0.1;
/// Braking from which the lamps tell it, m/s².
const LAMPS_MPS2: f32 = 0.7;
/// Speed across the lane from which the indicators tell it, m/s.
const INDICATES_MPS: f32 = 0.1;
/// Nobody is faster, and nobody comes farther, m/s and metres.
const MOST_MPS: f32 = 1000.0;
const FARTHEST_M: f32 = 1e9;
/// The way in a turn of the legs or the pedals, metres.
const STRIDE_M: f32 = 1.4;
const PEDALS_M: f32 = 5.0;

state! {
    /// How a front door swings.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct DoorSwing {
        /// How far open it was, [0, 1].
        pub from: f32,
        /// And will be.
        pub to: f32,
        /// When it began to swing.
        pub since: Tick,
        /// How long it swings, ticks.
        pub takes_ticks: u32,
    }
}

impl DoorSwing {
    /// A door that was never opened.
    pub const SHUT: Self = Self { from: 0.0, to: 0.0, since: 0, takes_ticks: 1 };

    /// How far open it is at a tick, [0, 1].
    pub fn share(&self, tick: Tick) -> f32 {
        let swung = tick.saturating_sub(self.since) as f32 / self.takes_ticks.max(1) as f32;
        self.from + (self.to - self.from) * swung.min(1.0)
    }
}

state! {
    /// Somebody who plays.
    #[derive(Clone, Debug, PartialEq)]
    pub struct StoryActor {
        /// Where it is.
        pub spot: Spot,
        /// Has left the map.
        pub gone: bool,
        /// Speed along its heading, m/s.
        pub speed_mps: f32,
        /// How fast it was when it came to the end of its road, and is again where it is taken from there, m/s.
        pub ended_mps: f32,
        /// Speed to the left across its lane, m/s.
        pub drift_mps: f32,
        /// So far to the left of where it wants to be in its lane it still is after it changed that for its way, metres.
        pub slip_m: f32,
        /// What its speed became in the last tick, m/s².
        pub acceleration_mps2: f32,
        /// Velocity, m/s.
        pub velocity_mps: Vec3,
        /// The way so far, metres.
        pub travelled_m: f32,
        /// For how many ticks it has stood.
        pub stood_ticks: u32,
        /// For how many ticks it has been beside the road.
        pub off_road_ticks: u32,
        /// For how many ticks it has stood where its road ends.
        pub at_end_ticks: u32,
        /// Phase of its gait or pedals, 2^-16 turns.
        pub phase: u16,
        /// Its front doors, left and right.
        pub doors: [DoorSwing; 2],
        /// Lanes that it takes next.
        pub route: Vec<u32>,
        /// The deed that decides how fast it goes.
        pub speed_by: Option<u32>,
        /// The deed that decides where across its lane it is.
        pub side_by: Option<u32>,
        /// The deed whose line it follows, or whose way it goes.
        pub way_by: Option<u32>,
    }
}

impl StoryActor {
    /// Somebody who stands at a place.
    pub fn standing(spot: Spot) -> Self {
        Self {
            spot,
            gone: false,
            speed_mps: 0.0,
            ended_mps: 0.0,
            drift_mps: 0.0,
            slip_m: 0.0,
            acceleration_mps2: 0.0,
            velocity_mps: Vec3::ZERO,
            travelled_m: 0.0,
            stood_ticks: 0,
            off_road_ticks: 0,
            at_end_ticks: 0,
            phase: 0,
            doors: [DoorSwing::SHUT; 2],
            route: Vec::new(),
            speed_by: None,
            side_by: None,
            way_by: None,
        }
    }

    /// Whether it is where somebody can be, as fast as somebody can be.
    pub fn is_possible(&self) -> bool {
        let about = |m: f32| m.abs() < MOST_M;
        let on = self.spot.on.is_none_or(|on| about(on.s_m) && about(on.offset_m));
        let speeds = [self.speed_mps, self.ended_mps, self.drift_mps, self.velocity_mps.length()];
        let places = [self.spot.position.abs().max_element(), self.slip_m, self.spot.heading_rad];
        on && places.into_iter().all(about)
            && speeds.into_iter().all(|mps| mps.abs() < MOST_MPS)
            && self.travelled_m < FARTHEST_M
    }

    /// Takes over where it came in a tick.
    pub fn came(&mut self, before: &Self, kind: Option<ActorKind>, on_road: bool, at_end: bool) {
        let step = self.spot.position - before.spot.position;
        self.velocity_mps = step / TICK_S;
        self.acceleration_mps2 = (self.speed_mps - before.speed_mps) / TICK_S;
        let step_m = step.length();
        self.travelled_m += step_m;
        let count = |goes_on: bool, ticks: u32| if goes_on { ticks.saturating_add(1) } else { 0 };
        self.stood_ticks = count(self.speed_mps.abs() < STANDS_MPS, before.stood_ticks);
        self.off_road_ticks = count(!on_road, before.off_road_ticks);
        self.at_end_ticks = count(at_end, before.at_end_ticks);
        let turn_m = if kind.is_some_and(ActorKind::is_on_foot) { STRIDE_M } else { PEDALS_M };
        self.phase = before.phase.wrapping_add((step_m / turn_m * 65536.0) as u16);
    }

    /// As pictures and physics need it.
    pub fn body(&self, role: script::RoleId, kind: ActorKind) -> Body {
        let lamp = |lamp: u8, burns: bool| if burns { lamp } else { 0 };
        let drives = kind.is_car_or_heavier() || kind.is_motorcycle();
        let side = if self.side_by.is_some() { self.drift_mps } else { 0.0 };
        let burning = lamp(lamps::BRAKE, self.acceleration_mps2 < -LAMPS_MPS2)
            | lamp(lamps::LEFT, side > INDICATES_MPS)
            | lamp(lamps::RIGHT, side < -INDICATES_MPS);
        Body {
            id: FIRST_STORY_ID + role as u32,
            kind,
            variant: role as u32,
            position: self.spot.position,
            rotation: self.rotation(),
            velocity_mps: self.velocity_mps,
            phase_rad: f32::from(self.phase) * (core::f32::consts::TAU / 65536.0),
            lamps: if drives { burning } else { 0 },
        }
    }

    /// Level across, as steep along as it goes.
    pub fn rotation(&self) -> Quat {
        let ahead = crate::geometry::direction(self.spot.heading_rad);
        let along_mps = self.velocity_mps.truncate().dot(ahead);
        let rise = if along_mps.abs() > 1.0 { (self.velocity_mps.z / along_mps).clamp(-0.3, 0.3) } else { 0.0 };
        let forward = ahead.extend(rise).normalize_or(Vec3::X);
        let left = Vec3::new(-forward.y, forward.x, 0.0).normalize_or(Vec3::Y);
        Quat::from_mat3(&Mat3::from_cols(forward, left, forward.cross(left)))
    }
}

/// What the others see of somebody who plays.
pub fn obstacle(body: &Body, heading_rad: f32) -> Obstacle {
    Obstacle {
        id: body.id,
        position: body.position,
        heading_rad,
        velocity_mps: body.velocity_mps,
        size_m: body.kind.size_m(),
        on_foot: body.kind.is_on_foot(),
    }
}

/// Length, width and height of a role, metres.
pub fn size_m(role: &script::Role) -> Vec3 {
    role.kind.map_or(ego::SIZE_M, ActorKind::size_m)
}
