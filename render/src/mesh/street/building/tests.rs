//! What houses are like, whatever box and variant they have.

use std::collections::BTreeSet;

use super::design::{Adornment, Roof};
use super::*;
use crate::SemanticTag;

const SIZES: [Vec3; 7] = [
    Vec3::new(6.0, 2.9, 2.7),
    Vec3::new(5.0, 5.0, 32.0),
    Vec3::new(10.0, 7.5, 11.0),
    Vec3::new(17.0, 10.0, 15.0),
    Vec3::new(9.0, 11.0, 7.1),
    Vec3::new(10.0, 14.0, 10.2),
    Vec3::new(12.0, 16.0, 19.5),
];

fn houses() -> impl Iterator<Item = (u32, Vec3)> {
    (0..60).flat_map(|variant| SIZES.map(|size| (variant, size)))
}

fn extent(mesh: &Mesh) -> [Vec3; 2] {
    let places = mesh.vertices.iter().map(|v| Vec3::from_array(v.position));
    places.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}

#[test]
fn houses_of_all_kinds_are_built() {
    let designs: Vec<Design> = houses().map(|(variant, size)| Design::new(variant, size)).collect();
    let count = |is_so: &dyn Fn(&Design) -> bool| designs.iter().filter(|design| is_so(design)).count();
    let kinds: BTreeSet<u8> = designs.iter().map(|design| design.kind as u8).collect();
    assert_eq!(kinds.len(), 6);
    for material in style::PLASTER..=style::GARAGE {
        let is_so =
            |design: &Design| [design.wall, design.tiles].iter().any(|paint| paint.code & style::MATERIAL == material);
        assert!(count(&is_so) > 4, "{material}");
    }
    for roof in [Roof::Flat, Roof::Gabled, Roof::Hipped] {
        assert!(count(&|design| design.roof == roof) > 20, "{roof:?}");
    }
    for adornment in [Adornment::Balconies, Adornment::Bay, Adornment::FlowerBoxes] {
        assert!(count(&|design| design.adornment == adornment) > 10, "{adornment:?}");
    }
    assert!(count(&|design| design.has_awning) > 10 && count(&|design| design.has_dormers) > 10);
}

/// Lamps stand 0.8 m from the front at least, and who walks there is not struck.
#[test]
fn a_house_stays_off_the_street() {
    for (variant, size) in houses() {
        let mesh = building(variant, size, Detail::Fine);
        let [low, high] = extent(&mesh);
        let beyond = high - 0.5 * size;
        assert!(beyond.x < 0.8 && beyond.y < 0.5 && (low + 0.5 * size).truncate().min_element() > -0.5, "{variant}");
        let below_head = mesh.vertices.iter().filter(|v| v.position[2] < 1.7);
        let reach_m = below_head.map(|v| v.position[0]).fold(0.0, f32::max) - 0.5 * size.x;
        assert!(reach_m < 0.5, "{variant}: {reach_m} m");
        assert!(low.z >= 0.0 && high.z < size.z + 2.5);
        assert!(mesh.vertices.iter().all(|v| v.tag == SemanticTag::Building as u8));
    }
}

#[test]
fn levels_of_detail_reach_equally_far_and_get_lighter() {
    for (variant, size) in houses() {
        let meshes = Detail::ALL.map(|detail| building(variant, size, detail));
        let [fine, ..] = &meshes;
        for (mesh, detail) in meshes.iter().zip(Detail::ALL) {
            for (corner, finest) in extent(mesh).into_iter().zip(extent(fine)) {
                let off = (corner - finest).abs().max_element();
                assert!(off <= 0.25, "{variant} {size} {detail:?}: {off} m");
            }
        }
        let counts = meshes.each_ref().map(|mesh| mesh.vertices.len());
        assert!(
            counts.is_sorted_by(|a, b| a >= b) && counts[2] <= 330 && counts.iter().sum::<usize>() < 1500,
            "{counts:?}"
        );
    }
}

/// Gardens of suburbs have houses of 5.6 and 8.6 m, new towns wide ones.
#[test]
fn half_timbered_houses_stand_in_old_towns_alone() {
    let timbered = |size: Vec3| {
        let of = |variant: u32| Design::new(variant, size).wall.code & style::MATERIAL == style::TIMBER;
        (0..200).filter(|variant| of(*variant)).count()
    };
    for size in [[9.0, 8.6, 8.6], [8.2, 10.2, 5.6], [10.0, 9.6, 10.2], [11.0, 14.0, 13.3]] {
        assert_eq!(timbered(Vec3::from_array(size)), 0, "{size:?}");
    }
    assert!(timbered(Vec3::new(10.0, 7.5, 10.8)) > 50);
}

/// Who comes along a street sees the door below its canopy.
#[test]
fn doors_are_not_covered_by_what_hangs_over_them() {
    let shader = include_str!("../../../shaders/facade.wgsl");
    assert!(shader.contains("select(0.77, 0.7, (it.code & SHOP) != 0u), it.shop || it.door"));
    for (variant, size) in houses() {
        let design = Design::new(variant, size);
        let storey_m = design.eaves_m / design.storeys;
        if matches!(design.kind, Kind::Garage | Kind::Tower) || design.is_shop() {
            continue;
        }
        let mesh = building(variant, size, Detail::Fine);
        let columns = (size.y / CELL_M.x).floor().max(f32::from(style::DOOR_COLUMNS));
        let door_y = size.y * ((design.door_column() + 0.5) / columns - 0.5);
        let hangs = mesh.vertices.iter().filter(|v| {
            let [x, y, z] = v.position;
            x > 0.5 * size.x + 0.6 && (y - door_y).abs() < 0.4 * size.y / columns && z < 0.98 * storey_m
        });
        let lowest_m = hangs.map(|v| v.position[2]).fold(f32::MAX, f32::min);
        assert!(lowest_m > 0.84 * storey_m, "{variant} {size}: {lowest_m} m of {storey_m}");
    }
}

#[test]
fn walls_are_as_high_as_the_horizon_takes_for_solid() {
    for (variant, size) in houses() {
        let design = Design::new(variant, size);
        assert!(design.eaves_m >= 0.599 * size.z, "{variant} {size}");
        let storey_m = design.eaves_m / design.storeys;
        assert!(design.kind == Kind::Garage || (2.6..4.0).contains(&storey_m), "{variant} {size}: {storey_m} m");
    }
}

#[test]
fn what_has_no_windows_is_below_them() {
    for (variant, size) in houses() {
        let mesh = building(variant, size, Detail::Fine);
        let facade: BTreeSet<u32> =
            mesh.triangles[crate::mesh::Finish::Facade as usize].iter().flatten().copied().collect();
        assert!(
            facade.iter().map(|i| mesh.vertices[*i as usize]).filter(|v| v.code == style::TILES).all(|v| v.uv[1] < 0.0)
        );
    }
}
