//! Street furniture, each piece as what it is.

mod boxes;
mod loose;
mod piece;
mod posts;
mod seats;
mod sundry;

use glam::Vec3;
use kernel::map::FurnitureKind;

use self::piece::{Piece, lengthwise};
use crate::SemanticTag;
use crate::mesh::Mesh;
use crate::mesh::model::Detail;

/// A piece of street furniture of a class in a box of `size` metres.
pub fn mesh(what: FurnitureKind, tag: SemanticTag, variant: u32, size: Vec3, detail: Detail) -> Mesh {
    use FurnitureKind as F;
    let piece = Piece { tag, size, detail };
    match what {
        F::Bench => lengthwise(&piece, |piece| seats::bench(piece, variant)),
        F::Shelter => lengthwise(&piece, |piece| seats::shelter(piece, variant)),
        F::BicycleStand => lengthwise(&piece, posts::bicycle_stand),
        F::Planter => lengthwise(&piece, |piece| boxes::planter(piece, variant)),
        F::Cabinet => lengthwise(&piece, |piece| boxes::cabinet(piece, variant)),
        F::Post => posts::post(&piece),
        F::Hydrant => posts::hydrant(&piece),
        F::Mailbox => boxes::mailbox(&piece),
        F::Dumpster => boxes::dumpster(&piece, variant),
        F::Bin => loose::bin(&piece, variant),
        F::Cone => loose::cone(&piece),
        F::Beacon => loose::beacon(&piece),
        F::Barricade => loose::barricade(&piece),
        F::Stall => loose::stall(&piece, variant),
        F::Other => match tag {
            SemanticTag::Dynamic => loose::movable(&piece, variant),
            SemanticTag::Other => sundry::sundry(&piece, variant),
            _ => boxes::block(&piece),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAGS: [SemanticTag; 3] = [SemanticTag::Static, SemanticTag::Dynamic, SemanticTag::Other];

    fn places(mesh: &Mesh) -> impl Iterator<Item = Vec3> + '_ {
        mesh.vertices.iter().map(|v| Vec3::from_array(v.position))
    }

    fn count(mesh: &Mesh) -> usize {
        mesh.all_triangles().count()
    }

    /// Whatever a file says of its size, a piece is of its class, within its box, as high as that, and cheap.
    #[test]
    fn every_piece_fills_its_box_and_no_more() {
        let sizes =
            [[1.6, 0.6, 0.9], [0.6, 1.8, 0.85], [0.25, 0.25, 1.0], [0.3, 0.3, 6.0], [3.6, 1.4, 2.5], [1.2, 1.0, 1.3]];
        for (size, &what) in sizes.iter().flat_map(|size| FurnitureKind::ALL.iter().map(move |what| (size, what))) {
            let size = Vec3::from_array(*size);
            for (tag, detail) in TAGS.into_iter().flat_map(|tag| Detail::ALL.map(|detail| (tag, detail))) {
                for variant in 0..6 {
                    let mesh = mesh(what, tag, variant, size, detail);
                    let box_m = size * Vec3::new(0.5, 0.5, 1.0) + 0.051;
                    assert!(mesh.vertices.iter().all(|v| v.tag == tag as u8), "{what:?}");
                    assert!(places(&mesh).all(|p| p.abs().cmple(box_m).all()), "{what:?} {tag:?} {size} {detail:?}");
                    assert!((places(&mesh).map(|p| p.z).fold(0.0, f32::max) - size.z).abs() < 1e-3, "{what:?} {size}");
                    assert!(
                        count(&mesh) <= if detail == Detail::Fine { 320 } else { 200 },
                        "{what:?} {}",
                        count(&mesh)
                    );
                }
            }
        }
    }

    /// Pieces of one size look different, so it is not their size that tells them.
    #[test]
    fn kinds_of_one_size_look_different() {
        let size = Vec3::new(1.6, 0.6, 0.9);
        let meshes: Vec<Mesh> =
            FurnitureKind::ALL.iter().map(|&what| mesh(what, SemanticTag::Static, 1, size, Detail::Fine)).collect();
        for (k, one) in meshes.iter().enumerate() {
            assert!(meshes[..k].iter().all(|other| other != one), "{:?}", FurnitureKind::ALL[k]);
        }
    }

    /// A bench is open below its seat, and its back is at positive y.
    #[test]
    fn a_bench_has_a_seat_and_a_back() {
        let size = Vec3::new(1.6, 0.6, 0.9);
        for variant in 0..8 {
            let mesh = mesh(FurnitureKind::Bench, SemanticTag::Static, variant, size, Detail::Fine);
            assert!(places(&mesh).filter(|p| p.z > 0.86).all(|p| p.y > 0.2));
            let faces = mesh.all_triangles().map(|t| t.map(|i| places(&mesh).nth(i as usize).expect("a corner")));
            let wide = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).x.abs() + (b - a).cross(c - a).y.abs() > 0.3;
            assert!(faces.filter(|t| t.iter().all(|p| p.z < 0.44)).all(|t| !wide(t)), "nothing but feet below");
        }
    }
}
