//! What holds for the looks of all vehicles.

use std::collections::BTreeSet;

use glam::Vec3;
use kernel::ops;
use kernel::scene::ActorKind;

use crate::mesh::Mesh;
use crate::mesh::actor::{actor_model, ego_model, parked_model};
use crate::mesh::look::look;
use crate::mesh::model::{Detail, Model};
use crate::mesh::prop;

const VARIANTS: u32 = 60;

const VEHICLES: [ActorKind; 11] = [
    ActorKind::Car,
    ActorKind::Suv,
    ActorKind::Van,
    ActorKind::Emergency,
    ActorKind::Truck,
    ActorKind::Bus,
    ActorKind::Tram,
    ActorKind::Motorcycle,
    ActorKind::Scooter,
    ActorKind::Bicycle,
    ActorKind::CargoBike,
];

/// Mirrors, handlebars and helmets may stand out of the box by this, metres.
const OVER_M: f32 = 0.18;

/// Where riders sit, whose limbs have fewer sides afar.
const LIMB_M: f32 = 0.03;

fn points(mesh: &Mesh) -> impl Iterator<Item = Vec3> + '_ {
    mesh.all_triangles().flatten().map(|i| Vec3::from_array(mesh.vertices[i as usize].position))
}

/// How far it reaches in a direction.
fn reach_m(mesh: &Mesh, direction: Vec3) -> f32 {
    points(mesh).fold(f32::NEG_INFINITY, |most, p| most.max(p.dot(direction)))
}

/// Directions all around and above.
fn directions() -> impl Iterator<Item = Vec3> {
    let around = (0..16).map(|i| core::f32::consts::TAU * i as f32 / 16.0);
    let tilts = [0.0f32, 0.4, 0.8, 1.2];
    around.flat_map(move |azimuth| {
        tilts.map(|up| Vec3::new(ops::cos(azimuth) * ops::cos(up), ops::sin(azimuth) * ops::cos(up), ops::sin(up)))
    })
}

fn triangles(model: &Model) -> usize {
    model.at_rest().all_triangles().count()
}

#[test]
fn every_vehicle_stays_in_its_box() {
    for kind in VEHICLES {
        let half = kind.size_m() * Vec3::new(0.5, 0.5, 1.0);
        for (variant, detail) in (0..VARIANTS).flat_map(|v| Detail::ALL.map(|detail| (v, detail))) {
            let mesh = actor_model(kind, variant, detail).at_rest();
            let over = points(&mesh).map(|p| p.abs() - half).fold(Vec3::splat(-9.0), Vec3::max);
            assert!(over.max_element() < OVER_M, "{kind:?} {variant} {detail:?}: {over}");
            let high = reach_m(&mesh, Vec3::Z);
            assert!(high > 0.85 * half.z && high < half.z + OVER_M, "{kind:?} {variant} {detail:?}: {high} m");
        }
    }
}

#[test]
fn levels_of_detail_reach_equally_far() {
    for kind in VEHICLES {
        for variant in 0..VARIANTS / 3 {
            let [fine, coarse, rough] = Detail::ALL.map(|detail| actor_model(kind, variant, detail).at_rest());
            for (mesh, detail) in [(&coarse, Detail::Coarse), (&rough, Detail::Rough)] {
                for direction in directions() {
                    let off_m = (reach_m(mesh, direction) - reach_m(&fine, direction)).abs();
                    let may_m = detail.error_m() + LIMB_M;
                    assert!(off_m < may_m, "{kind:?} {variant} {detail:?}: {off_m} m towards {direction}");
                }
            }
        }
    }
}

#[test]
fn cars_have_three_shapes_or_more() {
    let shape = |variant: u32| {
        let body = actor_model(ActorKind::Car, variant, Detail::Coarse).at_rest();
        [Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(-0.6, 0.0, 0.8)]
            .map(|direction| (reach_m(&body, direction) * 1000.0) as i32)
    };
    let shapes: BTreeSet<[i32; 4]> = (0..VARIANTS).map(shape).collect();
    assert!((3..8).contains(&shapes.len()), "{shapes:?}");
}

#[test]
fn vehicles_of_one_kind_differ() {
    for kind in VEHICLES {
        let colours = |variant: u32| {
            let mesh = actor_model(kind, variant, Detail::Coarse).at_rest();
            mesh.vertices.iter().map(|v| v.colour).collect::<Vec<_>>()
        };
        let looks: BTreeSet<Vec<[u8; 3]>> = (0..12).map(colours).collect();
        assert!(looks.len() >= 3, "{kind:?}: {} looks", looks.len());
    }
}

#[test]
fn only_those_that_drive_have_people_in_them_and_only_at_their_finest() {
    for kind in [ActorKind::Car, ActorKind::Van] {
        for (variant, detail) in (0..VARIANTS).flat_map(|v| Detail::ALL.map(|detail| (v, detail))) {
            let [driven, parked] =
                [actor_model, parked_model].map(|model_of| triangles(&model_of(kind, variant, detail)));
            let people = driven - parked;
            let is_fine = detail == Detail::Fine;
            assert!(if is_fine { people >= 12 } else { people == 0 }, "{kind:?} {variant} {detail:?}: {people}");
        }
    }
}

#[test]
fn what_is_parked_looks_like_what_drives() {
    let city = kernel::map::bundled("city").expect("a bundled map");
    let cars = city.props.iter().filter(|prop| prop.kind == kernel::map::PropKind::ParkedCar);
    for car in cars.take(5) {
        let parked = prop::mesh(car, Detail::Coarse);
        assert_eq!(parked, actor_model(car.parked_kind(), look(car), Detail::Coarse).at_rest());
    }
}

#[test]
fn vehicles_are_cheap_to_draw() {
    // Kind, most triangles at each level.
    for (kind, most) in [
        (ActorKind::Car, [580, 228, 58]),
        (ActorKind::Suv, [580, 228, 58]),
        (ActorKind::Van, [460, 178, 178]),
        (ActorKind::Emergency, [505, 210, 210]),
        (ActorKind::Truck, [700, 264, 264]),
        (ActorKind::Bus, [490, 172, 172]),
        (ActorKind::Tram, [420, 234, 234]),
        (ActorKind::Motorcycle, [1930, 990, 625]),
        (ActorKind::Scooter, [1930, 990, 625]),
        (ActorKind::Bicycle, [1640, 765, 400]),
        (ActorKind::CargoBike, [1640, 780, 415]),
    ] {
        for variant in 0..VARIANTS {
            let counts = Detail::ALL.map(|detail| triangles(&actor_model(kind, variant, detail)));
            let fits = counts.iter().zip(most).all(|(count, most)| *count <= most);
            assert!(fits, "{kind:?} {variant}: {counts:?} of {most:?}");
        }
    }
    assert!(triangles(ego_model()) <= 730);
}
