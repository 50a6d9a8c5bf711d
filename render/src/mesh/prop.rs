//! The mesh of each kind of static object.

use glam::{Quat, Vec3};
use kernel::map::{FurnitureKind, Prop, PropKind};

use super::Mesh;
use super::actor::parked_model;
use super::look::look;
use super::model::Detail;
use super::street::{barrier, building, furniture, hedge, lamp, sign, signal, structure, tree};
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

/// Moves a mesh from the frame of an object standing at `position` with a heading into the world.
pub fn place(mesh: &mut Mesh, position: Vec3, heading_rad: f32) {
    let turn = Quat::from_rotation_z(heading_rad);
    for v in &mut mesh.vertices {
        v.position = (position + turn * Vec3::from_array(v.position)).to_array();
        let n = (turn * Vec3::from_array(v.normal.map(f32::from))).round();
        v.normal = [n.x as i8, n.y as i8, n.z as i8];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_of_a_row_share_their_colour_and_differ_in_shape() {
        let piece = |x: f32| {
            let (position, size) = (Vec3::new(x, 70.0, 0.0), Vec3::new(5.6, 1.2, 1.5));
            Prop { kind: PropKind::Hedge, position, heading_rad: 0.0, size, variant: 0 }
        };
        let [one, next, beyond] = [3.0, 9.0, 103.0].map(|x| mesh(&piece(x), Detail::Rough));
        let colours = |mesh: &Mesh| mesh.vertices.iter().map(|v| v.colour).collect::<Vec<_>>();
        assert!(colours(&one) == colours(&next) && one != next);
        assert_ne!(colours(&one), colours(&beyond));
    }
}
