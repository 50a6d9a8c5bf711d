//! Pictures with models of a user's own.

use std::collections::BTreeMap;

use kernel::map::Prop;

use super::*;
use crate::mesh::model::{Detail, Model};
use crate::mesh::{CODE_LACQUER, CODE_STREET, Mesh, Paint};
use crate::models::{Figure, Subject};

/// Magenta, which nothing else is.
const COLOUR: [u8; 3] = [255, 0, 255];

/// A box with a colour of its own, with the proportions of what it stands for.
fn boxed(subject: Subject, size: Vec3, code: u8) -> Figure {
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::plain(subject.tag(), COLOUR).coded(code), Vec3::new(0.0, 0.0, 1.0), size + Vec3::Z);
    Figure::new(subject, Model::rigid(mesh)).expect("it fits")
}

fn register(digest: u8, named: &[(&str, Vec3)], code: u8) -> ModelsId {
    let figures: BTreeMap<Subject, Vec<Figure>> = named
        .iter()
        .map(|(name, size)| {
            let subject = Subject::named(name).expect("a name");
            (subject, vec![boxed(subject, *size, code)])
        })
        .collect();
    Models::new([digest; 16].into(), figures).register()
}

fn is_pink(rgb: &[u8]) -> bool {
    u32::from(rgb[0].min(rgb[2])) > 2 * u32::from(rgb[1]) + 40
}

/// Pixels of a class and instance, those of them of the model's colour, and pixels of the instance.
fn counts(frame: &Frame, tag: SemanticTag, instance: u16) -> [usize; 3] {
    let ids = frame.fine_ids.iter().zip(&frame.instance_ids).zip(frame.rgb.chunks(3));
    let of_instance = ids.filter(|((_, id), _)| **id == instance);
    let of_both = of_instance.clone().filter(|((class, _), _)| **class == tag as u8);
    let pink = of_both.clone().filter(|(_, rgb)| is_pink(rgb));
    [of_both.count(), pink.count(), of_instance.count()]
}

fn scene_with(kind: ActorKind) -> (Arc<RoadNetwork>, SceneSnapshot) {
    let network = network("city");
    let mut scene = places("city", &network, 4).remove(1);
    scene.weather = Weather::dry(0.0, 0.0, 50.0, 0.0);
    scene.actors = vec![ActorScene { kind, ..car_at(&scene, 12.0, 0.5) }];
    (network, scene)
}

#[test]
fn models_stand_for_road_users_with_their_class_and_instance() {
    let models = register(1, &[("car", Vec3::new(4.0, 2.0, 1.5)), ("pedestrian", Vec3::new(0.3, 0.5, 1.8))], 0);
    for (kind, tag) in [(ActorKind::Car, SemanticTag::Vehicles), (ActorKind::Pedestrian, SemanticTag::Pedestrian)] {
        let (network, scene) = scene_with(kind);
        let mut renderer = renderer(&network);
        let own = Camera { models: Some(models), ..Camera::driver(256, 128) };
        let frame = renderer.draw(&scene, &own).expect("drawn");
        let [labelled, pink, all] = counts(&frame, tag, instance_of_actor(1));
        assert!(pink > 60 && labelled == all, "{kind:?}: {pink} of {labelled}, {all}");
        let labels = renderer.draw_classes(&scene, &own).expect("drawn");
        assert!(Frame { rgb: Vec::new(), ..frame.clone() } == labels, "{kind:?}");
    }
}

#[test]
fn a_used_renderer_draws_models_as_a_new_one_does_and_its_own_afterwards() {
    let (network, scene) = scene_with(ActorKind::Bus);
    let models = register(2, &[("car", Vec3::new(4.5, 1.85, 1.5)), ("tree", Vec3::new(3.0, 3.0, 6.0))], 0);
    let usual = Camera::chase(256, 128);
    let own = Camera { models: Some(models), ..usual };
    let mut used = renderer(&network);
    let before = used.draw(&scene, &usual).expect("drawn");
    let with = used.draw(&scene, &own).expect("drawn");
    assert!(with == renderer(&network).draw(&scene, &own).expect("drawn"), "with models");
    assert!(before == used.draw(&scene, &usual).expect("drawn"), "without");
    assert!(before.class_ids != with.class_ids, "trees and parked cars are others");
}

#[test]
fn models_that_were_not_read_are_named() {
    let (network, scene) = scene_with(ActorKind::Car);
    let unread = Camera { models: Some([99; 16].into()), ..Camera::driver(64, 32) };
    let said = renderer(&network).draw(&scene, &unread).expect_err("refused").to_string();
    assert!(said.contains(&"63".repeat(16)) && said.contains("expected their folder with --models DIR"), "{said}");
}

#[test]
fn models_that_do_not_come_to_the_adapter_are_told_and_taken_off() {
    let (network, scene) = scene_with(ActorKind::Car);
    let models = register(7, &[("car", Vec3::new(4.5, 1.85, 1.5))], 0);
    let usual = Camera::driver(64, 32);
    let own = Camera { models: Some(models), ..usual };
    let mut renderer = renderer(&network);
    let [before, with] = [&usual, &own].map(|camera| renderer.draw(&scene, camera).expect("drawn"));
    renderer.draw(&scene, &usual).expect("drawn");
    renderer.gpu.fail("out of memory");
    let said = renderer.draw(&scene, &own).expect_err("it failed").to_string();
    assert!(said.contains("did not come to adapter") && said.contains("out of memory"), "{said}");
    assert!(renderer.draw(&scene, &usual).expect("drawn") == before);
    assert!(renderer.draw(&scene, &own).expect("drawn") == with);
}

#[test]
fn lacquer_is_that_of_the_variant() {
    let models = register(3, &[("car", Vec3::new(4.5, 1.85, 1.5))], CODE_LACQUER);
    let models = Models::known(models).expect("known");
    let colours = |variant: u32| {
        let model = models.actor(ActorKind::Car, variant, Detail::Fine, Model::default).expect("a car");
        let mut colours: Vec<_> = model.parts[0].mesh.vertices.iter().map(|v| (v.colour, v.code)).collect();
        colours.dedup();
        colours
    };
    let all: Vec<_> = (0..20).map(colours).collect();
    assert!(all.iter().all(|one| one.len() == 1 && one[0].1 == 0 && one[0].0 != COLOUR), "{all:?}");
    assert!(all.iter().collect::<std::collections::BTreeSet<_>>().len() > 5 && all[4] == colours(4), "{all:?}");
}

/// Who rides is drawn in code where the model is a bicycle alone.
#[test]
fn a_bicycle_alone_has_a_rider() {
    let models = register(4, &[("bicycle", Vec3::new(1.8, 0.5, 1.0))], 0);
    let (network, scene) = scene_with(ActorKind::Bicycle);
    let own = Camera { models: Some(models), ..Camera::driver(256, 128) };
    let frame = renderer(&network).draw(&scene, &own).expect("drawn");
    let [bicycle, pink, all] = counts(&frame, SemanticTag::Bicycle, instance_of_actor(1));
    let [rider, riders_pink, _] = counts(&frame, SemanticTag::Rider, instance_of_actor(1));
    assert!(2 * pink > bicycle && bicycle > 20 && rider > 20 && riders_pink == 0, "{pink} {bicycle} {rider}");
    assert_eq!(bicycle + rider, all);
}

/// A tree whose file has so many units to the metre.
fn tree_in(per_m: f32) -> Figure {
    let paint = Paint::plain(SemanticTag::Vegetation, COLOUR);
    let mut mesh = Mesh::default();
    mesh.tube(paint, Vec3::ZERO, Vec3::Z * (3.0 * per_m), 0.25 * per_m, 0.125 * per_m, 12);
    mesh.ellipsoid(paint, Vec3::Z * (5.0 * per_m), Vec3::new(1.75, 1.75, 3.0) * per_m, 24, 32);
    // Files have none, and those of shapes made in code are metres.
    mesh.vertices.iter_mut().for_each(|v| v.uv = [0.0; 2]);
    Figure::new(Subject::Tree, Model::rigid(mesh)).expect("it fits")
}

#[test]
fn a_tree_is_as_detailed_in_any_unit() {
    let metres = tree_in(1.0);
    let triangles = Detail::ALL.map(|detail| metres.at(detail).at_rest().all_triangles().count());
    assert!(triangles.is_sorted_by(|a, b| a > b) && triangles[2] > 20, "{triangles:?}");
    for per_m in [1024.0, 1.0 / 64.0] {
        assert!(tree_in(per_m) == metres, "{per_m} units a metre");
    }
}

/// A street lamp whose glass, if it has one, hangs to the left.
fn lamp(digest: u8, code: u8) -> ModelsId {
    let mut mesh = Mesh::default();
    let steel = Paint::plain(SemanticTag::Pole, COLOUR);
    mesh.cuboid(steel, Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 100.0));
    mesh.cuboid(steel.coded(code), Vec3::new(-1.0, 9.0, 80.0), Vec3::new(1.0, 11.0, 90.0));
    let figure = Figure::new(Subject::Lamp, Model::rigid(mesh)).expect("it fits");
    Models::new([digest; 16].into(), BTreeMap::from([(Subject::Lamp, vec![figure])])).register()
}

#[test]
fn a_lamp_shines_where_its_glass_is() {
    let (_, scene) = scene_with(ActorKind::Car);
    let (position, size) = (scene.ego.position, Vec3::new(0.2, 0.2, 10.0));
    let prop = Prop { kind: PropKind::Lamp, position, heading_rad: 0.5, size, variant: 0 };
    let roads = MapData { props: vec![prop], ..MapData::clone(&network("city")) };
    let mut renderer = renderer(&roads.into());
    let mut place = |models: Option<ModelsId>| {
        renderer.draw(&scene, &Camera { models, ..Camera::driver(64, 32) }).expect("drawn");
        renderer.street_lamps[0].position
    };
    let made = place(None);
    // The model is 12 wide and 100 high: its middle stands on the place, five to the left of its pole.
    let glass = place(Some(lamp(5, CODE_STREET)));
    let expected = position + Quat::from_rotation_z(0.5) * Vec3::new(0.0, 0.5, 8.5);
    assert!(glass.distance(expected) < 1e-3, "{glass}, expected {expected}");
    assert_eq!([place(Some(lamp(6, 0))), place(None)], [made; 2], "one that says nothing shines where others do");
}

#[test]
fn what_would_be_distorted_is_refused() {
    let figure = |name: &str, size: Vec3| {
        let subject = Subject::named(name).expect("a name");
        let mut mesh = Mesh::default();
        mesh.cuboid(Paint::plain(subject.tag(), COLOUR), Vec3::new(0.0, 0.0, 1.0), size + Vec3::Z);
        Figure::new(subject, Model::rigid(mesh)).map(|_| ())
    };
    // A car of 4.5 x 1.85 x 1.5 m.
    assert_eq!(figure("car", Vec3::new(45.0, 18.0, 15.0)), Ok(()), "in decimetres");
    assert_eq!(figure("car", Vec3::new(3.1, 1.85, 1.5)), Ok(()));
    let said = figure("car", Vec3::new(2.9, 1.85, 1.5)).expect_err("refused");
    assert!(said.contains("1.55 times in length, 1.00 in width"), "{said}");
    assert!(figure("pedestrian", Vec3::new(0.3, 1.7, 1.8)).expect_err("refused").contains("on each side"));
    assert_eq!(figure("tree", Vec3::new(9.0, 1.0, 1.0)), Ok(()), "trees are as wide as their crowns");
}
