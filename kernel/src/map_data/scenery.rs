//! What stands and lies around: surfaces and props.

use glam::Vec3;

use super::digest::{digested, digested_codes};
use crate::actor::ActorKind;
use crate::state_enum;

state_enum! {
    /// What a static surface is made of.
    pub enum SurfaceKind {
        /// Asphalt.
        Road = 0,
        /// Paint on the asphalt.
        RoadLine = 1,
        /// Pavement of a sidewalk with its kerb.
        Sidewalk = 2,
        /// Grass and soil.
        Terrain = 3,
        /// Paved ground that is none of the above.
        Ground = 4,
        /// Packed gravel of a road or track.
        Gravel = 5,
        /// Setts of a road.
        Setts = 6,
        /// The bed between and beside rails.
        Track = 7,
        /// Steel on the bed or the asphalt.
        Rail = 8,
        /// Open water.
        Water = 9,
    }
}

digested! {
    /// A triangle mesh of one material.
    #[derive(Clone, Debug)]
    pub struct Surface {
        /// Material.
        pub kind: SurfaceKind,
        /// Vertices.
        pub positions: Vec<Vec3>,
        /// Counter-clockwise seen from above.
        pub triangles: Vec<[u32; 3]>,
    }
}

state_enum! {
    /// What a static object is.
    pub enum PropKind {
        /// A house; `size` is its box.
        Building = 0,
        /// A tree; `size.x` is the diameter of its crown, `size.z` its height.
        Tree = 1,
        /// A hedge or bush.
        Hedge = 2,
        /// A street lamp.
        Lamp = 3,
        /// A traffic sign on its post; `variant` is a `SIGN_*` constant.
        Sign = 4,
        /// The pole of a signal head.
        SignalPole = 5,
        /// A parked car; part of the static world until somebody runs into it.
        ParkedCar = 6,
        /// A fence; `size.x` is its length.
        Fence = 7,
        /// A wall; `size.x` is its length.
        Wall = 8,
        /// A guard rail; `size.x` is its length.
        GuardRail = 9,
        /// Street furniture that stands fast, as benches, bollards and cabinets; `variant` is a [`FurnitureKind`].
        Furniture = 10,
        /// What somebody may take away: bins, cones, beacons, prams; `variant` is a [`FurnitureKind`].
        Movable = 11,
        /// What has no class of its own: stalls, shelters, post boxes, swings; `variant` is a [`FurnitureKind`].
        Sundry = 12,
        /// A piece of a bridge; it rises along its x axis by `variant` as [`Prop::rise_m`] reads it.
        Bridge = 13,
        /// A piece of the wall or roof of a tunnel; it rises as that of a bridge does.
        Tunnel = 14,
    }
}

state_enum! {
    /// What a piece of street furniture is; its code is [`Prop::variant`] of [`PropKind::Furniture`],
    /// [`PropKind::Movable`] and [`PropKind::Sundry`].
    pub enum FurnitureKind {
        /// None of those below.
        Other = 0,
        /// A bench; its y axis points to its back.
        Bench = 1,
        /// A bin for litter or waste.
        Bin = 2,
        /// A cabinet for switches.
        Cabinet = 3,
        /// A bollard or any other post.
        Post = 4,
        /// A hydrant.
        Hydrant = 5,
        /// A mailbox.
        Mailbox = 6,
        /// A shelter at a bus stop; its y axis points to its back.
        Shelter = 7,
        /// A large container for waste.
        Dumpster = 8,
        /// A trough with plants.
        Planter = 9,
        /// Hoops that bicycles are locked to.
        BicycleStand = 10,
        /// A traffic cone.
        Cone = 11,
        /// A striped board of a road works.
        Beacon = 12,
        /// A barrier of boards across a way.
        Barricade = 13,
        /// A market stall.
        Stall = 14,
    }
}

digested_codes!(SurfaceKind PropKind);

digested! {
    /// A static object standing on the ground.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Prop {
        /// What it is.
        pub kind: PropKind,
        /// Centre of its footprint on the ground.
        pub position: Vec3,
        /// Direction of its x axis, radians.
        pub heading_rad: f32,
        /// Extent along its own x, y and z in metres.
        pub size: Vec3,
        /// Selects colour, shape or sign.
        pub variant: u32,
    }
}

/// Parked cars taller than this are vans, metres.
const VAN_M: f32 = 1.8;

/// Parts of a metre in which the rise of a piece is told.
const RISE_PARTS: f32 = 1024.0;

/// [`Prop::variant`] of a piece that rises so much along its x axis, metres.
pub(crate) fn rising(rise_m: f32) -> u32 {
    ((rise_m * RISE_PARTS) as i32).cast_unsigned()
}

impl SurfaceKind {
    /// Whether it lies on other ground, too thin for wheels to notice.
    pub fn lies_on_ground(self) -> bool {
        matches!(self, Self::RoadLine | Self::Rail)
    }
}

impl FurnitureKind {
    /// What [`Prop::variant`] of street furniture says; a number that says nothing is [`Self::Other`].
    pub fn of(variant: u32) -> Self {
        Self::ALL.get(variant as usize).copied().unwrap_or(Self::Other)
    }

    /// [`Prop::variant`] of such a piece.
    pub const fn variant(self) -> u32 {
        self as u32
    }
}

impl Prop {
    /// What it is, if it is street furniture.
    pub fn furniture(&self) -> Option<FurnitureKind> {
        let is_furniture = matches!(self.kind, PropKind::Furniture | PropKind::Movable | PropKind::Sundry);
        is_furniture.then(|| FurnitureKind::of(self.variant))
    }

    /// How much higher the far end of a piece of a bridge or tunnel is than the near one, metres; 0 for all else.
    pub fn rise_m(&self) -> f32 {
        match self.kind {
            PropKind::Bridge | PropKind::Tunnel => self.variant.cast_signed() as f32 / RISE_PARTS,
            _ => 0.0,
        }
    }

    /// What a parked car is among the kinds of road users.
    pub fn parked_kind(&self) -> ActorKind {
        if self.size.z > VAN_M { ActorKind::Van } else { ActorKind::Car }
    }
}

/// [`Prop::variant`] of a stop sign.
pub const SIGN_STOP: u32 = 0;
/// [`Prop::variant`] of a yield sign.
pub const SIGN_YIELD: u32 = 1;
/// [`Prop::variant`] of the sign of a bus stop.
pub const SIGN_BUS_STOP: u32 = 2;
/// [`Prop::variant`] of a speed limit: this plus the number on it, km/h or what its country counts in.
pub const SIGN_LIMIT: u32 = 1000;
