//! Skirts: triangles that hang from the open edges of a surface, so that nothing shines through where its neighbours are
//! simplified otherwise (Ulrich 2002, "Rendering massive terrains using chunked level of detail control").

use std::collections::BTreeSet;

use glam::Vec3;

use super::{Mesh, Vertex};

/// The mesh with a triangle of a depth in metres below each edge that belongs to one triangle alone. It looks like the surface
/// that it hangs from. Where an edge begins and ends it is that of its neighbours, and there are no gaps to close. With a depth
/// of 0 there is none.
pub fn with_skirt(mesh: &Mesh, depth_m: f32) -> Mesh {
    let mut skirted = mesh.clone();
    if depth_m <= 0.0 {
        return skirted;
    }
    let place = |i: u32| mesh.vertices[i as usize].position.map(f32::to_bits);
    let edges = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
    let all: BTreeSet<_> = mesh.all_triangles().flat_map(edges).map(|(a, b)| (place(a), place(b))).collect();
    for (finish, triangles) in mesh.triangles.iter().enumerate() {
        let open = triangles.iter().copied().flat_map(edges).filter(|&(a, b)| !all.contains(&(place(b), place(a))));
        for (a, b) in open {
            let [from, to] = [a, b].map(|i| Vec3::from_array(mesh.vertices[i as usize].position));
            let position = (0.5 * (from + to) - Vec3::Z * depth_m).to_array();
            skirted.vertices.push(Vertex { position, ..mesh.vertices[a as usize] });
            skirted.triangles[finish].push([a, skirted.vertices.len() as u32 - 1, b]);
        }
    }
    skirted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SemanticTag;
    use crate::mesh::Paint;

    #[test]
    fn a_skirt_hangs_from_the_outline_and_looks_outwards() {
        let mut mesh = Mesh::default();
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| Vec3::new(x, y, 1.0));
        mesh.polygon(Paint::plain(SemanticTag::Road, [90; 3]), &square);
        let skirted = with_skirt(&mesh, 0.5);
        assert_eq!((mesh.all_triangles().count(), skirted.all_triangles().count()), (2, 2 + 4), "none inside");
        let at = |i: u32| Vec3::from_array(skirted.vertices[i as usize].position);
        for [a, b, c] in skirted.all_triangles().skip(2) {
            let normal = (at(b) - at(a)).cross(at(c) - at(a));
            let outwards = (at(a) + at(b) + at(c)) / 3.0 - Vec3::new(1.0, 1.0, 1.0);
            assert!(normal.z == 0.0 && normal.dot(outwards) > 0.0);
            assert!([a, b, c].into_iter().all(|i| at(i).z == 1.0 || at(i).z == 0.5));
        }
        assert_eq!(with_skirt(&mesh, 0.0), mesh);
    }
}
