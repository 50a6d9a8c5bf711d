//! Skirts: strips that hang from the open edges of a surface, so that nothing shines through where its neighbours are
//! simplified otherwise (Ulrich 2002, "Rendering massive terrains using chunked level of detail control").

use std::collections::{BTreeMap, BTreeSet};

use super::Mesh;

/// The mesh with a strip of a depth in metres below each edge that belongs to one triangle alone. It looks like the surface
/// that it hangs from. With a depth of 0 there is none.
pub fn with_skirt(mesh: &Mesh, depth_m: f32) -> Mesh {
    let mut skirted = mesh.clone();
    if depth_m <= 0.0 {
        return skirted;
    }
    let place = |i: u32| mesh.vertices[i as usize].position.map(f32::to_bits);
    let edges = |[a, b, c]: [u32; 3]| [(a, b), (b, c), (c, a)];
    let all: BTreeSet<_> = mesh.all_triangles().flat_map(edges).map(|(a, b)| (place(a), place(b))).collect();
    let mut lowered: BTreeMap<u32, u32> = BTreeMap::new();
    for (finish, triangles) in mesh.triangles.iter().enumerate() {
        let open = triangles.iter().copied().flat_map(edges).filter(|&(a, b)| !all.contains(&(place(b), place(a))));
        for (a, b) in open {
            let [low_a, low_b] = [a, b].map(|i| {
                *lowered.entry(i).or_insert_with(|| {
                    let mut vertex = mesh.vertices[i as usize];
                    vertex.position[2] -= depth_m;
                    skirted.vertices.push(vertex);
                    skirted.vertices.len() as u32 - 1
                })
            });
            skirted.triangles[finish].extend([[a, low_a, low_b], [a, low_b, b]]);
        }
    }
    skirted
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::SemanticTag;
    use crate::mesh::Paint;

    #[test]
    fn a_skirt_hangs_from_the_outline_and_looks_outwards() {
        let mut mesh = Mesh::default();
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| Vec3::new(x, y, 1.0));
        mesh.polygon(Paint::plain(SemanticTag::Road, [90; 3]), &square);
        let skirted = with_skirt(&mesh, 0.5);
        assert_eq!((mesh.all_triangles().count(), skirted.all_triangles().count()), (2, 2 + 2 * 4), "none inside");
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
