//! Road users as boxes: how traffic sees the rest of the world, and how the world sees traffic.

use glam::{Quat, Vec3};

use crate::actor::ActorKind;
use crate::signals::HeldLight;
use crate::time::Tick;
use crate::weather::Conditions;

/// A box that moves freely: the ego car, or an actor that physics has taken over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// Id of the actor; 0 for the ego car.
    pub id: u32,
    /// Centre of its footprint on the ground, metres.
    pub position: Vec3,
    /// Direction of its x axis, radians counter-clockwise from east.
    pub heading_rad: f32,
    /// Velocity, m/s.
    pub velocity_mps: Vec3,
    /// Length, width and height, metres.
    pub size_m: Vec3,
    /// It is somebody on foot.
    pub on_foot: bool,
}

/// What traffic sees of the rest of the world, as it was at the end of the previous tick.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// The tick that is being computed.
    pub tick: Tick,
    /// The ego car.
    pub ego: Obstacle,
    /// Its controls' flags: traffic sees the indicators and hears the horn.
    pub ego_flags: u8,
    /// Actors that physics has made loose, by ascending id: they decide nothing, their state stays
    /// as it was, and others see them at these poses. Those who play a story are among them.
    pub loose: &'a [Obstacle],
    /// Lights that a story holds, by ascending group.
    pub lights: &'a [HeldLight],
    /// What the weather asks of everybody.
    pub conditions: Conditions,
}

impl Surroundings<'_> {
    /// In dry weather, with an ego car that does nothing, and nobody and nothing held.
    pub fn calm(tick: Tick, ego: Obstacle) -> Self {
        Self { tick, ego, ego_flags: 0, loose: &[], lights: &[], conditions: Conditions::default() }
    }
}

/// An actor as physics and pictures need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Id of the actor, 1 or more.
    pub id: u32,
    /// What it is; gives its box by [`ActorKind::size_m`].
    pub kind: ActorKind,
    /// Selects colour and shape.
    pub variant: u32,
    /// Centre of its footprint on the ground, metres.
    pub position: Vec3,
    /// Rotation from its axes (x forward, y left, z up) to the world's.
    pub rotation: Quat,
    /// Velocity, m/s.
    pub velocity_mps: Vec3,
    /// Phase of gait or pedalling, radians in [0, 2 pi).
    pub phase_rad: f32,
    /// Its lamps: bit set of [`lamps`](crate::scene::lamps).
    pub lamps: u8,
}

impl Surroundings<'_> {
    /// Whether physics holds the actor.
    pub(super) fn holds(&self, id: u16) -> bool {
        self.is_loose(u32::from(id))
    }

    /// The same of a parked car too.
    pub(super) fn is_loose(&self, id: u32) -> bool {
        self.loose.binary_search_by_key(&id, |o| o.id).is_ok()
    }
}
