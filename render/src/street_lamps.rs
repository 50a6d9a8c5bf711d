//! Where the street lamps of a map shine.

use glam::{Quat, Vec3};
use kernel::map::{Prop, PropKind};

use crate::mesh::street::lamp;
use crate::models::Models;

/// A street lamp that shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StreetLamp {
    /// Middle of its glass.
    pub(crate) position: Vec3,
    /// Height of its foot in the world.
    pub(crate) foot_m: f32,
}

impl StreetLamp {
    fn of(object: &Prop, models: Option<&Models>) -> Option<Self> {
        if object.kind != PropKind::Lamp {
            return None;
        }
        let own = models.and_then(|models| models.lamp_glass(object));
        let glass = own.unwrap_or_else(|| lamp::lamp_glass(object.size.z));
        let position = object.position + Quat::from_rotation_z(object.heading_rad) * glass;
        Some(Self { position, foot_m: object.position.z })
    }
}

/// All of some objects, with models of a user's own or without.
pub(crate) fn all(objects: &[Prop], models: Option<&Models>) -> Vec<StreetLamp> {
    objects.iter().filter_map(|object| StreetLamp::of(object, models)).collect()
}

/// Those no farther than this from a point.
pub(crate) fn near(all: &[StreetLamp], at: Vec3, reach_m: f32) -> Vec<StreetLamp> {
    all.iter().filter(|lamp| lamp.position.distance_squared(at) < reach_m * reach_m).copied().collect()
}
