//! What there is to see at one tick, apart from the static map.
//!
//! Every value is on the grid of its byte layout ([`quantise`]), so that a snapshot that was stored
//! and read back renders to the same pixels as the live one.

use glam::{Quat, Vec3};

use crate::light::LightPhase;
use crate::time::Tick;
use crate::{ops, state};

pub use crate::actor::{ActorKind, FIRST_DOOR_ID, FIRST_PARKED_ID, FIRST_STORY_DOOR_ID, FIRST_STORY_ID};
pub use crate::weather::Weather;

state! {
    /// The ego car.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct EgoScene {
        /// Centre of the rear axle's projection on the ground plane of the car, metres.
        pub position: Vec3,
        /// Rotation from the car's axes (x forward, y left, z up) to the world's.
        pub rotation: Quat,
        /// Speed along the car's x axis, m/s; negative in reverse.
        pub speed_mps: f32,
        /// Mean angle of the front wheels, radians, positive to the right.
        pub wheel_angle_rad: f32,
        /// Its lamps: bit set of [`lamps`].
        pub lamps: u8,
    }
}

state! {
    /// Another road user.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ActorScene {
        /// Stable number of the actor within the run, 1 or more; from [`FIRST_PARKED_ID`] on a parked car that was pushed,
        /// which is no longer where the map has it, and from [`FIRST_DOOR_ID`] on an open door.
        pub id: u32,
        /// What it is.
        pub kind: ActorKind,
        /// Selects colour and shape.
        pub variant: u32,
        /// Centre of its footprint on the ground, metres.
        pub position: Vec3,
        /// Rotation from its axes (x forward, y left, z up) to the world's.
        pub rotation: Quat,
        /// Speed along its x axis, m/s.
        pub speed_mps: f32,
        /// Phase of its gait or pedalling, radians in [0, 2 pi).
        pub phase_rad: f32,
        /// Its lamps: bit set of [`lamps`].
        pub lamps: u8,
    }
}

/// Lamps of a road user, as bits.
pub mod lamps {
    /// Brake lights on.
    pub const BRAKE: u8 = 1;
    /// Indicates to the left; whoever draws it lets it flash.
    pub const LEFT: u8 = 2;
    /// Indicates to the right; both sides are the hazard lights.
    pub const RIGHT: u8 = 4;
    /// Headlights on.
    pub const HEADLIGHTS: u8 = 8;
}

state! {
    /// The moving world at one tick.
    #[derive(Clone, Debug, PartialEq)]
    pub struct SceneSnapshot {
        /// The tick.
        pub tick: Tick,
        /// The ego car.
        pub ego: EgoScene,
        /// The other road users, by ascending id.
        pub actors: Vec<ActorScene>,
        /// Phase of each light group of the map, by index.
        pub lights: Vec<LightPhase>,
        /// Weather.
        pub weather: Weather,
    }
}

/// Steps a metre, radian, m/s or unit is divided into in a snapshot.
const STEPS: f32 = 1024.0;
const QUAT_STEPS: f32 = 16384.0;

fn grid(v: f32, steps: f32) -> f32 {
    ops::round(v * steps) / steps
}

fn grid3(v: Vec3) -> Vec3 {
    Vec3::new(grid(v.x, STEPS), grid(v.y, STEPS), grid(v.z, STEPS))
}

fn grid_quat(q: Quat) -> Quat {
    Quat::from_xyzw(grid(q.x, QUAT_STEPS), grid(q.y, QUAT_STEPS), grid(q.z, QUAT_STEPS), grid(q.w, QUAT_STEPS))
}

/// Puts every value of a snapshot on its grid: 2^-10 for lengths, angles and speeds, 2^-14 for
/// the components of rotations.
pub fn quantise(scene: &mut SceneSnapshot) {
    let ego = &mut scene.ego;
    ego.position = grid3(ego.position);
    ego.rotation = grid_quat(ego.rotation);
    ego.speed_mps = grid(ego.speed_mps, STEPS);
    ego.wheel_angle_rad = grid(ego.wheel_angle_rad, STEPS);
    for actor in &mut scene.actors {
        actor.position = grid3(actor.position);
        actor.rotation = grid_quat(actor.rotation);
        actor.speed_mps = grid(actor.speed_mps, STEPS);
        actor.phase_rad = grid(actor.phase_rad, STEPS);
    }
}
