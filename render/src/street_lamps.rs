//! Where the street lamps of a map shine.

use glam::{Quat, Vec3};
use kernel::map::{Prop, PropKind, RoadNetwork};

use crate::mesh::street::lamp;

/// A street lamp that shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StreetLamp {
    /// Middle of its glass.
    pub(crate) position: Vec3,
    /// Height of its foot in the world.
    pub(crate) foot_m: f32,
}

impl StreetLamp {
    fn of(object: &Prop) -> Option<Self> {
        let turn = Quat::from_rotation_z(object.heading_rad);
        let position = object.position + turn * lamp::lamp_glass(object.size.z);
        (object.kind == PropKind::Lamp).then_some(Self { position, foot_m: object.position.z })
    }
}

/// All of a map.
pub(crate) fn all(network: &RoadNetwork) -> Vec<StreetLamp> {
    network.props.iter().filter_map(StreetLamp::of).collect()
}

/// Those no farther than this from a point.
pub(crate) fn near(all: &[StreetLamp], at: Vec3, reach_m: f32) -> Vec<StreetLamp> {
    all.iter().filter(|lamp| lamp.position.distance_squared(at) < reach_m * reach_m).copied().collect()
}
