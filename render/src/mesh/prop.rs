//! The mesh of each kind of static object.

use glam::{Quat, Vec3};
use kernel::map::{FurnitureKind, Prop, PropKind};

use super::Mesh;
use super::actor::parked_model;
use super::model::Detail;
use super::street::{barrier, building, furniture, hedge, lamp, sign, signal, structure, tree};
use super::variety::Variety;
use crate::SemanticTag;

/// The mesh of a static object in its own frame: x along its heading, origin in the middle of its
/// footprint on the ground, z up.
pub fn mesh(prop: &Prop, detail: Detail) -> Mesh {
    let Prop { size, .. } = *prop;
    let variant = if prop.kind == PropKind::Sign { prop.variant } else { look(prop) };
    let what = FurnitureKind::of(prop.variant);
    match prop.kind {
        PropKind::Building => building::building(variant, size, detail),
        PropKind::Tree => tree::tree(variant, size.x, size.z, detail),
        PropKind::Hedge => hedge::hedge(variant, size, detail),
        PropKind::Lamp => lamp::lamp(size.z, detail),
        PropKind::Sign => sign::sign(variant, size.z, detail),
        PropKind::SignalPole => signal::pole(size.z, detail),
        PropKind::ParkedCar => parked_model(prop.parked_kind(), variant, detail).at_rest(),
        PropKind::Fence => barrier::fence(variant, size, detail),
        PropKind::Wall => barrier::wall(variant, size),
        PropKind::GuardRail => barrier::guard_rail(size, detail),
        PropKind::Furniture => furniture::mesh(what, SemanticTag::Static, variant, size, detail),
        PropKind::Movable => furniture::mesh(what, SemanticTag::Dynamic, variant, size, detail),
        PropKind::Sundry => furniture::mesh(what, SemanticTag::Other, variant, size, detail),
        PropKind::Bridge => structure::bridge(size, prop.rise_m()),
        PropKind::Tunnel => structure::tunnel(size, prop.rise_m()),
    }
}

/// What selects colour and shape. Maps have few variants; where a thing stands tells it apart from its neighbours.
pub fn look(prop: &Prop) -> u32 {
    let place = prop.position.x.to_bits().rotate_left(16) ^ prop.position.y.to_bits();
    prop.variant ^ Variety::of(place).bits()
}

/// Moves a mesh from the frame of an object standing at `position` with a heading into the world.
pub fn place(mesh: &mut Mesh, position: Vec3, heading_rad: f32) {
    let turn = Quat::from_rotation_z(heading_rad);
    for v in &mut mesh.vertices {
        v.position = (position + turn * Vec3::from_array(v.position)).to_array();
        let n = (turn * Vec3::from_array(v.normal.map(f32::from))).round();
        v.normal = [n.x as i8, n.y as i8, n.z as i8];
    }
}
